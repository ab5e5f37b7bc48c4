// fuzz_msh FOLDER COUNT [FIRST]: reads the gmsh meshes of a folder, damaged in COUNT ways. Each must give a sound mesh
// or an Error. A failure names the number of the way, which is FIRST to repeat it alone.
#include <cmath>
#include <cstdlib>
#include <iostream>

#include "base/check.hpp"
#include "mesh/mesh_info.hpp"
#include "mesh/msh_reader.hpp"
#include "mutate.hpp"

namespace {

using namespace sprekk;

/// What is wrong with the mesh, empty if nothing is.
std::string defect(const mesh::GlobalMesh& mesh) {
  const auto is_index = [](auto i, auto n) { return i >= 0 && i < static_cast<decltype(i)>(n); };
  for (Real x : mesh.coordinates)
    if (!std::isfinite(x)) return "a coordinate is not finite";
  for (auto node : mesh.cells)
    if (!is_index(node, mesh.n_nodes())) return "a cell has a node that is none";
  for (int region : mesh.cell_region)
    if (!is_index(region, mesh.region_names.size())) return "a cell has a region that is none";
  for (const auto& face : mesh.fracture_faces)
    for (int side : {mesh::minus, mesh::plus})
      if (!is_index(face.cell[side], mesh.n_cells()) || !is_index(face.local_face[side], n_faces(mesh.shape)))
        return "a fracture face has a cell that is none";
  for (const auto& face : mesh.boundary_faces)
    if (!is_index(face.cell, mesh.n_cells()) || !is_index(face.boundary, mesh.boundary_names.size()))
      return "a boundary face has a cell that is none";
  const auto info = describe(mesh);
  if (!(info.smallest_scaled_jacobian > 0)) return "a cell is inside out";
  if (mesh::to_text(info).empty()) return "it has no description";
  return "";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: fuzz_msh FOLDER COUNT [FIRST]\n";
    return 2;
  }
  const auto texts = fuzz::contents(argv[1], ".msh");
  const long first = argc > 3 ? std::atol(argv[3]) : 0, count = std::atol(argv[2]);
  if (texts.empty() || count <= 0) {
    std::cerr << "fuzz_msh: nothing to do\n";
    return 2;
  }
  long n_meshes = 0;
  for (long i = first; i < first + count; ++i) {
    const auto& text = texts[i % texts.size()];
    mesh::MshOptions options;
    for (const char* name : {"f1", "f2", "f3"})
      if (text.find('"' + std::string(name) + '"') != text.npos) options.fractures[name] = {};
    try {
      const auto what = defect(mesh::parse_msh(fuzz::Mutator(i).damaged(text), "damaged.msh", options));
      if (!what.empty()) {
        std::cerr << "fuzz_msh: way " << i << ": " << what << '\n';
        return 1;
      }
      ++n_meshes;
    } catch (const Error&) {
    } catch (const std::exception& error) {
      std::cerr << "fuzz_msh: way " << i << ": not an Error: " << error.what() << '\n';
      return 1;
    }
  }
  std::cout << count << " damaged meshes: " << n_meshes << " read, " << count - n_meshes << " refused\n";
}
