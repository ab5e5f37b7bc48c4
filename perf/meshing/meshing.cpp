// meshing SCENE [PATH=VALUE...]: makes only the mesh of the scene, and prints sizes, seconds and memory as JSON.
#include "base/timer.hpp"
#include "mesh/distribute.hpp"
#include "perf/program.hpp"

namespace {

using namespace sprekk;
using perf::json, perf::time_of;

/// Gathers a number of each rank on all ranks. Collective.
std::vector<Real> of_ranks(const Comm& comm, Real here) {
  std::vector<Real> all(comm.getSize());
  Teuchos::gatherAll(comm, 1, &here, comm.getSize(), all.data());
  return all;
}

json measure(const model::Scene& given, RCP<const Comm> comm) {
  const auto scene = model::prepared(given).value;
  json result;
  RCP<const mesh::Mesh> mesh;
  result["peak_bytes_before"] = of_ranks(*comm, static_cast<Real>(base::peak_memory_bytes()));
  result["seconds_to_distribute"] =
      time_of(*comm, [&] { mesh = mesh::make_distributed([&] { return scene.make_mesh(); }, comm); });
  result["peak_bytes_distributed"] = of_ranks(*comm, static_cast<Real>(base::peak_memory_bytes()));
  result["seconds_to_refine"] = time_of(*comm, [&] { mesh = scene.refined(mesh); });
  result["peak_bytes"] = of_ranks(*comm, static_cast<Real>(base::peak_memory_bytes()));
  result["cells"] = mesh->n_global_cells;
  result["nodes"] = mesh->n_global_nodes;
  result["fracture_faces"] = mesh->n_global_fracture_faces;
  result["local_cells"] = of_ranks(*comm, mesh->n_cells());
  return result;
}

}  // namespace

int main(int argc, char** argv) { return perf::run("meshing", argc, argv, measure); }
