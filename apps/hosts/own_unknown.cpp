// A host that brings its own unknown: grout in a fracture, its pressure solved for together with the rock. A column is
// pushed down; first the grout alone carries it, then the walls of the fracture touch.
#include "grout.hpp"
#include "model/model.hpp"

#include <Tpetra_Core.hpp>

#include <cmath>
#include <iostream>

using namespace sprekk;

namespace {

// A column of 1 m with a fracture in its middle: rock, grout, and by how much the grout may be squeezed.
constexpr Real E = 10e9, K = 0.5e9, thickness = 0.02, squeeze = 5e-4;  // Pa, Pa, m, m

/// The top moves down by 1 mm per unit of time.
model::Scene column() {
  model::Scene scene;
  scene.mesh.cells = {3, 4};
  scene.mesh.fractures["void"] = {{0, 0.5}, {1, 0.5}, {}, false};
  auto& rock = scene.materials["rock"];
  rock.type = "elastic";
  rock.E = E;
  rock.nu = 0;
  auto& walls = scene.materials["walls"];
  walls.type = "joint";
  walls.friction_coefficient = 0.6;
  walls.initial_gap = -squeeze;  // they touch when the jump is this
  scene.bulk.material = "rock";
  scene.fractures["void"].material = "walls";
  const base::Expression free("free");
  const auto hold = [&](const std::string& boundary, const std::vector<base::Expression>& displacement) {
    auto& condition = scene.boundary_conditions[boundary];
    condition.boundary = boundary;
    condition.displacement = displacement;
  };
  hold("south", {0, 0});
  hold("north", {0, base::Expression("-1e-3*t")});
  for (const char* side : {"west", "east"}) hold(side, {0, free});
  return scene;
}

/// The largest deviation of a rank's faces from the pressure of the grout and the pressure between the walls, Pa.
Real error(model::Model& model, Real grout, Real contact) {
  const auto p = model.field("grout pressure").values;
  const auto lambda = model.field("traction").values;  // tension positive, the normal component first
  Real largest = 0;
  for (std::size_t face = 0; face < p.extent(0); ++face)
    largest = std::max({largest, std::abs(p(face, 0) - grout), std::abs(lambda(face, 0) + contact)});
  return largest;
}

}  // namespace

int main(int argc, char** argv) {
  Tpetra::ScopeGuard guard(&argc, &argv);
  const auto comm = Tpetra::getDefaultComm();
  const auto grout = [](const mesh::Mesh& mesh) {
    std::vector<std::unique_ptr<assembly::Module>> modules;
    modules.push_back(hosts::make_grout(mesh.shape, {thickness, K}));
    return modules;
  };
  bool good = true;
  try {
    model::Model model(column(), comm, grout);
    for (Real t : {1, 3}) {
      good = model.step_to(t).converged && good;
      // By hand: springs in series, d = p (1 m/E + h/K); once the walls touch, the rock alone yields further.
      const Real d = 1e-3 * t, alone = d / (1 / E + thickness / K), full = squeeze * K / thickness;
      const Real p = std::min(alone, full), contact = alone > full ? (d - squeeze) * E - full : 0;
      const Real off = error(model, p, contact);
      std::cout << "rank " << comm->getRank() << ", " << d << " m: grout " << p << " Pa, walls " << contact
                << " Pa, error " << off << " Pa\n";
      good = good && off < 1e-9 * p;
    }
  } catch (const Error& error) {
    std::cerr << error.what() << '\n';
    good = false;
  }
  return good ? 0 : 1;
}
