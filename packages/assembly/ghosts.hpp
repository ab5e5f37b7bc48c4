// Exchange of ghosts between ranks.
#pragma once

#include "assembly/structure.hpp"
#include "fields/evaluation.hpp"

#include <vector>

namespace sprekk::assembly {

/// Creates unknowns with the ghosts that modules read, [block], and counts the exchanges. Refers to the structure.
class Ghosts {
 public:
  explicit Ghosts(const Structure& structure) : structure_(structure) {}

  enum class Which { read, all };  ///< read: ghosts of blocks in Structure::exchanged
  /// Returns a copy of x with its ghosts. Collective.
  fields::BlockVector exchange(const fields::BlockVector& x, Which which);
  /// Returns zeros. Local.
  fields::BlockVector zero() const;
  /// Returns the numbers since the last call. Values of x are compared by checksums. Collective.
  fields::Exchanges take();

 private:
  const Structure& structure_;
  std::vector<long long> checksums_;  // [exchange] of x on this rank
};

}  // namespace sprekk::assembly
