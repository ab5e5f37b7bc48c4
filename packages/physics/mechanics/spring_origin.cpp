#include "physics/mechanics/spring_origin.hpp"

#include "assembly/bound_module.hpp"
#include "assembly/load.hpp"
#include "base/host_table.hpp"

#include <utility>

namespace sprekk::physics {

namespace {

View<Real*> flat(const View<Real**>& values) { return View<Real*>(values.data(), values.size()); }

View<Real*> values_of(fields::Vector& vector) {
  const auto local = vector.getLocalViewDevice(Tpetra::Access::ReadWrite);
  return View<Real*>(local.data(), local.extent(0));
}

class SpringOrigin final : public assembly::Module,
                           public assembly::Loads,
                           public assembly::Steps,
                           public assembly::Transfer,
                           public assembly::Supporting {
 public:
  SpringOrigin(std::unique_ptr<assembly::Module> springs, std::string name, const std::array<Real, 3>& stiffness,
               bool keeps)
      : springs_(std::move(springs)), name_(std::move(name)), stiffness_(stiffness), keeps_(keeps) {}

  std::string name() const override { return name_; }
  std::string fingerprint() const override { return springs_->fingerprint(); }
  void set_fields(const std::set<std::string>& fields) override { springs_->set_fields(fields); }
  assembly::Declaration declare(const mesh::Mesh& mesh) const override {
    auto d = springs_->declare(mesh);
    if (keeps_) d.history.push_back(origin(mesh.dim()));
    return d;
  }
  void bind(const assembly::Context& context) override {
    springs_->bind(context);
    displacement_ = context.field("displacement");
    dim_ = context.mesh()->dim();
    layout_ = context.layout(displacement_);
    load_ = assembly::Load(layout_->n_owned());
  }
  bool constrains_bodies() const override { return springs_.constrains_bodies(); }
  std::optional<std::vector<contact::Support>> supports() const override { return springs_.supporting->supports(); }
  bool constant_load() const override { return !keeps_; }
  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override { springs_->jacobian(state, J); }
  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    springs_->residual(state, r);
    if (keeps_) load_.add_to(r[displacement_], -1);
  }

  /// Computes f(u_0).
  void start_step(const assembly::State& state) override {
    if (!keeps_) return;
    fields::Vector owned(layout_->owned()), all(layout_->ghosted());
    Kokkos::deep_copy(values_of(owned), flat(state.history.back()));
    all.doImport(owned, *layout_->import(), Tpetra::REPLACE);
    auto there = state;
    there.x[displacement_] = values_of(all);
    assembly::Rows forces;
    forces.resize(displacement_ + 1);
    forces[displacement_] = View<Real*>("forces of springs", layout_->n_owned());
    springs_->residual(there, forces);
    load_.set([&](const auto& load) { Kokkos::deep_copy(load, forces[displacement_]); });
  }

  /// Passes on the traction of the springs.
  void pass_on(const assembly::State& state,
               std::vector<std::pair<assembly::History, View<Real**>>>& histories) const override {
    histories.emplace_back(origin(dim_), of_sprung(state, [](Real k, Real u, Real u_0) { return k * (u - u_0); }));
  }
  void take_over(assembly::State& state) const override {
    if (keeps_)
      Kokkos::deep_copy(state.history.back(),
                        of_sprung(state, [](Real k, Real u, Real traction) { return u - traction / k; }));
  }

 private:
  static assembly::History origin(int dim) { return {"origin", fields::Entity::node, dim}; }

  /// Returns value(k, u, history) at springs, [owned node, component]; 0 elsewhere.
  template <class Value>
  View<Real**> of_sprung(const assembly::State& state, const Value& value) const {
    const base::HostTable<Real**> result("of springs", layout_->n_owned_entities(), dim_);
    const View<Real**> before = keeps_ ? state.history.back() : View<Real**>("none", result.extent(0), dim_);
    const auto u = base::to_host(state.x[displacement_]);
    const auto saved = base::to_host(before);
    const auto sprung = springs_.supporting->supports().value();
    for (const auto& [unknown, i, along] : sprung)
      if (const LocalIndex node = unknown / dim_; unknown < layout_->n_owned())
        result(node, i) = value(stiffness_[i], u(unknown), saved(node, i));
    return result.on_device();
  }

  assembly::BoundModule springs_;
  std::string name_;
  std::array<Real, 3> stiffness_;
  bool keeps_;
  int displacement_ = -1, dim_ = 0;
  std::optional<fields::Layout> layout_;
  assembly::Load load_;  // N
};

}  // namespace

std::unique_ptr<assembly::Module> make_spring_origin(std::unique_ptr<assembly::Module> springs, const std::string& name,
                                                     const std::array<Real, 3>& stiffness, bool keeps) {
  return std::make_unique<SpringOrigin>(std::move(springs), name, stiffness, keeps);
}

}  // namespace sprekk::physics
