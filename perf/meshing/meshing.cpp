// meshing SCENE [PATH=VALUE...]: makes the scene's mesh, and nothing else, and prints sizes, seconds and memory as
// JSON.
#include "base/timer.hpp"
#include "mesh/distribute.hpp"
#include "model/scene.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Core.hpp>
#include <nlohmann/json.hpp>

#include <chrono>
#include <functional>
#include <iostream>

namespace {

using namespace sprekk;
using nlohmann::json;

/// Seconds on the clock until all ranks are done. Collective.
Real time_of(const Comm& comm, const std::function<void()>& work) {
  comm.barrier();
  const auto begin = std::chrono::steady_clock::now();
  work();
  comm.barrier();
  return std::chrono::duration<Real>(std::chrono::steady_clock::now() - begin).count();
}

/// A number of each rank. Collective.
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

int main(int argc, char** argv) {
  Tpetra::ScopeGuard guard(&argc, &argv);
  const auto comm = Tpetra::getDefaultComm();
  try {
    SPREKK_CHECK(argc > 1, "usage: meshing SCENE [PATH=VALUE...]");
    const auto result = measure(model::read_scene(*comm, argv[1], {argv + 2, argv + argc}), comm);
    if (comm->getRank() == 0) std::cout << result.dump(2) << '\n';
  } catch (const Error& error) {  // the same on every rank
    if (comm->getRank() == 0) std::cerr << "meshing: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
