// Operators of the flow along fracture faces of a mesh.
#pragma once

#include "assembly/assembler.hpp"
#include "base/host_table.hpp"
#include "mesh/facets.hpp"
#include "transport/changed_flow.hpp"
#include "transport/face_plane.hpp"
#include "transport/fracture_flow.hpp"
#include "transport/present_conduits.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace sprekk::transport {

/// Flow of a fracture face through its ridges. Unknowns: p_F and the pressures on ridges.
template <int n>
using FractureFace = StoredFlow<n, assembly::Slots<assembly::Slot<1 + n, 1>>>;

/// Flow of `Base` with transmissivities that depend on the widening of the face, m, the last unknown, and on pressures:
/// those of EndTransmissivities multiply the potential differences of `Base`. The matrix T of `Base` is that of a unit
/// transmissivity.
template <class Base>
struct WideningFace {
  static constexpr int n_ends = Base::n_ends, n = n_ends, m = Base::Columns::size;
  using Columns = typename Joined<typename Base::Columns, assembly::Slots<assembly::Slot<1, 1>>>::Slots;
  using Rows = typename Base::Rows;

  Base base;
  PresentConduits conduits;

  KOKKOS_INLINE_FUNCTION EndTransmissivities<n> at_ends(int face, const Real (&x)[m + 1]) const {
    Real rise[n];
    for (int j = 0; j < n; ++j) rise[j] = x[1 + j] - x[0];
    return conduits.at_ends(face, x[m], rise);
  }
  KOKKOS_INLINE_FUNCTION void flow(int face, const Real (&x)[m + 1], Real (&q)[n]) const {
    Real own[m];
    for (int k = 0; k < m; ++k) own[k] = x[k];
    base.flow_of(base.at(face).scaled(at_ends(face, x).value), own, q);
  }
  KOKKOS_INLINE_FUNCTION void dflow(int face, const Real (&x)[m + 1], Real (&dq)[n][m + 1]) const {
    Real own[m], by_own[n][m];
    for (int k = 0; k < m; ++k) own[k] = x[k];
    const auto t = at_ends(face, x);
    const auto here = base.at(face);
    base.dflow_of(here.scaled(t.value), own, by_own);
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < m; ++k) dq[i][k] = by_own[i][k];
      dq[i][m] = 0;
    }
    for (int j = 0; j < n; ++j) {
      Real only[n] = {}, part[n];
      only[j] = 1;
      base.flow_of(here.scaled(only), own, part);
      for (int i = 0; i < n; ++i) {
        for (int k = 0; k < n; ++k) {
          dq[i][0] -= part[i] * t.by_rise[j][k];
          dq[i][1 + k] += part[i] * t.by_rise[j][k];
        }
        dq[i][m] += part[i] * t.by_widening[j];
      }
    }
  }
  KOKKOS_INLINE_FUNCTION void residual(int face, const Real (&x)[m + 1], Real (&r)[1 + n]) const {
    Real q[n];
    flow(face, x, q);
    balance(q, r);
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int face, const Real (&x)[m + 1], Real (&J)[1 + n][m + 1]) const {
    Real dq[n][m + 1];
    dflow(face, x, dq);
    balance(dq, J);
  }
};

/// Fields on which the flow along faces depends, in the order of the unknowns: FractureFace, ChangedFlow, WideningFace.
inline std::vector<std::string> drivers(const FractureFlowParameters& parameters, bool widens) {
  std::vector<std::string> fields = {"face pressure"};
  if (parameters.change) fields.push_back("face " + parameters.change->field);
  if (widens) fields.push_back("widening");
  return fields;
}

/// Faces of a mesh, including the resistances of cutting fractures at their ridges.
template <Shape shape>
class FractureFaces {
 public:
  using Plane = FacePlane<shape>;
  static constexpr int dim = Plane::dim, n = Plane::n;

  /// `facets`: layout of the pressures. `widens`: see WideningFace. Collective.
  FractureFaces(RCP<const mesh::Mesh> mesh, const fields::Layout& facets, const FractureFlowParameters& parameters,
                bool widens)
      : mesh_(mesh), parameters_(&parameters), widens_(widens) {
    find_fillings(facets);
    set_faces();
  }

  const FractureFace<n>& op() const { return op_; }
  ConstView<laws::Conduit*> conduits() const { return conduits_; }  ///< [local fracture face]

  Plane plane(LocalIndex f) const {
    const auto& face = parameters_->faces[f];
    Plane plane(*mesh_, f, widens_ ? 1 : face.along.transmissivity(), parameters_->scheme);
    for (const int cutting : parameters_->cut_by[mesh_->fracture_faces[f].fracture])
      for (int k = 0; k < n; ++k) {
        const Real filling = fillings_[cutting][mesh_->facets->ridge[f * n + k]];
        if (filling > 0)
          add_resistance(plane.T, k, filling / (face.along.hydraulic_aperture() * mesh::ridge_length(*mesh_, f, k)));
      }
    return plane;
  }

 private:
  /// Computes the resistance of half of the width of each cutting fracture, per area, at its ridges. It is the mean
  /// over the faces that end there; the owner of a ridge has all of them.
  void find_fillings(const fields::Layout& facets) {
    fillings_.resize(parameters_->cut_by.size());
    for (const auto& all : parameters_->cut_by)
      for (const int cutting : all)
        if (fillings_[cutting].empty()) fillings_[cutting] = filling_of(cutting, facets);
  }

  std::vector<Real> filling_of(int cutting, const fields::Layout& facets) const {
    fields::Vector owned(facets.owned()), everywhere(facets.ghosted());
    std::vector<int> count(facets.n_owned(), 0);
    {
      auto sum = owned.getLocalViewHost(Tpetra::Access::ReadWrite);
      for (LocalIndex f = 0; f < mesh_->n_fracture_faces(); ++f)
        for (int k = 0; k < n && mesh_->fracture_faces[f].fracture == cutting; ++k)
          if (const LocalIndex ridge = mesh_->facets->ridge[f * n + k]; ridge < facets.n_owned()) {
            sum(ridge, 0) += 1 / parameters_->faces[f].exchange;
            ++count[ridge];
          }
      for (LocalIndex k = 0; k < facets.n_owned(); ++k) sum(k, 0) /= std::max(1, count[k]);
    }
    everywhere.doImport(owned, *facets.import(), Tpetra::REPLACE);
    const auto values = everywhere.getLocalViewHost(Tpetra::Access::ReadOnly);
    std::vector<Real> filling;
    for (std::size_t k = 0; k < values.extent(0); ++k) filling.push_back(values(k, 0));
    return filling;
  }

  void set_faces() {
    const LocalIndex n_faces = mesh_->n_fracture_faces();
    const base::HostTable<Real**> T("T", n_faces, n * n), lift("lift", n_faces, n);
    for (LocalIndex f = 0; f < n_faces; ++f) {
      const Plane plane = this->plane(f);
      for (int k = 0; k < n; ++k) {
        for (int j = 0; j < n; ++j) T(f, k * n + j) = plane.T[k][j];
        lift(f, k) = 0;
        for (int i = 0; i < dim; ++i) lift(f, k) += parameters_->weight[i] * plane.d[k][i];
      }
    }
    std::vector<laws::Conduit> conduits;
    for (const auto& face : parameters_->faces) conduits.push_back(face.along);
    op_ = {.T = T.on_device(), .lift = lift.on_device(), .fluid = parameters_->fluid};
    conduits_ = assembly::to_device(conduits, "conduits");
  }

  RCP<const mesh::Mesh> mesh_;
  const FractureFlowParameters* parameters_;
  bool widens_;
  std::vector<std::vector<Real>> fillings_;  // [fracture][facet] Pa s/m; empty: the fracture cuts none
  FractureFace<n> op_;
  ConstView<laws::Conduit*> conduits_;
};

}  // namespace sprekk::transport
