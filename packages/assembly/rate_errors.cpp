#include "assembly/rate_errors.hpp"

#include "base/over_ranks.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::assembly {

namespace {

View<Real**> entries(const fields::Vector& v, int n_components) {
  const auto local = const_cast<fields::Vector&>(v).getLocalViewDevice(Tpetra::Access::ReadWrite);
  return View<Real**>(local.data(), local.extent(0) / n_components, n_components);
}

/// Sets rate = (x - old)/dt and returns the largest |x - start|. Local.
Real find_rate(const View<Real**>& x, const View<Real**>& old, const View<Real**>& start, Real dt,
               const View<Real**>& rate) {
  Real largest = 0;
  const int width = static_cast<int>(x.extent(1));
  Kokkos::parallel_reduce(
      "rate", Kokkos::RangePolicy<Execution>(0, x.extent(0)),
      KOKKOS_LAMBDA(int e, Real& maximum) {
        for (int k = 0; k < width; ++k) {
          rate(e, k) = (x(e, k) - old(e, k)) / dt;
          const Real change = x(e, k) > start(e, k) ? x(e, k) - start(e, k) : start(e, k) - x(e, k);
          if (change > maximum) maximum = change;
        }
      },
      Kokkos::Max<Real>(largest));
  return largest;
}

/// Returns the sum of (a u + b v + c w)^2. Local.
Real square_of_sum(Real a, const View<Real**>& u, Real b, const View<Real**>& v, Real c, const View<Real**>& w) {
  Real sum = 0;
  const int width = static_cast<int>(u.extent(1));
  Kokkos::parallel_reduce(
      "difference", Kokkos::RangePolicy<Execution>(0, u.extent(0)),
      KOKKOS_LAMBDA(int e, Real& s) {
        for (int k = 0; k < width; ++k) {
          const Real value = a * u(e, k) + b * v(e, k) + c * w(e, k);
          s += value * value;
        }
      },
      sum);
  return sum;
}

}  // namespace

RateErrors::RateErrors(RCP<const Comm> comm, const std::vector<fields::Layout>& layouts,
                       const std::vector<char>& balances, Rates::Scheme scheme, const fields::BlockVector& start,
                       Real duration)
    : comm_(std::move(comm)), second_order_(scheme == Rates::Scheme::bdf2), duration_(duration) {
  for (std::size_t b = 0; b < layouts.size(); ++b) {
    if (!balances[b]) continue;
    const auto& field = layouts[b].field();
    const auto x = entries(*start[b], field.n_components);
    const auto like = [&](bool rates) { return View<Real**>("saved", rates ? x.extent(0) : 0, x.extent(1)); };
    BlockRates rates{static_cast<int>(b), field, like(true), like(true), like(true), like(second_order_)};
    Kokkos::deep_copy(rates.start, x);
    Kokkos::deep_copy(rates.old, x);
    rates.n = static_cast<Real>(layouts[b].owned()->getGlobalNumElements());
    if (rates.n > 0) blocks_.push_back(std::move(rates));
  }
}

void RateErrors::begin(const fields::BlockVector& x) {
  for (const auto& rates : blocks_) Kokkos::deep_copy(rates.old, entries(*x[rates.block], rates.field.n_components));
}

void RateErrors::forget(bool abrupt) {
  n_rates_ = abrupt ? -1 : 0;
  for (auto& rates : blocks_) rates.lasts = rates.sum = 0;
}

fields::StepErrors RateErrors::of_step(const fields::BlockVector& x, Real dt, bool second_order,
                                       const std::vector<Real>& minimum) {
  fields::StepErrors errors;
  const bool known = n_rates_ > (second_order ? 1 : 0);
  std::vector<Real> squares, largest;
  for (auto& rates : blocks_) {
    const auto now = entries(*x[rates.block], rates.field.n_components);
    const View<Real**> rate("rate", now.extent(0), now.extent(1));
    largest.push_back(find_rate(now, rates.old, rates.start, dt, rate));
    Real a = 1 / (dt + dt_), b = -a, c = 0;  // f_2
    if (second_order && known) {
      const Real before = 1 / (dt_ + dt_before_), all = dt + dt_ + dt_before_;
      a /= all;
      b = (b - before) / all;
      c = before / all;
    }
    squares.push_back(square_of_sum(1, rate, 0, rate, 0, rate));
    squares.push_back(square_of_sum(a, rate, b, rates.rate, c, second_order && known ? rates.rate_before : rates.rate));
    if (second_order_) Kokkos::deep_copy(rates.rate_before, rates.rate);
    Kokkos::deep_copy(rates.rate, rate);
    Kokkos::deep_copy(rates.old, now);
  }
  squares = base::sum_over_ranks(*comm_, squares);
  largest = base::max_over_ranks(*comm_, largest);
  const Real w = dt_ > 0 ? dt / dt_ : 1;
  const Real constant = second_order ? (1 + w) * (1 + w) / (w * (1 + 2 * w)) * dt * dt * dt : dt * dt;
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    auto& rates = blocks_[k];
    const Real speed = std::sqrt(squares[2 * k] / rates.n), bent = std::sqrt(squares[2 * k + 1] / rates.n);
    const bool changes = n_rates_ > 0 && rates.speed > 0;
    const Real shrinks = changes ? std::min<Real>(1, speed / rates.speed) : 1,
               grows = changes && speed > rates.speed ? rates.speed / speed : 1;
    const Real growth = n_rates_ > 0 && rates.largest > 0 && elapsed_ > 0
                            ? std::log(std::max<Real>(1, largest[k] / rates.largest)) / std::log(1 + dt / elapsed_)
                            : 0;
    const Real ahead = std::clamp<Real>(duration_ / (elapsed_ + dt), 1, 10);
    rates.largest = std::max(rates.largest, largest[k]);
    const Real size = std::max(rates.largest * std::pow(ahead, std::min<Real>(growth, 0.5)), minimum[rates.block]);
    rates.lasts = shrinks * grows * rates.lasts + dt;
    rates.speed = speed;
    const Real own = known ? constant * bent : 0;
    rates.sum = shrinks * rates.sum + own;
    if (!known)
      errors.push_back({rates.field.name, 0, fields::StepError::unknown});
    else
      errors.push_back({rates.field.name, size > 0 ? std::sqrt(rates.sum * own * rates.lasts / dt) / size : 0,
                        (second_order ? 2 : 1) + dt / rates.lasts});
  }
  dt_before_ = dt_;
  dt_ = dt;
  elapsed_ += dt;
  n_rates_ = std::min(n_rates_ + 1, 2);
  return errors;
}

std::vector<std::pair<fields::Field, View<Real**>>> RateErrors::histories() const {
  std::vector<std::pair<fields::Field, View<Real**>>> all;
  const auto add = [&](const std::string& what, const BlockRates& rates, const View<Real**>& values) {
    all.push_back({{what + rates.field.name, rates.field.entity, rates.field.n_components, ""}, values});
  };
  for (const auto& rates : blocks_) {
    add("rate of ", rates, rates.rate);
    if (second_order_) add("rate before of ", rates, rates.rate_before);
  }
  return all;
}

std::vector<Real> RateErrors::memory() const {
  std::vector<Real> numbers = {static_cast<Real>(n_rates_), dt_, dt_before_, elapsed_};
  for (const auto& rates : blocks_) numbers.insert(numbers.end(), {rates.largest, rates.lasts, rates.speed, rates.sum});
  return numbers;
}

void RateErrors::resume(const std::vector<Real>& memory) {
  if (memory.size() != 4 + 4 * blocks_.size()) {  // from steps without error estimates
    n_rates_ = 0;
    dt_ = dt_before_ = elapsed_ = 0;
    return;
  }
  n_rates_ = static_cast<int>(memory[0]);
  dt_ = memory[1];
  dt_before_ = memory[2];
  elapsed_ = memory[3];
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const Real* of = &memory[4 + 4 * k];
    blocks_[k].largest = of[0];
    blocks_[k].lasts = of[1];
    blocks_[k].speed = of[2];
    blocks_[k].sum = of[3];
  }
}

}  // namespace sprekk::assembly
