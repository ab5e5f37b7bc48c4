#include "transport/antidiffusion.hpp"

#include "assembly/geometry.hpp"
#include "assembly/loop.hpp"
#include "fields/properties.hpp"

#include <algorithm>
#include <map>

namespace sprekk::transport {

using mesh::Vector;
using mesh::operator+;
using mesh::operator-;
using mesh::operator*;

namespace {

/// Finds the neighbours. `facet_of(number of the end)`: -1 for an end without a neighbour.
template <class FacetOf>
void join(EndGraph& graph, const FacetOf& facet_of) {
  const auto n = graph.centre.size() * graph.n_ends;
  std::map<LocalIndex, std::vector<std::size_t>> sharing;
  for (std::size_t k = 0; k < n; ++k)
    if (const LocalIndex facet = facet_of(k); facet >= 0) sharing[facet].push_back(k);
  graph.neighbour.assign(n, -1);
  graph.end.assign(n, -1);
  for (const auto& [facet, ends] : sharing)
    for (std::size_t k = 0; k < ends.size() && ends.size() == 2; ++k) {
      const auto other = static_cast<int>(ends[1 - k]);
      graph.neighbour[ends[k]] = other / graph.n_ends;
      graph.end[ends[k]] = other % graph.n_ends;
    }
}

/// Solves (A + 1e-10 tr(A) I) g = b. If A is singular, e.g. for entities in a plane, g is close to the minimum-norm
/// solution.
Vector solve(Real (&A)[3][3], Vector b) {
  const Real shift = 1e-10 * (A[0][0] + A[1][1] + A[2][2]);
  for (int i = 0; i < 3; ++i) A[i][i] += shift;
  if (!(shift > 0)) return {};
  for (int k = 0; k < 3; ++k)
    for (int i = k + 1; i < 3; ++i) {
      const Real factor = A[i][k] / A[k][k];
      for (int j = k; j < 3; ++j) A[i][j] -= factor * A[k][j];
      b[i] -= factor * b[k];
    }
  for (int k = 2; k >= 0; --k) {
    for (int j = k + 1; j < 3; ++j) b[k] -= A[k][j] * b[j];
    b[k] /= A[k][k];
  }
  return b;
}

}  // namespace

EndGraph end_graph_of_cells(const mesh::Mesh& mesh) {
  EndGraph graph{.n_ends = mesh::n_faces(mesh.shape), .neighbour = {}, .end = {}, .centre = {}, .away = {}};
  for (LocalIndex c = 0; c < mesh.n_cells(); ++c) {
    graph.centre.push_back(mesh::cell_centre(mesh, c));
    for (int i = 0; i < graph.n_ends; ++i)
      graph.away.push_back(mesh::face_centre(mesh::face_corners(mesh, c, i)) - graph.centre.back());
  }
  std::vector<char> in_fracture(graph.away.size(), 0);
  for (const auto& [f, side] : assembly::fracture_sides(mesh)) {
    const auto& face = mesh.fracture_faces[f];
    in_fracture[face.cell[side] * graph.n_ends + face.local_face[side]] = 1;
  }
  join(graph, [&](std::size_t k) { return in_fracture[k] ? -1 : mesh.facets->of_cell[k]; });
  return graph;
}

EndGraph end_graph_of_fractures(const mesh::Mesh& mesh) {
  EndGraph graph{.n_ends = mesh::n_face_corners(mesh.shape), .neighbour = {}, .end = {}, .centre = {}, .away = {}};
  for (LocalIndex f = 0; f < mesh.n_fracture_faces(); ++f) {
    graph.centre.push_back(mesh.fracture_faces[f].centre);
    for (int k = 0; k < graph.n_ends; ++k) graph.away.push_back(mesh::ridge_centre(mesh, f, k) - graph.centre.back());
  }
  join(graph, [&](std::size_t k) { return mesh.facets->ridge[k]; });
  return graph;
}

Antidiffusion::Antidiffusion(const mesh::Mesh& mesh, fields::Entity entity, EndGraph graph)
    : graph_(std::move(graph)),
      of_ends_({"antidiffusion", entity, graph_.n_ends, ""}, mesh),
      of_bounds_({"bounds", entity, 2, ""}, mesh) {}

/// Fits the gradient to the neighbours, and to the ends without a neighbour.
Vector Antidiffusion::gradient(LocalIndex e, const std::vector<Real>& u, const std::vector<Real>& of_ends) const {
  Real A[3][3] = {};
  Vector b{};
  for (int i = 0; i < graph_.n_ends; ++i) {
    const auto k = e * graph_.n_ends + i;
    const LocalIndex other = graph_.neighbour[k];
    const Vector d = other < 0 ? graph_.away[k] : graph_.centre[other] - graph_.centre[e];
    const Real rise = (other < 0 ? of_ends[k] : u[other]) - u[e], weight = 1 / mesh::dot(d, d);
    for (int l = 0; l < 3; ++l) {
      for (int m = 0; m < 3; ++m) A[l][m] += weight * d[l] * d[m];
      b[l] += weight * rise * d[l];
    }
  }
  return solve(A, b);
}

/// Returns s_i: the distance of the neighbour from the end, divided by the sum of both distances.
Real Antidiffusion::share(std::size_t k) const {
  const Real own = mesh::norm(graph_.away[k]),
             other = mesh::norm(graph_.away[graph_.neighbour[k] * graph_.n_ends + graph_.end[k]]);
  return other / (own + other);
}

void Antidiffusion::keep(const std::vector<Real>& u, const std::vector<Real>& of_ends, const std::vector<Real>& flow,
                         const std::vector<Real>& stored, Real dt, const Stored& saved) const {
  const int n = graph_.n_ends;
  for (LocalIndex e = 0; e < static_cast<LocalIndex>(saved.extent(0)); ++e) {
    const bool began = dt > 0 && saved(e, n + 3) > 0;  // otherwise u_old is unknown
    const Real late = (u[e] - saved(e, n)) / 2;
    const Vector G = began ? gradient(e, u, of_ends) : Vector{};
    Real largest = u[e], minimum = u[e];
    for (int i = 0; i < n; ++i) {
      const auto k = e * n + i;
      const LocalIndex other = graph_.neighbour[k];
      largest = std::max({largest, of_ends[k], other < 0 ? u[e] : u[other]});
      minimum = std::min({minimum, of_ends[k], other < 0 ? u[e] : u[other]});
      const bool leaves = began && other >= 0 && flow[k] > 0;
      const Real f = leaves ? dt * flow[k] * (mesh::dot(G, graph_.away[k]) - share(k) * (of_ends[k] - u[e]) - late) : 0;
      saved(e, i) = leaves && f * (u[other] - u[e]) > 0 ? f : 0;
    }
    saved(e, n) = u[e];
    saved(e, n + 1) = largest;
    saved(e, n + 2) = minimum;
    saved(e, n + 3) = stored[e];
  }
}

std::vector<Real> Antidiffusion::gains(const Stored& saved) const {
  const int n = graph_.n_ends;
  const auto n_owned = static_cast<LocalIndex>(saved.extent(0));
  std::vector<Real> own, shares, gained(n_owned, 0);
  for (LocalIndex e = 0; e < n_owned; ++e)
    for (int i = 0; i < n; ++i) own.push_back(saved(e, i));
  const auto f = with_ghosts(of_ends_, own);
  const auto inflow = [&](LocalIndex e, int i) {  // through end i, minus the outflow there
    const auto k = e * n + i;
    const LocalIndex other = graph_.neighbour[k];
    return other < 0 ? 0 : f[other * n + graph_.end[k]] - f[k];
  };
  for (LocalIndex e = 0; e < n_owned; ++e) {
    Real up = 0, down = 0;
    for (int i = 0; i < n; ++i) {
      up += std::max(Real(0), inflow(e, i));
      down -= std::min(Real(0), inflow(e, i));
    }
    const Real C = saved(e, n + 3), room = C * (saved(e, n + 1) - saved(e, n)),
               depth = C * (saved(e, n) - saved(e, n + 2));
    shares.push_back(up > room ? room / up : 1);
    shares.push_back(down > depth ? depth / down : 1);
  }
  const auto share = with_ghosts(of_bounds_, shares);  // allowed fractions of gains and losses
  for (LocalIndex e = 0; e < n_owned; ++e)
    for (int i = 0; i < n; ++i) {
      const LocalIndex other = graph_.neighbour[e * n + i];
      const Real gain = inflow(e, i);
      if (gain == 0) continue;
      gained[e] += gain * (gain > 0 ? std::min(share[2 * e], share[2 * other + 1])
                                    : std::min(share[2 * e + 1], share[2 * other]));
    }
  return gained;
}

}  // namespace sprekk::transport
