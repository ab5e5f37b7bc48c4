// Unknowns at which a problem is evaluated.
#pragma once

#include "fields/types.hpp"

#include <memory>
#include <utility>

namespace sprekk::fields {

/// Unknowns x with their ghosts. Residual, Jacobian, measures and states at x read from one object, so that ghosts are
/// exchanged once. Copies of this object share the values.
class Evaluation {
 public:
  Evaluation() = default;  ///< without x
  /// Shares the vectors of x, which must not change while this object is in use. A function of an evaluation that is
  /// called with x makes one of its own. Local.
  Evaluation(BlockVector x) : data_(std::make_shared<Data>(Data{std::move(x), {}})) {}

  bool empty() const { return !data_; }
  const BlockVector& x() const { return data_->x; }  ///< [block](owned unknown)
  /// Returns the unknowns with ghosts, [block](unknown). The first call computes them by exchange(x). Collective.
  template <class Exchange>
  const BlockVector& with_ghosts(const Exchange& exchange) const {
    if (data_->with_ghosts.empty()) data_->with_ghosts = exchange(data_->x);
    return data_->with_ghosts;
  }

 private:
  struct Data {
    BlockVector x, with_ghosts;
  };
  std::shared_ptr<Data> data_;
};

/// Numbers of exchanges of ghosts and of distinct x among them. They are equal if each x has one evaluation.
struct Exchanges {
  long long ghosts = 0, iterates = 0;
};

}  // namespace sprekk::fields
