// Common parts of the measurement programs: NAME SCENE [PATH=VALUE...] measures properties of a scene and prints
// JSON.
#pragma once

#include "base/heap.hpp"
#include "model/scene.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Core.hpp>
#include <nlohmann/json.hpp>

#include <chrono>
#include <functional>
#include <iostream>
#include <string>

namespace sprekk::perf {

using nlohmann::json;

/// Wall-clock seconds until all ranks have finished. Collective.
inline Real time_of(const Comm& comm, const std::function<void()>& work) {
  comm.barrier();
  const auto begin = std::chrono::steady_clock::now();
  work();
  comm.barrier();
  return std::chrono::duration<Real>(std::chrono::steady_clock::now() - begin).count();
}

/// Implements main() of a program. Returns the exit status: 1 after an Error, which rank 0 prints to stderr.
inline int run(const std::string& name, int argc, char** argv,
               const std::function<json(const model::Scene&, RCP<const Comm>)>& measure) {
  base::keep_heap();  // as in the main program
  Tpetra::ScopeGuard guard(&argc, &argv);
  const auto comm = Tpetra::getDefaultComm();
  try {
    SPREKK_CHECK(argc > 1, "usage: {} SCENE [PATH=VALUE...]", name);
    const auto result = measure(model::read_scene(*comm, argv[1], {argv + 2, argv + argc}), comm);
    if (comm->getRank() == 0) std::cout << result.dump(2) << '\n';
  } catch (const Error& error) {  // thrown on every rank
    if (comm->getRank() == 0) std::cerr << name << ": " << error.what() << '\n';
    return 1;
  }
  return 0;
}

}  // namespace sprekk::perf
