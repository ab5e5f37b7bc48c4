#include "model/fingerprint.hpp"

#include "base/over_ranks.hpp"
#include "base/xml.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace sprekk::model {

using nlohmann::json;

namespace {

/// Hash of numbers, small enough for its sum over all entities of a mesh.
template <class T>
long long hash(const std::vector<T>& numbers) {
  const std::string_view bytes(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T));
  return static_cast<long long>(std::hash<std::string_view>()(bytes) >> 33);
}

/// Sums of hashes of all cells with their nodes, fracture faces and boundary faces, with their global numbers.
json mesh_hash(const mesh::Mesh& mesh) {
  std::array<long long, 3> here{};
  const int dim = mesh.dim(), n = mesh.nodes_per_cell();
  for (LocalIndex cell = 0; cell < mesh.n_owned_cells; ++cell) {
    std::vector<GlobalIndex> numbers = {mesh.cell_id[cell], mesh.cell_region[cell]};
    std::vector<Real> corners;
    for (int k = 0; k < n; ++k) {
      const LocalIndex node = mesh.cells[cell * n + k];
      numbers.insert(numbers.end(), {mesh.node_id[node], mesh.node_id[mesh.free_node(node)]});
      corners.insert(corners.end(), &mesh.coordinates[node * dim], &mesh.coordinates[node * dim] + dim);
    }
    numbers.push_back(hash(corners));
    here[0] += hash(numbers);
  }
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
    const auto& face = mesh.fracture_faces[f];
    here[1] += hash(std::vector<GlobalIndex>{face.id, face.fracture, mesh.cell_id[face.cell[0]], face.local_face[0],
                                             mesh.cell_id[face.cell[1]], face.local_face[1]});
  }
  for (const auto& face : mesh.boundary_faces)
    if (face.owned) here[2] += hash(std::vector<GlobalIndex>{face.boundary, mesh.cell_id[face.cell], face.local_face});
  return base::sum_over_ranks(*mesh.comm, here);
}

json unknowns(const assembly::System& system) {
  json all = json::array();
  for (const auto& layout : system.layouts()) {
    const auto& field = layout.field();
    all.push_back({field.name, field.entity, field.n_components, layout.owned()->getGlobalNumElements()});
  }
  for (const auto& [field, values] : system.histories(false))
    all.push_back({field.name, field.entity, field.n_components});
  return all;
}

/// Returns true for sections that may change at a restart, or that are compared separately.
bool is_free(const std::string& section) {
  constexpr const char* free[] = {"Mesh", "Mesh file", "Tables", "Time", "Solver", "Output", "Probes", "Stages"};
  return std::find(std::begin(free), std::end(free), section) != std::end(free);
}

/// Returns true if `later` begins with all points of `earlier`.
bool extends(const json& earlier, const json& later) {
  return earlier.size() <= later.size() && std::equal(earlier.begin(), earlier.end(), later.begin());
}

bool same_tables(const json& earlier, const json& later) {
  if (earlier.size() != later.size()) return false;
  for (const auto& [name, points] : earlier.items())
    if (!later.contains(name) || !extends(points, later[name])) return false;
  return true;
}

}  // namespace

json fingerprint(const Scene& scene, const assembly::System& system) {
  Scene copy = scene;
  auto sections = base::effective(copy, "Sprekk");
  json result = {{"mesh", mesh_hash(system.mesh())},
                 {"unknowns", unknowns(system)},
                 {"Time > start", scene.time.start},
                 {"Tables", json::object()}};
  physics::for_each_physics([&]<physics::HasRates P>(P) {
    if (P::Rates::exist(scene)) result["Time > scheme"] = scene.time.scheme;
  });
  for (const auto& named_entry : sections) {
    const std::string& name = named_entry.first;
    if (!is_free(name) && sections.isSublist(name)) result[name] = base::to_xml(sections.sublist(name));
  }
  for (const auto& [name, set, properties] : system.mesh().single_fractures)
    if (!properties.empty()) result["properties of fractures"][name] = properties;
  for (const auto& module : system.modules())
    result["module \"" + module->name() + "\""].push_back(module->fingerprint());
  for (const auto& [name, table] : scene.tables)
    for (std::size_t i = 0; i < table.arguments.size(); ++i)
      result["Tables"][name].push_back({table.arguments[i], table.values[i]});
  return result;
}

void check_fingerprint(const json& of_checkpoint, const json& of_scene) {
  std::vector<std::string> different;
  json all = of_checkpoint;
  all.update(of_scene);
  for (const auto& [what, ignored] : all.items()) {
    const json before = of_checkpoint.value(what, json()), now = of_scene.value(what, json());
    if (what == "Tables" ? !same_tables(before, now) : before != now) different.push_back(what);
  }
  SPREKK_CHECK(
      different.empty(),
      "the checkpoint is of another scene, they differ in: {}; only the rest of Time, Solver, Output, Probes and later "
      "Stages may change, and tables get more points at their end; use a stage for changes at its time or later",
      fmt::join(different, ", "));
}

}  // namespace sprekk::model
