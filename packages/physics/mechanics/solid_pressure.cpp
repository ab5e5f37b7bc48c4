#include "physics/mechanics/solid_pressure.hpp"

#include "assembly/capabilities.hpp"
#include "assembly/geometry.hpp"
#include "assembly/term.hpp"
#include "assembly/volume_work.hpp"
#include "mesh/extents.hpp"
#include "mesh/facets.hpp"
#include "physics/mechanics/displacements.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace sprekk::physics {

using assembly::Loop;
using assembly::Slot;
using mesh::Shape;

namespace {

/// Compression of a cell by its pressure.
///
/// | symbol     | shape  | unit           |                  |
/// | x          | 1      | Pa             | p                |
/// | r          | 1      | m^3 (2D: m^2)  | -compliance p    |
/// | compliance | [cell] | m^3/Pa         | |K|/kappa        |
struct PressedCell {
  using Columns = assembly::Slots<Slot<1, 1>>;
  using Rows = Columns;
  ConstView<Real*> compliance;

  KOKKOS_INLINE_FUNCTION void residual(int e, const Real (&x)[1], Real (&r)[1]) const { r[0] = -compliance(e) * x[0]; }
  KOKKOS_INLINE_FUNCTION void jacobian(int e, const Real (&)[1], Real (&J)[1][1]) const { J[0][0] = -compliance(e); }
};

/// Eliminated bubble of the face between two cells.
///
/// | symbol | shape  | unit          |                               |
/// | x      | 2      | Pa            | p_K, p_L                      |
/// | r      | 2      | m^3 (2D: m^2) | -give (p_K - p_L), its negative |
/// | give   | [pair] | m^3/Pa        | V_f^2/alpha                   |
struct BubbleBetween {
  using Columns = assembly::Slots<Slot<2, 1>>;
  using Rows = Columns;
  ConstView<Real*> give;

  KOKKOS_INLINE_FUNCTION void residual(int e, const Real (&x)[2], Real (&r)[2]) const {
    r[0] = -give(e) * (x[0] - x[1]);
    r[1] = -r[0];
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int e, const Real (&)[2], Real (&J)[2][2]) const {
    J[0][0] = J[1][1] = -give(e);
    J[0][1] = J[1][0] = give(e);
  }
};

/// Integrals of the normal bubble of a face over a cell: its outward volume and its energy.
template <Shape shape>
std::array<Real, 2> bubble_of(const mesh::Mesh& mesh, LocalIndex cell, int local_face, const laws::Elasticity& law) {
  constexpr int dim = mesh::dimension(shape), n = mesh::n_nodes(shape);
  using Cell = assembly::ReferenceCell<shape>;
  Real X[n][dim], dN[n][dim], db[dim], g[dim];
  assembly::gather_host<shape>(mesh, cell, X);
  const auto area = mesh::area_vector(mesh::face_corners(mesh, cell, local_face));
  Real volume = 0, energy = 0;
  assembly::for_each_cell_point<shape>(mesh, cell, [&](const Real(&xi)[dim], Real part, const auto&) {
    Cell::gradients(xi, dN);
    Cell::bubble(local_face, xi, db);
    assembly::CellPoint<shape>(X, dN).gradient(db, g);
    for (int i = 0; i < dim; ++i) volume += part * g[i] * area[i] / mesh::norm(area);
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j)
        energy += part * law.stiffness(g, g, i, j) * area[i] * area[j] / mesh::dot(area, area);
  });
  return {volume, energy};
}

class SolidPressure final : public assembly::Module, public assembly::RowWeights {
 public:
  explicit SolidPressure(SolidPressureParameters parameters) : parameters_(std::move(parameters)) {}

  std::string name() const override { return "solid pressure"; }

  assembly::Declaration declare(const mesh::Mesh& mesh) const override {
    assembly::Declaration d;
    const Real area = mesh::typical_face_area(mesh);
    assembly::Unknown p{{"solid pressure", fields::Entity::cell, 1, "Pa"}, "solid pressure", {{"displacement", area}}};
    p.unbounded = true;
    d.unknowns = {p};
    d.scales = {{"solid pressure", 0}};
    d.relations = {{"solid pressure", 1, "stress"}};
    for (const auto& part : assembly::divergence_fields(mesh, displacements)) {
      d.couplings.push_back({part.loop, part.field, {"solid pressure"}});
      d.couplings.push_back({part.loop, "solid pressure", {part.field}});
    }
    for (const auto loop : {Loop::cells, Loop::neighbours})
      d.couplings.push_back({loop, "solid pressure", {"solid pressure"}});
    d.schur = {"solid pressure"};
    d.linear = true;
    return d;
  }

  void bind(const assembly::Context& context) override {
    mesh_ = context.mesh();
    p_ = context.field("solid pressure");
    const auto pressed = [this](LocalIndex cell) { return modulus(cell) > 0 ? 1 : 0; };
    add<PressedCell>(context, Loop::cells, {p_}, pressed_cells());
    add<BubbleBetween>(context, Loop::neighbours, {p_}, bubbles_between());
    for (const auto& part : assembly::divergence(*mesh_, displacements, pressed))  // rate -1: symmetric
      terms_.push_back(
          assembly::make_volume_work(context, {part.loop, context.field(part.field), p_, part.volume}, false, -1));
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    for (const auto& term : terms_) term.add_residual(state, r);
  }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    for (const auto& term : terms_) term.add_jacobian(state, J);
  }
  void add_schur(const assembly::State&, const assembly::Rows& diagonals) const override {
    const auto rows = diagonals[p_];
    const auto schur = schur_;
    Kokkos::parallel_for(
        "schur", Kokkos::RangePolicy<Execution>(0, rows.extent(0)), KOKKOS_LAMBDA(int i) { rows(i) -= schur(i); });
  }

  /// Adds the inverse of the diagonal, including the Schur complement of the displacements.
  void merit_weights(const assembly::Rows& weights) const override {
    const auto rows = weights[p_];
    const auto schur = schur_;
    const auto compliance = compliance_;
    Kokkos::parallel_for(
        "weights", Kokkos::RangePolicy<Execution>(0, rows.extent(0)),
        KOKKOS_LAMBDA(int i) { rows(i) += 1 / (compliance(i) + schur(i)); });
  }

 private:
  template <class Op>
  void add(const assembly::Context& context, Loop loop, const std::vector<int>& blocks, Op op) {
    terms_.emplace_back(context, loop, blocks, blocks, false, [op](const auto&) { return op; });
  }

  Real modulus(LocalIndex cell) const { return parameters_.modulus.of_cell(*mesh_, cell); }
  const laws::Elasticity& law(LocalIndex cell) const { return parameters_.elasticity.of_cell(*mesh_, cell); }

  PressedCell pressed_cells() {
    std::vector<Real> compliance, schur;
    for (LocalIndex c = 0; c < mesh_->n_cells(); ++c) {
      const Real size = assembly::cell_mean(*mesh_, c, [](const auto&) { return 0; })[0];
      const auto [G, lambda] = law(c);
      compliance.push_back(size / (modulus(c) > 0 ? modulus(c) : G));
      if (c < mesh_->n_owned_cells) schur.push_back(modulus(c) > 0 ? size / (2 * G + lambda) : 0);
    }
    schur_ = assembly::to_device(schur, "schur");
    compliance_ = assembly::to_device(compliance, "compliance");
    return {compliance_};
  }

  /// Bubbles between cells. No bubble at region borders, where pressures may be discontinuous.
  BubbleBetween bubbles_between() const {
    std::vector<Real> give;
    for (const auto& pair : assembly::neighbours(*mesh_)) {
      const auto [a, b] = pair;
      const bool is_stiff = mesh::order(mesh_->shape) == 1 && mesh::is_simplex(mesh_->shape);  // locks without bubbles
      const Real weight = is_stiff ? 1.0 / mesh::n_faces(mesh_->shape) : 1;
      Real volume = 0, alpha = 0;
      for (const LocalIndex cell : pair) {
        const auto [outward, energy] = mesh::for_shape(mesh_->shape, [&](auto shape) {
          return bubble_of<shape()>(*mesh_, cell, face_between(cell, pair), law(cell));
        });
        volume = outward;
        alpha += weight * energy;
      }
      const bool inside = mesh_->cell_region[a] == mesh_->cell_region[b] && modulus(a) > 0 && modulus(b) > 0;
      give.push_back(inside ? volume * volume / alpha : 0);
    }
    return {assembly::to_device(give, "bubbles")};
  }

  /// Local number of the common face of a pair in the given cell.
  int face_between(LocalIndex cell, const std::array<LocalIndex, 2>& pair) const {
    const int n_faces = mesh::n_faces(mesh_->shape);
    const LocalIndex* const of[] = {&mesh_->facets->of_cell[pair[0] * n_faces],
                                    &mesh_->facets->of_cell[pair[1] * n_faces]};
    const int own = cell == pair[0] ? 0 : 1;
    return static_cast<int>(std::find_first_of(of[own], of[own] + n_faces, of[1 - own], of[1 - own] + n_faces) -
                            of[own]);
  }

  SolidPressureParameters parameters_;
  RCP<const mesh::Mesh> mesh_;
  int p_ = -1;
  ConstView<Real*> schur_;       // [owned cell] |K|/(lambda_0 + 2 G), m^3/Pa
  ConstView<Real*> compliance_;  // [cell] |K|/kappa, m^3/Pa
  std::vector<assembly::Term> terms_;
};

}  // namespace

VolumetricSplit::VolumetricSplit(const laws::Elasticity& law, int order) : elasticity(law), modulus(0) {
  const auto of_ratio = [&](Real nu) { return 2 * law.G * nu / (1 - 2 * nu); };
  if (law.lambda <= of_ratio(order == 1 ? 0.45 : 0.49)) return;
  elasticity.lambda = of_ratio(0.4);
  modulus = law.lambda - elasticity.lambda;
}

std::unique_ptr<assembly::Module> make_solid_pressure(SolidPressureParameters parameters) {
  return std::make_unique<SolidPressure>(std::move(parameters));
}

}  // namespace sprekk::physics
