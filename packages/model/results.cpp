#include "model/results.hpp"

#include "base/over_ranks.hpp"
#include "base/units.hpp"
#include "base/xml.hpp"
#include "io/file.hpp"
#include "model/fracture_table.hpp"
#include "model/json_keys.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprekk::model {

using assembly::OutputField;
using assembly::Summary;
using nlohmann::json;

namespace {

/// Returns the first row, or null without rows.
json first_of(const std::vector<io::SeriesRow>& rows) {
  return rows.empty() ? json() : json{{"time", rows.front().time}, {"values", rows.front().values}};
}

/// Rows of a probe from a previous run, up to the restart. `begun` is its entry in Results::probes_begun().
std::vector<io::SeriesRow> earlier_rows(const std::string& name, const json& begun, const std::vector<json>& journal) {
  std::vector<io::SeriesRow> rows;
  if (const auto& first = begun.at("first"); !first.is_null())
    rows.push_back({first.at("time"), values_of(first.at("values"))});
  for (const auto& entry : journal)
    if (const Real t = entry.at("step").at("time"); rows.empty() || t > rows.front().time)
      rows.push_back({t, values_of(entry.at("probes").at(name))});
  return rows;
}

}  // namespace

Results::Results(Model& model, Scene as_read, std::string directory, const std::optional<EarlierResults>& earlier)
    : model_(model),
      directory_(std::move(directory)),
      probes_(model),
      n_changes_(model.n_changes()),
      ends_{model.setting().start} {
  const auto comm = model_.system().comm();
  io::make_directory(*comm, directory_);
  base::collectively(*comm, [&] {
    const auto list = base::effective(as_read, "Sprekk");
    if (comm->getRank() != 0) return;
    io::write_file(directory_ + "/effective_input.xml", base::to_xml(list));
    remove_earlier(earlier.has_value());
  });
  if (model_.scene().output.vtu) {
    std::vector<Real> written;
    if (earlier)
      for (const auto& entry : earlier->journal)
        if (entry.at("written")) written.push_back(entry.at("step").at("time"));
    bulk_.emplace(comm, directory_, "bulk", written);
    if (!model_.mesh().fracture_names.empty()) start_fractures(written);
  }
  if (earlier)
    for (const auto& entry : earlier->journal) ends_.push_back(entry.at("step").at("time"));
  if (model_.scene().output.error_estimate || model_.scene().accuracy)
    estimates_.emplace(model_, model_.setting().start);
  tables_.emplace(model_);
  const auto& mesh = model_.mesh();
  json_["status"] = "running";
  json_["ranks"] = comm->getSize();
  json_.update(mesh_summary(mesh));
  const auto& solver = model_.newton().linear().solver();
  json_["solver"] = {{"choice", solver.reason}, {"parameters", solver.describe()}};
  json_["blocks"] = block_summary(model_.system());
  if (!mesh.fracture_names.empty()) json_["single_fractures"] = described_singles(mesh);
  for (const auto& own : model.scene().own_joints)
    json_["single_fractures"][own.first]["own_joint"] = physics::own_entries(model.scene(), mesh, own.first);
  const auto& unit = model_.scene().output.time_unit;
  json_["time_unit"] = {{"name", unit}, {"seconds", base::value_in("s", {1, unit})}};
  json_["steps"] = json::array();
  if (earlier) {
    for (const auto& entry : earlier->journal) add(entry.at("step"));
    if (!earlier->stages.empty()) json_["stages"] = earlier->stages;
    json_.update(earlier->common);
    json_["restarts"] = earlier->restarts;
    json_["restarts"].push_back(model_.time());
    n_steps_ = static_cast<int>(json_["steps"].size());
  }
  if (model_.scene().growth) grown_.emplace(mesh, earlier ? earlier->journal : std::vector<json>());
  if (!earlier) add_initial_state();
  if (const auto& rule = model_.scene().output.events; rule && !mesh.fracture_names.empty()) {
    catalogue_.emplace(mesh, rule->rate, model_.time(), model_.system().outputs(model_.state()));
    if (earlier) catalogue_->resume(mesh, earlier->journal, earlier->faces);
  }
  if (!probes_.empty()) start_probes(earlier);
  write_json();
}

/// Adds a step. Only rank 0 stores and writes the complete entry.
void Results::add(const json& step) {
  json_["steps"].push_back(model_.mesh().comm->getRank() == 0 ? step : json{{"time", step.at("time")}});
}

void Results::start_fractures(const std::vector<Real>& written) {
  fractures_.emplace(model_.mesh().comm, directory_, "fractures", written, io::VtuSeries::Of::blocks);
  add_intersections();
}

void Results::add_intersections() {
  const auto& mesh = model_.mesh();
  const auto piece = io::intersection_piece(mesh::intersections(mesh));
  if (base::on_any_rank(*mesh.comm, piece.n_cells() > 0)) fractures_->keep({"intersections", piece});
}

/// Adds the state before the first step, if the scene and its loads define it.
void Results::add_initial_state() {
  auto& system = model_.system();
  auto memory = system.memory();
  memory.t = model_.time();
  bool known = true;
  physics::for_each_physics([&](auto physics) { known = known && physics.has_initial_state(model_.scene()); });
  json initial = {{"time", model_.time()}};
  try {
    system.resume(model_.state(), memory);
    if (!known) return;
    add_fractures(initial, system.outputs(model_.state()));
    initial.update(reactions());
    initial["mesh"] = json_["mesh"];
  } catch (const Error&) {  // loads without a value at the start, perhaps with values in the steps
    return;
  }
  json_["initial"] = initial;
  sets_ = singles_ = {};  // no step yet
}

/// Begins the tables of probes with the present state. A table of the previous run with the same probe is continued.
void Results::start_probes(const std::optional<EarlierResults>& earlier) {
  auto& system = model_.system();
  const bool known = earlier || json_.contains("initial");
  const auto outputs = system.outputs(model_.state());
  json now = reactions();
  add_fractures(now, outputs);
  const auto values = probes_.values({outputs, sets_, singles_, now, units_});
  sets_ = singles_ = {};  // no step yet
  auto tables = probes_.tables();
  const auto definitions = probes_.definitions();
  for (std::size_t t = 0; t < tables.size(); ++t) {
    auto& rows = tables[t].rows;
    const auto before = earlier ? earlier->probes.value(tables[t].name, json::object()) : json::object();
    const bool continued = before.value("definition", "") == definitions[t];
    if (continued)
      rows = earlier_rows(tables[t].name, before, earlier->journal);
    else if (known)
      rows = {{model_.time(), values[t]}};
    probes_begun_[tables[t].name] = {{"definition", definitions[t]},
                                     {"first", continued ? before.at("first") : first_of(rows)}};
  }
  series_.emplace(model_.system().comm(), directory_, std::move(tables),
                  io::TimeUnit{json_["time_unit"]["name"], json_["time_unit"]["seconds"]});
}

std::vector<json> Results::journal(int begin) const {
  std::vector<json> entries;
  if (model_.mesh().comm->getRank() != 0) return entries;
  for (int k = begin; k < n_steps_; ++k) {
    const auto& step = json_["steps"][k];
    const bool written =
        bulk_ && std::binary_search(bulk_->times().begin(), bulk_->times().end(), step["time"].get<Real>());
    entries.push_back({{"step", step}, {"written", written}});
    if (series_)
      for (const auto& table : series_->tables())
        entries.back()["probes"][table.name] = table.rows[table.rows.size() - n_steps_ + k].values;
  }
  return entries;
}

json Results::common_entries() const {
  json entries = json::object();
  for (const char* name : {"units", "tables", "initial", "single_fractures"})
    if (json_.contains(name)) entries[name] = json_[name];
  return entries;
}

/// Returns true after every n-th step. With adaptive steps and a schedule, only the times of the schedule are counted.
bool Results::fields_are_due(const StepTaken& step) const {
  const auto& time = model_.scene().time;
  int n = n_steps_;
  if (time.chooses_steps() && time.schedule) {
    if (!step.at_time) return false;
    n = static_cast<int>(std::upper_bound(time.schedule->begin(), time.schedule->end(), step.end) -
                         time.schedule->begin());
  }
  return n % model_.scene().output.every == 0;
}

std::array<long long, 3> Results::add_step(const StepTaken& taken, bool last) {
  const auto& report = taken.report;
  if (n_changes_ != model_.n_changes()) follow_change();
  if (taken.begins_stage) begin_stage(taken.stage, taken.begin);
  json step = {{"time", report.time},
               {"newton_iterations", report.newton_iterations},
               {"linear_iterations", solve::iterations(report.linear_solves)},
               {"iterates", report.exchanges.iterates},
               {"ghost_exchanges", report.exchanges.ghosts},
               {"substeps", report.substeps},
               {"cuts", report.cuts},
               {"converged", report.converged}};
  if (!taken.stage.empty()) step["stage"] = taken.stage;
  step.update(taken.growth);
  if (model_.scene().time.chooses_steps()) {
    step["length"] = report.time - taken.begin;
    step["rejected"] = taken.n_rejected;
    step["rejected_newton_iterations"] = taken.rejected_iterations;
    for (const auto& error : taken.errors) step["estimated_errors"][with_underscores(error.name)] = error.value;
  }
  for (const auto& linear : report.linear_solves)
    step["linear_solves"].push_back(
        {{"iterations", linear.iterations}, {"residual", linear.residual}, {"used", linear.used}});
  for (const auto& advected : report.advected_solves)
    step["advected_solves"].push_back({{"iterations", advected.iterations}, {"residual", advected.residual}});
  if (report.converged && !report.floating.empty()) step["floating"] = report.floating;
  if (!report.converged) step["oscillating_faces"] = add_oscillating(report);
  for (const auto& measure : report.measures) step["measures"][with_underscores(measure.name)] = measure.value;
  if (!report.converged && report.substeps == 0) {  // state unchanged
    add(step);
    return {0, 0, 0};
  }
  auto outputs = model_.system().outputs(model_.state());
  ends_.push_back(report.time);
  physics::for_each_physics([&]<physics::HasWarnings P>(P) {
    for (const auto& warning : P::Warnings::of_state(model_.setting(), ends_, outputs))
      if (reported_.insert(warning).second) warnings_.push_back(warning);
  });
  if (grown_) grown_->add(taken.extensions);
  add_fractures(step, outputs);
  add_error_bounds(step["fractures"], outputs);
  step.update(reactions());
  step.update(tables_->of_state(outputs));
  if (!tables_->units().empty()) json_["tables"].update(tables_->units());
  if (grown_) add_growth(step, taken.extensions);
  if (catalogue_) step["events"] = catalogue_->add(model_.mesh(), report.time, outputs);
  add_probes(step, outputs);
  if (estimates_ && (model_.scene().output.error_estimate || estimates_->need(last))) {
    const auto scope = model_.timers().scope("error estimate");
    const auto estimate = estimates_->take(present_state(model_, outputs), last, report.converged);
    step["error_estimate"] = summary(estimates_->estimator(), estimate);
    outputs.insert(outputs.end(), estimate.fields.begin(), estimate.fields.end());
  }
  add(step);
  ++n_steps_;
  if (last || fields_are_due(taken)) write_fields(report.time, outputs);
  const auto rest = std::max<std::chrono::steady_clock::duration>(std::chrono::seconds(5), 20 * write_.took);
  if (base::on_any_rank(*model_.mesh().comm, std::chrono::steady_clock::now() - write_.end > rest)) write_json();
  return counts_of_classes(*model_.mesh().comm, outputs);
}

/// Adds the size of the mesh and the table of extensions, which a failed step does not have.
void Results::add_growth(json& step, const estimate::StateTable& extensions) {
  step["mesh"] = mesh_summary(model_.mesh())["mesh"];
  for (const auto& column : extensions.columns) json_["tables"]["growth"][column.name] = column.unit;
  if (extensions.fractures.empty()) return;
  step["growth"] = {{"fracture", extensions.fractures}};
  for (const auto& column : extensions.columns) step["growth"][column.name] = column.values;
}

/// Adds the values of sets and, if present, of single fractures.
void Results::add_fractures(json& step, const std::vector<OutputField>& outputs) {
  const auto& mesh = model_.mesh();
  step["fractures"] = json::object();
  if (mesh.fracture_names.empty()) return;
  sets_ = fracture_table(mesh, outputs, Grouping::sets);
  const bool same = mesh.single_fractures.size() == mesh.fracture_names.size();
  singles_ = same ? sets_ : fracture_table(mesh, outputs, Grouping::singles);
  if (grown_) {
    grown_->append(mesh, Grouping::sets, sets_);
    grown_->append(mesh, Grouping::singles, singles_);
  }
  step["fractures"] = by_sets(mesh, sets_);
  if (mesh.comm->getRank() == 0) step["single_fractures"] = by_singles(singles_);
  json_["units"] = units(sets_);
}

void Results::add_probes(const json& step, const std::vector<OutputField>& outputs) {
  if (!series_) return;
  const auto scope = model_.timers().scope("probes");
  series_->add(step.at("time"), probes_.values({outputs, sets_, singles_, step, units_}));
}

/// Sets the error bounds of this state: maximum over all fractures.
void Results::add_error_bounds(const json& fractures, const std::vector<OutputField>& outputs) {
  for (const auto& output : outputs) {
    if (output.summary.kind != Summary::error_bound) continue;
    const auto name = with_underscores(output.summary.name);
    Real largest = 0;
    for (const auto& fracture : fractures) largest = std::max(largest, fracture.at("error_of_" + name).get<Real>());
    json_["error_bounds"][name] = error_bounds_[output.summary.name] = largest;
  }
}

/// Adapts to the changed scene of the model, and perhaps to its changed mesh.
void Results::follow_change() {
  n_changes_ = model_.n_changes();
  probes_.update_places();
  if (estimates_) estimates_.emplace(model_, ends_.back());
  if (model_.scene().accuracy || grown_) {
    json_.update(mesh_summary(model_.mesh()));
    json_["blocks"] = block_summary(model_.system());
    if (fractures_) add_intersections();
  }
  tables_.emplace(model_);
}

RunEstimates& Results::estimates() {
  if (n_changes_ != model_.n_changes()) follow_change();
  return *estimates_;
}

/// Adds a stage to results.json.
void Results::begin_stage(const std::string& name, Real time) {
  const auto& mesh = model_.mesh();
  json_["stages"].push_back({{"name", name},
                             {"time", time},
                             {"nodes", mesh.n_global_nodes},
                             {"cells", mesh.n_global_cells},
                             {"fracture_faces", mesh.n_global_fracture_faces}});
}

/// Reactions of conditions, by boundary, region or fracture, and totals of the modules. Collective.
json Results::reactions() {
  json all = {{"reactions", json::object()}, {"reaction_moments", json::object()}};  // present in any case
  const auto add = [](json& sum, Real value) { sum = value + (sum.is_null() ? 0 : sum.get<Real>()); };
  const auto add_all = [&](json& sums, const std::vector<Real>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) add(sums[i], values[i]);
  };
  const auto& mesh = model_.mesh();
  for (const auto& reaction : model_.system().reactions_of_step(model_.state())) {
    const bool in_region = reaction.region >= 0, on_fracture = reaction.fracture >= 0;
    const auto& [name, moments, regions, unit, fractures] = reaction.called;
    units_.insert({{name, unit}, {moments, unit + "*m"}, {regions, unit}, {fractures, unit}});
    const auto& place = in_region     ? mesh.region_names[reaction.region]
                        : on_fracture ? mesh.fracture_names[reaction.fracture]
                                      : model_.scene().boundary_conditions.at(reaction.condition).boundary;
    if (const auto& called = in_region ? regions : on_fracture ? fractures : name; called.empty())
      continue;
    else if (reaction.force.size() == 1)
      add(all[called][place], reaction.force[0]);
    else
      add_all(all[called][place], reaction.force);
    const auto& m = reaction.moment;
    if (!moments.empty())
      add_all(all[moments][place], mesh.dim() == 2 ? std::vector<Real>{m[2]} : std::vector<Real>(m.begin(), m.end()));
  }
  for (const auto& total : model_.system().totals(model_.state())) {
    json* place = &all;
    for (const auto& name : total.names) place = &(*place)[name];
    *place = total.value + (place->is_null() ? 0 : place->get<Real>());
    units_.insert({fmt::format("{}", fmt::join(total.names, " > ")), total.unit});
  }
  return all;
}

Real Results::value_of(const physics::LogColumn& column) const {
  Real largest = std::numeric_limits<Real>::quiet_NaN();
  for (const auto& member : json_["steps"].back().value(column.section, json::object()))
    if (const auto& value = member.value(column.result, json()); value.is_number())
      largest = std::fmax(largest, value.get<Real>());
  return largest;
}

std::vector<std::string> Results::fracture_digest() const {
  return singles_.empty() ? std::vector<std::string>() : digest(json_["single_fractures"], singles_);
}

}  // namespace sprekk::model
