// Sums over all ranks at places that several ranks share by global number.
#pragma once

#include "base/types.hpp"
#include "fields/types.hpp"

#include <array>
#include <unordered_map>
#include <vector>

namespace sprekk::transport {

/// Sums over all ranks at numbered places.
class Places {
 public:
  int add(GlobalIndex id) {
    const auto [found, is_new] = number_.emplace(id, static_cast<int>(ids_.size()));
    if (is_new) ids_.push_back(id);
    return found->second;
  }
  /// Builds the maps after all places have been added. Collective.
  void close(const RCP<const Comm>& comm) {
    const auto unknown = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
    map_ =
        rcp(new const fields::Map(unknown, Teuchos::ArrayView<const GlobalIndex>(ids_.data(), ids_.size()), 0, comm));
    import_ = rcp(new const fields::Import(Tpetra::createOneToOne(map_), map_));
  }
  std::size_t size() const { return ids_.size(); }
  GlobalIndex id(int place) const { return ids_[place]; }

  /// Replaces each value by its sum over all ranks. Collective.
  template <std::size_t m>
  void sum_over_ranks(std::vector<std::array<Real, m>>& values) const {
    fields::MultiVector here(map_, m), unique(import_->getSourceMap(), m);
    const auto copy = [&](const auto& one) {
      const auto view = here.getLocalViewHost(Tpetra::Access::ReadWrite);
      for (std::size_t p = 0; p < values.size(); ++p)
        for (std::size_t k = 0; k < m; ++k) one(values[p][k], view(p, k));
    };
    copy([](Real& value, Real& entry) { entry = value; });
    unique.doExport(here, *import_, Tpetra::ADD);
    here.doImport(unique, *import_, Tpetra::REPLACE);
    copy([](Real& value, Real& entry) { value = entry; });
  }

 private:
  std::unordered_map<GlobalIndex, int> number_;
  std::vector<GlobalIndex> ids_;
  RCP<const fields::Map> map_;
  RCP<const fields::Import> import_;
};

}  // namespace sprekk::transport
