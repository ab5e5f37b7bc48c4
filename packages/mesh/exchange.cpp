#include "mesh/exchange.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Export.hpp>
#include <algorithm>
#include <utility>

namespace sprekk::mesh {
namespace {

using IndexMap = Tpetra::Map<LocalIndex, GlobalIndex>;
using IndexVector = Tpetra::Vector<GlobalIndex, LocalIndex, GlobalIndex>;

RCP<const IndexMap> map_of(const GlobalIndex* ids, LocalIndex n, const RCP<const Comm>& comm) {
  return rcp(new IndexMap(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                          Teuchos::ArrayView<const GlobalIndex>(ids, n), 0, comm));
}

}  // namespace

GhostExchange::GhostExchange(const std::vector<GlobalIndex>& ids, LocalIndex n_owned, const RCP<const Comm>& comm)
    : import_(map_of(ids.data(), n_owned, comm), map_of(ids.data(), static_cast<LocalIndex>(ids.size()), comm)),
      owned_(import_.getSourceMap()),
      all_(import_.getTargetMap()) {}

void GhostExchange::to_largest(std::vector<GlobalIndex>& values) const {
  {
    const auto to = all_.getDataNonConst();
    std::copy(values.begin(), values.end(), to.begin());
    const auto owned = owned_.getDataNonConst();
    std::copy_n(values.begin(), owned.size(), owned.begin());
  }
  owned_.doExport(all_, import_, Tpetra::ABSMAX);
  {
    const auto owned = owned_.getData();
    std::copy(owned.begin(), owned.end(), values.begin());
  }
  (*this)(values);
}

std::vector<GlobalIndex> sums_before(const std::vector<GlobalIndex>& ids, const std::vector<GlobalIndex>& counts,
                                     const RCP<const Comm>& comm) {
  const auto here = map_of(ids.data(), static_cast<LocalIndex>(ids.size()), comm);
  const auto n = static_cast<Tpetra::global_size_t>(here->getMaxAllGlobalIndex() + 1);  // 0 without indices
  const auto in_order = rcp(new IndexMap(here->getGlobalNumElements() == 0 ? 0 : n, 0, comm));
  const Tpetra::Export<LocalIndex, GlobalIndex> there(here, in_order);
  IndexVector mine(here), sorted(in_order);
  std::copy(counts.begin(), counts.end(), mine.getDataNonConst().begin());
  sorted.doExport(mine, there, Tpetra::INSERT);
  {
    const auto values = sorted.getDataNonConst();
    GlobalIndex sum = 0, up_to_here = 0;
    for (const GlobalIndex value : values) sum += value;
    Teuchos::scan(*comm, Teuchos::REDUCE_SUM, sum, Teuchos::outArg(up_to_here));
    GlobalIndex before = up_to_here - sum;
    for (GlobalIndex& value : values) before += std::exchange(value, before);
  }
  mine.doImport(sorted, there, Tpetra::INSERT);
  const auto values = mine.getData();
  return {values.begin(), values.end()};
}

}  // namespace sprekk::mesh
