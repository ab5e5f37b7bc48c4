// Section Accuracy of a scene: quantities of interest and their tolerances.
#pragma once

#include "base/types.hpp"
#include "estimate/mesh_error.hpp"

#include <map>
#include <optional>
#include <string>

namespace sprekk::base {
class Section;
}

namespace sprekk::model {

/// Quantity of interest in the last state.
struct Quantity : estimate::Functional {   ///< `what`: one of the quantities() of a physics
  std::optional<Real> relative, absolute;  ///< tolerances; the larger one applies

  std::string unit(int dim) const;
  /// Returns true for energy norms, which cover the whole domain.
  bool is_norm() const;
  /// Text `QUANTITY of "fault 3"`.
  std::string title() const;
  /// Tolerance at a value, in the unit of the quantity. It is 0 if the value is 0 and there is no absolute tolerance.
  Real requested(Real value) const;
  void describe(base::Section& section);
};

struct Accuracy {
  std::map<std::string, Quantity> quantities;  ///< by user-defined names
  long long cells = 1000000;                   ///< upper limit of the cells of a mesh
  std::optional<Real> seconds;                 ///< limit of the total wall-clock time, s
  std::optional<Real> memory;                  ///< memory limit over all ranks, bytes
  std::string refinement = "repeated runs";

  void describe(base::Section& section);
  /// Returns whether the mesh is refined between steps, with transfer of the state.
  bool refines_during_run() const { return refinement == "during the run"; }
  /// Quantities without their tolerances, by name.
  std::map<std::string, estimate::Functional> functionals() const { return {quantities.begin(), quantities.end()}; }
};

}  // namespace sprekk::model
