#include "model/fracture_table.hpp"

#include "model/json_keys.hpp"
#include "base/over_ranks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace sprekk::model {

using assembly::OutputField;
using assembly::Summary;
using nlohmann::json;

namespace {

constexpr Real missing = std::numeric_limits<Real>::quiet_NaN();

/// Groups of faces with sums and maxima over their faces.
class Groups {
 public:
  Groups(const mesh::Mesh& mesh, Grouping grouping)
      : mesh_(mesh),
        grouping_(grouping),
        n_(grouping == Grouping::sets ? mesh.fracture_names.size() : mesh.single_fractures.size()) {}

  std::size_t n() const { return n_; }

  /// Integrals of value(face, component) over the area, [group * n + component].
  template <class Value>
  std::vector<Real> integrals(int n, const Value& value) const {
    std::vector<Real> sums(n_ * n, 0);
    for (LocalIndex f = 0; f < mesh_.n_owned_fracture_faces; ++f)
      for (int c = 0; c < n; ++c) sums[group(f) * n + c] += mesh_.fracture_faces[f].area * value(f, c);
    return base::sum_over_ranks(*mesh_.comm, sums);
  }

  std::vector<Real> maxima(const std::vector<Real>& values) const {
    std::vector<Real> maximum(n_, -std::numeric_limits<Real>::max());
    for (LocalIndex f = 0; f < mesh_.n_owned_fracture_faces; ++f)
      maximum[group(f)] = std::max(maximum[group(f)], values[f]);
    return base::max_over_ranks(*mesh_.comm, maximum);
  }

 private:
  int group(LocalIndex f) const {
    const auto& face = mesh_.fracture_faces[f];
    return grouping_ == Grouping::sets ? face.fracture : face.single;
  }

  const mesh::Mesh& mesh_;
  Grouping grouping_;
  std::size_t n_;
};

/// Adds the columns of one output.
class Adder {
 public:
  Adder(const Groups& groups, const std::vector<Real>& area, std::vector<FractureColumn>& columns)
      : groups_(groups), area_(area), columns_(columns) {}

  void add(const OutputField& output) {
    const auto& reported = output.summary;
    for (std::size_t c = 0; c < reported.classes.size(); ++c)
      if (!reported.classes[c].empty()) add_class(output, static_cast<Real>(c), with_underscores(reported.classes[c]));
    if (reported.kind == Summary::none || reported.kind == Summary::fractions) return;
    const auto name = with_underscores(reported.name);
    if (reported.kind == Summary::error_bound) return add_maxima(output, "error_of_" + name);
    const int n = output.n_components;
    const bool is_mean = reported.kind != Summary::integral;
    auto values = groups_.integrals(n, [&](LocalIndex f, int c) { return output.values[f * n + c]; });
    for (std::size_t i = 0; i < values.size() && is_mean; ++i) values[i] /= area_[i / n];
    for (const auto& derived : reported.derived) add_derived(derived, n, values);
    columns_.push_back({is_mean ? "mean_" + name : name, reported.frame, is_mean ? output.unit : reported.unit, n,
                        values, reported.events});
    if (reported.kind == Summary::mean_and_max) add_maxima(output, "max_" + name);
  }

 private:
  void add_maxima(const OutputField& output, const std::string& name) {
    auto maxima = groups_.maxima(output.values);
    for (std::size_t k = 0; k < maxima.size(); ++k)
      if (area_[k] == 0) maxima[k] = missing;  // group without faces, all merged with others
    columns_.push_back({name, "", output.unit, 1, maxima});
  }

  void add_class(const OutputField& output, Real number, const std::string& name) {
    auto areas = groups_.integrals(1, [&](LocalIndex f, int) { return Real(output.values[f] == number); });
    columns_.push_back({"area_" + name, "", columns_.front().unit, 1, areas});
    for (std::size_t k = 0; k < areas.size(); ++k) areas[k] /= area_[k];
    columns_.push_back({"fraction_" + name, "", "-", 1, areas});
  }

  void add_derived(const assembly::Derived& derived, int n, const std::vector<Real>& from) {
    FractureColumn column{derived.name, "", derived.unit};
    for (std::size_t k = 0; k < groups_.n(); ++k)
      column.values.push_back(derived.of({&from[k * n], &from[k * n] + n}).value_or(missing));
    columns_.push_back(column);
  }

  const Groups& groups_;
  const std::vector<Real>& area_;
  std::vector<FractureColumn>& columns_;
};

/// Returns true for columns of single fractures. Vectors in the global frame are omitted because their sign depends on
/// the arbitrary normal.
bool is_of_singles(const FractureColumn& column) { return column.frame != "global"; }

}  // namespace

json FractureColumn::of(std::size_t group) const {
  if (frame.empty()) return values[group];
  return std::vector<Real>(&values[group * n_components], &values[group * n_components] + n_components);
}

std::vector<FractureColumn> fracture_table(const mesh::Mesh& mesh, const std::vector<OutputField>& outputs,
                                           Grouping grouping) {
  const Groups groups(mesh, grouping);
  const auto area = groups.integrals(1, [](LocalIndex, int) { return Real(1); });
  std::vector<FractureColumn> columns = {{"area", "", mesh.dim() == 2 ? "m" : "m^2", 1, area}};
  Adder adder(groups, area, columns);
  for (const auto& output : outputs)
    if (output.entity == fields::Entity::fracture_face) adder.add(output);
  return columns;
}

json by_sets(const mesh::Mesh& mesh, const std::vector<FractureColumn>& columns) {
  json sets = json::object();
  for (std::size_t k = 0; k < mesh.fracture_names.size(); ++k)
    for (const auto& column : columns) {
      auto& set = sets[mesh.fracture_names[k]];
      (column.frame.empty() ? set[column.name] : set[column.name][column.frame]) = column.of(k);
    }
  return sets;
}

json by_singles(const std::vector<FractureColumn>& columns) {
  json lists = json::object();
  for (const auto& column : columns) {
    if (!is_of_singles(column)) continue;
    auto& list = lists[column.full_name()] = json::array();
    for (std::size_t k = 0; k < column.values.size() / column.n_components; ++k) list.push_back(column.of(k));
  }
  return lists;
}

json units(const std::vector<FractureColumn>& columns) {
  json all = json::object();
  for (const auto& column : columns)
    if (is_of_singles(column)) all[column.full_name()] = column.unit;
  return all;
}

json described_singles(const mesh::Mesh& mesh) {
  const Groups groups(mesh, Grouping::singles);
  const auto& faces = mesh.fracture_faces;
  const auto area = groups.integrals(1, [](LocalIndex, int) { return Real(1); });
  const auto centre = groups.integrals(3, [&](LocalIndex f, int c) { return faces[f].centre[c]; });
  const auto normal = groups.integrals(3, [&](LocalIndex f, int c) { return faces[f].frame[0][c]; });
  const auto degrees = [](Real y, Real x, Real period) {
    const Real angle = std::fmod(std::atan2(y, x) * 180 / M_PI + 360, period);
    return period - angle < 1e-9 ? 0 : angle;  // rounding error below 0
  };
  json all = json::array();
  for (std::size_t k = 0; k < groups.n(); ++k) {
    const auto& [name, set, properties] = mesh.single_fractures[k];
    json one = {{"name", name}, {"set", mesh.fracture_names[set]}, {"area", area[k]}};
    const Real size = std::hypot(normal[3 * k], normal[3 * k + 1], normal[3 * k + 2]);
    Real n[3];
    for (int c = 0; c < 3; ++c) {
      one["centre"].push_back(centre[3 * k + c] / area[k]);
      n[c] = normal[3 * k + c] / size;
      one["normal"].push_back(n[c]);
    }
    const Real up = n[2] < 0 ? -1 : 1;  // the plane dips along its upward normal, right of the strike
    if (mesh.dim() == 2)
      one["strike"] = degrees(n[1], -n[0], 180);
    else
      one.update({{"strike", degrees(-up * n[1], up * n[0], 360)}, {"dip", std::acos(std::abs(n[2])) * 180 / M_PI}});
    all.push_back(one);
  }
  return all;
}

std::array<long long, 3> counts_of_classes(const Comm& comm, const std::vector<OutputField>& outputs) {
  std::array<long long, 3> counts{};
  for (const auto& output : outputs)
    if (output.summary.classes.size() == counts.size())
      for (Real value : output.values) ++counts[static_cast<int>(value)];
  return base::sum_over_ranks(comm, counts);
}

std::vector<Real> values_of(const json& list) {
  std::vector<Real> values;
  for (const auto& value : list) values.push_back(value.is_null() ? missing : value.get<Real>());
  return values;
}

std::string csv_cell(std::string text) {
  for (auto at = text.find('"'); at != text.npos; at = text.find('"', at + 2)) text.insert(at, 1, '"');
  return text.find_first_of(",\"\n") == text.npos ? text : '"' + text + '"';
}

std::string to_csv(const json& described, const std::vector<FractureColumn>& columns) {
  const std::vector<std::pair<const char*, const char*>> known = {{"strike", "degree"}, {"dip", "degree"}};
  const auto is_described = [&](const char* entry) { return !described.empty() && described[0].contains(entry); };
  /// Areas in 2D are lengths.
  const auto title = [](const FractureColumn& column) {
    const auto name = column.full_name();
    return column.unit == "m" && name.rfind("area", 0) == 0 ? "length" + name.substr(4) : name;
  };
  std::vector<Real> rounding;  // [column] of the largest value
  for (const auto& column : columns) {
    rounding.push_back(0);
    for (const Real value : column.values) rounding.back() = std::max(rounding.back(), 1e-14 * std::abs(value));
  }
  std::string text = "name,set";
  for (const auto& [entry, unit] : known)
    if (is_described(entry)) text += fmt::format(",{} [{}]", entry, unit);
  for (const auto& column : columns)
    for (int c = 0; c < column.n_components && column.frame != "global"; ++c)
      text += fmt::format(",{}{} [{}]", title(column),
                          column.n_components == 1 ? ""
                          : c == 0                 ? " n"
                                   : fmt::format(" t{}", column.n_components == 2 ? "" : std::to_string(c)),
                          column.unit);
  text += '\n';
  for (std::size_t k = 0; k < described.size(); ++k) {
    text += csv_cell(described[k]["name"]) + ',' + csv_cell(described[k]["set"]);
    for (const auto& [entry, unit] : known)
      if (is_described(entry)) fmt::format_to(std::back_inserter(text), ",{}", described[k][entry].get<Real>());
    for (std::size_t i = 0; i < columns.size(); ++i)
      for (int c = 0; c < columns[i].n_components && columns[i].frame != "global"; ++c) {
        const Real value = columns[i].values[k * columns[i].n_components + c];
        fmt::format_to(std::back_inserter(text), ",{}", std::abs(value) < rounding[i] ? 0 : value);
      }
    text += '\n';
  }
  return text;
}

std::vector<std::string> digest(const json& described, const std::vector<FractureColumn>& columns) {
  const std::string prefix = "fraction_";
  std::vector<std::string> lines;
  for (const auto& column : columns) {
    if (column.name.compare(0, prefix.size(), prefix) != 0) continue;
    std::vector<std::pair<Real, std::size_t>> found;
    for (std::size_t k = 0; k < column.values.size(); ++k)
      if (column.values[k] > 0) found.emplace_back(-column.values[k], k);
    std::sort(found.begin(), found.end());
    constexpr std::size_t reported = 12;
    auto state = column.name.substr(prefix.size());
    std::replace(state.begin(), state.end(), '_', ' ');
    auto line = fmt::format("{} on {} of {} fractures", state, found.size(), described.size());
    for (std::size_t i = 0; i < std::min(reported, found.size()); ++i)
      line += fmt::format("{} \"{}\" ({:.3g} %{})", i == 0 ? ":" : ",",
                          described[found[i].second]["name"].get<std::string>(), -100 * found[i].first,
                          i == 0 ? " of its area" : "");
    lines.push_back(line + (found.size() > reported ? ", ..." : ""));
  }
  return lines;
}

}  // namespace sprekk::model
