// Coupling of a host's flow code to Sprekk's mechanics: by exchange, and as rows of Sprekk's Jacobian. The program
// compares costs and results with Sprekk's own flow. A fluid is injected into a fracture, which slips and opens.
#include "coupled.hpp"

#include <Tpetra_Core.hpp>

#include <chrono>
#include <iostream>
#include <set>

using namespace sprekk;

namespace {

/// Coupling method with its steps and their costs.
struct Way {
  std::string name;
  model::Model& model;
  std::function<hosts::Cost(Real)> step;
  std::function<hosts::Values()> pressures;
  hosts::Cost sum = {};
  double seconds = 0;

  void take(Real t) {
    const auto begin = std::chrono::steady_clock::now();
    const auto cost = step(t);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    sum.exchanges += cost.exchanges;
    sum.newton += cost.newton;
    sum.krylov += cost.krylov;
  }
};

int run(int dim, int cells, int steps, const std::string& solver, RCP<const Comm> comm) {
  auto scene = hosts::block(dim, cells);
  scene.solver.linear_solver.type = solver;
  hosts::Exchange exchange(dim, cells, comm, scene);
  const auto together = hosts::make_together(scene, comm), sprekk = hosts::make_sprekk(scene, comm);
  const auto whole = [](model::Model& model) {
    return [&](Real t) {
      hosts::Cost cost;
      hosts::take(model, t, cost);
      return cost;
    };
  };
  std::vector<Way> ways = {{"exchange", exchange.model(), [&](Real t) { return exchange.step(t, 1e-5); },
                            [&] { return exchange.pressures(); }},
                           {"one Jacobian", *together, whole(*together), [&] { return hosts::pressures(*together); }},
                           {"Sprekk's flow", *sprekk, whole(*sprekk), [&] { return hosts::pressures(*sprekk); }}};
  const bool tells = comm->getRank() == 0;
  std::set<std::array<int, 3>> counts;
  for (int k = 1; k <= steps; ++k) {
    for (auto& way : ways) way.take(k * hosts::dt);
    const auto faces = hosts::count_states(*sprekk);
    if (tells)
      std::cout << fmt::format("t = {} s: {} faces open, {} stick, {} slip\n", k * hosts::dt, faces[0], faces[1],
                               faces[2]);
    counts.insert(faces);
  }
  bool good = counts.size() > 1;  // contact states have changed
  if (tells) std::cout << "way            exchanges  Newton  Krylov  seconds  p         u         jump\n";
  for (auto& way : ways) {
    const auto off = [&](const char* name) {
      return hosts::distance(way.model.output(name).values, sprekk->output(name).values, *comm);
    };
    const Real errors[] = {hosts::distance(way.pressures(), ways.back().pressures(), *comm), off("displacement"),
                           off("jump")};
    if (tells)
      std::cout << fmt::format("{:<14} {:>9} {:>7} {:>7} {:>8.2f}  {:.1e}   {:.1e}   {:.1e}\n", way.name,
                               way.sum.exchanges, way.sum.newton, way.sum.krylov, way.seconds, errors[0], errors[1],
                               errors[2]);
    for (const Real error : errors) good = good && error < 1e-8;
  }
  return good ? 0 : 1;
}

}  // namespace

/// Arguments: coupled [dimension [cells per edge [steps [direct | iterative]]]]
int main(int argc, char** argv) {
  Tpetra::ScopeGuard guard(&argc, &argv);
  const auto number = [&](int k, int otherwise) { return argc > k ? std::stoi(argv[k]) : otherwise; };
  try {
    return run(number(1, 2), number(2, 8), number(3, 4), argc > 4 ? argv[4] : "auto", Tpetra::getDefaultComm());
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
