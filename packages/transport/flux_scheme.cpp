#include "transport/flux_scheme.hpp"

#include "assembly/geometry.hpp"
#include "base/check.hpp"
#include "base/over_ranks.hpp"

#include <array>

namespace sprekk::transport {

namespace {

/// Returns whether (k/mu) A is parallel to d on all faces of a cell.
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

/// Number of non-orthogonal cells and number of cells on all ranks. Collective.
std::array<GlobalIndex, 2> skew_cells(const mesh::Mesh& mesh, const fields::Properties<laws::Mobility>& mobility) {
  std::array<GlobalIndex, 2> here{0, mesh.n_owned_cells};
  mesh::for_corners(mesh.shape, [&](auto shape) {
    Real X[mesh::n_nodes(shape())][mesh::dimension(shape())];
    for (LocalIndex c = 0; c < mesh.n_owned_cells; ++c) {
      assembly::gather_host<shape()>(mesh, c, X);
      here[0] += !is_orthogonal(CellFaces<shape()>(X), mobility.of_cell(mesh, c));
    }
  });
  return base::sum_over_ranks(*mesh.comm, here);
}

}  // namespace

ChosenScheme flux_scheme(const SchemeEntry& entry, const mesh::Mesh& mesh,
                         const fields::Properties<laws::Mobility>& mobility) {
  const auto& [section, name, property] = entry;
  const bool simplices = mesh::is_simplex(mesh.shape);
  SPREKK_CHECK(name != "rt0" || simplices,
               "Sprekk > {} > \"scheme\": \"rt0\" takes triangles and tetrahedra; others take tpfa or mimetic",
               section);
  if (name != "auto")
    return {name == "tpfa" ? FluxScheme::tpfa : name == "mimetic" ? FluxScheme::mimetic : FluxScheme::rt0, ""};
  if (simplices) return {FluxScheme::rt0, "auto: cells are simplices"};
  if (skew_cells(mesh, mobility)[0] > 0)
    return {FluxScheme::mimetic, fmt::format("auto: {} and cells are not orthogonal", property)};
  return {FluxScheme::tpfa, fmt::format("auto: {} and cells are orthogonal", property)};
}

std::string scheme_warning(const SchemeEntry& entry, const mesh::Mesh& mesh,
                           const fields::Properties<laws::Mobility>& mobility) {
  const auto [skew, all] = entry.name == "tpfa" ? skew_cells(mesh, mobility) : std::array<GlobalIndex, 2>{};
  if (skew == 0) return "";
  return fmt::format(
      "Sprekk > {} > \"scheme\": in {} of {} cells {} and faces are not orthogonal; there tpfa neglects the flux along "
      "faces, and its error does not decrease with the size of cells: use \"auto\"",
      entry.section, skew, all, entry.property);
}

std::string name_of(FluxScheme scheme) {
  return scheme == FluxScheme::rt0 ? "rt0" : scheme == FluxScheme::tpfa ? "tpfa" : "mimetic";
}

}  // namespace sprekk::transport
