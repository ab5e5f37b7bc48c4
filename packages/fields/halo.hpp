// What neighbouring ranks know of each other's nodes.
#pragma once

#include <vector>

#include "fields/types.hpp"

namespace sprekk::fields {

/// Nodes that a rank has values of: those it owns, then ghosts, in the order of a map. Values of a node lie together.
/// All members are collective unless they return stored data.
class Halo {
 public:
  /// `all` begins with the nodes of `owned`, in their order.
  Halo(RCP<const Map> owned, RCP<const Map> all);

  LocalIndex n_owned() const { return static_cast<LocalIndex>(base::n_local_elements(*owned_)); }
  LocalIndex n_all() const { return static_cast<LocalIndex>(base::n_local_elements(*all_)); }
  const RCP<const Map>& owned() const { return owned_; }
  const RCP<const Map>& all() const { return all_; }
  std::vector<LocalIndex> sent_nodes() const;  ///< owned ones that are ghosts of other ranks, perhaps several times

  /// Of an exchange, that this rank receives. Stored data.
  std::size_t n_messages() const;

  /// Takes the `width` values of each ghost, x(width * node) ..., from its owner.
  template <class T>
  void exchange(const View<T*>& x, int width) const;

  /// The same for rows of different lengths: that of a node has the values width * start(node) up to
  /// width * start(node + 1), and is as long as its owner's.
  template <class T>
  void exchange_rows(const View<std::size_t*>& start, const View<T*>& x, int width) const;

 private:
  RCP<const Map> owned_, all_;
  RCP<const Import> import_;  // null: no ghosts on any rank
  mutable View<Real*> sent_, received_;
};

}  // namespace sprekk::fields
