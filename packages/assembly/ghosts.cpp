#include "assembly/ghosts.hpp"

#include "assembly/rows.hpp"
#include "base/over_ranks.hpp"

#include <bit>
#include <cstdint>
#include <set>
#include <utility>

namespace sprekk::assembly {

using fields::BlockVector;

namespace {

/// Returns a checksum below 2^47, so that sums over ranks do not overflow.
long long checksum(const BlockVector& x) {
  std::uint64_t sum = 0;
  for (const auto& block : x) {
    const auto values = block->getLocalViewHost(Tpetra::Access::ReadOnly);
    for (std::size_t i = 0; i < values.extent(0); ++i) {
      sum = (sum ^ std::bit_cast<std::uint64_t>(values(i, 0))) * 0xbf58476d1ce4e5b9ULL;
      sum ^= sum >> 30;
    }
  }
  return static_cast<long long>(sum >> 17);
}

}  // namespace

BlockVector Ghosts::exchange(const BlockVector& x, Which which) {
  const auto scope = structure_.timers->scope("ghost exchange");
  checksums_.push_back(checksum(x));
  auto all = zero();
  for (std::size_t b = 0; b < x.size(); ++b) {
    if (which == Which::all || structure_.exchanged[b]) {
      all[b]->doImport(*x[b], *structure_.layouts[b].import(), Tpetra::REPLACE);
    } else {
      const auto from = const_view_of(*x[b]);
      const auto to = view_of(*all[b]);
      Kokkos::deep_copy(Kokkos::subview(to, Kokkos::make_pair(std::size_t(0), from.extent(0))), from);
    }
  }
  return all;
}

BlockVector Ghosts::zero() const {
  BlockVector zeros;
  for (const auto& layout : structure_.layouts) zeros.push_back(rcp(new fields::Vector(layout.ghosted())));
  return zeros;
}

fields::Exchanges Ghosts::take() {
  const auto all = base::sum_over_ranks(*structure_.mesh->comm, std::exchange(checksums_, {}));
  return {static_cast<long long>(all.size()),
          static_cast<long long>(std::set<long long>(all.begin(), all.end()).size())};
}

}  // namespace sprekk::assembly
