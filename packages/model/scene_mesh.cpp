#include "assembly/quarter_points.hpp"
#include "base/check.hpp"
#include "base/text.hpp"
#include "mesh/msh_reader.hpp"
#include "mesh/periodic.hpp"
#include "mesh/raise_order.hpp"
#include "mesh/refine.hpp"
#include "mesh/renumber.hpp"
#include "mesh/tips.hpp"
#include "model/scene.hpp"

#include <algorithm>

namespace sprekk::model {

namespace {

/// Applies the entry "tips" to the mesh.
template <class AnyMesh>
void enrich(AnyMesh& mesh, const std::string& tips) {
  if (tips == "plain") return;
  if (mesh::order(mesh.shape) == 1) {
    mesh::mark_tips(mesh);
  } else {
    assembly::move_to_quarter_points(mesh);
    mesh.tip = mesh::tip_nodes(mesh);
  }
}

}  // namespace

mesh::GlobalMesh Scene::make_mesh() const {
  if (bisection && !bisection->has_value()) bisection->emplace(bisected());
  auto result = bisection ? (*bisection)->mesh(order()) : accuracy ? bisected().mesh(order()) : read_mesh();
  if (refinements() > 0)
    mesh::turn_for_refinement(result);
  else
    enrich(result, tips());
  return result;
}

RCP<const mesh::Mesh> Scene::refined(RCP<const mesh::Mesh> coarse) const {
  if (refinements() == 0) return coarse;
  auto fine = mesh::refined(*coarse, refinements());
  if (order() == 2) fine = mesh::raise_order(*fine);
  enrich(*fine, tips());
  return fine;
}

const std::string& Scene::tips() const { return mesh_file ? mesh_file->tips : mesh.tips; }

int Scene::refinements() const { return mesh_file ? mesh_file->refinements : mesh.refinements; }

int Scene::order() const { return mesh_file ? mesh_file->order.value_or(1) : mesh.order; }

mesh::Bisection Scene::bisected() const {
  const auto coarse = read_mesh();
  const bool is_2d = growth || mesh::dimension(coarse.shape) == 2;
  SPREKK_CHECK(mesh::is_simplex(coarse.shape) && is_2d == (mesh::dimension(coarse.shape) == 2),
               "Sprekk > {}, must be {} with \"{}\"",
               mesh_file ? fmt::format("Mesh file > \"path\": {} has other cells", mesh_file->path)
                         : fmt::format("Mesh > \"cell\": is {}", mesh.cell),
               is_2d ? "triangle" : "tetrahedron", growth ? "Growth" : "Accuracy");
  return mesh::Bisection(coarse);
}

mesh::GlobalMesh Scene::read_mesh() const {
  const bool raised_later = refinements() > 0 || accuracy || bisection;
  if (!mesh_file) {
    auto box = mesh;
    if (raised_later) box.order = 1;
    return mesh::make_box(box);
  }
  SPREKK_CHECK(!mesh_file->path.empty(),
               "Sprekk > Mesh file > \"path\": missing; the mesh of a network is made by `./sprekk mesh {} -o FILE`, "
               "and by `./sprekk run` and `./sprekk check`",
               origin);
  mesh::MshOptions options;
  if (!raised_later) options.order = mesh_file->order;
  for (const auto& [name, fracture] : mesh_file->fractures) {
    auto& orientation = options.fractures[name];
    orientation.swap_sides = fracture.swap_sides;
    const auto n = fracture.reference_normal ? fracture.reference_normal->size() : 0;
    if (n != 2 && n != 3) continue;  // other lengths are refused below
    orientation.reference.emplace();
    std::copy_n(fracture.reference_normal->begin(), std::min<std::size_t>(3, fracture.reference_normal->size()),
                orientation.reference->begin());
  }
  std::vector<std::pair<std::string, std::string>> pairs;
  for (std::size_t i = 0; i + 1 < mesh_file->periodic.size(); i += 2)
    pairs.emplace_back(mesh_file->periodic[i], mesh_file->periodic[i + 1]);
  auto result = mesh::read_msh(mesh_file->path, options);
  SPREKK_CHECK(refinements() == 0 || mesh::order(result.shape) == 1,
               "Sprekk > Mesh file > \"refinements\": is {}, must be 0 for cells of order 2 as in {}", refinements(),
               mesh_file->path);
  SPREKK_CHECK(!accuracy || mesh::order(result.shape) == 1,
               "Sprekk > Mesh file > \"path\": {} has cells of order 2, must have order 1 with \"Accuracy\"; \"order\" "
               "raises it",
               mesh_file->path);
  for (const auto& [name, fracture] : mesh_file->fractures) {
    const auto n = fracture.reference_normal ? fracture.reference_normal->size() : 0;
    SPREKK_CHECK(n == 0 || static_cast<int>(n) == result.dim(),
                 "Sprekk > Mesh file > fractures > {} > \"reference normal\": has {}, needs {} as {} has that "
                 "dimension",
                 name, base::counted(n, "component"), result.dim(), mesh_file->path);
  }
  return mesh::tie_periodic(mesh::in_spatial_order(result), pairs);
}

}  // namespace sprekk::model
