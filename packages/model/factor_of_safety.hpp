// Factor of safety by reduction of the joint strength.
#pragma once

#include "model/scene.hpp"

#include <functional>
#include <string>
#include <vector>

namespace sprekk::model {

struct SafetyOptions {
  std::string scene;                   ///< path of the XML file
  std::vector<std::string> overrides;  ///< "Path.To.Entry=value"
  Real tolerance = 1e-3;               ///< relative tolerance of the factor
  Real first = 1;                      ///< factor for the complete run of the scene
  Real maximum = 100;                  ///< largest factor to be tested
};

/// Trial with one factor.
struct Reduction {
  Real factor;
  bool stands;         ///< an equilibrium exists
  int iterations;      ///< of Newton's method
  std::string reason;  ///< reason for a missing equilibrium
};

struct FactorOfSafety {
  Real stable;               ///< largest factor with an equilibrium
  std::optional<Real> lost;  ///< smallest factor without one, <= (1 + tolerance) stable; absent: `maximum` has one
  std::vector<Reduction> reductions;  ///< in the order of the trials
  std::vector<std::string> states;    ///< digest() of the state at `stable`
};

/// Runs the scene to its end with the strength of all joints divided by the factor F = `first`. Then F is increased at
/// the final loads. Bisection follows between the largest F with an equilibrium and the smallest without one
/// (Zienkiewicz, Humpheson and Lewis 1975). Every trial starts from the state at the largest F with an equilibrium.
/// `report` is called after each trial. Throws an Error if the scene has no joints, has balances of rates, or has no
/// equilibrium for F = `first`. Collective.
FactorOfSafety factor_of_safety(const SafetyOptions& options, RCP<const Comm> comm,
                                const std::function<void(const Reduction&)>& report = {});

}  // namespace sprekk::model
