#include "physics/hybrid_cell.hpp"

#include "base/check.hpp"

#include <Teuchos_CommHelpers.hpp>

namespace sprekk::physics {

namespace {

/// Whether (k/mu) A is parallel to d on all faces of a cell.
template <Shape shape>
bool is_orthogonal(const CellFaces<shape>& faces, const laws::Mobility& mobility) {
  constexpr int dim = mesh::dimension(shape);
  for (int f = 0; f < faces.n; ++f) {
    Real flux[dim] = {}, flux2 = 0, distance2 = 0, dot = 0;
    for (int i = 0; i < dim; ++i) {
      for (int j = 0; j < dim; ++j) flux[i] += mobility.value[i][j] * faces.area[f][j];
      flux2 += flux[i] * flux[i];
      distance2 += faces.centre[f][i] * faces.centre[f][i];
      dot += flux[i] * faces.centre[f][i];
    }
    if (!(dot > 0 && flux2 * distance2 - dot * dot <= 1e-10 * flux2 * distance2)) return false;
  }
  return true;
}

}  // namespace

ChosenScheme flux_scheme(const std::string& section, const std::string& name, const mesh::Mesh& mesh,
                         const std::vector<laws::Mobility>& mobility, const std::vector<int>& mobility_of_cell) {
  const bool simplices = mesh::is_simplex(mesh.shape);
  SPREKK_CHECK(name != "rt0" || simplices,
               "Sprekk > {} > \"scheme\": \"rt0\" takes triangles and tetrahedra; others take tpfa or mimetic",
               section);
  if (name != "auto")
    return {name == "tpfa" ? FluxScheme::tpfa : name == "mimetic" ? FluxScheme::mimetic : FluxScheme::rt0, ""};
  if (simplices) return {FluxScheme::rt0, "auto: cells are simplices"};
  int here = 0, anywhere = 0;  // cells that are not
  mesh::for_shape(mesh.shape, [&](auto shape) {
    Real X[mesh::n_nodes(shape())][mesh::dimension(shape())];
    for (LocalIndex c = 0; c < mesh.n_owned_cells && !here; ++c) {
      assembly::gather_host<shape()>(mesh, c, X);
      here = !is_orthogonal(CellFaces<shape()>(X),
                            mobility[mobility_of_cell.empty() ? mesh.cell_region[c] : mobility_of_cell[c]]);
    }
  });
  Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_MAX, 1, &here, &anywhere);
  if (anywhere) return {FluxScheme::mimetic, "auto: permeability and cells are not orthogonal"};
  return {FluxScheme::tpfa, "auto: permeability and cells are orthogonal"};
}

std::string name_of(FluxScheme scheme) {
  return scheme == FluxScheme::rt0 ? "rt0" : scheme == FluxScheme::tpfa ? "tpfa" : "mimetic";
}

}  // namespace sprekk::physics
