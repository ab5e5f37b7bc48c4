// Exchange of values of shared entities between ranks.
#pragma once

#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <vector>

#include "base/trilinos_compat.hpp"
#include "base/types.hpp"

namespace sprekk::mesh {

/// Exchange of values between the owners of entities and the ranks with ghost copies.
class GhostExchange {
 public:
  /// Builds the exchange. `ids` are the global numbers of the entities on this rank; the first n_owned are owned.
  /// Collective.
  GhostExchange(const std::vector<GlobalIndex>& ids, LocalIndex n_owned, const RCP<const Comm>& comm);

  /// Sets the values of ghosts [entity * width + k] to those of their owners. T is an integer type. Collective.
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

  /// Sets each value to its maximum over all ranks. Values must not be negative. Collective.
  void to_largest(std::vector<GlobalIndex>& values) const;

 private:
  using Vector = Tpetra::Vector<GlobalIndex, LocalIndex, GlobalIndex>;

  Tpetra::Import<LocalIndex, GlobalIndex> import_;
  mutable Vector owned_, all_;  // one component
};

/// Returns for each entity of this rank the sum of the counts of all entities with lower numbers on all ranks. The
/// numbers in `ids` are ascending, and no number occurs on two ranks. The result is independent of the distribution.
/// Collective.
std::vector<GlobalIndex> sums_before(const std::vector<GlobalIndex>& ids, const std::vector<GlobalIndex>& counts,
                                     const RCP<const Comm>& comm);

}  // namespace sprekk::mesh
