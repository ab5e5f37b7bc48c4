// The quantities of the section Accuracy: their values, how far these are off, and which cells are to blame.
#pragma once

#include "model/error_estimate.hpp"

namespace sprekk::model {

/// Follows the states of a model, which it refers to. All members are collective unless they return stored data.
class Goals {
 public:
  struct Estimate {
    Real value = 0;
    Real error = 0;  ///< by the mesh; infinite where there is no estimate
  };

  explicit Goals(Model& model);

  /// Whether a state has to be added: the last one, and with slip, which adds up, each. Stored data.
  bool need(bool last) const;
  /// Takes the present state, with its outputs and their errors. A face that does not slip in a step keeps what its
  /// slip lacked before. `last`: no other state follows.
  void add(const std::vector<assembly::OutputField>& outputs, const ErrorEstimate& estimate, ErrorEstimator& estimator,
           bool last);
  /// Weighs cells for the state added last: if it is the `last` one, and for slip where others slip than before.
  void weigh(const std::vector<assembly::OutputField>& outputs, const ErrorEstimate& estimate,
             ErrorEstimator& estimator, bool last);

  /// What flows is in error, too, which does not fall with the order of cells. Stored data.
  bool any_flux() const { return !fluxes_.empty() && !fluxes_.back().empty(); }
  /// Of the last state, by the names of the quantities.
  const std::map<std::string, Estimate>& estimates() const { return estimates_; }

  /// [owned cell] the largest over quantities of weight * the cell's share in the bound of the error.
  std::vector<Real> indicators(const std::map<std::string, Real>& weights) const;

 private:
  /// Of the slip of a face: its error, with its sign and without.
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
  std::vector<Real> plastic_;                             // jump of the last state, as in its output
  std::vector<Lack> lacks_;                               // [owned fracture face]
  std::vector<char> slips_, weighted_;  // [owned fracture face] in the last step, and when cells were weighted last
  std::map<std::string, Estimate> estimates_;
  std::map<std::string, std::vector<Real>> bounds_;  // [quantity][owned cell]
};

/// The fewest cells that have at least the share `theta` of the sum of indicators, of which the largest come first; but
/// for that those within a factor of 2^(1/8) come together: so the choice does not depend on how ranks round sums.
/// Collective.
std::vector<LocalIndex> marked(const Comm& comm, const std::vector<Real>& indicators, Real theta);

}  // namespace sprekk::model
