#include "transport/wells.hpp"

#include "assembly/capabilities.hpp"
#include "assembly/load.hpp"
#include "base/check.hpp"
#include "base/host_table.hpp"
#include "base/over_ranks.hpp"
#include "transport/injected_quantity.hpp"
#include "transport/exchange.hpp"
#include "transport/well_connections.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace sprekk::transport {

namespace {

class Wells final : public assembly::Module, public assembly::Loads, public assembly::Steps, public assembly::Totals {
 public:
  explicit Wells(WellsParameters parameters) : parameters_(std::move(parameters)) {}

  std::string name() const override { return "wells"; }
  void set_fields(const std::set<std::string>& fields) override { widens_ = fields.count("widening") > 0; }

  assembly::Declaration declare(const mesh::Mesh&) const override {
    assembly::Declaration d;
    if (in_rock())
      d.couplings = {{assembly::Loop::cells, "pressure", {"pressure"}},
                     {assembly::Loop::cells, "face pressure", {"face pressure"}}};
    else
      d.couplings = {{assembly::Loop::fracture_cells, "face pressure", {"face pressure"}}};
    if (widens_) {
      d.couplings.push_back({assembly::Loop::fracture_cells, "face pressure", {"widening"}});
      d.history = {{"widening", fields::Entity::fracture_face, 1}};
    }
    for (const auto& carried : parameters_.carried) {
      if (carried.change) {
        d.couplings.push_back({assembly::Loop::cells, "pressure", {carried.field}});
        d.couplings.push_back({assembly::Loop::cells, "face pressure", {"face " + carried.field}});
      }
      const auto &u = carried.field, on_facets = "face " + u;
      d.couplings.push_back({assembly::Loop::cells, u, {u, "pressure"}});
      d.couplings.push_back({assembly::Loop::cells, on_facets, {on_facets, "face pressure"}});
      if (widens_) d.couplings.push_back({assembly::Loop::fracture_cells, on_facets, {"widening"}});
    }
    d.linear = is_linear();
    return d;
  }

  void bind(const assembly::Context& context) override {
    mesh_ = context.mesh();
    const auto [connections, failure] = find_well_connections(*mesh_, parameters_);
    connections_ = connections;
    if (widens_) widening_ = context.field("widening");
    sums_ = sums([](LocalIndex) { return 0; });
    for (const auto& c : connections_) {
      const bool widens = widens_ && c.face >= 0;
      if (well(c).pressure) exchange_[c.face >= 0].add(c.row, widens ? c.index : index(c), c.face);
    }
    for (const int k : places()) {
      const bool widens = widens_ && k == 1;
      blocks_[k] = context.field(k == 0 ? "pressure" : "face pressure");
      exchange_[k].bind(context, blocks_[k], parameters_.fluid,
                        widens ? parameters_.faces : std::vector<laws::Conduit>(), change(k == 1));
      load_[k] = assembly::Load(context.layout(blocks_[k]).n_owned());
    }
    bind_carried(context);
    SPREKK_CHECK(failure.empty(), "{}", failure);
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    for (const int k : places()) {
      exchange_[k].add_residual(state, r);
      load_[k].add_to(r[blocks_[k]]);
    }
    for (const auto& injected : injected_) injected.add_residual(state, r);
  }

  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    for (const int k : places()) exchange_[k].add_jacobian(state, J);
    for (const auto& injected : injected_) injected.add_jacobian(state, J);
  }
  bool symmetric(const assembly::State&) const override { return injected_.empty(); }

  bool constant_load() const override {
    return !widens_ && std::all_of(parameters_.wells.begin(), parameters_.wells.end(),
                                   [](const Well& well) { return control(well).constant_in_time(); });
  }

  void start_step(const assembly::State& state) override {
    if (widens_) {
      const auto before = base::to_host(state.history[0]);
      start_ = {before.data(), before.data() + before.extent(0)};
      sums_ = sums([&](LocalIndex face) { return start_[face]; });
      for (std::size_t w = 0; w < sums_.size(); ++w)
        SPREKK_CHECK(sums_[w] > 0,
                     "Sprekk > Flow > Wells > {}: its fractures are closed at t = {}, without flow into them; give a "
                     "\"residual aperture\"",
                     parameters_.wells[w].name, state.t);
    }
    std::array<std::vector<Real>, 2> outside;
    for (const int k : places()) {
      load_[k].set([&](const auto& rows) {
        for (const auto& c : connections_) {
          if ((c.fracture >= 0) != (k == 1)) continue;
          if (well(c).pressure)
            outside[k].push_back(pressure(c, state.t));
          else
            rows(c.row) -= rate(c, state.t);
        }
      });
      exchange_[k].set_outside(outside[k]);
    }
    set_carried(state.t);
  }

  void commit(assembly::State& state) const override {
    if (!widens_) return;
    const auto widening = state.x[widening_];
    const auto saved = state.history[0];
    Kokkos::parallel_for(
        "widening", Kokkos::RangePolicy<Execution>(0, saved.extent(0)),
        KOKKOS_LAMBDA(int f) { saved(f, 0) = widening(f); });
  }

  /// Scales: the pressure in wells, or the pressure difference due to a rate.
  assembly::Scales loads(Real t) const override {
    Real largest = 0;
    for (std::size_t w = 0; w < parameters_.wells.size(); ++w) {
      const auto& one = parameters_.wells[w];
      const Real value = std::abs(control(one)(one.points[0], t));
      largest = std::max(largest, one.pressure ? value : value / sums_[w]);
    }
    assembly::Scales all = {{"pressure", largest}};
    for (const auto& carried : parameters_.carried)
      for (const auto& one : parameters_.wells)
        if (const auto value = carried.in_wells.find(one.name); value != carried.in_wells.end())
          all[carried.field] = std::max(all[carried.field], std::abs(value->second(one.points[0], t)));
    return all;
  }

  void totals(const assembly::State& state, std::vector<assembly::Total>& totals) const override {
    const auto first = totals.size();
    const auto width = 3 + mesh_->fracture_names.size() + 2 * parameters_.carried.size();
    for (const auto& one : parameters_.wells) {
      const char* const unit = mesh_->dim() == 2 ? "m^2/s" : "m^3/s";
      totals.push_back({{"wells", one.name, "rate"}, 0, unit});
      totals.push_back({{"wells", one.name, "pressure"}, 0, "Pa"});
      totals.push_back({{"wells", one.name, "in rock"}, 0, unit});
      for (const auto& fracture : mesh_->fracture_names)
        totals.push_back({{"wells", one.name, "in " + fracture}, 0, unit});
      for (std::size_t j = 0; j < parameters_.carried.size(); ++j) {
        const auto& carried = parameters_.carried[j];
        totals.push_back({{"wells", one.name, carried.field}, 0, carried_units_[j]});
        totals.push_back({{"wells", one.name, carried.total}, 0, carried.unit + (mesh_->dim() == 2 ? "/m" : "")});
      }
    }
    const auto on_host = [](const auto& x) { return base::to_host(x); };
    const std::array p = {on_host(state.x[blocks_[0]]), on_host(state.x[blocks_[1]])};
    const auto widening = widens_ ? on_host(state.x[widening_]) : p[1];
    const auto W_of = [&](const WellConnection& c) {
      return index(c, widens_ && c.face >= 0 ? widening(c.face) : 0) * flow_factor(state, c);
    };
    const auto unbalanced = unbalanced_per_index(state, W_of);
    for (const auto& c : connections_) {
      const Real at = p[c.fracture >= 0](c.row), share = this->share(c);
      const Real W = W_of(c);
      const bool constrained = well(c).pressure.has_value();
      const auto of_row = unbalanced[c.fracture >= 0].find(c.row);
      const Real rest = of_row == unbalanced[c.fracture >= 0].end() ? 0 : of_row->second;
      const Real product = constrained ? W * parameters_.fluid.drop(pressure(c, state.t), at, 0) : rate(c, state.t);
      const Real flow = constrained ? product + W * rest : product;
      const Real drop = flow == 0 ? 0 : flow / W;
      const auto of_well = first + c.well * width;
      totals[of_well].value += flow;
      totals[of_well + 1].value += share * (constrained ? control(well(c))(well(c).points[0], state.t)
                                                        : at + drop - head(c, at + drop, state.t));
      totals[of_well + 3 + c.fracture].value += flow;
      auto next = of_well + 3 + mesh_->fracture_names.size();
      for (std::size_t j = 0; j < parameters_.carried.size(); ++j) {
        const auto control = this->control(c, parameters_.carried[j], state.t);
        const Real there = carried_at(state, j, c), u = product > 0 && control.prescribes ? control.value : there;
        totals[next++].value += share * u;
        totals[next++].value +=
            parameters_.carried[j].capacity * (flow * there + product * (u - there));  // same expression as in the row
      }
    }
  }

 private:
  bool in_rock() const { return !parameters_.mobility.values.empty(); }
  /// Numbers of the places of connections: 0: rock, 1: fractures.
  std::vector<int> places() const { return in_rock() ? std::vector<int>{0, 1} : std::vector<int>{1}; }

  /// Residual of rows with wells of prescribed pressure, divided by the sum of W(connection) of these wells, Pa: [rock,
  /// fractures] by row. If W is large compared with the conductances around it, the pressure drop is near round-off.
  /// The balance of the row is then more accurate than W times the drop.
  template <class Index>
  std::array<std::map<LocalIndex, Real>, 2> unbalanced_per_index(const assembly::State& state, const Index& W) const {
    std::array<std::map<LocalIndex, Real>, 2> sums;
    if (state.unbalanced.empty()) return sums;
    for (const auto& c : connections_)
      if (well(c).pressure) sums[c.fracture >= 0][c.row] += W(c);
    for (const int k : places()) {
      const auto unbalanced = base::to_host(state.unbalanced[blocks_[k]]);
      for (auto& [row, sum] : sums[k]) sum = sum > 0 ? unbalanced(row) / sum : 0;
    }
    return sums;
  }
  bool is_linear() const { return parameters_.fluid.compressibility == 0 && !widens_ && parameters_.carried.empty(); }

  /// Sets up the transported quantities: for each of them one InjectedQuantity for rock and one for fractures.
  void bind_carried(const assembly::Context& context) {
    for (const auto& carried : parameters_.carried) {
      carried_units_.push_back(context.layout(context.field(carried.field)).field().unit);
      for (const bool in_fractures : {false, true}) {
        const bool widens = widens_ && in_fractures;
        auto& injected = injected_.emplace_back();
        for (const auto& c : connections_)
          if ((c.face >= 0) == in_fractures)
            injected.add(c.row, widens ? c.index : index(c), well(c).pressure.has_value(), c.face);
        carried_.push_back(context.field(in_fractures ? "face " + carried.field : carried.field));
        injected.bind(context, blocks_[in_fractures], carried_.back(), parameters_.fluid, carried.capacity,
                      widens ? parameters_.faces : std::vector<laws::Conduit>(), change(in_fractures));
      }
    }
  }

  /// Transported field that changes the fluid, with the name of the field on cells or facets.
  std::optional<FluidChange> change(bool in_fractures) const {
    for (const auto& carried : parameters_.carried)
      if (auto change = carried.change) {
        if (in_fractures) change->field = "face " + change->field;
        return change;
      }
    return {};
  }
  /// Density of the fluid in a well divided by rho_0. Uses u of the injected fluid if given, otherwise rho_0.
  Real heaviness(const Well& well, Real t) const {
    for (const auto& carried : parameters_.carried)
      if (const auto value = carried.in_wells.find(well.name); carried.change && value != carried.in_wells.end())
        return carried.change->response.density(value->second(well.points[0], t)).value;
    return 1;
  }

  void set_carried(Real t) {
    for (std::size_t k = 0; k < injected_.size(); ++k) {
      std::vector<InjectedQuantity::Control> controls;
      for (const auto& c : connections_)
        if ((c.face >= 0) == (k % 2 == 1)) controls.push_back(control(c, parameters_.carried[k / 2], t));
      injected_[k].set(controls);
    }
  }

  InjectedQuantity::Control control(const WellConnection& c, const Carried& carried, Real t) const {
    const auto value = carried.in_wells.find(well(c).name);
    const bool prescribes = value != carried.in_wells.end();
    return {.driver = well(c).pressure ? pressure(c, t) : rate(c, t),
            .value = prescribes ? value->second(well(c).points[0], t) : 0,
            .prescribes = prescribes};
  }

  Real carried_at(const assembly::State& state, std::size_t j, const WellConnection& c) const {
    const auto u = state.x[carried_[2 * j + (c.face >= 0)]];
    return base::to_host(Kokkos::subview(u, c.row))();
  }

  Real flow_factor(const assembly::State& state, const WellConnection& c) const {
    for (std::size_t j = 0; j < parameters_.carried.size(); ++j)
      if (const auto& change = parameters_.carried[j].change)
        return change->response.flow(carried_at(state, j, c)).value;
    return 1;
  }

  const Well& well(const WellConnection& c) const { return parameters_.wells[c.well]; }
  static const base::Expression& control(const Well& well) { return well.pressure ? *well.pressure : *well.rate; }

  /// Index W of a connection with its transmissivity.
  Real index(const WellConnection& c, Real widening = 0) const {
    return c.face < 0 ? c.index : c.index * parameters_.faces[c.face].transmissivity(widening);
  }
  /// [well] sum of W over all connections on all ranks, with widening(face). Collective.
  template <class Widening>
  std::vector<Real> sums(const Widening& widening) const {
    std::vector<Real> here(parameters_.wells.size(), 0);
    for (const auto& c : connections_) here[c.well] += index(c, c.face < 0 ? 0 : widening(c.face));
    return base::sum_over_ranks(*mesh_->comm, here);
  }
  Real share(const WellConnection& c) const {
    return index(c, c.face < 0 || start_.empty() ? 0 : start_[c.face]) / sums_[c.well];
  }
  Real rate(const WellConnection& c, Real t) const { return control(well(c))(well(c).points[0], t) * share(c); }

  Real lift(const WellConnection& c, Real t) const {
    Real sum = 0;
    for (int i = 0; i < mesh_->dim(); ++i) sum += parameters_.weight[i] * (c.x[i] - well(c).points[0][i]);
    return sum * heaviness(well(c), t);
  }
  /// Pressure in the well at a connection.
  Real pressure(const WellConnection& c, Real t) const {
    const Real first = control(well(c))(well(c).points[0], t);
    return first + parameters_.fluid.head(first, lift(c, t));
  }
  /// Pressure difference between a connection with pressure p and the first point, due to the weight of the fluid.
  Real head(const WellConnection& c, Real p, Real t) const { return -parameters_.fluid.head(p, -lift(c, t)); }

  WellsParameters parameters_;
  bool widens_ = false;  // apertures of fractures depend on "widening"
  RCP<const mesh::Mesh> mesh_;
  std::vector<WellConnection> connections_;  // of this rank
  std::vector<Real> start_;                  // [owned fracture face] widening at the start of the step; empty: none
  std::vector<Real> sums_;                   // [well] sum of W over all ranks at the start of the step
  std::array<int, 2> blocks_{};              // pressure, face pressure
  int widening_ = -1;
  std::array<Exchange, 2> exchange_;        // wells with prescribed pressure
  std::array<assembly::Load, 2> load_;      // [owned row] wells with prescribed rate, m^3/s
  std::vector<InjectedQuantity> injected_;  // [2 carried + in fractures]
  std::vector<int> carried_;                // blocks of their rows
  std::vector<std::string> carried_units_;  // [carried] unit of u
};

}  // namespace

std::unique_ptr<assembly::Module> make_wells(WellsParameters parameters) {
  return std::make_unique<Wells>(std::move(parameters));
}

}  // namespace sprekk::transport
