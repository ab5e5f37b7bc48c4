#include "model/accuracy.hpp"

#include "base/parameters.hpp"
#include "base/text.hpp"

#include <algorithm>

namespace sprekk::model {

const std::vector<std::string>& Quantity::names() {
  static const std::vector<std::string> all = {"slip", "opening", "normal force", "shear force", "reaction", "stress"};
  return all;
}

const char* Quantity::unit(int dim) const {
  if (what == "slip" || what == "opening") return "m";
  if (what == "stress") return dim == 2 ? "sqrt(J/m)" : "sqrt(J)";
  return dim == 2 ? "N/m" : "N";
}

std::string Quantity::title() const {
  if (what == "stress") return what;
  if (what == "reaction") return fmt::format("reaction {} of \"{}\"", component, boundary);
  return what + " of " + (fractures.empty() ? "all fractures" : base::quoted_list(fractures));
}

Real Quantity::asked(Real value) const {
  return std::max(relative.value_or(0) * std::abs(value), absolute.value_or(0));
}

void Quantity::describe(base::Section& s) {
  s.required_choice(what, "quantity", names(),
                    "slip, opening: the mean over the area of fractures; normal force, shear force: the integral of "
                    "compression, of the size of shear traction; reaction: the force that holds a boundary; stress: "
                    "root of the integral of s : C^-1 s, twice the "
                    "elastic energy");
  s.entry(fractures, "fractures", "-", "over which it is taken together; absent: all");
  s.entry(boundary, "boundary", "-", "of a reaction: where displacements are prescribed");
  s.choice(component, "component", {"x", "y", "z"}, "of a reaction");
  s.entry(relative, "relative", "-", base::between(1e-8, 1), "error by the value at the end of the run");
  const bool is_length = what == "slip" || what == "opening";
  s.entry(absolute, "absolute", is_length ? "m" : "-", base::positive(),
          "error; of forces in N (2D: N/m), of stress in sqrt(J) (2D: sqrt(J/m)); with relative the larger one counts");
  if (!s.complete()) return;
  if (!relative && !absolute) s.fail("needs \"relative\", \"absolute\", or both");
  if ((what == "stress" || what == "reaction") && !fractures.empty())
    s.fail("fractures", fmt::format("must be absent: \"{}\" is of none", what));
  if ((what == "reaction") != !boundary.empty())
    s.fail("boundary", what == "reaction" ? "missing; it is required of a reaction" : "is of a reaction alone");
}

void Accuracy::describe(base::Section& s) {
  s.named_sections(quantities, "quantities", "by names of your choice: numbers and the errors they may have");
  s.entry(cells, "cells", "-", base::at_least(1), "no mesh is to have more");
  s.entry(seconds, "seconds", "s", base::positive(), "of the clock, after which no finer mesh is begun; absent: any");
  s.entry(memory, "memory", "-", base::positive(), "bytes of all ranks that no mesh is to need more of; absent: any");
  if (s.complete() && quantities.empty()) s.fail("quantities", "missing; give at least one");
}

}  // namespace sprekk::model
