#include "physics/flow/advection.hpp"

#include "physics/flow/fracture_faces.hpp"
#include "physics/hybrid_rock.hpp"

namespace sprekk::physics {

using assembly::Loop;

namespace {

/// | symbol   | shape | unit         |                                                        |
/// | x        | m + 1 + n | Pa, m, U | what the flow depends on [m], u of the entity and its ends |
/// | r        | 1 + n | Q/s          | of energy W                                            |
/// | q        | n     | m^3/s        | outward flow through ends (2D: m^2/s)                  |
/// | capacity |       | Q/(m^3 U)    | c                                                      |
template <class Flow, class Carried>
struct Advection {
  static constexpr int n = Flow::n_ends, m = Flow::Columns::size;
  using Columns = typename Joined<typename Flow::Columns, Carried>::Slots;
  using Rows = Carried;
  static_assert(Rows::size == 1 + n);
  Flow flow;
  Real capacity;

  KOKKOS_INLINE_FUNCTION void residual(int e, const Real (&x)[m + 1 + n], Real (&r)[1 + n]) const {
    Real drivers[m], q[n];
    for (int k = 0; k < m; ++k) drivers[k] = x[k];
    flow.flow(e, drivers, q);
    r[0] = 0;
    for (int i = 0; i < n; ++i) {
      const Real rise = capacity * q[i] * (x[m + 1 + i] - x[m]);  // along the outward flow
      r[0] += q[i] < 0 ? rise : 0;
      r[1 + i] = q[i] > 0 ? rise : 0;
    }
  }

  KOKKOS_INLINE_FUNCTION void jacobian(int e, const Real (&x)[m + 1 + n], Real (&J)[1 + n][m + 1 + n]) const {
    Real drivers[m], q[n], dq[n][m];
    for (int k = 0; k < m; ++k) drivers[k] = x[k];
    flow.flow(e, drivers, q);
    flow.dflow(e, drivers, dq);
    for (auto& row : J)
      for (Real& value : row) value = 0;
    for (int i = 0; i < n; ++i) {
      Real(&row)[m + 1 + n] = J[q[i] > 0 ? 1 + i : 0];
      for (int k = 0; k < m; ++k) row[k] += capacity * dq[i][k] * (x[m + 1 + i] - x[m]);
      row[m] -= capacity * q[i];
      row[m + 1 + i] += capacity * q[i];
    }
  }
};

/// Of flow in cells.
template <Shape shape, bool changes>
struct InCells {
  using Cell = HybridCell<shape>;
  using Flow = std::conditional_t<changes, ChangedFlow<Cell>, Cell>;
  using Carried = typename Cell::Columns;
  static constexpr Loop loop = Loop::cells;
  HybridDiffusionParameters parameters;
  std::unique_ptr<Cell> cell = {};

  std::vector<std::string> drivers() const {
    std::vector<std::string> fields = {parameters.field, "face " + parameters.field};
    if (changes) fields.push_back(parameters.change->field);
    return fields;
  }
  std::vector<std::string> carried(const std::string& field) const { return {field, "face " + field}; }
  std::string place() const { return ""; }
  void bind(const assembly::Context& context) {
    cell = std::make_unique<Cell>(hybrid_cell<shape>(context, parameters));
  }
  Flow at(const assembly::State&) const {
    if constexpr (changes)
      return {*cell, parameters.change->response};
    else
      return *cell;
  }
};

/// Of flow along fracture faces.
template <Shape shape, bool widens, bool changes>
struct InFractures {
  static constexpr int n = FractureFaces<shape>::n;
  using Face = FractureFace<n>;
  using Fluid = std::conditional_t<changes, ChangedFlow<Face>, Face>;
  using Flow = std::conditional_t<widens, WideningFace<Fluid>, Fluid>;
  using Carried = assembly::Slots<assembly::Slot<1 + n, 1>>;
  static constexpr Loop loop = Loop::fracture_cells;
  FractureFlowParameters parameters;
  std::unique_ptr<FractureFaces<shape>> faces = {};

  std::vector<std::string> drivers() const { return physics::drivers(parameters, widens); }
  std::vector<std::string> carried(const std::string& field) const { return {"face " + field}; }
  std::string place() const { return " in fractures"; }
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
class AdvectionModule final : public assembly::Module {
 public:
  AdvectionModule(Where where, const Carried& carried)
      : where_(std::make_unique<Where>(std::move(where))), carried_(carried) {}

  std::string name() const override { return "advection of " + carried_.field + where_->place(); }

  assembly::Declaration declare(const mesh::Mesh&) const override {
    assembly::Declaration d;
    for (const auto& row : rows()) d.couplings.push_back({Where::loop, row, columns()});
    d.carries = rows();
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
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    assembler_->add_residual(at(state), state, r);
  }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    assembler_->add_jacobian(at(state), state, J);
  }
  bool symmetric(const assembly::State&) const override { return false; }

 private:
  using Op = Advection<typename Where::Flow, typename Where::Carried>;
  using Assembler = assembly::Assembler<Op>;

  Op at(const assembly::State& state) const { return {where_->at(state), carried_.capacity}; }
  std::vector<std::string> rows() const { return where_->carried(carried_.field); }
  std::vector<std::string> columns() const {
    auto names = where_->drivers();
    for (const auto& name : rows()) names.push_back(name);
    return names;
  }

  std::unique_ptr<Where> where_;
  Carried carried_;
  std::unique_ptr<Assembler> assembler_;
};

template <class Where>
std::unique_ptr<assembly::Module> module_of(Where where, const Carried& carried) {
  return std::make_unique<AdvectionModule<Where>>(std::move(where), carried);
}

}  // namespace

std::unique_ptr<assembly::Module> make_advection(Shape shape, const HybridDiffusionParameters& flow,
                                                 const Carried& carried) {
  return mesh::for_shape(shape, [&](auto s) {
    return flow.change ? module_of(InCells<s(), true>{flow}, carried) : module_of(InCells<s(), false>{flow}, carried);
  });
}

std::unique_ptr<assembly::Module> make_fracture_advection(Shape shape, const FractureFlowParameters& flow,
                                                          const Carried& carried, bool widens) {
  return mesh::for_shape(shape, [&](auto s) {
    const auto make = [&](auto changes) {
      return widens ? module_of(InFractures<s(), true, changes()>{flow}, carried)
                    : module_of(InFractures<s(), false, changes()>{flow}, carried);
    };
    return flow.change ? make(std::true_type()) : make(std::false_type());
  });
}

}  // namespace sprekk::physics
