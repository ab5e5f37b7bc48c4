// Quantities of the section Accuracy: values, errors, and the cells that cause the errors.
#pragma once

#include "model/error_estimate.hpp"

namespace sprekk::model {

/// Quantities along the states of a model, to which it refers. All members are collective unless they return stored
/// data.
class Goals {
 public:
  struct Estimate {
    Real value = 0;
    Real error = 0;  ///< error due to the mesh; infinite without an estimate
  };

  explicit Goals(Model& model);

  /// Returns true if the state must be added: the last one, or every one if slip is a quantity or the model has
  /// storage. Stored data.
  bool need(bool last) const;
  /// Adds the present state, with its outputs and errors. A face without slip in this step retains its previous slip
  /// error. `last`: no other state follows.
  void add(const std::vector<assembly::OutputField>& outputs, const ErrorEstimate& estimate, ErrorEstimator& estimator,
           bool last);
  /// Computes cell weights for the state added last. It does so in the `last` state and, for slip, when the set of
  /// slipping faces has changed.
  void weigh(const std::vector<assembly::OutputField>& outputs, const ErrorEstimate& estimate,
             ErrorEstimator& estimator, bool last);

  /// Returns true if flux errors exist too; their rate does not increase with the order of the cells. Stored data.
  bool any_flux() const { return !fluxes_.empty() && !fluxes_.back().empty(); }
  /// Estimates for the last state, by the names of the quantities.
  const std::map<std::string, Estimate>& estimates() const { return estimates_; }

  /// [owned cell] maximum over the quantities of weight * contribution of the cell to the error bound.
  std::vector<Real> indicators(const std::map<std::string, Real>& weights) const;

 private:
  /// Slip error of a face: signed component along the slip, and absolute value.
  struct Lack {
    Real along = 0, size = 0;
  };

  std::vector<LocalIndex> faces_of(const Quantity& quantity) const;
  Estimate of_boundary(const Quantity& quantity, const ErrorEstimate& estimate) const;
  void follow_slip(const std::vector<assembly::OutputField>& outputs, const ErrorEstimate& estimate);
  bool others_slip() const;
  Estimate of_fractures(const Quantity& quantity, const std::vector<assembly::OutputField>& outputs,
                        const ErrorEstimate& estimate) const;
  std::vector<Real> energies(const Quantity& quantity, const std::vector<assembly::OutputField>& outputs,
                             const ErrorEstimate& estimate, ErrorEstimator& estimator) const;

  bool add_flux(const std::string& name, const Quantity& quantity, const ErrorEstimate& estimate,
                ErrorEstimator& estimator, bool last);
  void add_to_bound(const std::string& name, const std::vector<Real>& shares);
  std::vector<Real> all_energies(const std::vector<Real>& of_stress) const;

  Model& model_;
  std::vector<std::vector<ErrorEstimate::Flux>> fluxes_;  // of all steps
  std::vector<Real> plastic_;                             // plastic jump of the last state, as in its output
  std::vector<Lack> lacks_;                               // [owned fracture face]
  std::vector<char> slips_, weighted_;  // [owned fracture face] slip in the last step, and at the last weighing
  std::map<std::string, Estimate> estimates_;
  std::map<std::string, std::vector<Real>> bounds_;  // [quantity][owned cell]
};

/// Returns the smallest set of cells with at least the share `theta` of the sum of indicators, largest first.
/// Indicators within a factor of 2^(1/8) are selected together, so the choice does not depend on the rounding of sums
/// over ranks. Collective.
std::vector<LocalIndex> marked(const Comm& comm, const std::vector<Real>& indicators, Real theta);

}  // namespace sprekk::model
