// Exchange of nodal values between neighbouring ranks.
#pragma once

#include <vector>

#include "fields/types.hpp"

namespace sprekk::fields {

/// Nodes with values on this rank: owned nodes, then ghosts, in the order of a map. The values of a node are adjacent.
/// All members are collective unless they return stored data.
class Halo {
 public:
  /// Creates the exchange. `all` must begin with the nodes of `owned` in their order; otherwise throws an Error.
  Halo(RCP<const Map> owned, RCP<const Map> all);

  LocalIndex n_owned() const { return static_cast<LocalIndex>(base::n_local_elements(*owned_)); }
  LocalIndex n_all() const { return static_cast<LocalIndex>(base::n_local_elements(*all_)); }
  const RCP<const Map>& owned() const { return owned_; }
  const RCP<const Map>& all() const { return all_; }
  std::vector<LocalIndex> sent_nodes() const;  ///< owned nodes that are ghosts of other ranks; may repeat

  /// Number of messages received by this rank in an exchange. Stored data.
  std::size_t n_messages() const;

  /// Copies the `width` values of each ghost, x(width * node) ..., from its owner.
  template <class T>
  void exchange(const View<T*>& x, int width) const;

  /// Copies rows of different lengths. The values of a node are width * start(node) up to width * start(node + 1). A
  /// ghost must have the length of its owner's row.
  template <class T>
  void exchange_rows(const View<std::size_t*>& start, const View<T*>& x, int width) const;

 private:
  RCP<const Map> owned_, all_;
  RCP<const Import> import_;  // null: no ghosts on any rank
  mutable View<Real*> sent_, received_;
};

}  // namespace sprekk::fields
