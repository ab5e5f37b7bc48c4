// Host that controls main, the communicator, the scene and the time loop. It shears a block with a joint, finds the
// onset of sliding by bisection, and then prescribes a slip of the joint.
#include "model/model.hpp"

#include <Teuchos_DefaultMpiComm.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>

using namespace sprekk;

namespace {
// Block of 1 m: rock (Poisson's ratio 0), stiffness and friction of the joint, compression.
constexpr Real E = 10e9, K_t = 30e9, mu = 0.6, compression = 1e-3;  // Pa, Pa/m, -, m

/// Returns the scene: the top moves down until t = 1, then sideways by 1 mm per unit of time.
model::Scene block() {
  model::Scene scene;
  scene.mesh.cells = {4, 4};
  scene.mesh.periodic = {"x"};
  scene.mesh.fractures["joint"] = {{0, 0.5}, {1, 0.5}, {}, false};
  auto& rock = scene.materials["rock"];
  rock.type = "elastic";
  rock.E = E;
  rock.nu = 0;
  auto& joint = scene.materials["smooth"];
  joint.type = "joint";
  joint.tangential_stiffness = K_t;
  joint.friction_coefficient = mu;
  scene.bulk.material = "rock";
  scene.fractures["joint"].material = "smooth";
  auto& floor = scene.boundary_conditions["floor"];
  floor.boundary = "south";
  floor.displacement = {0, 0};
  const base::Expression right("1e-3*max(t - 1, 0)"), down("-1e-3*min(t, 1)");
  auto& top = scene.boundary_conditions["top"];
  top.boundary = "north";
  top.displacement = {right, down};
  return scene;
}

Real largest(const std::vector<Real>& values, MPI_Comm comm) {
  Real here = 0, all = 0;
  for (Real v : values) here = std::max(here, v);
  MPI_Allreduce(&here, &all, 1, MPI_DOUBLE, MPI_MAX, comm);
  return all;
}

void step(model::Model& model, Real t) {
  const auto report = model.step_to(t);
  if (!report.converged) throw Error(report.reason);  // the model keeps its last state
}

/// Returns the errors of the displacement below the joint, where u = (tau y/G, -compression y), m.
std::vector<Real> displacement_errors(model::Model& model, Real tau) {
  const auto u = model.field("displacement").values;
  std::vector<Real> errors;
  for (std::size_t node = 0; node < u.extent(0); ++node) {
    const Real y = model.mesh().coordinates[2 * node + 1];
    if (y < 0.5) errors.push_back(std::hypot(u(node, 0) - tau * y / (E / 2), u(node, 1) + compression * y));
  }
  return errors;
}

int run(MPI_Comm comm) {
  model::Model model(block(), rcp(new Teuchos::MpiComm<int>(comm)));
  step(model, 1);
  for (Real dt = 1; dt > 1e-3; dt /= 2) {
    const auto before = model.save();
    step(model, model.time() + dt);
    if (largest(model.output("slip").values, comm) > 1e-12) model.restore(before);
  }
  // Analytical solution: block and joint shear in series, tau = d/(1 m/G + 1/K_t), at most mu times the pressure.
  const Real compliance = 2 / E + 1 / K_t, onset = 1 + 1e3 * mu * E * compression * compliance, stuck = model.time();

  // A slip given by the host reduces the shear stress. From here on, it is part of the joint's history.
  const auto plastic = model.field("elastic-plastic jump: plastic jump").values;
  constexpr Real given = 2e-4;
  for (std::size_t face = 0; face < plastic.extent(0); ++face) plastic(face, 0) = given;
  step(model, stuck + 0.01);
  const Real tau = (1e-3 * (model.time() - 1) - given) / compliance;
  const Real error = largest(displacement_errors(model, tau), comm);

  // The joint is weakened and slips until its friction balances the remaining shear stress.
  auto weaker = model.scene();
  weaker.materials["smooth"].friction_coefficient = mu / 6;
  model.change(weaker);
  step(model, model.time() + 0.01);
  const Real error_of_weak = largest(displacement_errors(model, mu / 6 * E * compression), comm);
  if (model.mesh().comm->getRank() == 0)
    std::cout << "slides after t = " << stuck << ", by hand " << onset << "; error of u " << error
              << " m, of a weak joint " << error_of_weak << " m\n";
  return stuck <= onset && onset < stuck + 2e-3 && error < 1e-14 && error_of_weak < 1e-14 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  Kokkos::initialize(argc, argv);
  int status = 1;
  try {
    status = run(MPI_COMM_WORLD);  // models must be destroyed before Kokkos ends
  } catch (const Error& error) {   // thrown on all ranks
    std::cerr << error.what() << '\n';
  }
  Kokkos::finalize();
  MPI_Finalize();
  return status;
}
