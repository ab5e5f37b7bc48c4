// bandwidth SCENE [PATH=VALUE...]: prints the times of the parts of the scene's first step, and the memory
// bandwidth of the same ranks, as JSON. The repeated linear solves use the system at the end of the step.
#include "base/trilinos_compat.hpp"
#include "model/model.hpp"
#include "perf/program.hpp"

#include <algorithm>

namespace {

using namespace sprekk;
using perf::json, perf::time_of;

constexpr std::size_t triad_length = 8u << 20;  // per array and rank: together several times the largest caches
constexpr int n_rounds = 25, n_solves = 3;
constexpr std::size_t touched = std::size_t(2) << 30;  // bytes of all ranks together, more than the scene needs

struct Kernel {
  std::string name;
  std::function<void()> work;
  std::vector<Real> seconds;
};

Real sum(const Comm& comm, Real here) {
  Real all = 0;
  Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, 1, &here, &all);
  return all;
}

Real median(std::vector<Real> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

/// Median seconds of each kernel. The kernels run in turns, so that other load of the machine affects all of them.
/// Collective.
json medians(const Comm& comm, std::vector<Kernel> kernels) {
  json result;
  for (int round = 0; round <= n_rounds; ++round)
    for (auto& kernel : kernels) {
      const Real seconds = time_of(comm, kernel.work);
      if (round > 0) kernel.seconds.push_back(seconds);  // the first round warms up
    }
  for (const auto& kernel : kernels) result[kernel.name] = median(kernel.seconds);
  return result;
}

/// a = b + s c of STREAM (McCalpin 1995), counted as 24 bytes per entry.
Kernel triad() {
  const View<Real*> a("a", triad_length), b("b", triad_length), c("c", triad_length);
  Kokkos::deep_copy(b, 1);
  Kokkos::deep_copy(c, 2);
  return {"triad",
          [=] {
            Kokkos::parallel_for(
                "triad", Kokkos::RangePolicy<Execution>(0, triad_length),
                KOKKOS_LAMBDA(std::size_t i) { a(i) = b(i) + 3.0 * c(i); });
            Kokkos::fence();
          },
          {}};
}

Kernel product(const std::string& name, RCP<const fields::Operator> A) {
  const auto x = rcp(new fields::MultiVector(A->getDomainMap(), 1)),
             y = rcp(new fields::MultiVector(A->getRangeMap(), 1));
  x->randomize();
  return {name, [=] { A->apply(*x, *y); }, {}};
}

/// Minimum bytes moved by y = A x: values and columns of entries, row offsets, x and y.
Real bytes(const fields::CrsMatrix& A) {
  return base::n_local_entries(A) * (sizeof(Real) + sizeof(LocalIndex)) +
         base::n_local_rows(A) * (sizeof(std::size_t) + sizeof(Real)) + base::n_local_columns(A) * sizeof(Real);
}

json to_json(const base::Timers& timers) {
  json phases = json::object();
  for (const auto& phase : timers.phases()) phases[phase.name] = {{"seconds", phase.seconds}, {"count", phase.count}};
  return phases;
}

/// Computes the step, then restores history and solver to its beginning. Returns x at the end of the step. Throws
/// if the step does not converge. Collective.
fields::BlockVector take_step(model::Model& model, Real t, json& result) {
  const auto start = model.save();
  const auto report = model.step_to(t);
  SPREKK_CHECK(report.converged, "the step does not converge: {}", report.reason);
  result["newton_iterations"] = report.newton_iterations;
  result["phases"] = to_json(model.timers());
  auto x = fields::create_like(model.state());
  fields::copy(model.state(), x);
  model.restore(start);
  return x;
}

/// Times set-ups and solves, with the Jacobians at the end x and at the beginning of the step alternately. Throws
/// if a solve does not converge. Collective.
void solve_again(model::Model& model, const fields::BlockVector& x, solve::CondensedSolve& linear,
                 const base::Timers& timers, json& result) {
  auto& system = model.system();
  auto b = fields::create_like(x), dx = fields::create_like(x);
  const auto set_up = [&](const fields::BlockVector& at) {
    system.jacobian(at);
    linear.update();
  };
  set_up(x);
  result["first"] = to_json(timers);
  system.residual(model.state(), b);
  std::vector<Real> solves, setups;
  for (int k = 0; k < n_solves; ++k) {
    solve::LinearReport report;
    solves.push_back(time_of(*system.comm(), [&] { report = linear.solve(b, dx, linear.tolerance()); }));
    SPREKK_CHECK(report.converged, "{}", report.reason);
    result["iterations"] = report.iterations;
  }
  for (int k = 0; k < n_solves; ++k) {
    system.jacobian(model.state());
    setups.push_back(time_of(*system.comm(), [&] { linear.update(); }));
    set_up(x);
  }
  result["solve"] = median(solves);
  result["elimination and set-up"] = median(setups);
}

/// Allocates and frees memory; returns the seconds. The host of a virtual machine may first have to provide the
/// memory, which would distort the later measurements. Collective.
Real touch_memory(const Comm& comm) {
  return time_of(comm, [&] { std::vector<char>(touched / comm.getSize()).back() = 1; });
}

json measure(const model::Scene& scene, RCP<const Comm> comm) {
  json result;
  result["first touch"] = {{"first", touch_memory(*comm)}, {"again", touch_memory(*comm)}};
  model::Model model(scene, comm);
  const Real t = scene.time.times().front();
  const auto x = take_step(model, t, result);
  auto& system = model.system();
  system.set_time(t, t - scene.time.start);
  touch_memory(*comm);  // the host may have reclaimed it
  const auto timers = rcp(new base::Timers);
  solve::CondensedSolve linear(system, scene.solver.linear_solver, timers);
  solve_again(model, x, linear, *timers, result);

  const auto& solver = *linear.solver().solver;
  SPREKK_CHECK(!solver.preconditioner().is_null(),
               "the scene is solved directly; Solver.Linear solver.type must be iterative");
  const RCP<const fields::CrsMatrix> A = system.create_matrix()(0, 0);  // before elimination; values are irrelevant
  result["medians"] = medians(*comm, {triad(), product("SpMV", A)});
  std::vector<Real> whole;
  std::vector<std::vector<Real>> of_parts(solver.costs().size());
  const auto preconditioner = product("preconditioner", solver.preconditioner());
  for (int round = 0; round < n_rounds; ++round) {
    const auto before = solver.costs();
    whole.push_back(time_of(*comm, preconditioner.work));
    for (std::size_t k = 0; k < before.size(); ++k)
      of_parts[k].push_back(solver.costs()[k].application_seconds - before[k].application_seconds);
  }
  result["preconditioner"] = median(whole);
  const auto costs = solver.costs();
  for (std::size_t k = 0; k < costs.size(); ++k)  // the last one is multigrid, perhaps below a fine level
    result["parts"].push_back({{"name", costs[k].name},
                               {"seconds", median(of_parts[k])},
                               {"bytes", sum(*comm, costs[k].cycle_bytes)},
                               {"operator_complexity", costs[k].operator_complexity},
                               {"unknowns", costs[k].n_unknowns}});
  result["triad_bytes"] = sum(*comm, 3.0 * sizeof(Real) * triad_length);
  result["spmv_bytes"] = sum(*comm, bytes(*A));
  result["unknowns"] = A->getGlobalNumRows();
  result["entries"] = A->getGlobalNumEntries();
  result["ranks"] = comm->getSize();
  return result;
}

}  // namespace

int main(int argc, char** argv) { return perf::run("bandwidth", argc, argv, measure); }
