#include "model/probes.hpp"

#include "base/over_ranks.hpp"
#include "base/text.hpp"
#include "base/xml.hpp"
#include "model/growth_energies.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

namespace sprekk::model {

using assembly::OutputField;
using fields::Entity;
using mesh::norm;
using mesh::Vector;
using mesh::operator-;
using nlohmann::json;
using physics::Probe;

namespace {

constexpr Real missing_value = std::numeric_limits<Real>::quiet_NaN();

/// Suffixes of component names; empty for a single component.
std::vector<std::string> component_names(int n, bool is_local) {
  if (n == 1) return {""};
  if (n == 6) return {" XX", " YY", " ZZ", " XY", " YZ", " XZ"};
  if (is_local) return n == 2 ? std::vector<std::string>{" n", " t"} : std::vector<std::string>{" n", " t1", " t2"};
  std::vector<std::string> names = {" x", " y", " z"};
  names.resize(n);
  return names;
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Points of a probe: its place, or equally spaced points on its line.
std::vector<Vector> points_of(const Probe& probe, int dim) {
  std::vector<Vector> points(probe.line.empty() ? 1 : probe.points, Vector{});
  for (std::size_t k = 0; k < points.size(); ++k)
    for (int i = 0; i < dim; ++i) {
      const Real s = probe.line.empty() ? 0 : static_cast<Real>(k) / static_cast<Real>(points.size() - 1);
      points[k][i] = probe.line.empty() ? probe.point[i] : (1 - s) * probe.line[i] + s * probe.line[dim + i];
    }
  return points;
}

/// Adds the columns of the place: distance from the first point and coordinates.
void report_places(io::SeriesTable& table, const std::vector<Vector>& points, int dim) {
  table.place_columns = {{"distance", "m"}};
  for (int i = 0; i < dim; ++i) table.place_columns.push_back({std::string(1, "xyz"[i]), "m"});
  for (const auto& x : points) {
    table.places.push_back(norm(x - points[0]));
    table.places.insert(table.places.end(), x.begin(), x.begin() + dim);
  }
}

/// Returns the value at a path of names, or nullptr.
const json* find(const json& sums, const std::vector<std::string>& names) {
  const json* at = &sums;
  for (const auto& name : names) {
    if (!at->is_object() || !at->contains(name)) return nullptr;
    at = &at->at(name);
  }
  return at;
}

const char* measure(Entity entity, int dim) {
  if (entity == Entity::fracture_face) return dim == 2 ? "m" : "m^2";
  return dim == 2 ? "m^2" : "m^3";
}

}  // namespace

/// Available values before the first step.
struct Probes::Known {
  std::vector<OutputField> outputs;     ///< with zero values
  std::vector<FractureColumn> numbers;  ///< values of fractures
  struct Sum {
    int n_components;
    std::string unit;
  };
  std::map<std::string, Sum> on_boundaries, in_regions;

  explicit Known(const Model& model) {
    const auto& mesh = model.mesh();
    for (const auto& module : model.system().modules()) {
      const auto declared = module->declare(mesh);
      for (const auto& output : declared.outputs) outputs.push_back(output.field);
      for (const auto& unknown : declared.unknowns) {
        const auto& [name, moments, regions, unit, fractures] = unknown.reactions;
        const int n = unknown.field.n_components;
        on_boundaries.insert({{name, {n, unit}}, {moments, {mesh.dim() == 2 ? 1 : 3, unit + "*m"}}});
        in_regions.insert({regions, {n, unit}});
      }
    }
    on_boundaries.erase("");
    in_regions.erase("");
    for (auto& output : outputs)
      if (output.entity == Entity::fracture_face)
        output.values.assign(std::size_t(mesh.n_owned_fracture_faces) * output.n_components, 0);
    if (!mesh.fracture_names.empty()) numbers = fracture_table(mesh, outputs, Grouping::sets);
    if (model.scene().growth) GrowthEnergies(mesh, {}).append(mesh, Grouping::sets, numbers);
  }

  template <class List>
  auto named(const List& list, const std::string& name) const {
    return std::find_if(list.begin(), list.end(), [&](const auto& one) { return one.name == name; });
  }
};

Probes::Probes(const Model& model) : model_(model), probes_(model.scene().probes) {
  if (probes_.empty()) return;
  const Known known(model);
  std::vector<std::string> errors;
  for (const auto& [name, probe] : probes_) try {
      add(name, probe, known);
    } catch (const Error& error) {  // the same on all ranks
      errors.push_back(fmt::format("{}: Sprekk > Probes > {}: {}", model.scene().origin, name, error.what()));
    }
  base::throw_errors(errors);
}

void Probes::update_places() {
  if (empty()) return;
  auto tables = std::exchange(tables_, {});
  looks_.clear();
  const Known known(model_);
  for (const auto& table : tables) add(table.name, probes_.at(table.name), known);
  tables_ = std::move(tables);
}

void Probes::add(const std::string& name, const Probe& probe, const Known& known) {
  const auto& mesh = model_.mesh();
  tables_.push_back({name});
  looks_.emplace_back();
  if (const auto totals = probe.totals(); !totals.empty()) return add_totals(totals);
  if (!probe.line.empty()) report_places(tables_.back(), points_of(probe, mesh.dim()), mesh.dim());
  const auto index = [](const auto& all, const std::string& one, const auto& name_of) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& other) { return name_of(other) == one; });
    return found == all.end() ? -1 : static_cast<int>(found - all.begin());
  };
  int fracture = -1;
  bool is_set = true;
  if (probe.fracture) {
    fracture = index(mesh.fracture_names, *probe.fracture, [](const auto& one) { return one; });
    is_set = fracture >= 0;
    if (!is_set) fracture = index(mesh.single_fractures, *probe.fracture, [](const auto& one) { return one.name; });
    if (fracture < 0) {
      auto known = mesh.fracture_names;
      for (const auto& one : mesh.single_fractures) known.push_back(one.name);
      throw Error(fmt::format("\"fracture\": is \"{}\", must be one of {}, or one of their fractures{}",
                              *probe.fracture, base::quoted_list(mesh.fracture_names),
                              base::did_you_mean(*probe.fracture, known)));
    }
  }
  for (auto wanted = probe.outputs.begin(); wanted != probe.outputs.end(); ++wanted)
    SPREKK_CHECK(std::find(probe.outputs.begin(), wanted, *wanted) == wanted, "\"outputs\": \"{}\" is there twice",
                 *wanted);
  for (const auto& wanted : probe.outputs) {
    if (const auto output = known.named(known.outputs, wanted); output != known.outputs.end()) {
      add_output(probe, *output);
      continue;
    }
    const auto& sums = probe.region ? known.in_regions : known.on_boundaries;
    const auto number = std::find_if(known.numbers.begin(), known.numbers.end(),
                                     [&](const auto& column) { return column.full_name() == wanted; });
    if (const auto sum = sums.find(wanted); (probe.boundary || probe.region) && sum != sums.end()) {
      add_sum(wanted, probe.boundary ? *probe.boundary : *probe.region, sum->second.n_components, sum->second.unit);
    } else if (probe.fracture && number != known.numbers.end()) {
      add_number(is_set, fracture, *number);
    } else {
      std::vector<std::string> names;
      for (const auto& output : known.outputs) names.push_back(output.name);
      for (const auto& column : known.numbers)
        if (probe.fracture) names.push_back(column.full_name());
      for (const auto& sum : sums)
        if (probe.boundary || probe.region) names.push_back(sum.first);
      throw Error(fmt::format("\"outputs\": is \"{}\", must be one of {}{}", wanted, base::quoted_list(names),
                              base::did_you_mean(wanted, names)));
    }
  }
}

void Probes::add_output(const Probe& probe, const OutputField& output) {
  const bool on_fractures = output.entity == Entity::fracture_face;
  SPREKK_CHECK(!(probe.boundary || probe.region) || !on_fractures,
               "\"outputs\": \"{}\" is of fractures; give the \"fracture\"", output.name);
  SPREKK_CHECK(output.entity != Entity::facet, "\"outputs\": \"{}\" is only in the files of ParaView", output.name);
  SPREKK_CHECK(!probe.fracture || on_fractures, "\"outputs\": \"{}\" is of the rock, not of a fracture", output.name);
  const bool integral = probe.is_extended() && probe.value == "integral";
  const auto unit =
      integral ? fmt::format("{}*{}", output.unit,
                             measure(probe.boundary ? Entity::fracture_face : output.entity, model_.mesh().dim()))
               : output.unit;
  const std::string prefix = probe.is_extended() ? probe.value + " " : "";
  for (const auto& component : component_names(output.n_components, ends_with(output.name, " local")))
    tables_.back().columns.push_back({prefix + output.name + component, unit});
  looks_.back().push_back(look(probe, output));
}

void Probes::add_number(bool is_set, int fracture, const FractureColumn& column) {
  for (const auto& component : component_names(column.n_components, column.frame == "local"))
    tables_.back().columns.push_back({column.full_name() + component, column.unit});
  const auto look = [=, name = column.full_name()](const Observation& seen) {
    for (const auto& one : is_set ? seen.sets : seen.singles)
      if (one.full_name() == name) {
        const auto first = one.values.begin() + std::ptrdiff_t(fracture) * one.n_components;
        return std::vector<Real>(first, first + one.n_components);
      }
    return std::vector<Real>();
  };
  looks_.back().push_back(look);
}

void Probes::add_sum(const std::string& output, const std::string& place, int n, const std::string& unit) {
  for (const auto& component : component_names(n, false)) tables_.back().columns.push_back({output + component, unit});
  looks_.back().push_back([=](const Observation& seen) {
    std::vector<Real> values(n, missing_value);  // place without a condition
    if (const auto* sum = find(seen.sums, {output, place}))
      for (int i = 0; i < n; ++i) values[i] = sum->is_array() ? sum->at(i).get<Real>() : sum->get<Real>();
    return values;
  });
}

/// Adds the probe of a total. The names within the total are known only after the first state.
void Probes::add_totals(const std::vector<std::string>& names) {
  const auto look = [this, names, t = tables_.size() - 1](const Observation& seen) {
    auto& columns = tables_[t].columns;
    const bool first = columns.empty();
    std::vector<Real> values;
    const auto* totals = find(seen.sums, names);
    const json nothing = json::object();
    for (const auto& [name, value] : (totals ? totals : &nothing)->items()) {
      const auto unit = seen.units.find(fmt::format("{} > {}", fmt::join(names, " > "), name));
      if (first) columns.push_back({name, unit == seen.units.end() ? "-" : unit->second});
      values.push_back(value.template get<Real>());
    }
    return values;
  };
  looks_.back().push_back(look);
}

Probes::Look Probes::look(const Probe& probe, const OutputField& output) const {
  const auto& mesh = model_.mesh();
  const auto index = [](const std::vector<std::string>& names, const std::string& name) {
    return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  std::vector<Shares> places;
  if (probe.boundary) {
    places = {shares_on_boundary(mesh, output.entity, index(mesh.boundary_names, *probe.boundary))};
  } else if (probe.region) {
    places = {shares_in_region(mesh, output.entity, index(mesh.region_names, *probe.region))};
  } else if (probe.fracture) {
    const int set = index(mesh.fracture_names, *probe.fracture);
    const bool is_set = set < static_cast<int>(mesh.fracture_names.size());
    const auto named = [&](const auto& one) { return one.name == *probe.fracture; };
    const auto single = std::find_if(mesh.single_fractures.begin(), mesh.single_fractures.end(), named);
    places = {shares_on_fractures(mesh, is_set, is_set ? set : int(single - mesh.single_fractures.begin()))};
  } else {
    const auto points = points_of(probe, mesh.dim());
    try {
      places = shares_at(mesh, output.entity, points);
    } catch (const Error&) {  // the same on all ranks
      if (mesh.origin.is_null()) throw;
      const std::vector<Real> nothing(points.size() * output.n_components, missing_value);  // excavated place
      return [nothing](const Observation&) { return nothing; };
    }
  }
  Real whole = 0;
  for (const auto& share : places[0]) whole += share.weight;
  whole = base::sum_over_ranks(*mesh.comm, whole);
  const bool is_empty = probe.is_extended() && !(whole > 0);
  const Real divisor = probe.is_extended() && probe.value == "mean" ? whole : 1;
  const Real sign = probe.value == "minimum" ? -1 : 1;
  const bool is_sum = !probe.is_extended() || probe.value == "mean" || probe.value == "integral";
  const int n = output.n_components;
  return [=, &mesh, name = output.name](const Observation& seen) {
    const auto field = std::find_if(seen.outputs.begin(), seen.outputs.end(),
                                    [&](const OutputField& one) { return one.name == name; });
    std::vector<Real> values(places.size() * n, is_sum ? 0 : -std::numeric_limits<Real>::max());
    for (std::size_t k = 0; k < places.size(); ++k)
      for (const auto& [entity, weight] : places[k])
        for (int c = 0; c < n; ++c) {
          const Real value = field->values[std::size_t(entity) * n + c];
          auto& at = values[k * n + c];
          at = is_sum ? at + weight * value : std::max(at, sign * value);
        }
    values = is_sum ? base::sum_over_ranks(*mesh.comm, values) : base::max_over_ranks(*mesh.comm, values);
    for (auto& value : values) value = is_empty ? missing_value : is_sum ? value / divisor : sign * value;
    return values;
  };
}

std::vector<std::vector<Real>> Probes::values(const Observation& observation) {
  std::vector<std::vector<Real>> all;
  for (std::size_t t = 0; t < tables_.size(); ++t) {
    const auto n_places = tables_[t].n_places();
    std::vector<std::vector<Real>> found;
    for (const auto& look : looks_[t]) found.push_back(look(observation));
    auto& values = all.emplace_back();
    for (std::size_t k = 0; k < n_places; ++k)
      for (const auto& one : found) {
        const auto n = one.size() / n_places;
        values.insert(values.end(), one.begin() + k * n, one.begin() + (k + 1) * n);
      }
  }
  return all;
}

std::vector<std::string> Probes::definitions() const {
  Scene copy = model_.scene();
  auto list = base::effective(copy, "Sprekk");
  std::vector<std::string> texts;
  for (const auto& table : tables_) texts.push_back(base::to_xml(list.sublist("Probes").sublist(table.name)));
  return texts;
}

}  // namespace sprekk::model
