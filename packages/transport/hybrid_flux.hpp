// Geometry of simplices and fracture faces in the hybrid form, and the flows through their ends.
#pragma once

#include "assembly/constraints.hpp"
#include "assembly/geometry.hpp"
#include "base/host_table.hpp"
#include "base/over_ranks.hpp"
#include "fields/layout.hpp"
#include "mesh/facets.hpp"
#include "transport/face_plane.hpp"
#include "transport/hybrid_diffusion.hpp"
#include "transport/simplex_flux.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>

namespace sprekk::transport {

/// Transmissivity of local fracture faces, m^3/(Pa s), and factors of the potential differences to their ridges,
/// [face * d + ridge]; no factors: 1.
struct FaceTransmissivity {
  std::vector<Real> of_faces, at_ridges = {};
};

struct HybridFluxParameters {
  HybridDiffusionParameters rock = {};                         ///< as in the module
  std::vector<Real> transmissivity = {};                       ///< [local fracture face] m^3/(Pa s)
  std::vector<assembly::DirichletCondition> constrained = {};  ///< conditions that prescribe values on facets
  std::map<LocalIndex, Real> fed = {};  ///< 2D: [fracture face with a well] distance of the well from the centre, m
};

/// Potential of a compressible fluid, (e - 1)/c.
inline Real potential_of(const laws::Fluid& fluid, Real p) {
  const Real c = fluid.compressibility;
  return c == 0 ? p : std::expm1(c * (p - fluid.reference_pressure)) / c;
}

/// Potentials of a state, or their change under small forces. Compressible fluid: (e - 1)/c, whose gradient drives the
/// mass flux.
class Potentials {
 public:
  using Layouts = std::array<const fields::Layout*, 2>;
  enum Of { cell, facet };

  /// Imports ghost values. `dp`: change of p, optional. Collective.
  Potentials(const Layouts& layouts, const laws::Fluid& fluid, const std::array<const fields::Vector*, 2>& p,
             const std::array<const fields::Vector*, 2>& dp = {})
      : fluid_(fluid), is_linearized_(dp[0]) {
    for (int k = 0; k < 2; ++k) {
      p_[k] = with_ghosts(*layouts[k], *p[k]);
      if (is_linearized_) dp_[k] = with_ghosts(*layouts[k], *dp[k]);
    }
  }

  bool is_linearized() const { return is_linearized_; }
  Real operator()(Of of, LocalIndex i) const {
    return is_linearized_ ? fluid_.density(p_[of][i]) * dp_[of][i] : of_pressure(p_[of][i]);
  }
  Real of_pressure(Real p) const { return potential_of(fluid_, p); }
  /// Driving potential difference from an entity to one of its ends, see laws::Fluid.
  Real drop(Of of, LocalIndex entity, LocalIndex end, Real lift) const {
    const Real a = p_[of][entity], b = p_[facet][end];
    if (!is_linearized_) return fluid_.drop(a, b, lift);
    return fluid_.ddrop_da(a, b, lift) * dp_[of][entity] + fluid_.ddrop_db(a, b, lift) * dp_[facet][end];
  }
  /// Factor of rho_0 g in the gradient: e^2.
  Real heaviness(Of of, LocalIndex i) const {
    const Real e = fluid_.density(p_[of][i]);
    return e * e * (is_linearized_ ? 2 * fluid_.compressibility * dp_[of][i] : 1);
  }

 private:
  static std::vector<Real> with_ghosts(const fields::Layout& layout, const fields::Vector& owned) {
    fields::Vector all(layout.ghosted());
    all.doImport(owned, *layout.import(), Tpetra::REPLACE);
    const auto view = all.getLocalViewHost(Tpetra::Access::ReadOnly);
    return {view.data(), view.data() + view.extent(0)};
  }

  laws::Fluid fluid_;
  bool is_linearized_;
  std::array<std::vector<Real>, 2> p_, dp_;
};

/// Outward flows, [owned cell * (d + 1) + face] and [owned fracture face * d + ridge].
struct HybridFlows {
  std::vector<Real> in_cells, in_faces;
};

/// Geometry and flows of owned cells and fracture faces. Holds references to the layouts of cells and facets.
template <Shape shape>
class HybridFlux {
 public:
  static constexpr int dim = mesh::dimension(shape), n = dim + 1;
  using InCell = SimplexFlux<dim>;
  using InFace = SimplexFlux<dim - 1>;
  using Of = Potentials::Of;

  struct Cell {
    InCell flux;
    CellFaces<shape> faces;
  };
  struct Face {
    InFace flux;
    FacePlane<shape> plane;
  };

  HybridFlux(RCP<const mesh::Mesh> mesh, const Potentials::Layouts& layouts, HybridFluxParameters parameters)
      : mesh_(mesh), layouts_(layouts), parameters_(std::move(parameters)) {
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c) add_cell(c);
    find_faces();
    for (const auto& [f, s] : assembly::fracture_sides(*mesh_)) {
      const auto& face = mesh_->fracture_faces[f];
      if (face.cell[s] < mesh_->n_owned_cells && exchange(f) < INFINITY)
        resistance_[face.cell[s] * n + face.local_face[s]] = 1 / (exchange(f) * face.area);
    }
  }

  void set_transmissivity(FaceTransmissivity present) {
    parameters_.transmissivity = std::move(present.of_faces);
    at_ridges_ = std::move(present.at_ridges);
    find_faces();
  }

  const Potentials::Layouts& layouts() const { return layouts_; }
  const HybridFluxParameters& parameters() const { return parameters_; }
  const Cell& cell(LocalIndex c) const { return cells_[c]; }
  const Face& face(LocalIndex f) const { return faces_[f]; }

  /// Corner opposite to a face of a cell, or to a ridge of a fracture face.
  static constexpr int opposite(int face) { return dim == 2 ? (face + 2) % 3 : face; }
  static constexpr int opposite_ridge(int ridge) { return dim == 2 ? 1 - ridge : (ridge + 2) % 3; }

  /// Transfer coefficient per area of each side of a fracture face, m/(Pa s); infinite: no resistance.
  Real exchange(LocalIndex f) const {
    return parameters_.rock.exchange.empty() ? INFINITY : parameters_.rock.exchange[f];
  }
  LocalIndex node(LocalIndex cell, int k) const { return mesh_->cells[cell * mesh_->nodes_per_cell() + k]; }
  LocalIndex facet_of_cell(LocalIndex c, int k) const { return mesh_->facets->of_cell[c * n + k]; }
  LocalIndex facet_of_face(LocalIndex f, int k) const { return mesh_->facets->ridge[f * dim + k]; }

  /// Outward flows of potential differences, [face or ridge]. The result is indexed by the corner opposite to each end.
  typename InCell::Flows in_cell(LocalIndex c, const std::array<Real, n>& drops) const {
    FlowMatrix<shape> matrix(cells_[c].faces, parameters_.rock.mobility.of_cell(*mesh_, c), parameters_.rock.scheme);
    for (int k = 0; k < n; ++k)
      if (const auto found = resistance_.find(c * n + k); found != resistance_.end())
        add_resistance(matrix.T, k, found->second);
    typename InCell::Flows q{};
    for (int k = 0; k < n; ++k)
      for (int l = 0; l < n; ++l) q[opposite(l)] += matrix.T[l][k] * drops[k];
    return q;
  }
  typename InFace::Flows in_face(LocalIndex f, const std::array<Real, dim>& drops) const {
    typename InFace::Flows q{};
    for (int k = 0; k < dim; ++k) {
      const Real drop = at_ridges_.empty() ? drops[k] : at_ridges_[f * dim + k] * drops[k];
      for (int l = 0; l < dim; ++l) q[opposite_ridge(l)] += faces_[f].plane.T[l][k] * drop;
    }
    return q;
  }
  /// Outward flows of a state.
  typename InCell::Flows in_cell(LocalIndex c, const Potentials& u) const {
    std::array<Real, n> drops{};
    for (int k = 0; k < n; ++k) drops[k] = u.drop(Of::cell, c, facet_of_cell(c, k), lift(cells_[c].faces.centre[k]));
    return in_cell(c, drops);
  }
  typename InFace::Flows in_face(LocalIndex f, const Potentials& u) const {
    std::array<Real, dim> drops{};
    for (int k = 0; k < dim; ++k)
      drops[k] = u.drop(Of::facet, mesh_->facets->fracture_face[f], facet_of_face(f, k), lift(faces_[f].plane.d[k]));
    return in_face(f, drops);
  }

  /// Face of a cell, or end of a fracture face, with a prescribed potential.
  struct Constrained {
    bool in_rock;
    LocalIndex entity;  ///< cell or fracture face
    int end;            ///< face of the cell, or ridge
    LocalIndex facet;
    int condition;
  };
  /// Ends with a prescribed potential. `mask`: [owned facet] nonzero if prescribed. Collective.
  std::vector<Constrained> constrained(ConstView<char*> mask) const {
    fields::Vector owned(layouts_[1]->owned()), all(layouts_[1]->ghosted());
    {
      const auto from = base::to_host(mask);
      const auto to = owned.getLocalViewHost(Tpetra::Access::OverwriteAll);
      for (std::size_t k = 0; k < from.extent(0); ++k) to(k, 0) = from(k);
    }
    all.doImport(owned, *layouts_[1]->import(), Tpetra::REPLACE);
    const auto is_constrained = all.getLocalViewHost(Tpetra::Access::ReadOnly);
    std::vector<Constrained> result;
    for (const auto& face : mesh_->boundary_faces) {
      const LocalIndex facet = facet_of_cell(face.cell, face.local_face);
      if (!face.owned || is_constrained(facet, 0) == 0) continue;
      const int condition = condition_of(face.boundary, mesh_->cell_region[face.cell], -1);
      if (condition < static_cast<int>(parameters_.constrained.size()))  // else another condition applies
        result.push_back({true, face.cell, face.local_face, facet, condition});
    }
    std::map<std::pair<LocalIndex, int>, int> conditions;  // [end]; several boundaries may share an end
    for (const auto& rim : mesh_->facets->rims) {
      if (rim.face >= mesh_->n_owned_fracture_faces || is_constrained(facet_of_face(rim.face, rim.ridge), 0) == 0)
        continue;
      const int condition = condition_of(rim.boundary, -1, mesh_->fracture_faces[rim.face].fracture);
      if (condition == static_cast<int>(parameters_.constrained.size())) continue;  // another condition applies
      const auto [known, is_new] = conditions.emplace(std::pair(rim.face, rim.ridge), condition);
      if (!is_new) known->second = std::min(known->second, condition);
    }
    for (const auto& [end, condition] : conditions)
      result.push_back({false, end.first, end.second, facet_of_face(end.first, end.second), condition});
    return result;
  }

  /// Point of a prescribed end, halfway between corners a and b of the cell or the fracture face. `share`: weight in
  /// the mean of a quadratic function over the end.
  struct ConstrainedPoint {
    int a, b;
    mesh::Vector x;
    Real share;
  };
  std::vector<ConstrainedPoint> points(const Constrained& constrained) const {
    std::vector<ConstrainedPoint> result;
    const auto add = [&](int a, int b, LocalIndex at_a, LocalIndex at_b, Real share) {
      mesh::Vector x{};
      for (int i = 0; i < dim; ++i)
        x[i] = (mesh_->coordinates[at_a * dim + i] + mesh_->coordinates[at_b * dim + i]) / 2;
      result.push_back({a, b, x, share});
    };
    if (constrained.in_rock) {
      const auto& corners = mesh::face_nodes(shape)[constrained.end];
      for (int a = 0; a < dim; ++a)
        for (int b = a; b < dim; ++b) {
          const Real share = a == b ? (dim == 2 ? 1.0 / 6 : 0) : (dim == 2 ? 2.0 / 3 : 1.0 / 3);
          add(corners[a], corners[b], node(constrained.entity, corners[a]), node(constrained.entity, corners[b]),
              share);
        }
      return result;
    }
    const auto& nodes = mesh_->fracture_faces[constrained.entity].nodes[mesh::minus];
    const int last = dim == 2 ? constrained.end : (constrained.end + 1) % 3;
    for (const auto& [a, b] :
         {std::pair(constrained.end, constrained.end), std::pair(constrained.end, last), std::pair(last, last)})
      add(a, b, nodes[a], nodes[b], a == b ? 1.0 / 6 : 2.0 / 3);
    return result;
  }
  Real prescribed(const Constrained& constrained, const mesh::Vector& x, Real t) const {
    return (*parameters_.constrained[constrained.condition].values[0])(x, t);
  }

 private:
  void add_cell(LocalIndex c) {
    Real X[mesh::n_nodes(shape)][dim], corners[n][dim];
    assembly::gather_host<shape>(*mesh_, c, X);
    for (int k = 0; k < n; ++k) std::copy_n(X[k], dim, corners[k]);
    cells_.push_back({InCell(corners, parameters_.rock.mobility.of_cell(*mesh_, c)), CellFaces<shape>(X)});
  }
  void find_faces() {
    faces_.clear();
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) {
      const auto& face = mesh_->fracture_faces[f];
      const Real T = parameters_.transmissivity[f];
      Real X[dim][dim - 1];
      for (int k = 0; k < dim; ++k)
        for (int t = 0; t < dim - 1; ++t) {
          X[k][t] = 0;
          for (int i = 0; i < dim; ++i)
            X[k][t] += face.frame[1 + t][i] * mesh_->coordinates[face.nodes[mesh::minus][k] * dim + i];
        }
      faces_.push_back(
          {InFace(X, laws::Mobility::isotropic(T)), FacePlane<shape>(*mesh_, f, T, parameters_.rock.scheme)});
    }
  }
  template <class Way>
  Real lift(const Way& way) const {
    Real sum = 0;
    for (int i = 0; i < dim; ++i) sum += parameters_.rock.weight[i] * way[i];
    return sum;
  }
  /// First condition on a face of the rock (fracture < 0), or on an end of a fracture.
  int condition_of(int boundary, int region, int fracture) const {
    const auto& all = parameters_.constrained;
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) {
      if (one.boundary != boundary) return false;
      return fracture < 0 ? one.fracture < 0 && (one.region < 0 || one.region == region)
                          : one.region < 0 && (one.fracture < 0 || one.fracture == fracture);
    });
    return static_cast<int>(found - all.begin());
  }

  RCP<const mesh::Mesh> mesh_;
  Potentials::Layouts layouts_;
  HybridFluxParameters parameters_;
  std::vector<Cell> cells_;
  std::vector<Face> faces_;
  std::vector<Real> at_ridges_;                      // see FaceTransmissivity
  std::unordered_map<LocalIndex, Real> resistance_;  // [cell * n + face] Pa s/m^3
};

}  // namespace sprekk::transport
