#include "model/knots.hpp"

#include "base/check.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <memory>
#include <optional>

namespace sprekk::model {

namespace {

/// Calls visit(text) for all texts in a list and its sublists.
template <class Visit>
void for_each_text(const Teuchos::ParameterList& list, const Visit& visit) {
  for (const auto& named_entry : list) {
    const Teuchos::ParameterEntry& entry = named_entry.second;
    if (entry.isList())
      for_each_text(list.sublist(named_entry.first), visit);
    else if (entry.isType<std::string>())
      visit(Teuchos::getValue<std::string>(entry));
    else if (entry.isType<Teuchos::Array<std::string>>())
      for (const auto& text : Teuchos::getValue<Teuchos::Array<std::string>>(entry)) visit(text);
  }
}

/// Returns the text in the parentheses of each call of a function.
std::vector<std::string> arguments(const std::string& text, const std::string& function) {
  std::vector<std::string> all;
  for (auto at = text.find(function + '('); at != text.npos; at = text.find(function + '(', at + 1)) {
    if (at > 0 && (std::isalnum(static_cast<unsigned char>(text[at - 1])) || text[at - 1] == '_')) continue;
    const auto begin = at + function.size() + 1;
    int depth = 1;
    auto end = begin;
    while (end < text.size() && depth > 0) {
      depth += text[end] == '(' ? 1 : text[end] == ')' ? -1 : 0;
      ++end;
    }
    if (depth == 0) all.push_back(text.substr(begin, end - begin - 1));
  }
  return all;
}

/// Returns a and b for a text that equals a + b t with nonzero b, for times of the order of `size`; otherwise nothing.
std::optional<std::array<Real, 2>> linear_in_time(const std::string& text, const Scene& scene, Real size) {
  try {
    base::Expression f(text);
    f.compile(std::make_shared<base::Tables>(scene.tables), scene.expressions);
    const Real a = f({}, 0), b = (f({}, size) - a) / size;
    for (const Real t : {0.37 * size, 0.71 * size, size})
      if (const Real value = f({1.3 * size, 0.7 * size, 2.1 * size}, t);
          std::abs(value - a - b * t) > 1e-12 * (std::abs(a) + std::abs(b * size)))
        return {};
    return b != 0 ? std::make_optional(std::array<Real, 2>{a, b}) : std::nullopt;
  } catch (const Error&) {  // undefined at a tested time
    return {};
  }
}

}  // namespace

std::vector<TableOfTime> tables_of_time(const Scene& scene) {
  std::vector<TableOfTime> all;
  if (scene.tables.empty()) return all;
  Scene copy = scene;
  const auto list = base::effective(copy, "Sprekk");
  const Real end = scene.time.times().back();
  for (const auto& [name, table] : scene.tables)
    for_each_text(list, [&, &name = name, &table = table](const std::string& text) {
      for (const auto& argument : arguments(text, name)) {
        const auto linear = linear_in_time(argument, scene, end - scene.time.start);
        const auto same = [&](const TableOfTime& other) {
          return linear && other.name == name && other.shift == (*linear)[0] && other.factor == (*linear)[1];
        };
        if (linear && std::none_of(all.begin(), all.end(), same))
          all.push_back({name, &table, (*linear)[0], (*linear)[1]});
      }
    });
  return all;
}

std::vector<Real> knots(const Scene& scene, Real end) {
  std::vector<Real> all;
  for (const auto& of : tables_of_time(scene))
    for (const Real argument : of.table->arguments)
      if (const Real t = (argument - of.shift) / of.factor; t > scene.time.start && t < end) all.push_back(t);
  std::sort(all.begin(), all.end());
  const auto close = [&](Real a, Real b) { return b - a <= 1e-12 * (end - scene.time.start); };
  all.erase(std::unique(all.begin(), all.end(), close), all.end());
  return all;
}

}  // namespace sprekk::model
