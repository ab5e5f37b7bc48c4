#include "assembly/rate_history.hpp"

#include "assembly/rows.hpp"

namespace sprekk::assembly {

RateHistory::RateHistory(const Structure& structure, Rates::Scheme scheme) : structure_(structure), scheme_(scheme) {
  for (int b = 0; b < structure.n_blocks(); ++b) {
    const auto& field = structure.layouts[b].field();
    const bool stored = scheme != Rates::Scheme::implicit_euler && structure.unknowns[b].balance;
    gains_.emplace_back("gain", stored ? fields::n_entities(*structure.mesh, field.entity, false) : 0,
                        field.n_components);
  }
}

void RateHistory::begin(Real t, Real dt) {
  t_ = t;
  dt_ = dt;
  rates_ = dt > 0 ? Rates::of(scheme_, dt, committed_dt_) : Rates{};
}

void RateHistory::subtract_before(Real before, const Rows& r) const {
  for (std::size_t b = 0; b < r.size() && before > 0; ++b) {
    if (gains_[b].extent(0) == 0) continue;
    const auto row = r[b];
    const auto gain = gains_[b];
    const int width = static_cast<int>(gain.extent(1));
    Kokkos::parallel_for(
        "gains", Kokkos::RangePolicy<Execution>(0, row.extent(0)),
        KOKKOS_LAMBDA(int i) { row(i) -= before * gain(i / width, i % width); });
  }
}

void RateHistory::commit(const fields::BlockVector& residual, const State& state) {
  if (structure_.has_rates()) {
    at_end_ = residual;
    unbalanced_ = fields::create_like(residual);
    fields::copy(residual, unbalanced_);
    structure_.zero_prescribed(rows_of(unbalanced_));
  }
  if (scheme_ != Rates::Scheme::implicit_euler) find_gains(state);
  committed_t_ = t_;
  committed_dt_ = dt_;
}

namespace {

/// Sets gain = (with - without)/rate; [entity, component] from [unknown].
void set_gains(const View<Real**>& gain, const View<Real*>& with, const View<Real*>& without, Real rate) {
  const int width = static_cast<int>(gain.extent(1));
  Kokkos::parallel_for(
      "gains", Kokkos::RangePolicy<Execution>(0, gain.extent(0)), KOKKOS_LAMBDA(int e) {
        for (int k = 0; k < width; ++k) gain(e, k) = (with(e * width + k) - without(e * width + k)) / rate;
      });
}

}  // namespace

/// Computes the storage increases from the residuals with and without storage.
void RateHistory::find_gains(const State& state) {
  const auto gained = structure_.create_vector(), rest = structure_.create_vector();
  const auto with = rows_of(gained), without = rows_of(rest);
  for (const auto& module : structure_.modules) {
    if (!module.declaration.stores) continue;
    auto there = module.at(state);
    module->residual(there, with);
    there.rate = 0;
    module->residual(there, without);
  }
  for (std::size_t b = 0; b < gains_.size(); ++b) set_gains(gains_[b], with[b], without[b], state.rate);
}

void RateHistory::resume(Real t, Real dt) {
  committed_t_ = t;
  committed_dt_ = dt;
  at_end_.clear();
  unbalanced_.clear();
}

std::vector<ConstView<Real*>> RateHistory::unbalanced() const {
  std::vector<ConstView<Real*>> views;
  for (const auto& v : unbalanced_) views.push_back(const_view_of(*v));
  return views;
}

std::vector<std::pair<fields::Field, View<Real**>>> RateHistory::histories() const {
  std::vector<std::pair<fields::Field, View<Real**>>> all;
  for (std::size_t b = 0; b < gains_.size(); ++b) {
    const auto& field = structure_.layouts[b].field();
    if (scheme_ != Rates::Scheme::implicit_euler && structure_.unknowns[b].balance)  // the same on all ranks
      all.push_back({{"gain of " + field.name, field.entity, field.n_components, "", true}, gains_[b]});
  }
  return all;
}

}  // namespace sprekk::assembly
