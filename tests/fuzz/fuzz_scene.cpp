// fuzz_scene FOLDER COUNT [FIRST]: reads the scenes of a folder, damaged in COUNT ways. Each must be read or give an
// Error. A failure names the number of the way, which is FIRST to repeat it alone.
#include <Teuchos_DefaultSerialComm.hpp>
#include <cstdlib>
#include <iostream>

#include "base/check.hpp"
#include "model/scene.hpp"
#include "mutate.hpp"

int main(int argc, char** argv) {
  using namespace sprekk;
  if (argc < 3) {
    std::cerr << "usage: fuzz_scene FOLDER COUNT [FIRST]\n";
    return 2;
  }
  const auto texts = fuzz::contents(argv[1], ".xml");
  const long first = argc > 3 ? std::atol(argv[3]) : 0, count = std::atol(argv[2]);
  if (texts.empty() || count <= 0) {
    std::cerr << "fuzz_scene: nothing to do\n";
    return 2;
  }
  std::string folder = (std::filesystem::temp_directory_path() / "fuzz_scene_XXXXXX").string();
  if (!mkdtemp(folder.data())) {
    std::cerr << "fuzz_scene: " << folder << " cannot be made\n";
    return 2;
  }
  const auto path = folder + "/damaged.xml";
  const Teuchos::SerialComm<int> comm;
  long n_scenes = 0;
  int status = 0;
  for (long i = first; i < first + count && status == 0; ++i) {
    std::ofstream(path, std::ios::binary) << fuzz::Mutator(i).damaged(texts[i % texts.size()]);
    try {
      model::read_scene(comm, path);
      ++n_scenes;
    } catch (const Error&) {
    } catch (const std::exception& error) {
      std::cerr << "fuzz_scene: way " << i << ": not an Error: " << error.what() << '\n';
      status = 1;
    }
  }
  std::filesystem::remove_all(folder);
  if (status == 0)
    std::cout << count << " damaged scenes: " << n_scenes << " read, " << count - n_scenes << " refused\n";
  return status;
}
