// Lagged coefficients of fluxes.
#pragma once

#include "assembly/relaxation.hpp"
#include "assembly/structure.hpp"

namespace sprekk::assembly {

/// Coefficients of fluxes on fracture faces that are fixed during an iteration, see fields::BlockProblem::lag(). They
/// are updated in logarithms, since they vary over many orders of magnitude. For cubic laws, the slope of the iteration
/// is -3 if the unknowns determine the coefficients, and 0 if volumes determine them.
class FluxLag {
 public:
  /// Returns the fixed coefficients, [local fracture face]; empty: computed from x.
  const ConstView<Real*>& coefficients() const { return coefficients_; }
  /// Updates the coefficients at a state, as BlockProblem::lag(). Collective.
  Real update(fields::BlockProblem::Lag how, const Structure& structure, const State& state);
  /// Computes the coefficients from x again. Local.
  void stop();

 private:
  ConstView<Real*> coefficients_;
  Relaxation logarithms_;  // [local fracture face]
};

}  // namespace sprekk::assembly
