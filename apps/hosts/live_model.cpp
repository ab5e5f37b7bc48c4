// Host that changes a live model. Water from another code rises in the joint under a block on a slope until the block
// slides. Then, with less water, the strength of the joint is reduced until the block slides.
#include "model/model.hpp"

#include <Tpetra_Core.hpp>

#include <cmath>
#include <functional>
#include <iostream>

using namespace sprekk;

namespace {
// Scene data: weight of the block, base area, dip and friction, per metre of width. N, m^2, rad, rad
constexpr Real weight = 2700 * 9.81 * 10 * 2, base_area = 10, dip = M_PI / 6, friction = 40 * M_PI / 180;

/// Returns the pressure in the joint, Pa, for a water level above it, m, in place of a groundwater code.
Real seepage(Real level) { return 1000 * 9.81 * level; }

/// Returns the largest x between `stands` and `falls`, to 1e-6, for which change(scene, x) permits an equilibrium. Each
/// trial continues from the last equilibrium. Throws an Error if the result has no equilibrium. Collective.
Real largest(model::Model& model, Real stands, Real falls, const std::function<void(model::Scene&, Real)>& change) {
  const model::Scene own = model.scene();
  const auto goes = [&](Real x) {
    model::Scene changed = own;
    change(changed, x);
    model.change(changed);
    return model.find_equilibrium().converged;  // false: the state remains that of the last equilibrium
  };
  while (falls - stands > 1e-6 * falls) {
    const Real x = (stands + falls) / 2;
    (goes(x) ? stands : falls) = x;
  }
  if (!goes(stands)) throw Error("what stood does not stand any more");
  return stands;
}

bool agree(const char* what, Real found, Real by_hand, bool speaks) {
  if (speaks) std::cout << what << ' ' << found << ", by hand " << by_hand << '\n';
  return std::abs(found / by_hand - 1) < 2e-6;
}

int run(RCP<const Comm> comm) {
  const bool speaks = comm->getRank() == 0;
  model::Scene scene = model::read_scene(*comm, "../../xml/slopes/plane_2d.xml");
  scene.time.stepping.proximal_continuation = false;  // a sliding block is no valid state here
  model::Model model(scene, comm);
  for (const auto& warning : model.warnings())  // collective
    if (speaks) std::cerr << warning << '\n';
  if (const auto report = model.step_to(1); !report.converged) throw Error(report.reason);

  // Limit: (W cos(dip) - p A) tan(friction) = W sin(dip)
  const Real level = largest(
      model, 0, 10, [](model::Scene& changed, Real x) { changed.fractures.at("joint").fluid_pressure = seepage(x); });
  const Real pressure = weight * (std::cos(dip) - std::sin(dip) / std::tan(friction)) / base_area;
  bool right = agree("slides at a level of", level, pressure / seepage(1), speaks);

  // With half of this level: F = (W cos(dip) - p A) tan(friction)/(W sin(dip))
  scene.fractures.at("joint").fluid_pressure = seepage(level / 2);
  model.change(scene);
  if (!model.find_equilibrium().converged) throw Error("with less water the block does not rest");
  const Real factor = largest(
      model, 1, 10, [](model::Scene& changed, Real x) { changed.materials.at("joint").strength_reduction = x; });
  const Real by_hand = (weight * std::cos(dip) - seepage(level / 2) * base_area) * std::tan(friction) / (weight / 2);
  right = agree("factor of safety with half of it", factor, by_hand, speaks) && right;
  return right ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Tpetra::ScopeGuard guard(&argc, &argv);
  try {
    return run(Tpetra::getDefaultComm());
  } catch (const Error& error) {  // thrown on all ranks
    std::cerr << error.what() << '\n';
    return 1;
  }
}
