#include "mesh/extreme.hpp"

#include "base/over_ranks.hpp"

namespace sprekk::mesh {

void take_largest(const Comm& comm, std::vector<Extreme>& all) {
  std::vector<Real> value;
  for (const auto& one : all) value.push_back(one.value);
  const auto maximum = base::max_over_ranks(comm, value);
  std::vector<bool> here;
  for (std::size_t k = 0; k < all.size(); ++k) here.push_back(value[k] == maximum[k]);
  for (int i = 0; i < 3; ++i) {
    std::vector<Real> x;
    for (std::size_t k = 0; k < all.size(); ++k) x.push_back(here[k] ? all[k].x[i] : -Extreme::none);
    const auto minimum = base::min_over_ranks(comm, x);
    for (std::size_t k = 0; k < all.size(); ++k) {
      here[k] = here[k] && x[k] == minimum[k];
      all[k].x[i] = minimum[k];
    }
  }
  for (std::size_t k = 0; k < all.size(); ++k) all[k].value = maximum[k];
}

}  // namespace sprekk::mesh
