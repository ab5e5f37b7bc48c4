#include "estimate/mesh_error.hpp"

#include "assembly/system.hpp"
#include "base/host_table.hpp"

namespace sprekk::estimate {

void zero_constrained_rows(const assembly::System& system, fields::BlockVector& right_side) {
  for (std::size_t b = 0; b < right_side.size(); ++b) {
    const auto constrained = base::to_host(system.constrained(static_cast<int>(b)));
    const auto view = right_side[b]->getLocalViewHost(Tpetra::Access::ReadWrite);
    for (std::size_t i = 0; i < constrained.extent(0); ++i)
      if (constrained(i)) view(i, 0) = 0;
  }
}

}  // namespace sprekk::estimate
