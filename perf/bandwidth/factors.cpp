// factors SCENE [PATH=VALUE...]: prints estimated and measured costs of the pressure of faces as JSON: factors and
// multigrid. Rock must be rigid, with storage: the Jacobians differ by the length of the step.
#include "base/trilinos_compat.hpp"
#include "model/model.hpp"
#include "multigrid/direct_inverse.hpp"
#include "perf/program.hpp"
#include "solve/factor_cost.hpp"

#include <algorithm>
#include <ctime>
#include <optional>

namespace {

using namespace sprekk;
using perf::json;

constexpr int n_setups = 5, n_applications = 20;
constexpr char field[] = "face pressure";

/// CPU seconds of this rank, which depend little on the load of the machine.
Real time_of(const std::function<void()>& work) {
  const auto begin = std::clock();
  work();
  return static_cast<Real>(std::clock() - begin) / CLOCKS_PER_SEC;
}

/// Set-up of an inverse with the present Jacobian, which returns the seconds, and the inverse.
struct Inverse {
  std::function<Real()> set_up;
  std::function<RCP<const fields::Operator>()> made;
};

/// Median CPU seconds of a set-up after the first one, and mean seconds of an application of n_cycles. Collective.
json measured(model::Model& model, const Inverse& inverse, int n_cycles = 1) {
  auto& system = model.system();
  const auto& scene = model.scene();
  const Real dt = scene.time.times().front() - scene.time.start;
  std::vector<Real> setups;
  for (int k = 0; k <= n_setups; ++k) {
    system.set_time(model.time() + dt * (1 + k % 2), dt * (1 + k % 2));
    system.jacobian(model.state());
    setups.push_back(inverse.set_up());
  }
  std::nth_element(setups.begin() + 1, setups.begin() + 1 + n_setups / 2, setups.end());
  const auto made = inverse.made();
  fields::MultiVector x(made->getDomainMap(), 1), y(made->getRangeMap(), 1);
  x.randomize();
  const Real seconds = time_of([&] {
    for (int k = 0; k < n_applications; ++k) made->apply(x, y, Teuchos::NO_TRANS, 1, 0);
  });
  return {{"set-up", setups[1 + n_setups / 2]}, {"application", n_cycles * seconds / n_applications}};
}

json to_json(const solve::InverseCost& cost) { return {{"set-up", cost.setup}, {"application", cost.application}}; }

json measure(const model::Scene& scene, RCP<const Comm> comm) {
  model::Model model(scene, comm);
  const auto& system = model.system();
  const auto& blocks = system.blocks();
  const auto found = std::find_if(blocks.begin(), blocks.end(), [](const auto& block) { return block.name == field; });
  SPREKK_CHECK(found != blocks.end(), "the scene has no '{}'", field);
  const int b = static_cast<int>(found - blocks.begin());
  const solve::FacetMatrix matrix{.n_unknowns = static_cast<Real>(found->map->getGlobalNumElements()),
                                  .dim = static_cast<int>(found->coordinates->getNumVectors()),
                                  .alone = true,
                                  .n_ranks = comm->getSize()};
  // the elimination of the pressure of cells does not change the graph
  const auto factors = rcp(new multigrid::DirectInverse(system.matrix()(b, b), field, comm->getSize()));
  auto options = scene.solver.linear_solver;
  options.type = "iterative";
  options.preconditioner.blocks[field].type = "multigrid";
  std::optional<solve::CondensedSolve> linear;
  const auto set_up_multigrid = [&] {
    const auto timers = rcp(new base::Timers);
    linear.emplace(model.system(), options, timers);
    linear->update();
    const auto phases = timers->phases();
    return std::find_if(phases.begin(), phases.end(),
                        [](const auto& phase) { return phase.name == "set-up of linear solver"; })
        ->cpu_seconds;
  };
  json result{{"unknowns", matrix.n_unknowns}};
  result["measured"]["factors"] =
      measured(model, {[&] { return time_of([&] { factors->setup(false); }); }, [&] { return factors; }});
  result["measured"]["multigrid"] =
      measured(model, {set_up_multigrid, [&] { return linear->solver().solver->preconditioner(); }}, 2);
  result["measured"]["operations"] = factors->operations();
  result["measured"]["entries"] = factors->entries();
  const auto [operations, entries] = solve::factor_cost(matrix);
  result["estimated"] = {{"factors", to_json(solve::cost_of_factors(matrix))},
                         {"multigrid", to_json(solve::cost_of_multigrid(matrix))},
                         {"operations", operations},
                         {"entries", entries}};
  return result;
}

}  // namespace

int main(int argc, char** argv) { return perf::run("factors", argc, argv, measure); }
