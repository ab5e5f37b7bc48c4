// fuzz_msh FOLDER COUNT [FIRST]: reads the Gmsh meshes of a folder with COUNT random defects. Each must give a valid
// mesh or an Error.
#include <cmath>

#include "fuzz.hpp"
#include "mesh/mesh_info.hpp"
#include "mesh/msh_reader.hpp"

namespace {

using namespace sprekk;

/// Returns the defect of the mesh; empty if there is none.
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
  return fuzz::run(argc, argv, "fuzz_msh", ".msh", [](const std::string& text, const std::string& damaged) {
    mesh::MshOptions options;
    for (const char* name : {"f1", "f2", "f3"})
      if (text.find('"' + std::string(name) + '"') != text.npos) options.fractures[name] = {};
    return defect(mesh::parse_msh(damaged, "damaged.msh", options));
  });
}
