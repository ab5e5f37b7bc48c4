// Stabilisation that prevents pressure oscillations in steps too short for drainage.
#pragma once

#include "assembly/geometry.hpp"
#include "base/expression.hpp"
#include "base/host_table.hpp"
#include "transport/hybrid_cell.hpp"
#include "transport/hybrid_diffusion.hpp"

#include <vector>

namespace sprekk::transport {

/// Hybrid form of -div(beta grad dp/dt) in rock cells, with beta = softness S. S is the mean of x x^T over the corners
/// of a cell, relative to its centre, e.g. h^2/4 for a cube of edge h (Aguilar, Gaspar, Lisbona and Rodrigo 2008). It
/// vanishes with h^2. Faces on fractures are impermeable.
struct Stabilisation {
  std::vector<Real> softness = {};      ///< [local cell] alpha^2/(lambda + 2G), 1/Pa; empty: no stabilisation
  base::Expression initial = 0;         ///< initial pressure, Pa, with zero volumes
  FluxScheme scheme = FluxScheme::rt0;  ///< scheme of the flow in rock
};

/// Outward volumes through the faces of cells since the start, m^3 (2D: m^2); flows if multiplied by StoredFlow::rate.
/// T is the matrix of beta.
template <Shape shape>
using StabilisingFlow =
    StoredFlow<mesh::n_faces(shape), assembly::Slots<assembly::Slot<1, 1>, assembly::Slot<mesh::n_faces(shape), 1>>>;

template <Shape shape>
StabilisingFlow<shape> stabilising_flow(const mesh::Mesh& mesh, const Stabilisation& of) {
  constexpr int dim = mesh::dimension(shape), n_corners = mesh::n_corners(shape), n_faces = mesh::n_faces(shape);
  std::vector<int> closed(mesh.n_cells() * n_faces, 0);
  for (const auto& [f, side] : assembly::fracture_sides(mesh)) {
    const auto& face = mesh.fracture_faces[f];
    closed[face.cell[side] * n_faces + face.local_face[side]] = 1;
  }
  const bool varies = !of.initial.is_constant();
  const auto initial = [&](const auto& x) { return of.initial(x, 0); };
  const base::HostTable<Real**> T("T", mesh.n_cells(), n_faces * n_faces),
      lift("lift", varies ? mesh.n_cells() : 0, n_faces);
  Real X[n_corners][dim];
  for (LocalIndex c = 0; c < mesh.n_cells(); ++c) {
    if (of.softness[c] == 0) continue;
    assembly::gather_host<shape>(mesh, c, X);
    const CellFaces<shape> faces(X);
    laws::Mobility beta;
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j)
        for (int k = 0; k < n_corners; ++k)
          beta.value[i][j] += of.softness[c] * faces.corners[k][i] * faces.corners[k][j] / n_corners;
    FlowMatrix<shape> matrix(faces, beta, of.scheme);
    for (int e = 0; e < n_faces; ++e)
      if (closed[c * n_faces + e]) matrix.close(e);
    for (int i = 0; i < n_faces; ++i)
      for (int j = 0; j < n_faces; ++j) T(c, i * n_faces + j) = matrix.T[i][j];
    if (!varies) continue;
    const Real mean = assembly::cell_mean(mesh, c, initial)[1];
    for (int j = 0; j < n_faces; ++j)
      lift(c, j) = assembly::face_mean(mesh, c, j, [&](const auto&, const auto& x) { return initial(x); }) - mean;
  }
  return {.T = T.on_device(), .lift = lift.on_device()};
}

/// Sum of the flow `Flow` in cells and the stabilising flow: q + rate (V(x) - V) - before G. V: volumes until the start
/// of the step. G: volumes of the previous step.
template <class Flow, Shape shape>
struct StabilisedFlow {
  static constexpr int n_ends = Flow::n_ends, n = n_ends, m = Flow::Columns::size;
  using Columns = typename Flow::Columns;
  Flow base;
  StabilisingFlow<shape> volumes;  // empty T: none
  ConstView<Real**> passed;        // [local cell] V of the faces, then G
  Real rate, before;

  KOKKOS_INLINE_FUNCTION void flow(int e, const Real (&x)[m], Real (&q)[n]) const {
    base.flow(e, x, q);
    if (volumes.T.extent(0) == 0) return;
    Real p[1 + n], V[n];
    for (int k = 0; k <= n; ++k) p[k] = x[k];
    volumes.flow(e, p, V);
    for (int i = 0; i < n; ++i) q[i] += rate * (V[i] - passed(e, i)) - before * passed(e, n + i);
  }

  KOKKOS_INLINE_FUNCTION void dflow(int e, const Real (&x)[m], Real (&dq)[n][m]) const {
    base.dflow(e, x, dq);
    if (volumes.T.extent(0) == 0) return;
    Real p[1 + n], dV[n][1 + n];
    for (int k = 0; k <= n; ++k) p[k] = x[k];
    volumes.dflow(e, p, dV);
    for (int i = 0; i < n; ++i)
      for (int k = 0; k <= n; ++k) dq[i][k] += rate * dV[i][k];
  }
};

}  // namespace sprekk::transport
