// A question that all ranks answer together.
#pragma once

#include "base/types.hpp"

#include <Teuchos_CommHelpers.hpp>

#include <functional>

namespace sprekk::base {

/// Whether any rank's answer is yes; without a question it is no. Collective.
inline bool any_rank(const Comm& comm, const std::function<bool()>& question) {
  if (!question) return false;
  const int here = question();
  int any = 0;
  Teuchos::reduceAll(comm, Teuchos::REDUCE_MAX, 1, &here, &any);
  return any != 0;
}

}  // namespace sprekk::base
