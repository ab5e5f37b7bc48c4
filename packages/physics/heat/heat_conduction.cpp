#include "physics/heat/heat_conduction.hpp"

#include "mesh/extents.hpp"
#include "physics/ranged_entry.hpp"

#include <Teuchos_CommHelpers.hpp>

#include <algorithm>
#include <cmath>

namespace sprekk::physics {

using assembly::Loop;

namespace {

/// HybridCell of temperatures, and what the cell stores.
///
/// | symbol  | shape           | unit      |                                           |
/// | x       | 1 + faces       | K         | temperature of the cell, those of faces   |
/// | r       | 1 + faces       | W         | (2D: W/m)                                 |
/// | heat    | [cell]          | J/K       | V rho c                                   |
/// | initial | [cell]          | K         | at the start of the run                   |
/// | gained  | [owned cell, 1] | K         | T_old less that                           |
/// | rate    |                 | 1/s       | of assembly::State                        |
template <Shape shape>
struct HeatCell : HybridCell<shape> {
  using Base = HybridCell<shape>;
  static constexpr int n = Base::n;
  ConstView<Real*> heat = {}, initial = {};
  ConstView<Real**> gained = {};
  Real rate = 0;

  explicit HeatCell(const Base& base) : Base(base) {}

  KOKKOS_INLINE_FUNCTION void residual(int c, const Real (&x)[1 + n], Real (&r)[1 + n]) const {
    Base::residual(c, x, r);
    if (c < static_cast<int>(gained.extent(0))) r[0] += rate * heat(c) * (x[0] - initial(c) - gained(c, 0));
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int c, const Real (&x)[1 + n], Real (&J)[1 + n][1 + n]) const {
    Base::jacobian(c, x, J);
    J[0][0] += rate * heat(c);
  }
};

/// r = h A (T - T_beyond), the second part as a load.
///
/// | symbol      | shape           | unit |                                    |
/// | x           | 1               | K    | temperature of a boundary face     |
/// | coefficient | [boundary face] | W/K  | h A; 0 where there is no condition |
struct HeatTransfer {
  using Columns = assembly::Slots<assembly::Slot<1, 1>>;
  using Rows = Columns;
  ConstView<Real*> coefficient;

  KOKKOS_INLINE_FUNCTION void residual(int e, const Real (&x)[1], Real (&r)[1]) const { r[0] = coefficient(e) * x[0]; }
  KOKKOS_INLINE_FUNCTION void jacobian(int e, const Real (&)[1], Real (&J)[1][1]) const { J[0][0] = coefficient(e); }
};

template <Shape shape>
class HeatConduction final : public assembly::Module {
 public:
  using Op = HeatCell<shape>;
  static constexpr int dim = mesh::dimension(shape), n_faces = mesh::n_faces(shape);

  explicit HeatConduction(HeatConductionParameters parameters) : parameters_(std::move(parameters)) {}

  std::string name() const override { return "heat conduction"; }
  assembly::Declaration declare(const mesh::Mesh& mesh) const override;
  void bind(const assembly::Context& context) override;

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    cells_->add_residual(at(state), state, r);
    transfer_->add_residual(transfer_op_, state, r);
    for (int k = 0; k < 2; ++k) {
      const auto rows = r[blocks_[k]];
      const auto load = load_[k];
      Kokkos::parallel_for(
          "load", Kokkos::RangePolicy<Execution>(0, rows.extent(0)), KOKKOS_LAMBDA(int i) { rows(i) += load(i); });
    }
  }

  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    cells_->add_jacobian(at(state), state, J);
    transfer_->add_jacobian(transfer_op_, state, J);
  }

  void set_time(Real t, const assembly::Scales&) override;
  assembly::Scales loads(Real t) const override;

  void commit(assembly::State& state) const override {
    const auto initial = op_->initial;
    const auto gained = state.history[0];
    cells_->for_each(
        *op_, state, KOKKOS_LAMBDA(int c, const Real(&x)[1 + n_faces]) {
          if (c < static_cast<int>(gained.extent(0))) gained(c, 0) = x[0] - initial(c);
        });
  }

  /// What flows in, by boundaries; of prescribed temperatures the system tells the reactions.
  void totals(const assembly::State& state, std::vector<assembly::Total>& totals) const override {
    const auto T = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), state.x[blocks_[1]]);
    const std::size_t first = totals.size();
    for (const auto& one : parameters_.conditions)
      totals.push_back({{"heat_inflows", mesh_->boundary_names[one.boundary]}, 0});
    for_each_condition([&](const HeatCondition& one, std::size_t, LocalIndex facet, Real area, const auto& x) {
      if (facet >= mesh_->facets->n_owned) return;
      const Real value = one.value(x, state.t);
      totals[first + (&one - parameters_.conditions.data())].value -=
          area * (one.coefficient ? (*one.coefficient)(x, 0) * (T(facet) - value) : value);
    });
  }

 private:
  Op at(const assembly::State& state) const {
    Op op = *op_;
    op.gained = state.history[0];
    op.rate = state.rate;
    return op;
  }

  std::vector<Real> temperatures(const assembly::State& state) const {
    const auto T = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), state.x[blocks_[0]]);
    return {T.data(), T.data() + mesh_->n_owned_cells};
  }
  std::vector<Real> fluxes(const assembly::State& state) const;

  /// Calls visit(condition, boundary face, facet, area, x) at the quadrature points of boundary faces with a condition.
  template <class Visit>
  void for_each_condition(const Visit& visit) const {
    for (const auto& one : parameters_.conditions)
      for (std::size_t f = 0; f < mesh_->boundary_faces.size(); ++f) {
        const auto& face = mesh_->boundary_faces[f];
        if (face.boundary != one.boundary || (one.region >= 0 && mesh_->cell_region[face.cell] != one.region)) continue;
        const LocalIndex facet = mesh_->facets->of_cell[face.cell * n_faces + face.local_face];
        assembly::for_each_face_point<shape>(
            *mesh_, face.cell, face.local_face,
            [&](const auto&, Real area, const auto& x) { visit(one, f, facet, area, x); });
      }
  }

  HeatConductionParameters parameters_;
  RCP<const mesh::Mesh> mesh_;
  std::vector<int> blocks_;  // temperature, face temperature
  Real size_ = 0;            // largest extent of the domain, m
  Real largest_initial_ = 0;
  std::unique_ptr<Op> op_;
  std::unique_ptr<assembly::Assembler<Op>> cells_;
  HeatTransfer transfer_op_;
  std::unique_ptr<assembly::Assembler<HeatTransfer>> transfer_;
  std::array<View<Real*>, 2> load_;  // [owned row], W
};

template <Shape shape>
assembly::Declaration HeatConduction<shape>::declare(const mesh::Mesh& mesh) const {
  Real here = 0, largest = 0;
  for (const auto& one : parameters_.conductivity) here = std::max(here, one.template trace<dim>() / dim);
  Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_MAX, 1, &here, &largest);
  const Real conductance = largest / mesh::largest_extent(mesh) * mesh::typical_face_area(mesh);
  assembly::Declaration d;
  assembly::Unknown cells{{"temperature", fields::Entity::cell, 1, "K"}, "temperature", {{"temperature", conductance}}};
  cells.balance = true;
  cells.reactions = {"heat_inflows", "", "region_heat_inflows"};
  auto facets = cells;
  facets.field = {"face temperature", fields::Entity::facet, 1, "K"};
  facets.near_null_space = assembly::NearNullSpace::constants;
  (parameters_.in_regions ? cells.condensed_into : cells.local_group) =
      parameters_.in_regions ? "face temperature" : "heat in cells";
  d.unknowns = {cells, facets};
  d.scales = {{"temperature", 1e-12}};
  for (const char* row : {"temperature", "face temperature"})
    d.couplings.push_back({Loop::cells, row, {"temperature", "face temperature"}});
  d.couplings.push_back({Loop::boundary_faces, "face temperature", {"face temperature"}});
  d.stores = true;
  d.history = {{"gained temperature", fields::Entity::cell, 1}};
  d.outputs = {{{"temperature", "K", fields::Entity::cell, 1}, [this](const auto& s) { return temperatures(s); }},
               {{"heat flux", "W/m^2", fields::Entity::cell, 3}, [this](const auto& s) { return fluxes(s); }}};
  return d;
}

template <Shape shape>
void HeatConduction<shape>::bind(const assembly::Context& context) {
  mesh_ = context.mesh();
  size_ = mesh::largest_extent(*mesh_);
  op_ = std::make_unique<Op>(
      HybridCell<shape>{context.geometry(),
                        assembly::to_device(parameters_.conductivity, "conductivity"),
                        assembly::material_numbers(context.geometry(), parameters_.conductivity_of_cell),
                        {},
                        parameters_.scheme,
                        {}});
  blocks_ = {context.field("temperature"), context.field("face temperature")};
  using Positions = typename assembly::Assembler<Op>::Positions;
  cells_ = std::make_unique<assembly::Assembler<Op>>(context, Loop::cells, blocks_, blocks_, Positions::keep);
  transfer_ = std::make_unique<assembly::Assembler<HeatTransfer>>(context, Loop::boundary_faces,
                                                                  std::vector{blocks_[1]}, std::vector{blocks_[1]},
                                                                  assembly::Assembler<HeatTransfer>::Positions::keep);
  for (int k = 0; k < 2; ++k) load_[k] = View<Real*>("load", context.layout(blocks_[k]).n_owned());
  std::vector<Real> heat, initial, coefficient(mesh_->boundary_faces.size(), 0);
  for (LocalIndex c = 0; c < mesh_->n_cells(); ++c) {
    Real total = 0, sum = 0;
    assembly::for_each_cell_point<shape>(*mesh_, c, [&](const auto&, Real volume, const auto& x) {
      total += volume;
      sum += volume * parameters_.initial(x, 0);
    });
    heat.push_back(total * parameters_.capacity[mesh_->cell_region[c]]);
    initial.push_back(sum / total);
    largest_initial_ = std::max(largest_initial_, std::abs(sum / total));
  }
  for_each_condition([&](const HeatCondition& one, std::size_t face, LocalIndex, Real area, const auto& x) {
    if (!one.coefficient) return;
    RangedEntry("heat transfer coefficient", one.coefficient, 0).check(x);
    coefficient[face] += area * (*one.coefficient)(x, 0);
  });
  op_->heat = assembly::to_device(heat, "heat capacity");
  op_->initial = assembly::to_device(initial, "initial temperature");
  transfer_op_.coefficient = assembly::to_device(coefficient, "heat transfer");
}

template <Shape shape>
void HeatConduction<shape>::set_time(Real t, const assembly::Scales&) {
  const auto cells = Kokkos::create_mirror_view(load_[0]), facets = Kokkos::create_mirror_view(load_[1]);
  Kokkos::deep_copy(cells, 0.0);
  Kokkos::deep_copy(facets, 0.0);
  for (LocalIndex c = 0; c < mesh_->n_owned_cells && !parameters_.source.empty(); ++c)
    assembly::for_each_cell_point<shape>(
        *mesh_, c, [&](const auto&, Real volume, const auto& x) { cells(c) -= volume * parameters_.source[0](x, t); });
  for_each_condition([&](const HeatCondition& one, std::size_t, LocalIndex facet, Real area, const auto& x) {
    if (facet >= mesh_->facets->n_owned) return;
    facets(facet) += area * (one.coefficient ? -(*one.coefficient)(x, 0) : 1) * one.value(x, t);
  });
  Kokkos::deep_copy(load_[0], cells);
  Kokkos::deep_copy(load_[1], facets);
}

/// What flux and source make of temperature over the size of the domain.
template <Shape shape>
assembly::Scales HeatConduction<shape>::loads(Real t) const {
  Real flux = 0, temperature = largest_initial_, conductivity = 0;
  for_each_condition([&](const HeatCondition& one, std::size_t, LocalIndex, Real, const auto& x) {
    Real& largest = one.coefficient ? temperature : flux;
    largest = std::max(largest, std::abs(one.value(x, t)));
  });
  for (LocalIndex c = 0; c < mesh_->n_owned_cells && !parameters_.source.empty(); ++c)
    assembly::for_each_cell_point<shape>(*mesh_, c, [&](const auto&, Real, const auto& x) {
      flux = std::max(flux, size_ * std::abs(parameters_.source[0](x, t)));
    });
  for (const auto& one : parameters_.conductivity)
    conductivity = std::max(conductivity, one.template trace<dim>() / dim);
  return {{"temperature", std::max(temperature, size_ * flux / conductivity)}};
}

template <Shape shape>
std::vector<Real> HeatConduction<shape>::fluxes(const assembly::State& state) const {
  const auto T = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), state.x[blocks_[0]]);
  const auto trace = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), state.x[blocks_[1]]);
  std::vector<Real> values;
  Real X[mesh::n_nodes(shape)][dim], x[1 + n_faces], q[n_faces];
  for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c) {
    assembly::gather_host<shape>(*mesh_, c, X);
    const CellFaces<shape> faces(X);
    x[0] = T(c);
    for (int k = 0; k < n_faces; ++k) x[1 + k] = trace(mesh_->facets->of_cell[c * n_faces + k]);
    op_->at(c, faces).flow(x, q);
    for (int i = 0; i < 3; ++i) {
      Real flux = 0;
      for (int k = 0; k < n_faces && i < dim; ++k) flux += q[k] * faces.centre[k][i] / faces.volume;
      values.push_back(flux);
    }
  }
  return values;
}

}  // namespace

std::unique_ptr<assembly::Module> make_heat_conduction(Shape shape, HeatConductionParameters parameters) {
  return mesh::for_shape(shape, [&](auto s) -> std::unique_ptr<assembly::Module> {
    return std::make_unique<HeatConduction<s()>>(std::move(parameters));
  });
}

}  // namespace sprekk::physics
