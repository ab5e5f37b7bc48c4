#include "base/over_ranks.hpp"
#include "model/results.hpp"

#include <array>

namespace sprekk::model {

using nlohmann::json;

json mesh_summary(const mesh::Mesh& mesh) {
  const auto& partition = mesh.partition;
  const auto share = [](const std::array<GlobalIndex, 2>& range, double imbalance) {
    return json{{"min", range[0]}, {"max", range[1]}, {"imbalance", imbalance}};
  };
  return {{"mesh",
           {{"dimension", mesh.dim()},
            {"nodes", mesh.n_global_nodes},
            {"cells", mesh.n_global_cells},
            {"fracture_faces", mesh.n_global_fracture_faces}}},
          {"partition",
           {{"cells", share(partition.cells, partition.cell_imbalance)},
            {"fracture_faces", share(partition.fracture_faces, partition.fracture_face_imbalance)},
            {"cut_edges", partition.edge_cut},
            {"separated_fracture_faces", partition.separated_faces}}}};
}

json block_summary(const assembly::System& system) {
  json summary;
  const auto& comm = *system.comm();
  for (std::size_t b = 0; b < system.blocks().size(); ++b) {
    const auto& layout = system.layouts()[b];
    std::array<long long, 2> halo{};
    if (system.exchanged(static_cast<int>(b)))
      halo = base::sum_over_ranks(comm, std::array{static_cast<long long>(layout.halo_bytes()),
                                                   static_cast<long long>(layout.halo_messages())});
    summary["fields"].push_back({{"name", layout.field().name},
                                 {"entity", fields::name_of(layout.field().entity)},
                                 {"components", layout.field().n_components},
                                 {"unit", layout.field().unit},
                                 {"unknowns", layout.owned()->getGlobalNumElements()},
                                 {"halo_bytes", halo[0]},
                                 {"halo_messages", halo[1]}});
  }
  const auto& A = system.matrix();
  for (int i = 0; i < A.n_blocks(); ++i)
    for (int j = 0; j < A.n_blocks(); ++j) {
      const auto saved = i == j ? A.saved(i) : nullptr;
      if (A(i, j).is_null() && !saved) continue;
      const auto matrix = saved ? saved->J() : fields::wrapped(A(i, j));
      const auto& numbers = matrix->numbers();
      const auto starts = numbers.n_rows() / numbers.height;
      const auto entries = static_cast<long long>(numbers.value.extent(0));
      const long long bytes = entries * static_cast<long long>(sizeof(Real)) +
                              static_cast<long long>(numbers.column.extent(0) * sizeof(LocalIndex)) +
                              starts * static_cast<long long>(sizeof(std::size_t));
      const auto sums = base::sum_over_ranks(comm, std::array{static_cast<long long>(entries), bytes});
      summary["matrices"].push_back({{"row", system.blocks()[i].name},
                                     {"column", system.blocks()[j].name},
                                     {"entries", sums[0]},
                                     {"bytes", sums[1]}});
    }
  for (const auto& [field, values] : system.histories()) {
    const auto bytes = static_cast<long long>(values.size() * sizeof(Real));
    summary["histories"].push_back({{"name", field.name},
                                    {"entity", fields::name_of(field.entity)},
                                    {"components", field.n_components},
                                    {"bytes", base::sum_over_ranks(comm, bytes)}});
  }
  for (const auto& module : system.modules()) summary["modules"].push_back(module->name());
  for (const auto& group : system.local_groups()) {
    json names = json::array();
    for (int b : group.blocks) names.push_back(system.blocks()[b].name);
    summary["local_groups"].push_back({{"name", group.name}, {"blocks", names}});
  }
  return summary;
}

}  // namespace sprekk::model
