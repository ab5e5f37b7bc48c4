// By how much the joints of a scene may lose strength before it has no equilibrium.
#pragma once

#include "model/scene.hpp"

#include <functional>
#include <string>
#include <vector>

namespace sprekk::model {

struct SafetyOptions {
  std::string scene;                   ///< path of the XML file
  std::vector<std::string> overrides;  ///< "Path.To.Entry=value"
  Real tolerance = 1e-3;               ///< of the factor, relative
  Real first = 1;                      ///< the factor that the scene is run with to its end
  Real most = 100;                     ///< that is of interest
};

/// A factor that was tried.
struct Reduction {
  Real factor;
  bool stands;         ///< there is an equilibrium
  int iterations;      ///< of Newton's method
  std::string reason;  ///< why not
};

struct FactorOfSafety {
  Real least;                ///< with which there is an equilibrium
  std::optional<Real> lost;  ///< with which none was found, at most (1 + tolerance) least; absent: `most` stands
  std::vector<Reduction> reductions;  ///< in the order in which they were tried
  std::vector<std::string> states;    ///< digest() of the state at `least`
};

/// Runs the scene to its end, with the strength of all joints divided by the factor F = `first`; then lets F grow, at
/// the loads of the end, and bisects between the largest F with an equilibrium and the least one with none
/// (Zienkiewicz, Humpheson and Lewis 1975). Every trial goes on from the state of the largest F that stands. `tell` is
/// called after each one. Error: a scene without joints, with balances of rates, or that has no equilibrium
/// with F = `first`. Collective.
FactorOfSafety factor_of_safety(const SafetyOptions& options, RCP<const Comm> comm,
                                const std::function<void(const Reduction&)>& tell = {});

}  // namespace sprekk::model
