// A host that changes a live model: water that another code knows of rises in the joint under a block on a slope, until
// the block slides; then, with less water, the strength of the joint is reduced until it does.
#include "model/model.hpp"

#include <Tpetra_Core.hpp>

#include <cmath>
#include <functional>
#include <iostream>

using namespace sprekk;

namespace {
// Of the scene: the block's weight, its base, its dip and friction, per metre of the slope's width.
constexpr Real weight = 2700 * 9.81 * 10 * 2, base_area = 10, dip = M_PI / 6, friction = 40 * M_PI / 180;

/// What a code for groundwater would tell: the pressure in the joint, Pa, by the level of the water above it, m.
Real seepage(Real level) { return 1000 * 9.81 * level; }

/// The largest x up to which change(scene, x) leaves an equilibrium, between `stands` and `falls`, to a millionth.
/// Every trial goes on from the state of the last that stood.
Real largest(model::Model& model, Real stands, Real falls, const std::function<void(model::Scene&, Real)>& change) {
  const model::Scene own = model.scene();
  const auto goes = [&](Real x) {
    model::Scene changed = own;
    change(changed, x);
    model.change(changed);
    return model.find_equilibrium().converged;  // if not, the state is still that of the last that stood
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
  scene.time.stepping.tethers = false;  // a block that slides is no state here
  model::Model model(scene, comm);
  for (const auto& warning : model.warnings())  // collective
    if (speaks) std::cerr << warning << '\n';
  if (const auto report = model.step_to(1); !report.converged) throw Error(report.reason);

  // (W cos(dip) - p A) tan(friction) = W sin(dip)
  const Real level = largest(
      model, 0, 10, [](model::Scene& changed, Real x) { changed.fractures.at("joint").fluid_pressure = seepage(x); });
  const Real pressure = weight * (std::cos(dip) - std::sin(dip) / std::tan(friction)) / base_area;
  bool right = agree("slides at a level of", level, pressure / seepage(1), speaks);

  // with half of it: F = (W cos(dip) - p A) tan(friction)/(W sin(dip))
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
  } catch (const Error& error) {  // the same on every rank
    std::cerr << error.what() << '\n';
    return 1;
  }
}
