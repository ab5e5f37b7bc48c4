// Sums and extremes over all ranks. All are collective.
#pragma once

#include "base/types.hpp"

#include <Teuchos_CommHelpers.hpp>

#include <functional>

namespace sprekk::base {

/// Of a number, or of a container as long on all ranks, element by element.
template <class T>
T over_ranks(const Comm& comm, Teuchos::EReductionType how, const T& here) {
  T all = here;
  if constexpr (requires { here.data(); }) {
    if (!here.empty()) Teuchos::reduceAll(comm, how, static_cast<int>(here.size()), here.data(), all.data());
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

/// Whether it is so on any rank, or on all.
inline bool on_any_rank(const Comm& comm, bool here) { return max_over_ranks(comm, static_cast<int>(here)) != 0; }
inline bool on_all_ranks(const Comm& comm, bool here) { return min_over_ranks(comm, static_cast<int>(here)) != 0; }

/// Whether any rank's answer is yes; without a question it is no.
inline bool any_rank(const Comm& comm, const std::function<bool()>& question) {
  return question && on_any_rank(comm, question());
}

}  // namespace sprekk::base
