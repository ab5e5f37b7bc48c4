// fuzz_scene FOLDER COUNT [FIRST]: reads the scenes of a folder and its subfolders with COUNT random defects. Each
// must be read or give an Error.
#include <Teuchos_DefaultSerialComm.hpp>

#include "fuzz.hpp"
#include "laboratory/point.hpp"
#include "model/scene.hpp"

int main(int argc, char** argv) {
  using namespace sprekk;
  std::string folder = (std::filesystem::temp_directory_path() / "fuzz_scene_XXXXXX").string();
  if (!mkdtemp(folder.data())) {
    std::cerr << "fuzz_scene: " << folder << " cannot be made\n";
    return 2;
  }
  const auto path = folder + "/damaged.xml";
  const Teuchos::SerialComm<int> comm;
  const int status =
      fuzz::run(argc, argv, "fuzz_scene", ".xml", [&](const std::string& text, const std::string& damaged) {
        std::ofstream(path, std::ios::binary) << damaged;
        if (text.find("name=\"Point\"") != text.npos)
          laboratory::read_point_scene(comm, path);
        else
          model::read_scene(comm, path);
        return "";
      });
  std::filesystem::remove_all(folder);
  return status;
}
