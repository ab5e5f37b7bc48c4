// Host that runs two models at the same time: on one half of the ranks each, and alternately on the same ranks. The
// models must not affect each other: both end with the same bits as in separate runs.
#include "model/model.hpp"

#include <Tpetra_Core.hpp>

#include <cmath>
#include <iostream>

using namespace sprekk;

namespace {
constexpr Real E = 10e9;  // Pa

/// Returns the scene of a block of 1 m with a joint in its middle, moved down and sideways; kind 0 or 1.
model::Scene block(int kind) {
  model::Scene scene;
  scene.mesh.cell = kind == 0 ? "quadrilateral" : "triangle";
  scene.mesh.cells = {4 + 2 * kind, 4 + 4 * kind};
  scene.mesh.periodic = {"x"};
  scene.mesh.fractures["joint"] = {{0, 0.5}, {1, 0.5}, {}, false};
  auto& rock = scene.materials["rock"];
  rock.type = "elastic";
  rock.E = E;
  rock.nu = 0;
  auto& joint = scene.materials["smooth"];
  joint.type = "joint";
  joint.friction_coefficient = kind == 0 ? 0.4 : 0.7;
  scene.bulk.material = "rock";
  scene.fractures["joint"].material = "smooth";
  auto& floor = scene.boundary_conditions["floor"];
  floor.boundary = "south";
  floor.displacement = {0, 0};
  const base::Expression right("2e-3*t"), down(kind == 0 ? "-1e-3*t" : "-5e-4*t");
  auto& top = scene.boundary_conditions["top"];
  top.boundary = "north";
  top.displacement = {right, down};
  scene.solver.linear_solver.reproducible = true;  // on several ranks, MUMPS adds in the order of messages
  return scene;
}

constexpr Real times[] = {0.3, 0.6, 1};

void step(model::Model& model, Real t) {
  if (const auto report = model.step_to(t); !report.converged) throw Error(report.reason);
}

std::vector<Real> unknowns(model::Model& model) {
  std::vector<Real> all;
  for (const auto& block : model.system().blocks()) {
    const auto values = model.field(block.name).values;
    all.insert(all.end(), values.data(), values.data() + values.size());
  }
  return all;
}

std::vector<Real> alone(int kind, RCP<const Comm> comm) {
  model::Model model(block(kind), comm);
  for (Real t : times) step(model, t);
  return unknowns(model);
}

/// Compares with the analytical solution: shear traction mu E compression on the sliding joint.
bool is_exact(model::Model& model, Real mu, Real compression) {
  const auto lambda = model.field("traction").values;  // normal, tangential
  for (std::size_t face = 0; face < lambda.extent(0); ++face)
    if (std::abs(lambda(face, 1) / (mu * E * compression) - 1) > 1e-9) return false;
  return true;
}

bool works(RCP<const Comm> world) {
  // alternately on all ranks
  model::Model first(block(0), world), second(block(1), world);
  for (Real t : times) {
    step(first, t);
    step(second, t);
  }
  bool good = unknowns(first) == alone(0, world) && unknowns(second) == alone(1, world);
  good = good && is_exact(first, 0.4, 1e-3) && is_exact(second, 0.7, 5e-4);

  // at the same time, each on half of the ranks; then one after the other
  const int rank = world->getRank(), kind = 2 * rank < world->getSize() ? 0 : 1;
  const RCP<const Comm> half = world->split(kind, rank);
  const auto together = alone(kind, half);
  for (int turn = 0; turn < 2; ++turn) {
    if (turn == kind) good = good && together == alone(kind, half);
    world->barrier();
  }
  std::cout << (good ? "the same bits\n" : "differs from running alone\n");
  return good;
}

}  // namespace

int main(int argc, char** argv) {
  Tpetra::ScopeGuard guard(&argc, &argv);
  try {
    return works(Tpetra::getDefaultComm()) ? 0 : 1;
  } catch (const Error& error) {
    std::cerr << error.what() << std::endl;
    return MPI_Abort(MPI_COMM_WORLD, 1);  // the ranks of the other model would wait
  }
}
