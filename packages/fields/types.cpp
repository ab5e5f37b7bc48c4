#include "fields/types.hpp"

#include "base/over_ranks.hpp"

#include <Teuchos_CommHelpers.hpp>

namespace sprekk::fields {

RCP<const Map> make_map(const std::vector<GlobalIndex>& numbers, const RCP<const Comm>& comm) {
  const auto n = static_cast<GlobalIndex>(numbers.size());
  GlobalIndex end = 0;
  Teuchos::scan(*comm, Teuchos::REDUCE_SUM, 1, &n, &end);
  bool in_order = true;
  for (GlobalIndex i = 0; i < n; ++i) in_order = in_order && numbers[i] == end - n + i;
  const auto count_them = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
  if (base::on_all_ranks(*comm, in_order)) return rcp(new const Map(count_them, numbers.size(), 0, comm));
  return rcp(new const Map(count_them, Teuchos::arrayViewFromVector(numbers), 0, comm));
}

}  // namespace sprekk::fields
