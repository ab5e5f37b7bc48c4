#include "physics/mechanics/release.hpp"

#include "assembly/capabilities.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::physics {

namespace {

/// Computes rows += factor * history; [owned row], [owned entity, component].
void add(Real factor, const View<Real**>& history, const View<Real*>& rows) {
  const int n = static_cast<int>(history.extent(1));
  Kokkos::parallel_for(
      "release", Kokkos::RangePolicy<Execution>(0, rows.extent(0)),
      KOKKOS_LAMBDA(int i) { rows(i) += factor * history(i / n, i % n); });
}

/// Computes history := rows + remaining * history, where rows contain -remaining * history.
void take(Real remaining, const View<Real*>& rows, const View<Real**>& history) {
  const int n = static_cast<int>(history.extent(1));
  Kokkos::parallel_for(
      "release", Kokkos::RangePolicy<Execution>(0, rows.extent(0)), KOKKOS_LAMBDA(int i) {
        auto& value = history(i / n, i % n);
        value = rows(i) + remaining * value;
      });
}

class Release final : public assembly::Module, public assembly::Loads, public assembly::Transfer {
 public:
  Release(Real begin, Real end) : begin_(begin), end_(end) {}

  std::string name() const override { return "release"; }
  void set_fields(const std::set<std::string>& fields) override { tips_ = fields.count("tip displacement") > 0; }

  assembly::Declaration declare(const mesh::Mesh& mesh) const override {
    assembly::Declaration d;
    const auto keep = [&](const char* field, fields::Entity entity, int n) {
      d.history.push_back({std::string("of ") + field, entity, n, false, false});
    };
    keep("displacement", fields::Entity::node, mesh.dim());
    if (!mesh.fracture_names.empty()) keep("side bubble", fields::Entity::fracture_face, 2 * mesh.dim());
    if (tips_) keep("tip displacement", fields::Entity::enriched_node, mesh.dim());
    return d;
  }

  void bind(const assembly::Context& context) override {
    fields_ = {context.field("displacement")};
    if (!context.mesh()->fracture_names.empty()) fields_.push_back(context.field("side bubble"));
    if (tips_) fields_.push_back(context.field("tip displacement"));
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    const Real remaining = remaining_at(state.t);
    for (std::size_t k = 0; k < fields_.size() && remaining > 0; ++k) add(-remaining, state.history[k], r[fields_[k]]);
  }
  void jacobian(const assembly::State&, fields::BlockMatrix&) const override {}
  bool constant_load() const override { return false; }

  /// Saves the unbalanced forces. The residual contains the part of the previous history that is not yet released.
  void take_unbalanced(assembly::State& state, const assembly::Rows& residual) const override {
    if (std::abs(state.t - begin_) > 1e-9 * (end_ - begin_)) return;  // from an earlier stage
    for (std::size_t k = 0; k < fields_.size(); ++k)
      take(remaining_at(state.t), residual[fields_[k]], state.history[k]);
  }

 private:
  /// Returns 1 - s.
  Real remaining_at(Real t) const { return 1 - std::clamp<Real>((t - begin_) / (end_ - begin_), 0, 1); }

  Real begin_, end_;
  bool tips_ = false;
  std::vector<int> fields_;
};

}  // namespace

std::unique_ptr<assembly::Module> make_release(Real begin, Real end) { return std::make_unique<Release>(begin, end); }

}  // namespace sprekk::physics
