#include "physics/flow/darcy_flow.hpp"

#include "base/check.hpp"
#include "mesh/extents.hpp"
#include "physics/flow/exchange.hpp"
#include "physics/ranged_entry.hpp"

#include <Teuchos_CommHelpers.hpp>

#include <algorithm>
#include <cmath>

namespace sprekk::physics {

using assembly::Loop;

namespace {

template <Shape shape>
class DarcyFlow final : public assembly::Module {
 public:
  using Op = HybridCell<shape>;
  static constexpr int dim = Op::dim, n_faces = Op::n;

  explicit DarcyFlow(DarcyFlowParameters parameters) : parameters_(std::move(parameters)) {}

  std::string name() const override {
    return "Darcy flow, " + name_of(parameters_.scheme) +
           (parameters_.reason.empty() ? "" : " (" + parameters_.reason + ")");
  }

  void set_fields(const std::set<std::string>& fields) override { deforms_ = fields.count("displacement") > 0; }

  assembly::Declaration declare(const mesh::Mesh& mesh) const override {
    assembly::Declaration d;
    const Real conductance = largest_mobility(mesh) / mesh::largest_extent(mesh) * mesh::typical_face_area(mesh);
    assembly::Unknown cells{{"pressure", fields::Entity::cell, 1, "Pa"}, "pressure", {{"pressure", conductance}}};
    cells.balance = true;
    cells.reactions = {"inflows", "", "region_inflows"};
    auto facets = cells;
    facets.field = {"face pressure", fields::Entity::facet, 1, "Pa"};
    facets.near_null_space = assembly::NearNullSpace::constants;
    const bool stay = parameters_.in_regions || deforms_;
    (stay ? cells.condensed_into : cells.local_group) = stay ? "face pressure" : "fluid in cells";
    d.unknowns = {cells, facets};
    d.scales = {{"pressure", 1e-12}};
    for (const char* row : {"pressure", "face pressure"})
      d.couplings.push_back({Loop::cells, row, {"pressure", "face pressure"}});
    d.outputs = {{{"pressure", "Pa", fields::Entity::cell, 1}, [this](const auto& s) { return pressures(s); }},
                 {{"Darcy velocity", "m/s", fields::Entity::cell, 3}, [this](const auto& s) { return velocities(s); }}};
    d.linear = is_linear();
    return d;
  }

  void bind(const assembly::Context& context) override {
    mesh_ = context.mesh();
    size_ = mesh::largest_extent(*mesh_);
    const auto& weight = parameters_.weight;
    op_ = std::make_unique<Op>(Op{context.geometry(),
                                  assembly::to_device(parameters_.mobility, "mobility"),
                                  assembly::material_numbers(context.geometry(), parameters_.mobility_of_cell),
                                  {weight[0], weight[1], weight[2]},
                                  parameters_.scheme,
                                  parameters_.fluid});
    set_resistance();
    blocks_ = {context.field("pressure"), context.field("face pressure")};
    assembler_ = std::make_unique<Assembler>(context, Loop::cells, blocks_, blocks_,
                                             is_linear() ? Assembler::Positions::once : Assembler::Positions::keep);
    for_each_condition([&](const FluidCondition& condition, LocalIndex facet, Real area, const auto& x) {
      if (!condition.conductance) return;
      RangedEntry("conductance", condition.conductance, 0).check(x);
      exchange_.add(facet, area * (*condition.conductance)(x, 0));
    });
    exchange_.bind(context, blocks_[1], parameters_.fluid);
    for (int k = 0; k < 2; ++k) load_[k] = View<Real*>("load", context.layout(blocks_[k]).n_owned());
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    assembler_->add_residual(*op_, state, r);
    exchange_.add_residual(state, r);
    for (int k = 0; k < 2; ++k) {
      const auto rows = r[blocks_[k]];
      const auto load = load_[k];
      Kokkos::parallel_for(
          "load", Kokkos::RangePolicy<Execution>(0, rows.extent(0)), KOKKOS_LAMBDA(int i) { rows(i) += load(i); });
    }
  }

  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    assembler_->add_jacobian(*op_, state, J);
    exchange_.add_jacobian(state, J);
  }
  bool symmetric(const assembly::State&) const override { return is_linear(); }

  bool constant_load() const override {
    const auto constant = [](const auto& condition) { return condition.value.constant_in_time(); };
    return std::all_of(parameters_.conditions.begin(), parameters_.conditions.end(), constant) &&
           (parameters_.source.empty() || parameters_.source[0].constant_in_time());
  }

  void set_time(Real t, const assembly::Scales&) override {
    if (loaded_ && constant_load()) return;
    const auto cells = Kokkos::create_mirror_view(load_[0]), facets = Kokkos::create_mirror_view(load_[1]);
    Kokkos::deep_copy(cells, 0.0);
    Kokkos::deep_copy(facets, 0.0);
    for (LocalIndex c = 0; c < mesh_->n_owned_cells && !parameters_.source.empty(); ++c)
      assembly::for_each_cell_point<shape>(*mesh_, c, [&](const auto&, Real volume, const auto& x) {
        cells(c) -= volume * parameters_.source[0](x, t);
      });
    std::vector<Real> beyond;
    for_each_condition([&](const FluidCondition& condition, LocalIndex facet, Real area, const auto& x) {
      if (condition.conductance)
        beyond.push_back(condition.value(x, t));
      else if (facet < mesh_->facets->n_owned)
        facets(facet) += area * condition.value(x, t);
    });
    exchange_.set_outside(beyond);
    Kokkos::deep_copy(load_[0], cells);
    Kokkos::deep_copy(load_[1], facets);
    loaded_ = true;
  }

  /// What prescribed flow and gravity make of pressure over the size of the domain.
  assembly::Scales loads(Real t) const override {
    Real flux = 0, beyond = 0, weight = 0, mobility = 0;
    for_each_condition([&](const FluidCondition& condition, LocalIndex, Real, const auto& x) {
      Real& largest = condition.conductance ? beyond : flux;
      largest = std::max(largest, std::abs(condition.value(x, t)));
    });
    for (LocalIndex c = 0; c < mesh_->n_owned_cells && !parameters_.source.empty(); ++c)
      assembly::for_each_cell_point<shape>(*mesh_, c, [&](const auto&, Real, const auto& x) {
        flux = std::max(flux, size_ * std::abs(parameters_.source[0](x, t)));
      });
    for (Real component : parameters_.weight) weight += component * component;
    for (const auto& each : parameters_.mobility) mobility = std::max(mobility, each.template trace<dim>() / dim);
    return {{"pressure", std::max(beyond, size_ * (std::sqrt(weight) + flux / mobility))}};
  }

  void totals(const assembly::State& state, std::vector<assembly::Total>& totals) const override {
    const auto p = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), state.x[blocks_[1]]);
    const auto first = add_inflows(parameters_.conditions, *mesh_, totals);
    for_each_condition([&](const FluidCondition& condition, LocalIndex facet, Real area, const auto& x) {
      if (facet >= mesh_->facets->n_owned) return;
      const auto number = &condition - parameters_.conditions.data();
      totals[first + number].value -= area * condition.outflow(p(facet), x, state.t, parameters_.fluid);
    });
  }

 private:
  using Assembler = assembly::Assembler<Op>;

  std::vector<Real> pressures(const assembly::State& state) const {
    const auto p = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), state.x[blocks_[0]]);
    return {p.data(), p.data() + mesh_->n_owned_cells};
  }

  std::vector<Real> velocities(const assembly::State& state) const {
    const auto p = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), state.x[blocks_[0]]);
    const auto trace = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), state.x[blocks_[1]]);
    std::vector<Real> values;
    Real X[mesh::n_nodes(shape)][dim], x[1 + n_faces], q[n_faces];
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c) {
      assembly::gather_host<shape>(*mesh_, c, X);
      const CellFaces<shape> faces(X);
      x[0] = p(c);
      for (int k = 0; k < n_faces; ++k) x[1 + k] = trace(mesh_->facets->of_cell[c * n_faces + k]);
      op_->at(c, faces).flow(x, q);
      const Real scale = 1 / (parameters_.fluid.density(x[0]) * faces.volume);
      for (int i = 0; i < 3; ++i) {
        Real v = 0;
        for (int k = 0; k < n_faces && i < dim; ++k) v += q[k] * faces.centre[k][i] * scale;
        values.push_back(v);
      }
    }
    return values;
  }

  /// The largest component on the diagonal, m^2/(Pa s). Collective.
  Real largest_mobility(const mesh::Mesh& mesh) const {
    Real here = 0, largest = 0;
    for (const auto& one : parameters_.mobility)
      for (int i = 0; i < dim; ++i) here = std::max(here, one.value[i][i]);
    Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_MAX, 1, &here, &largest);
    return largest;
  }

  bool is_linear() const { return parameters_.fluid.compressibility == 0; }

  void set_resistance() {
    const auto& exchange = parameters_.exchange;
    if (std::all_of(exchange.begin(), exchange.end(), [](Real e) { return std::isinf(e); })) return;
    std::vector<int> beside(mesh_->n_cells(), -1);
    int n = 0;
    const auto sides = assembly::fracture_sides(*mesh_);
    for (const auto& [f, side] : sides)
      if (int& row = beside[mesh_->fracture_faces[f].cell[side]]; row < 0) row = n++;
    View<Real**> resistance("resistance", n, n_faces);
    const auto host = Kokkos::create_mirror_view(resistance);
    for (const auto& [f, side] : sides) {
      const auto& face = mesh_->fracture_faces[f];
      host(beside[face.cell[side]], face.local_face[side]) = 1 / (exchange[f] * face.area);
    }
    Kokkos::deep_copy(resistance, host);
    op_->beside = assembly::to_device(beside, "beside");
    op_->resistance = resistance;
  }

  /// Calls visit(condition, facet, area, x) at the quadrature points of all boundary faces with a condition.
  template <class Visit>
  void for_each_condition(const Visit& visit) const {
    for (const auto& one : parameters_.conditions)
      for (const auto& face : mesh_->boundary_faces) {
        if (face.boundary != one.boundary || (one.region >= 0 && mesh_->cell_region[face.cell] != one.region)) continue;
        const LocalIndex facet = mesh_->facets->of_cell[face.cell * n_faces + face.local_face];
        assembly::for_each_face_point<shape>(
            *mesh_, face.cell, face.local_face,
            [&](const auto&, Real area, const auto& x) { visit(one, facet, area, x); });
      }
  }

  DarcyFlowParameters parameters_;
  bool deforms_ = false;  // rock, which couples pressures of cells beside fractures: they stay in linear solves
  RCP<const mesh::Mesh> mesh_;
  std::vector<int> blocks_;  // pressure, face pressure
  Real size_ = 0;            // largest extent of the domain, m
  bool loaded_ = false;
  std::unique_ptr<Op> op_;
  std::unique_ptr<Assembler> assembler_;
  Exchange exchange_;                // with what is beyond the boundary
  std::array<View<Real*>, 2> load_;  // [owned row], m^3/s
};

}  // namespace

std::size_t add_inflows(const std::vector<FluidCondition>& conditions, const mesh::Mesh& mesh,
                        std::vector<assembly::Total>& totals) {
  const std::size_t first = totals.size();
  for (const auto& condition : conditions) totals.push_back({{"inflows", mesh.boundary_names[condition.boundary]}, 0});
  return first;
}

std::unique_ptr<assembly::Module> make_darcy_flow(Shape shape, DarcyFlowParameters parameters) {
  return mesh::for_shape(shape, [&](auto s) -> std::unique_ptr<assembly::Module> {
    return std::make_unique<DarcyFlow<s()>>(std::move(parameters));
  });
}

}  // namespace sprekk::physics
