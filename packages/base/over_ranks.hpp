// Reductions and broadcasts over all ranks. All functions are collective.
#pragma once

#include "base/types.hpp"

#include <Teuchos_CommHelpers.hpp>

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

namespace sprekk::base {

namespace detail {

/// Pointer to the first number of nested arrays, which are contiguous.
template <class T>
T* first_number(T& value) {
  return &value;
}
template <class T, std::size_t n>
auto* first_number(std::array<T, n>& values) {
  return first_number(values[0]);
}
template <class T, std::size_t n>
const auto* first_number(const std::array<T, n>& values) {
  return first_number(values[0]);
}

}  // namespace detail

/// Reduces a number, or each element of a container of numbers or arrays. The container must have the same length on
/// all ranks.
template <class T>
T over_ranks(const Comm& comm, Teuchos::EReductionType how, const T& here) {
  T all = here;
  if constexpr (requires { here.data(); }) {
    if (here.empty()) return all;
    const auto* from = detail::first_number(*here.data());
    const std::size_t n = here.size() * (sizeof(*here.data()) / sizeof(*from));
    Teuchos::reduceAll(comm, how, static_cast<int>(n), from, detail::first_number(*all.data()));
  } else {
    Teuchos::reduceAll(comm, how, 1, &here, &all);
  }
  return all;
}

template <class T>
T sum_over_ranks(const Comm& comm, const T& here) {
  return over_ranks(comm, Teuchos::REDUCE_SUM, here);
}
template <class T>
T max_over_ranks(const Comm& comm, const T& here) {
  return over_ranks(comm, Teuchos::REDUCE_MAX, here);
}
template <class T>
T min_over_ranks(const Comm& comm, const T& here) {
  return over_ranks(comm, Teuchos::REDUCE_MIN, here);
}

/// True if `here` is true on any rank, or on all ranks.
inline bool on_any_rank(const Comm& comm, bool here) { return max_over_ranks(comm, static_cast<int>(here)) != 0; }
inline bool on_all_ranks(const Comm& comm, bool here) { return min_over_ranks(comm, static_cast<int>(here)) != 0; }

/// True if `question` returns true on any rank. False without a function; then all ranks must be without one.
inline bool any_rank(const Comm& comm, const std::function<bool()>& question) {
  return question && on_any_rank(comm, question());
}

/// Returns the value of `rank`: a number, or a text or vector of any length.
template <class T>
T of_rank(const Comm& comm, int rank, T here) {
  if constexpr (requires { here.resize(1); }) {
    here.resize(of_rank(comm, rank, static_cast<int>(here.size())));
    Teuchos::broadcast(comm, rank, static_cast<int>(here.size()), here.data());
  } else {
    Teuchos::broadcast(comm, rank, 1, &here);
  }
  return here;
}

/// Concatenates the numbers of all ranks in the order of ranks. Lengths may differ.
template <class T>
std::vector<T> gather_over_ranks(const Comm& comm, std::vector<T> here) {
  std::vector<int> lengths(comm.getSize());
  const int n = static_cast<int>(here.size());
  Teuchos::gatherAll(comm, 1, &n, comm.getSize(), lengths.data());
  const int maximum = *std::max_element(lengths.begin(), lengths.end());
  if (maximum == 0) return {};
  here.resize(maximum);
  std::vector<T> padded(static_cast<std::size_t>(maximum) * comm.getSize()), all;
  Teuchos::gatherAll(comm, maximum, here.data(), static_cast<int>(padded.size()), padded.data());
  for (int r = 0; r < comm.getSize(); ++r)
    all.insert(all.end(), &padded[std::size_t(maximum) * r], &padded[std::size_t(maximum) * r] + lengths[r]);
  return all;
}

}  // namespace sprekk::base
