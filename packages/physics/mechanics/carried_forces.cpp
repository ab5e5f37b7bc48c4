#include "physics/mechanics/carried_forces.hpp"

#include <utility>

namespace sprekk::physics {

namespace {

/// rows += factor * values; [owned row], [owned node, component]
void add(Real factor, const View<Real**>& values, const View<Real*>& rows) {
  const int dim = static_cast<int>(values.extent(1));
  Kokkos::parallel_for(
      "carried forces", Kokkos::RangePolicy<Execution>(0, rows.extent(0)),
      KOKKOS_LAMBDA(int i) { rows(i) += factor * values(i / dim, i % dim); });
}

View<Real*> rows_of(const View<Real**>& values) { return View<Real*>(values.data(), values.size()); }

class CarriedForces final : public assembly::Module {
 public:
  CarriedForces(std::unique_ptr<assembly::Module> springs, std::string name, bool keeps)
      : springs_(std::move(springs)), name_(std::move(name)), keeps_(keeps) {}

  std::string name() const override { return name_; }
  std::string fingerprint() const override { return springs_->fingerprint(); }
  void set_fields(const std::set<std::string>& fields) override { springs_->set_fields(fields); }
  assembly::Declaration declare(const mesh::Mesh& mesh) const override {
    auto d = springs_->declare(mesh);
    if (keeps_) d.history.push_back(carried(mesh.dim()));
    return d;
  }
  void bind(const assembly::Context& context) override {
    springs_->bind(context);
    displacement_ = context.field("displacement");
    dim_ = context.mesh()->dim();
    n_nodes_ = context.layout(displacement_).n_owned_entities();
  }
  bool holds_bodies() const override { return springs_->holds_bodies(); }
  std::optional<std::vector<contact::Support>> supports() const override { return springs_->supports(); }
  bool constant_load() const override { return !keeps_; }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override { springs_->jacobian(state, J); }
  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    springs_->residual(state, r);
    if (keeps_) add(1, state.history.back(), r[displacement_]);
  }

  void pass_on(const assembly::State& state,
               std::vector<std::pair<assembly::History, View<Real**>>>& histories) const override {
    const auto all = forces(state);
    if (keeps_) add(1, state.history.back(), rows_of(all));
    histories.emplace_back(carried(dim_), all);
  }
  void take_over(assembly::State& state) const override {
    if (keeps_) add(-1, forces(state), rows_of(state.history.back()));
  }

 private:
  static assembly::History carried(int dim) { return {"carried forces", fields::Entity::node, dim}; }
  /// Of the springs alone, [owned node, component].
  View<Real**> forces(const assembly::State& state) const {
    const View<Real**> values("forces of springs", n_nodes_, dim_);
    assembly::Rows fields;
    fields.resize(displacement_ + 1);
    fields[displacement_] = rows_of(values);
    springs_->residual(state, fields);
    return values;
  }

  std::unique_ptr<assembly::Module> springs_;
  std::string name_;
  bool keeps_;
  int displacement_ = -1, dim_ = 0;
  LocalIndex n_nodes_ = 0;
};

}  // namespace

std::unique_ptr<assembly::Module> make_carried_forces(std::unique_ptr<assembly::Module> springs,
                                                      const std::string& name, bool keeps) {
  return std::make_unique<CarriedForces>(std::move(springs), name, keeps);
}

}  // namespace sprekk::physics
