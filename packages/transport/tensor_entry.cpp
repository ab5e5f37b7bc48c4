#include "transport/tensor_entry.hpp"

#include "base/check.hpp"
#include "base/text.hpp"

#include <fmt/ranges.h>

#include <algorithm>

namespace sprekk::transport {

bool is_uniform_tensor(const std::vector<base::Expression>& components) {
  return std::all_of(components.begin(), components.end(), [](const auto& value) { return value.is_constant(); });
}

laws::Mobility tensor_at(const std::string& name, const std::vector<base::Expression>& components, int dim,
                         const std::array<Real, 3>& x) {
  std::vector<Real> k;
  std::vector<std::string> texts;
  for (const auto& value : components) {
    k.push_back(value(x, 0));
    texts.push_back(value.text());
  }
  const auto n = static_cast<int>(k.size()), n_all = dim * (dim + 1) / 2;
  SPREKK_CHECK(n == 1 || n == dim || n == n_all, "\"{}\" has {}, must have 1, {} or {} in {}D", name,
               base::counted(k.size(), "value"), dim, n_all, dim);
  laws::Mobility m;
  for (int i = 0; i < dim; ++i) m.value[i][i] = k[n == 1 ? 0 : i];
  for (int i = dim; i < n; ++i) {
    const int row = i == 4 ? 1 : 0, column = i == 3 || dim == 2 ? 1 : 2;
    m.value[row][column] = m.value[column][row] = k[i];
  }
  SPREKK_CHECK(m.is_positive(dim), "\"{}\" = {{{}}} is not positive definite{}", name, fmt::join(texts, ", "),
               is_uniform_tensor(components) ? "" : fmt::format(" at x = ({}, {}, {})", x[0], x[1], x[2]));
  return m;
}

}  // namespace sprekk::transport
