#include "model/event_catalogue.hpp"

#include "base/over_ranks.hpp"
#include "fields/layout.hpp"
#include "model/fracture_table.hpp"
#include "model/json_keys.hpp"
#include "physics/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

namespace sprekk::model {

using assembly::OutputField;
using nlohmann::json;

namespace {

constexpr const char* memory_name = "events of faces";

/// Sources of the events; none if no physics has events.
std::optional<physics::EventSource> event_source() {
  std::optional<physics::EventSource> source;
  physics::for_each_physics([&]<physics::HasEvents P>(P) { source = P::Events::source(); });
  return source;
}

const OutputField* output_named(const std::vector<OutputField>& outputs, const std::string& name) {
  const auto found = std::find_if(outputs.begin(), outputs.end(), [&](const auto& one) { return one.name == name; });
  return found == outputs.end() ? nullptr : &*found;
}

Real length_of(const std::array<Real, 2>& v) { return std::hypot(v[0], v[1]); }
std::array<Real, 2> change_between(const std::array<Real, 2>& a, const std::array<Real, 2>& b) {
  return {a[0] - b[0], a[1] - b[1]};
}

/// Field of the numbers of Face that a checkpoint contains.
fields::Field field_of_memory() { return {memory_name, fields::Entity::fracture_face, 5, "-"}; }

/// Numbers of the owned faces in the whole mesh.
std::vector<GlobalIndex> ids_of(const mesh::Mesh& mesh) {
  std::vector<GlobalIndex> ids;
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f)
    ids.push_back(mesh.origin.is_null() ? mesh.fracture_faces[f].id : mesh.origin->fracture_faces[f]);
  return ids;
}

/// Centre of the fastest face of a single fracture. Collective.
json place_of_fastest(const mesh::Mesh& mesh, int single, const std::vector<Real>& rates, Real fastest) {
  const auto ids = ids_of(mesh);
  constexpr GlobalIndex none = std::numeric_limits<GlobalIndex>::max();
  GlobalIndex lowest = none;
  const auto is_candidate = [&](std::size_t f) {
    return mesh.fracture_faces[f].single == single && rates[f] >= (1 - 1e-9) * fastest;
  };
  for (std::size_t f = 0; f < rates.size(); ++f)
    if (is_candidate(f)) lowest = std::min(lowest, ids[f]);
  lowest = base::min_over_ranks(*mesh.comm, lowest);
  std::array<Real, 3> place{};
  for (std::size_t f = 0; f < rates.size(); ++f)
    if (ids[f] == lowest) place = mesh.fracture_faces[f].centre;
  return base::sum_over_ranks(*mesh.comm, place);
}

}  // namespace

EventCatalogue::EventCatalogue(const mesh::Mesh& mesh, Real rate, Real t, const std::vector<OutputField>& outputs)
    : threshold_(rate),
      time_(t),
      faces_(faces_of(mesh, outputs)),
      ids_(ids_of(mesh)),
      rows_(mesh.single_fractures.size()) {}

std::vector<EventCatalogue::Face> EventCatalogue::faces_of(const mesh::Mesh& mesh,
                                                           const std::vector<OutputField>& outputs) {
  std::vector<Face> faces(mesh.n_owned_fracture_faces);
  const auto source = event_source();
  const auto *path = source ? output_named(outputs, source->path) : nullptr,
             *force = source ? output_named(outputs, source->force) : nullptr,
             *density = source ? output_named(outputs, source->density) : nullptr;
  if (!path || !force || !density) return faces;
  const int dim = mesh.dim();
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (int k = 1; k < dim; ++k) {
      faces[f].path[k - 1] = path->values[f * dim + k];
      faces[f].force[k - 1] = force->values[f * dim + k];
    }
    faces[f].density = density->values[f];
  }
  return faces;
}

/// Returns the faces of the last step for the owned faces of a mesh. New faces have the values `now`.
std::vector<EventCatalogue::Face> EventCatalogue::moved_to(const mesh::Mesh& mesh, std::vector<Face> now) const {
  std::map<GlobalIndex, Face> before;
  for (std::size_t f = 0; f < faces_.size(); ++f) before.emplace(ids_[f], faces_[f]);
  const auto ids = ids_of(mesh);
  now.resize(ids.size());
  for (std::size_t f = 0; f < ids.size(); ++f)
    if (const auto found = before.find(ids[f]); found != before.end()) now[f] = found->second;
  return now;
}

io::NamedVectors EventCatalogue::memory(const mesh::Mesh& mesh) const {
  const auto vector = rcp(new fields::Vector(fields::owned_map(field_of_memory(), mesh)));
  {
    const auto faces = moved_to(mesh, {});
    const auto values = vector->getDataNonConst();
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const auto& face = faces[f];
      const Real numbers[] = {face.first_path[0], face.first_path[1], face.first_force[0], face.first_force[1],
                              Real(face.beyond)};
      std::copy(std::begin(numbers), std::end(numbers), values.begin() + static_cast<std::ptrdiff_t>(5 * f));
    }
  }
  return {{memory_name, vector}};
}

void EventCatalogue::resume(const mesh::Mesh& mesh, const std::vector<json>& journal, const io::NamedVectors& memory) {
  const auto rows_of = [](const json& entry) { return entry.at("step").value("events", json::array()); };
  for (const auto& entry : journal)
    for (const auto& row : rows_of(entry)) {
      n_rows_ = std::max(n_rows_, row.at("row").get<int>() + 1);
      number_ = std::max(number_, row.at("event").get<int>());
    }
  const auto saved = memory.find(memory_name);
  if (saved == memory.end()) return;  // the previous run had no catalogue
  if (!journal.empty())
    for (const auto& row : rows_of(journal.back())) {
      rows_[row.at("fracture").get<std::size_t>()] = row;
      any_ = true;
    }
  fields::Vector vector(fields::owned_map(field_of_memory(), mesh));
  vector.doImport(*saved->second, fields::Import(saved->second->getMap(), vector.getMap()), Tpetra::REPLACE);
  const auto values = vector.getData();
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    faces_[f].first_path = {values[5 * f], values[5 * f + 1]};
    faces_[f].first_force = {values[5 * f + 2], values[5 * f + 3]};
    faces_[f].beyond = values[5 * f + 4] != 0;
  }
}

json EventCatalogue::add(const mesh::Mesh& mesh, Real t, const std::vector<OutputField>& outputs) {
  const auto now = faces_of(mesh, outputs);
  if (auto ids = ids_of(mesh); ids != ids_) {
    faces_ = moved_to(mesh, now);
    ids_ = std::move(ids);
  }
  const Real dt = t - time_;
  const std::size_t n = rows_.size();
  std::vector<Real> rates(faces_.size()), fastest(n, 0);
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    rates[f] = dt > 0 ? length_of(change_between(now[f].path, faces_[f].path)) / dt : 0;
    Real& largest = fastest[mesh.fracture_faces[f].single];
    largest = std::max(largest, rates[f]);
  }
  fastest = base::max_over_ranks(*mesh.comm, fastest);
  const auto goes_on = [&](std::size_t k) { return fastest[k] > threshold_; };
  std::vector<std::array<Real, 4>> sums(n);  // area, integrals of path and drop, change of the integral of the density
  std::vector<Real> longest(n, 0);
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const auto k = static_cast<std::size_t>(mesh.fracture_faces[f].single);
    if (!goes_on(k)) continue;
    auto& face = faces_[f];
    if (rows_[k].is_null()) {
      face.first_path = face.path;
      face.first_force = face.force;
      face.beyond = false;
    }
    face.beyond = face.beyond || rates[f] > threshold_;
    const Real area = mesh.fracture_faces[f].area;
    sums[k][3] += area * std::abs(now[f].density - face.density);
    if (!face.beyond) continue;
    const auto along = change_between(now[f].path, face.first_path),
               drop = change_between(face.first_force, now[f].force);
    const Real size = length_of(along);
    sums[k][0] += area;
    sums[k][1] += area * size;
    if (size > 0) sums[k][2] += area * (drop[0] * along[0] + drop[1] * along[1]) / size;
    longest[k] = std::max(longest[k], size);
  }
  sums = base::sum_over_ranks(*mesh.comm, sums);
  longest = base::max_over_ranks(*mesh.comm, longest);
  json events = json::array();
  for (std::size_t k = 0; k < n; ++k) {
    auto& row = rows_[k];
    if (!goes_on(k)) {
      row = nullptr;
      continue;
    }
    if (row.is_null()) {
      if (!std::exchange(any_, true)) ++number_;
      row = {{"row", n_rows_++},
             {"event", number_},
             {"fracture", k},
             {"start", time_},
             {"integral", 0.0},
             {"rate", 0.0},
             {"place", place_of_fastest(mesh, static_cast<int>(k), rates, fastest[k])}};
    }
    const auto& [area, path, drop, change] = sums[k];
    row["end"] = t;
    row["area"] = area;
    row["mean"] = path / area;
    row["max"] = longest[k];
    row["drop"] = drop / area;
    row["integral"] = row["integral"].get<Real>() + change;
    row["rate"] = std::max(row["rate"].get<Real>(), fastest[k]);
    events.push_back(row);
  }
  any_ = !events.empty();
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    faces_[f].path = now[f].path;
    faces_[f].force = now[f].force;
    faces_[f].density = now[f].density;
  }
  time_ = t;
  return events;
}

std::string catalogue_csv(const json& results, const std::vector<FractureColumn>& columns) {
  const auto source = event_source();
  const auto column =
      std::find_if(columns.begin(), columns.end(), [](const auto& one) { return one.events.has_value(); });
  if (!source || column == columns.end()) return "";
  std::map<int, json> last;  // [row number] last state
  for (const auto& step : results["steps"])
    for (const auto& row : step.value("events", json::array())) last[row["row"].get<int>()] = row;
  std::vector<json> rows;
  for (const auto& [number, row] : last) rows.push_back(row);
  const auto key = [](const json& row) { return std::tuple(row["end"].get<Real>(), row["start"].get<Real>()); };
  std::stable_sort(rows.begin(), rows.end(), [&](const json& a, const json& b) { return key(a) < key(b); });
  const auto& [mean, derived] = *column->events;
  const auto path = with_underscores(mean);
  const std::string time = results["time_unit"]["name"], unit = results["units"]["mean_" + path];
  const Real seconds = results["time_unit"]["seconds"];
  const bool flat = results["mesh"]["dimension"] == 2;
  auto text = fmt::format(
      "fracture,start [{0}],end [{0}],{1} [{2}],{3} [{4}],{5} [{6}],cumulated_{3} [{4}],event [-],duration [s],"
      "max_{1} [{2}],max_{1}_rate [{2}/s],{7},{8} [{9}],x [m],y [m]{10}\n",
      time, path, unit, column->name, column->unit, derived.name, derived.unit, flat ? "length [m]" : "area [m^2]",
      source->drop, source->drop_unit, flat ? "" : ",z [m]");
  Real sum = 0;
  for (const auto& row : rows) {
    const Real start = row["start"], end = row["end"], integral = row["integral"];
    sum += integral;
    text += csv_cell(results["single_fractures"][row["fracture"].get<std::size_t>()]["name"]);
    for (const Real value :
         {start / seconds, end / seconds, row["mean"].get<Real>(), integral,
          derived.of({integral}).value_or(std::nan("")), sum, row["event"].get<Real>(), end - start,
          row["max"].get<Real>(), row["rate"].get<Real>(), row["area"].get<Real>(), row["drop"].get<Real>()})
      text += fmt::format(",{}", value);
    for (int i = 0; i < (flat ? 2 : 3); ++i) text += fmt::format(",{}", row["place"][i].get<Real>());
    text += '\n';
  }
  return text;
}

}  // namespace sprekk::model
