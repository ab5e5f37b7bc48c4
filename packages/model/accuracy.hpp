// The section Accuracy of a scene: which numbers a run is to reach, and with what error.
#pragma once

#include "base/types.hpp"
#include "physics/mesh_error.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::base {
class Section;
}

namespace sprekk::model {

/// A number of the last state.
struct Quantity : physics::Functional {    ///< `what`: of a physics' quantities()
  std::string component = "x";             ///< of a reaction
  std::optional<Real> relative, absolute;  ///< the error that is asked for, the larger of both

  std::string unit(int dim) const;
  /// A state's outputs or reactions tell its value, without an estimate.
  bool is_of_outputs() const;
  /// It is an energy's root.
  bool of_all() const { return what == "stress" || what == "flux"; }
  /// `slip of "fault 3"`.
  std::string title() const;
  /// The error that is asked for at a value; 0 where that is 0 and nothing else is said.
  Real asked(Real value) const;
  void describe(base::Section& section);
};

struct Accuracy {
  std::map<std::string, Quantity> quantities;  ///< by names of the user
  long long cells = 1000000;                   ///< no mesh has more
  std::optional<Real> seconds;                 ///< of the wall clock, in all
  std::optional<Real> memory;                  ///< bytes of all ranks

  void describe(base::Section& section);
};

}  // namespace sprekk::model
