// Files of the results: fields for ParaView, results.json and tables.
#include "base/over_ranks.hpp"
#include "io/file.hpp"
#include "io/json.hpp"
#include "mesh/intersections.hpp"
#include "model/events.hpp"
#include "model/fracture_table.hpp"
#include "model/json_keys.hpp"
#include "model/results.hpp"

#include <Teuchos_CommHelpers.hpp>

#include <algorithm>
#include <filesystem>

namespace sprekk::model {

using assembly::OutputField;
using assembly::Summary;
using nlohmann::json;

namespace {

constexpr const char* oscillating_name = "oscillating";  ///< name of the VTU files

io::Piece fractures_with(const mesh::Mesh& mesh, const std::vector<OutputField>& outputs) {
  auto piece = io::fracture_piece(mesh);
  std::vector<Real> number, single;
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
    number.push_back(mesh.fracture_faces[f].fracture);
    single.push_back(mesh.fracture_faces[f].single);
  }
  piece.cell_data.push_back(io::data_array("fracture", 1, number));
  piece.cell_data.push_back(io::data_array("single fracture", 1, single));
  for (const auto& output : outputs)
    if (output.entity == fields::Entity::fracture_face && output.summary.kind != Summary::integral)
      piece.cell_data.push_back(io::data_array(output.name, output.n_components, output.values));
  return piece;
}

/// One block of faces per fracture.
std::vector<io::Block> blocks_of(const mesh::Mesh& mesh, const io::Piece& fractures) {
  std::vector<std::vector<LocalIndex>> faces(mesh.fracture_names.size());
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) faces[mesh.fracture_faces[f].fracture].push_back(f);
  std::vector<io::Block> blocks;
  for (std::size_t k = 0; k < faces.size(); ++k)
    blocks.push_back({mesh.fracture_names[k], io::part_of(fractures, faces[k])});
  return blocks;
}

/// Adds the owned edges on intersections if there are outputs on facets.
void add_channels(const mesh::Mesh& mesh, const std::vector<OutputField>& outputs, std::vector<io::Block>& blocks) {
  const auto on_facets = [](const OutputField& output) { return output.entity == fields::Entity::facet; };
  if (std::none_of(outputs.begin(), outputs.end(), on_facets)) return;
  const auto edges = mesh::intersection_edges(mesh);
  auto piece = io::edge_piece(mesh, edges);
  for (const auto& output : outputs) {
    if (!on_facets(output)) continue;
    std::vector<Real> values;
    for (const auto& edge : edges) {
      const auto first = output.values.begin() + static_cast<std::ptrdiff_t>(edge.facet) * output.n_components;
      values.insert(values.end(), first, first + output.n_components);
    }
    piece.cell_data.push_back(io::data_array(output.name, output.n_components, std::move(values)));
  }
  blocks.push_back({"channels", std::move(piece)});
}

}  // namespace

void write_failure(const Comm& comm, const std::string& directory, const std::string& reason, bool only_replace) {
  const std::string path = directory + "/results.json";
  std::error_code unknown;
  int wanted = !only_replace || std::filesystem::exists(path, unknown);
  Teuchos::broadcast(comm, 0, 1, &wanted);
  if (!wanted) return;
  try {
    io::make_directory(comm, directory);
    io::write_json(comm, path,
                   {{"status", "failed"}, {"reason", reason}, {"ranks", comm.getSize()}, {"steps", json::array()}});
  } catch (const Error&) {  // the reason is reported in any case
  }
}

/// Removes the files of oscillating faces, tables and lists of written steps of a previous run. If the run is
/// continued, only tables that this run writes again are removed. Ignores failures. Not collective.
void Results::remove_earlier(bool goes_on) const {
  std::error_code ignored;
  const auto remove = [&](const std::string& name) { std::filesystem::remove(directory_ + '/' + name, ignored); };
  for (const char* end : {"", ".pvd", "_0000.pvtu"})
    std::filesystem::remove_all(directory_ + '/' + oscillating_name + end, ignored);
  remove("probes.h5");
  for (const char* name : {"fractures.csv", "events.csv", "bulk.pvd", "fractures.pvd"})
    if (!goes_on) remove(name);
  for (const auto& name : names_of_tables()) remove(name + ".csv");
  for (const auto& entry : std::filesystem::directory_iterator(directory_ + "/probes", ignored))
    if (entry.path().extension() == ".csv") std::filesystem::remove(entry.path(), ignored);
  remove("probes");  // only if empty
}

/// Counts the oscillating faces and writes them to a file together with the state. Collective.
long long Results::add_oscillating(const solve::StepReport& report) {
  const auto& mesh = model_.mesh();
  std::vector<Real> flags(report.oscillating.begin(), report.oscillating.end());
  flags.resize(mesh.n_owned_fracture_faces);  // empty if no iterate was accepted
  const long long here = std::count(flags.begin(), flags.end(), 1);
  const auto n = base::sum_over_ranks(*mesh.comm, here);
  if (n == 0 || !bulk_) return n;
  auto piece = fractures_with(mesh, model_.system().outputs(model_.state()));
  piece.cell_data.push_back(io::data_array("oscillating", 1, flags));
  io::VtuSeries(mesh.comm, directory_, oscillating_name).write(report.time, piece);
  return n;
}

void Results::write_fields(Real time, const std::vector<OutputField>& outputs) {
  if (!bulk_) return;
  const auto scope = model_.timers().scope("output");
  const auto& mesh = model_.mesh();
  auto bulk = io::bulk_piece(mesh);
  const std::vector<Real> rank(mesh.n_owned_cells, mesh.comm->getRank());
  bulk.cell_data.push_back(io::data_array("rank", 1, rank));
  bulk.cell_data.push_back(
      io::data_array("material", 1, {mesh.cell_region.begin(), mesh.cell_region.begin() + mesh.n_owned_cells}));
  for (const auto& output : outputs) {
    if (output.entity == fields::Entity::node)
      bulk.point_data.push_back(io::nodal_data_array(bulk, output.name, output.n_components, output.values));
    else if (output.entity == fields::Entity::cell)
      bulk.cell_data.push_back(io::data_array(output.name, output.n_components, output.values));
  }
  bulk_->write(time, bulk);
  if (!fractures_) return;
  auto blocks = blocks_of(mesh, fractures_with(mesh, outputs));
  add_channels(mesh, outputs, blocks);
  fractures_->write(time, blocks);
}

void Results::write_json() {
  const auto scope = model_.timers().scope("results");
  const auto begin = std::chrono::steady_clock::now();
  const auto& comm = *model_.system().comm();
  const auto here = static_cast<Real>(base::peak_memory_bytes());
  json_["memory"] = {{"peak_bytes_largest_rank", base::max_over_ranks(comm, here)},
                     {"peak_bytes_all_ranks", base::sum_over_ranks(comm, here)}};
  auto& parts = json_["solver"]["parts"] = json::array();
  for (const auto& cost : model_.newton().linear().solver().solver->costs()) {
    const auto maximum = base::max_over_ranks(
        comm, std::array<Real, 5>{cost.setup_seconds, cost.application_seconds, static_cast<Real>(cost.cycle_bytes),
                                  static_cast<Real>(cost.messages), static_cast<Real>(cost.message_bytes)});
    json of_levels = json::object();
    if (!cost.n_unknowns.empty())
      of_levels = {{"levels", cost.n_unknowns.size()},    {"unknowns_of_levels", cost.n_unknowns},
                   {"ranks_of_levels", cost.n_ranks},     {"cycle_bytes_largest_rank", maximum[2]},
                   {"messages_largest_rank", maximum[3]}, {"message_bytes_largest_rank", maximum[4]}};
    parts.push_back({{"name", cost.name},
                     {"setups", cost.n_setups},
                     {"applications", cost.n_applications},
                     {"setup_seconds", maximum[0]},
                     {"application_seconds", maximum[1]},
                     {"operator_complexity", cost.operator_complexity},
                     {"bytes", base::sum_over_ranks(comm, static_cast<Real>(cost.bytes))}});
    parts.back().update(of_levels);
  }
  json_["timing"] = json::object();
  for (const auto& phase : model_.timers().phases())
    json_["timing"][with_underscores(phase.name)] = {
        {"seconds", phase.seconds}, {"cpu_seconds", phase.cpu_seconds}, {"count", phase.count}};
  io::write_json(comm, directory_ + "/results.json", json_);
  if (series_) series_->write_all();
  base::collectively(comm, [&] {
    if (comm.getRank() != 0) return;
    for (const auto& [name, text] : tables_csv(json_)) io::write_file(directory_ + '/' + name + ".csv", text);
    if (singles_.empty()) return;
    io::write_file(directory_ + "/fractures.csv", to_csv(json_["single_fractures"], singles_));
    const auto events =
        catalogue_ ? catalogue_csv(json_, singles_) : events_csv(json_, singles_, model_.setting().start);
    if (!events.empty()) io::write_file(directory_ + "/events.csv", events);
  });
  n_written_ = static_cast<int>(json_["steps"].size());
  write_.end = std::chrono::steady_clock::now();
  write_.took = write_.end - begin;
}

void Results::finish(const std::string& status, const std::string& reason) {
  json_["status"] = status;
  if (!reason.empty()) json_["reason"] = reason;
  try {
    write_json();
  } catch (const Error& error) {
    finish_in_place(reason.empty() ? error.what() : reason);
    throw;
  }
}

/// Overwrites the file on a full disk. Without mesh and solver there is space for all steps, or for the earlier ones.
void Results::finish_in_place(const std::string& reason) {
  json_["status"] = "failed";
  json_["reason"] = reason;
  auto short_version = json_;
  for (const char* part : {"solver", "blocks", "partition", "timing", "memory"}) short_version.erase(part);
  const std::string path = directory_ + "/results.json";
  if (io::overwrite_json(*model_.system().comm(), path, short_version)) return;
  auto& steps = short_version["steps"];
  steps.erase(steps.begin() + std::min<std::ptrdiff_t>(n_written_, steps.size()), steps.end());
  io::overwrite_json(*model_.system().comm(), path, short_version);
}

}  // namespace sprekk::model
