#include "assembly/reactions.hpp"

#include "base/over_ranks.hpp"

#include <algorithm>

namespace sprekk::assembly {

std::vector<Reaction> sum_prescribed(const Structure& structure, const fields::BlockVector& r) {
  std::vector<Reaction> result;
  for (int b = 0; b < structure.n_blocks(); ++b) {
    const auto& unknown = structure.unknowns[b];
    if (!unknown.enriches.empty()) continue;  // the enriched field has the whole force: its functions sum to 1
    const auto view = r[b]->getLocalViewHost(Tpetra::Access::ReadOnly);
    const int n_components = structure.blocks[b].n_components,
              width = n_components + 3;  // force, then moment
    const auto& conditions = structure.constraints[b].conditions();
    std::vector<Real> here(conditions.size() * width, 0);
    for (const auto& entry : structure.constraints[b].entries()) {
      Real* sums = &here[entry.condition * width];
      const int i = entry.component, j = (i + 1) % 3, k = (i + 2) % 3;
      const Real force = view(entry.unknown, 0);
      sums[i] += force;
      sums[n_components + j] += entry.x[k] * force;
      sums[n_components + k] -= entry.x[j] * force;
    }
    const auto all = base::sum_over_ranks(structure.comm(), here);
    for (std::size_t c = 0; c < conditions.size(); ++c) {
      const auto sums = all.begin() + static_cast<std::ptrdiff_t>(c) * width;
      result.push_back({conditions[c].name, conditions[c].field, {sums, sums + n_components}});
      result.back().called = unknown.reactions;
      if (conditions[c].boundary < 0) {
        result.back().region = conditions[c].region;
        result.back().fracture = conditions[c].fracture;
      }
      std::copy_n(sums + n_components, 3, result.back().moment.begin());
    }
  }
  return result;
}

}  // namespace sprekk::assembly
