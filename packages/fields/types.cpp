#include "fields/types.hpp"

#include <Teuchos_CommHelpers.hpp>

namespace sprekk::fields {

RCP<const Map> make_map(const std::vector<GlobalIndex>& numbers, const RCP<const Comm>& comm) {
  const auto n = static_cast<GlobalIndex>(numbers.size());
  GlobalIndex end = 0;
  Teuchos::scan(*comm, Teuchos::REDUCE_SUM, 1, &n, &end);
  int here = 1, anywhere = 1;
  for (GlobalIndex i = 0; i < n; ++i)
    if (numbers[i] != end - n + i) here = 0;
  Teuchos::reduceAll(*comm, Teuchos::REDUCE_MIN, 1, &here, &anywhere);
  const auto count_them = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
  if (anywhere == 1) return rcp(new const Map(count_them, numbers.size(), 0, comm));
  return rcp(new const Map(count_them, Teuchos::arrayViewFromVector(numbers), 0, comm));
}

}  // namespace sprekk::fields
