// What ranks tell each other about entities that they share.
#pragma once

#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <vector>

#include "base/trilinos_compat.hpp"
#include "base/types.hpp"

namespace sprekk::mesh {

/// Between the owners of entities and the ranks that have them as ghosts.
class GhostExchange {
 public:
  /// `ids` are the global numbers of this rank's entities, the first n_owned of them owned. Collective.
  GhostExchange(const std::vector<GlobalIndex>& ids, LocalIndex n_owned, const RCP<const Comm>& comm);

  /// Sets the values of ghosts, [entity * width + k], to those of their owners. T is an integer type. Collective.
  template <class T>
  void operator()(std::vector<T>& values, int width = 1) const {
    const auto n = base::n_local_elements(*import_.getTargetMap());
    for (int k = 0; k < width; ++k) {
      {
        const auto from = owned_.getDataNonConst();
        for (std::size_t i = 0; i < static_cast<std::size_t>(from.size()); ++i) from[i] = values[i * width + k];
      }
      all_.doImport(owned_, import_, Tpetra::INSERT);
      const auto to = all_.getData();
      for (std::size_t i = owned_.getLocalLength(); i < n; ++i) values[i * width + k] = static_cast<T>(to[i]);
    }
  }

  /// Sets the values of entities, none of them negative, to the largest that any rank has. Collective.
  void to_largest(std::vector<GlobalIndex>& values) const;

 private:
  using Vector = Tpetra::Vector<GlobalIndex, LocalIndex, GlobalIndex>;

  Tpetra::Import<LocalIndex, GlobalIndex> import_;
  mutable Vector owned_, all_;  // one component
};

/// For each of this rank's entities the sum of the counts of all entities, on any rank, with lower numbers. No number
/// is in `ids` of two ranks, which are ascending. Independent of who has which. Collective.
std::vector<GlobalIndex> sums_before(const std::vector<GlobalIndex>& ids, const std::vector<GlobalIndex>& counts,
                                     const RCP<const Comm>& comm);

}  // namespace sprekk::mesh
