// Quantities of interest of fractures and their errors: slip, opening, normal force, shear force.
#pragma once

#include "estimate/mesh_error.hpp"
#include "mesh/mesh.hpp"

#include <vector>

namespace sprekk::physics {

/// Values and errors from outputs of a state and of its correction. Refers to the mesh.
class FractureGoals {
 public:
  using Outputs = std::vector<assembly::OutputField>;

  explicit FractureGoals(const mesh::Mesh& mesh) : mesh_(mesh) {}

  static bool knows(const std::string& what);
  static bool is_mean_jump(const std::string& what) { return what == "slip" || what == "opening"; }
  /// Adds a state to the history of slip. A face without slip in this step retains its previous slip error. Returns
  /// whether other faces slip than after the last call that returned true, with 0.1 of the slipping area. Collective.
  bool follow(const Outputs& outputs, const Outputs* corrected);
  /// Value and error; the error is infinite if `corrected` is null. Collective.
  estimate::Estimate evaluate(const estimate::Functional& J, const Outputs& outputs, const Outputs* corrected) const;
  /// Directions d in the face frames, [owned fracture face * dim], of a mean jump J, which is proportional to the
  /// integral of d . [[u]].
  std::vector<Real> directions(const estimate::Functional& J, const Outputs& outputs) const;

 private:
  /// Slip error of a face: signed component along the slip, and absolute value.
  struct SlipError {
    Real along = 0, size = 0;
  };
  std::vector<LocalIndex> faces_of(const estimate::Functional& J) const;

  const mesh::Mesh& mesh_;
  std::vector<Real> plastic_;           // plastic jump of the last state with a correction, as in its output
  std::vector<SlipError> slip_errors_;  // [owned fracture face]
  std::vector<char> slips_, noticed_;   // [owned fracture face] slip in the last step; at the last change
};

}  // namespace sprekk::physics
