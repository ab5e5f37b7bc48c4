#include "transport/advection.hpp"

#include "assembly/capabilities.hpp"
#include "base/host_table.hpp"
#include "transport/advected_flow.hpp"
#include "transport/antidiffusion.hpp"
#include "transport/fracture_faces.hpp"
#include "transport/hybrid_rock.hpp"

#include <algorithm>

namespace sprekk::transport {

using assembly::Loop;

namespace {

/// Flow in cells.
template <Shape shape, bool changes>
struct InCells {
  using Cell = HybridCell<shape>;
  using Fluid = std::conditional_t<changes, ChangedFlow<Cell>, Cell>;
  using Flow = StabilisedFlow<Fluid, shape>;
  using Carried = typename Cell::Columns;
  static constexpr Loop loop = Loop::cells;
  static constexpr bool has_passed = true;
  HybridDiffusionParameters parameters;
  Stabilisation stabilisation;
  std::unique_ptr<Cell> cell = {};
  std::unique_ptr<fields::Layout> of_faces = {};
  StabilisingFlow<shape> volumes = {};
  View<Real**> passed = {};  // [local cell] as in StabilisedFlow

  std::vector<std::string> drivers() const {
    std::vector<std::string> fields = {parameters.field, "face " + parameters.field};
    if (changes) fields.push_back(parameters.change->field);
    return fields;
  }
  std::vector<std::string> carried(const std::string& field) const { return {field, "face " + field}; }
  std::string place() const { return ""; }
  static constexpr auto entity = fields::Entity::cell;
  static EndGraph graph(const mesh::Mesh& mesh) { return end_graph_of_cells(mesh); }
  static LocalIndex row(const mesh::Mesh&, LocalIndex cell) { return cell; }
  static std::vector<Real> sizes(const mesh::Mesh& mesh) { return assembly::cell_volumes(mesh); }
  /// Marks the faces on boundaries without a condition on u, [local cell][face].
  static ConstView<char**> entrances(const mesh::Mesh& mesh, const transport::Carried& quantity) {
    const base::HostTable<char**> marks("entrances", mesh.n_cells(), Flow::n);
    for (const auto& face : mesh.boundary_faces) {
      const auto prescribes = [&](const auto& one) {
        return one.boundary == mesh.boundary_names[face.boundary] &&
               (one.region.empty() || one.region == mesh.region_names[mesh.cell_region[face.cell]]);
      };
      const auto& all = quantity.prescribed;
      if (std::none_of(all.begin(), all.end(), prescribes)) marks(face.cell, face.local_face) = 1;
    }
    return marks.on_device();
  }
  /// Storage volume per size of the entity, m^3.
  Real room(LocalIndex, const Real*, Real) const { return 1; }
  /// Number of columns of the history "passed"; 0 without stabilisation.
  int n_passed() const { return stabilisation.softness.empty() ? 0 : 2 * Flow::n; }
  void bind(const assembly::Context& context) {
    cell = std::make_unique<Cell>(hybrid_cell<shape>(context, parameters));
    if (n_passed() == 0) return;
    volumes = stabilising_flow<shape>(*context.mesh(), stabilisation);
    of_faces = std::make_unique<fields::Layout>(fields::Field{"passed", entity, n_passed(), ""}, *context.mesh());
    passed = View<Real**>("passed", context.mesh()->n_cells(), n_passed());
  }
  /// Copies the history to local cells. Collective.
  void start_step(const View<Real**>& saved) {
    const auto own = base::to_host(saved);
    std::vector<Real> owned;
    for (std::size_t e = 0; e < own.extent(0); ++e)
      for (int k = 0; k < n_passed(); ++k) owned.push_back(own(e, k));
    const auto all = with_ghosts(*of_faces, owned);
    const base::HostTable<Real**> values(passed);
    for (std::size_t e = 0; e < values.extent(0); ++e)
      for (int k = 0; k < n_passed(); ++k) values(e, k) = all[e * n_passed() + k];
    values.on_device();
  }
  /// Updates the history of volumes. `first`: start of a run, where the volume of the last step is zero.
  template <class Assembler, class Op>
  void keep(const Assembler& assembler, const Op& op, const assembly::State& state, const View<Real**>& saved,
            bool first) const {
    const auto n_owned = static_cast<int>(saved.extent(0));
    const auto flow = volumes;
    assembler.for_each(
        op, state, KOKKOS_LAMBDA(int e, const Real(&x)[Op::Columns::size]) {
          if (e >= n_owned) return;
          Real p[1 + Flow::n], V[Flow::n];
          for (int k = 0; k <= Flow::n; ++k) p[k] = x[k];
          flow.flow(e, p, V);
          for (int i = 0; i < Flow::n; ++i) {
            saved(e, Flow::n + i) = first ? 0 : V[i] - saved(e, i);
            saved(e, i) = V[i];
          }
        });
  }
  Flow at(const assembly::State& state) const {
    if constexpr (changes)
      return {{*cell, parameters.change->response}, volumes, passed, state.rate, state.before};
    else
      return {*cell, volumes, passed, state.rate, state.before};
  }
};

/// Flow along fracture faces.
template <Shape shape, bool widens, bool changes>
struct InFractures {
  static constexpr int n = FractureFaces<shape>::n;
  using Face = FractureFace<n>;
  using Fluid = std::conditional_t<changes, ChangedFlow<Face>, Face>;
  using Flow = std::conditional_t<widens, WideningFace<Fluid>, Fluid>;
  using Carried = assembly::Slots<assembly::Slot<1 + n, 1>>;
  static constexpr Loop loop = Loop::fracture_cells;
  static constexpr bool has_passed = false;
  FractureFlowParameters parameters;
  std::unique_ptr<FractureFaces<shape>> faces = {};

  std::vector<std::string> drivers() const { return transport::drivers(parameters, widens); }
  std::vector<std::string> carried(const std::string& field) const { return {"face " + field}; }
  std::string place() const { return " in fractures"; }
  static constexpr auto entity = fields::Entity::fracture_face;
  static EndGraph graph(const mesh::Mesh& mesh) { return end_graph_of_fractures(mesh); }
  static LocalIndex row(const mesh::Mesh& mesh, LocalIndex face) { return mesh.facets->fracture_face[face]; }
  /// None: the two-point flux at an end without a condition gives u_i = u_K.
  static ConstView<char**> entrances(const mesh::Mesh&, const transport::Carried&) { return {}; }
  static std::vector<Real> sizes(const mesh::Mesh& mesh) {
    std::vector<Real> areas;
    for (const auto& face : mesh.fracture_faces) areas.push_back(face.area);
    return areas;
  }
  /// Storage volume at reference conditions per size of the face, m^3. The drivers of the flow start with p_F and end
  /// with the widening.
  Real room(LocalIndex face, const Real* drivers, Real u) const {
    const Real aperture =
        parameters.faces[face].along.mechanical_aperture(widens ? drivers[Flow::Columns::size - 1] : 0);
    return aperture * parameters.fluid.density(drivers[0]) *
           (changes ? parameters.change->response.density(u).value : 1);
  }
  void bind(const assembly::Context& context) {
    faces = std::make_unique<FractureFaces<shape>>(context.mesh(), context.layout(context.field("face pressure")),
                                                   parameters, widens);
  }
  Flow at(const assembly::State& state) const {
    if constexpr (widens)
      return {fluid(), {faces->conduits(), state.coefficients}};
    else
      return fluid();
  }
  Fluid fluid() const {
    if constexpr (changes)
      return {faces->op(), parameters.change->response};
    else
      return faces->op();
  }
};

template <class Where>
class AdvectionModule final : public assembly::Module, public assembly::Steps, public assembly::Transfer {
 public:
  AdvectionModule(Where where, const Carried& carried, std::optional<std::vector<Real>> stored)
      : where_(std::make_unique<Where>(std::move(where))), carried_(carried), stored_(std::move(stored)) {}

  std::string name() const override { return "advection of " + carried_.field + where_->place(); }

  assembly::Declaration declare(const mesh::Mesh&) const override {
    assembly::Declaration d;
    for (const auto& row : rows()) d.couplings.push_back({Where::loop, row, columns()});
    d.carries = rows();
    if (corrects())
      d.history.push_back({"antidiffusion" + where_->place(), Where::entity, Antidiffusion::n_saved(n), false, false});
    if constexpr (Where::has_passed)
      if (where_->n_passed() > 0) d.history.push_back({"passed", Where::entity, where_->n_passed(), false, false});
    return d;
  }

  void bind(const assembly::Context& context) override {
    const auto numbers = [&](const auto& names) {
      std::vector<int> blocks;
      for (const auto& name : names) blocks.push_back(context.field(name));
      return blocks;
    };
    assembler_ = std::make_unique<Assembler>(context, Where::loop, numbers(rows()), numbers(columns()),
                                             Assembler::Positions::keep);
    where_->bind(context);
    entrances_ = Where::entrances(*context.mesh(), carried_);
    if (corrects()) bind_correction(context);
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    assembler_->add_residual(at(state), state, r);
    if (!corrects()) return;
    const auto rows = r[block_];
    const auto row = row_;
    const auto gains = gains_;
    const Real rate = state.rate;
    Kokkos::parallel_for(
        "antidiffusion", Kokkos::RangePolicy<Execution>(0, gains.extent(0)),
        KOKKOS_LAMBDA(int e) { rows(row(e)) -= rate * gains(e); });
  }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    assembler_->add_jacobian(at(state), state, J);
  }
  bool symmetric(const assembly::State&) const override { return false; }

  void start_step(const assembly::State& state) override {
    if (corrects()) gains_ = assembly::to_device(correction_->gains(base::to_host(state.history[0])), "gains");
    if constexpr (Where::has_passed)
      if (where_->n_passed() > 0) where_->start_step(state.history.back());
  }
  void take_over(assembly::State& state) const override { keep_passed(state, true); }
  void commit(assembly::State& state) const override {
    if (corrects()) commit_correction(state);
    keep_passed(state, false);
  }

  /// Stores the flux correction of the step in the history.
  void commit_correction(const assembly::State& state) const {
    const View<Real**> found("found", assembler_->n_entities(), Op::Columns::size), flows("flows", found.extent(0), n);
    const auto op = at(state);
    assembler_->for_each(
        op, state, KOKKOS_LAMBDA(int e, const Real(&x)[Op::Columns::size]) {
          Real drivers[m], q[n];
          for (int k = 0; k < Op::Columns::size; ++k) found(e, k) = x[k];
          for (int k = 0; k < m; ++k) drivers[k] = x[k];
          op.flow.flow(e, drivers, q);
          for (int i = 0; i < n; ++i) flows(e, i) = op.capacity * q[i];
        });
    const auto x = base::to_host(found);
    const auto q = base::to_host(flows);
    std::vector<Real> u, of_ends, flow, stored;
    for (LocalIndex e = 0; e < assembler_->n_entities(); ++e) {
      u.push_back(x(e, m));
      stored.push_back((*stored_)[e] * sizes_[e] * where_->room(e, &x(e, 0), u.back()));
      for (int i = 0; i < n; ++i) {
        of_ends.push_back(x(e, m + 1 + i));
        flow.push_back(q(e, i));
      }
    }
    const auto saved = base::to_host(state.history[0]);
    correction_->keep(u, of_ends, flow, stored, state.rate > 0 ? 1 / state.rate : 0, saved);
    Kokkos::deep_copy(state.history[0], saved);
  }

 private:
  using Op = Advection<typename Where::Flow, typename Where::Carried>;
  using Assembler = assembly::Assembler<Op>;
  static constexpr int n = Op::n, m = Op::m;

  void keep_passed(const assembly::State& state, bool first) const {
    if constexpr (Where::has_passed)
      if (where_->n_passed() > 0) where_->keep(*assembler_, at(state), state, state.history.back(), first);
  }

  bool corrects() const { return stored_.has_value(); }
  void bind_correction(const assembly::Context& context) {
    const auto& mesh = *context.mesh();
    block_ = context.field(rows()[0]);
    sizes_ = Where::sizes(mesh);
    correction_ = std::make_unique<Antidiffusion>(mesh, Where::entity, Where::graph(mesh));
    std::vector<LocalIndex> rows;
    for (LocalIndex e = 0; e < fields::n_entities(mesh, Where::entity, false); ++e) rows.push_back(Where::row(mesh, e));
    row_ = assembly::to_device(rows, "rows");
    gains_ = assembly::to_device(std::vector<Real>(rows.size(), 0), "gains");
  }

  Op at(const assembly::State& state) const { return {where_->at(state), carried_.capacity, entrances_}; }
  std::vector<std::string> rows() const { return where_->carried(carried_.field); }
  std::vector<std::string> columns() const {
    auto names = where_->drivers();
    for (const auto& name : rows()) names.push_back(name);
    return names;
  }

  std::unique_ptr<Where> where_;
  Carried carried_;
  std::unique_ptr<Assembler> assembler_;
  ConstView<char**> entrances_;
  std::optional<std::vector<Real>> stored_;  // [local entity] per volume and unit of u; this and the following for
                                             // Antidiffusion only
  std::vector<Real> sizes_;                  // [local entity]
  std::unique_ptr<Antidiffusion> correction_;
  int block_ = -1;              // block of the corrected rows
  ConstView<LocalIndex*> row_;  // [owned entity]
  ConstView<Real*> gains_;      // [owned entity] gains at the start of the step
};

template <class Where>
std::unique_ptr<assembly::Module> module_of(Where where, const Carried& carried,
                                            const std::optional<std::vector<Real>>& stored) {
  return std::make_unique<AdvectionModule<Where>>(std::move(where), carried, stored);
}

}  // namespace

std::unique_ptr<assembly::Module> make_advection(Shape shape, const FlowInRock& flow, const Carried& carried,
                                                 const std::optional<std::vector<Real>>& stored) {
  return mesh::for_corners(shape, [&](auto s) {
    return flow.darcy.change ? module_of(InCells<s(), true>{flow.darcy, flow.stabilisation}, carried, stored)
                             : module_of(InCells<s(), false>{flow.darcy, flow.stabilisation}, carried, stored);
  });
}

std::unique_ptr<assembly::Module> make_fracture_advection(Shape shape, const FractureFlowParameters& flow,
                                                          const Carried& carried, bool widens,
                                                          const std::optional<std::vector<Real>>& stored) {
  return mesh::for_face_corners(shape, [&](auto s) {
    const auto make = [&](auto changes) {
      return widens ? module_of(InFractures<s(), true, changes()>{flow}, carried, stored)
                    : module_of(InFractures<s(), false, changes()>{flow}, carried, stored);
    };
    return flow.change ? make(std::true_type()) : make(std::false_type());
  });
}

}  // namespace sprekk::transport
