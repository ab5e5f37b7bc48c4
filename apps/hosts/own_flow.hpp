// Flow of a host as a module: the equations of reservoir.hpp as rows of Sprekk's Jacobian.
#pragma once

#include "assembly/capabilities.hpp"
#include "mesh/facets.hpp"
#include "model/model.hpp"
#include "reservoir.hpp"

namespace hosts {

using namespace sprekk;
using mesh::operator+, mesh::operator-, mesh::operator*;

/// Flow in rock: storage of a cell, and outflow through its faces, q = T (p - p_face).
///
/// | symbol | shape        | unit       |                                       |
/// | x      | 1 + faces    | Pa         | pressure of the cell, of its faces    |
/// | r      | 1 + faces    | m^3/s      | storage + sum q, -q                   |
/// | T      | [cell, face] | m^3/(Pa s) | half-transmissibilities               |
/// | volume | [cell]       | m^3        | V                                     |
/// | storage |             | 1/Pa       | 1/M                                   |
/// | rate   |              | 1/s        | of assembly::State                    |
/// | old    | [owned cell] | Pa         | pressure at the start of the step     |
template <mesh::Shape shape>
struct CellFlow {
  static constexpr int n = mesh::n_faces(shape);
  using Columns = assembly::Slots<assembly::Slot<1, 1>, assembly::Slot<n, 1>>;
  using Rows = Columns;
  View<Real**> T;
  View<Real*> volume;
  Real storage = 0, rate = 0;
  View<Real**> old = {};

  KOKKOS_INLINE_FUNCTION void residual(int cell, const Real (&x)[1 + n], Real (&r)[1 + n]) const {
    const bool owned = cell < static_cast<int>(old.extent(0));
    r[0] = owned ? volume(cell) * storage * rate * (x[0] - old(cell, 0)) : 0;
    for (int k = 0; k < n; ++k) {
      r[1 + k] = -T(cell, k) * (x[0] - x[1 + k]);
      r[0] -= r[1 + k];
    }
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int cell, const Real (&)[1 + n], Real (&J)[1 + n][1 + n]) const {
    for (auto& row : J)
      for (Real& value : row) value = 0;
    J[0][0] = volume(cell) * storage * rate;
    for (int k = 0; k < n; ++k) {
      J[0][0] += T(cell, k);
      J[0][1 + k] = J[1 + k][0] = -T(cell, k);
      J[1 + k][1 + k] = T(cell, k);
    }
  }
};

/// Flow in a fracture: a face opens, receives injection, and exchanges fluid with its neighbours through its ridges.
///
/// | symbol | shape         | unit  |                                                          |
/// | x      | 2 + ridges    | Pa, m | pressure of the face, of its ridges; aperture change b   |
/// | r      | 1 + ridges    | m^3/s | |f| ((b - old)/dt - injection) + sum q, -q               |
/// | form   | [face, ridge] | -     | length of the ridge over its distance                    |
/// | area   | [face]        | m^2   |                                                          |
/// | old    | [owned face]  | m     | b at the start of the step                               |
template <mesh::Shape shape>
struct FaceFlow {
  static constexpr int n = mesh::n_face_corners(shape);
  using Columns = assembly::Slots<assembly::Slot<1 + n, 1>, assembly::Slot<1, 1>>;
  using Rows = assembly::Slots<assembly::Slot<1 + n, 1>>;
  View<Real**> form;
  View<Real*> area;
  Real aperture, minimum, viscosity, injection, rate = 0;  // m, m, Pa s, m/s, 1/s
  View<Real**> old = {};

  KOKKOS_INLINE_FUNCTION Real hydraulic(Real b) const { return aperture + b > minimum ? aperture + b : minimum; }

  KOKKOS_INLINE_FUNCTION void residual(int face, const Real (&x)[2 + n], Real (&r)[1 + n]) const {
    const bool owned = face < static_cast<int>(old.extent(0));
    const Real a = hydraulic(x[1 + n]), T = a * a * a / (12 * viscosity);
    r[0] = owned ? area(face) * (rate * (x[1 + n] - old(face, 0)) - injection) : 0;
    for (int k = 0; k < n; ++k) {
      r[1 + k] = -T * form(face, k) * (x[0] - x[1 + k]);
      r[0] -= r[1 + k];
    }
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int face, const Real (&x)[2 + n], Real (&J)[1 + n][2 + n]) const {
    for (auto& row : J)
      for (Real& value : row) value = 0;
    const Real a = hydraulic(x[1 + n]), T = a * a * a / (12 * viscosity),
               dT = a > minimum ? a * a / (4 * viscosity) : 0;
    J[0][1 + n] = area(face) * rate;
    for (int k = 0; k < n; ++k) {
      J[0][0] += T * form(face, k);
      J[0][1 + k] = J[1 + k][0] = -T * form(face, k);
      J[1 + k][1 + k] = T * form(face, k);
      J[1 + k][1 + n] = -dT * form(face, k) * (x[0] - x[1 + k]);
      J[0][1 + n] -= J[1 + k][1 + n];
    }
  }
};

template <mesh::Shape shape>
class OwnFlow final : public assembly::Module, public assembly::Steps {
 public:
  OwnFlow(const mesh::Mesh& mesh, const Fluid& fluid);

  std::string name() const override { return "own flow"; }

  assembly::Declaration declare(const mesh::Mesh&) const override {
    using assembly::Loop;
    assembly::Unknown cells{{"pressure", fields::Entity::cell, 1, "Pa"}, "pressure", {}};
    assembly::Unknown facets{{"face pressure", fields::Entity::facet, 1, "Pa"}, "pressure", {}};
    facets.near_null_space = assembly::NearNullSpace::constants;  // multigrid for face pressures
    cells.condensed_into = "face pressure";                       // cell pressures are eliminated from them
    cells.balance = facets.balance = true;                        // rows: volume per time
    assembly::Declaration d;
    d.unknowns = {cells, facets};
    d.scales = {{"pressure", 1e-12}};
    for (const char* row : {"pressure", "face pressure"})
      d.couplings.push_back({Loop::cells, row, {"pressure", "face pressure"}});
    d.couplings.push_back({Loop::fracture_cells, "face pressure", {"face pressure", "widening"}});
    d.stores = true;
    d.history = {{"old pressure", fields::Entity::cell, 1}, {"old widening", fields::Entity::fracture_face, 1}};
    return d;
  }

  void bind(const assembly::Context& context) override {
    using assembly::Loop;
    const int p = context.field("pressure"), trace = context.field("face pressure");
    own_ = {p, context.field("widening")};
    const std::vector<int> fields = {p, trace}, rows = {trace}, columns = {trace, own_[1]};
    in_cells_ = std::make_unique<InCells>(context, Loop::cells, fields, fields, InCells::Positions::keep);
    in_faces_ = std::make_unique<InFaces>(context, Loop::fracture_cells, rows, columns, InFaces::Positions::keep);
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    in_cells_->add_residual(at(cell_, state, 0), state, r);
    auto faces = at(face_, state, 1);
    faces.injection *= state.t;
    in_faces_->add_residual(faces, state, r);
  }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    in_cells_->add_jacobian(at(cell_, state, 0), state, J);
    in_faces_->add_jacobian(at(face_, state, 1), state, J);
  }

  void commit(assembly::State& state) const override {
    for (int k = 0; k < 2; ++k) {
      const auto old = state.history[k];
      const auto now = state.x[own_[k]];
      Kokkos::parallel_for(
          "old", Kokkos::RangePolicy<Execution>(0, old.extent(0)), KOKKOS_LAMBDA(int e) { old(e, 0) = now(e); });
    }
  }

 private:
  using InCells = assembly::Assembler<CellFlow<shape>>;
  using InFaces = assembly::Assembler<FaceFlow<shape>>;

  template <class Op>
  static Op at(Op op, const assembly::State& state, int history) {
    op.rate = state.rate;
    op.old = state.history[history];
    return op;
  }

  CellFlow<shape> cell_;
  FaceFlow<shape> face_;
  std::array<int, 2> own_{};  // blocks with history variables
  std::unique_ptr<InCells> in_cells_;
  std::unique_ptr<InFaces> in_faces_;
};

/// Computes half-transmissibilities of faces, and of ridges without the transmissivity of the fracture.
template <mesh::Shape shape>
OwnFlow<shape>::OwnFlow(const mesh::Mesh& mesh, const Fluid& fluid) {
  constexpr int n = CellFlow<shape>::n, n_ridges = FaceFlow<shape>::n;
  const View<Real**> T("T", mesh.n_cells(), n), form("form", mesh.n_fracture_faces(), n_ridges);
  const View<Real*> volume("volume", mesh.n_cells()), area("area", mesh.n_fracture_faces());
  const auto T_host = Kokkos::create_mirror_view(T), form_host = Kokkos::create_mirror_view(form);
  const auto volume_host = Kokkos::create_mirror_view(volume), area_host = Kokkos::create_mirror_view(area);
  for (LocalIndex c = 0; c < mesh.n_cells(); ++c) {
    std::array<mesh::Vector, n> centre;
    mesh::Vector middle{};
    for (int k = 0; k < n; ++k) {
      centre[k] = mesh::face_centre(mesh::face_corners(mesh, c, k));
      middle = middle + (1.0 / n) * centre[k];
    }
    volume_host(c) = 0;
    for (int k = 0; k < n; ++k) {
      const Real size = mesh::norm(mesh::area_vector(mesh::face_corners(mesh, c, k)));
      const Real distance = mesh::norm(centre[k] - middle);
      T_host(c, k) = fluid.mobility * size / distance;
      volume_host(c) += size * distance / mesh.dim();
    }
  }
  for (LocalIndex f = 0; f < mesh.n_fracture_faces(); ++f) {
    area_host(f) = mesh.fracture_faces[f].area;
    for (int k = 0; k < n_ridges; ++k)
      form_host(f, k) =
          mesh::ridge_length(mesh, f, k) / mesh::norm(mesh::ridge_centre(mesh, f, k) - mesh.fracture_faces[f].centre);
  }
  Kokkos::deep_copy(T, T_host);
  Kokkos::deep_copy(form, form_host);
  Kokkos::deep_copy(volume, volume_host);
  Kokkos::deep_copy(area, area_host);
  cell_ = {T, volume, fluid.storage};
  face_ = {form, area, fluid.aperture, fluid.minimum, fluid.viscosity, fluid.injection};
}

inline std::unique_ptr<assembly::Module> make_own_flow(const mesh::Mesh& mesh, const Fluid& fluid) {
  return mesh::for_shape(mesh.shape, [&](auto shape) -> std::unique_ptr<assembly::Module> {
    return std::make_unique<OwnFlow<shape()>>(mesh, fluid);
  });
}

}  // namespace hosts
