#include "model/accuracy.hpp"

#include "base/parameters.hpp"
#include "base/text.hpp"
#include "physics/scene.hpp"

#include <algorithm>

namespace sprekk::model {

std::vector<std::string> Quantity::names() {
  std::vector<std::string> all;
  physics::for_each_physics([&](auto physics) {
    for (auto& name : physics.quantities()) all.push_back(std::move(name));
  });
  return all;
}

bool Quantity::is_of_outputs() const {
  const auto known = {"slip", "opening", "normal force", "shear force", "reaction"};
  return std::any_of(known.begin(), known.end(), [&](const char* name) { return what == name; });
}

const char* Quantity::unit(int dim) const {
  if (what == "slip" || what == "opening") return "m";
  if (what == "stress") return dim == 2 ? "sqrt(J/m)" : "sqrt(J)";
  if (what == "flux") return dim == 2 ? "sqrt(W/m)" : "sqrt(W)";
  if (what == "pressure") return "Pa";
  if (what == "flow") return dim == 2 ? "m^2/s" : "m^3/s";
  return dim == 2 ? "N/m" : "N";
}

std::string Quantity::title() const {
  if (what == "stress" || what == "flux") return what;
  if (what == "reaction") return fmt::format("reaction {} of \"{}\"", component, boundary);
  if (!well.empty()) return fmt::format("{} of \"{}\"", what, well);
  if (!boundary.empty()) return fmt::format("{} through \"{}\"", what, boundary);
  return what + " of " + (fractures.empty() ? "all fractures" : base::quoted_list(fractures));
}

Real Quantity::asked(Real value) const {
  return std::max(relative.value_or(0) * std::abs(value), absolute.value_or(0));
}

void Quantity::describe(base::Section& s) {
  s.required_choice(what, "quantity", names(),
                    "slip, opening: the mean over the area of fractures; normal force, shear force: the integral of "
                    "compression, of the size of shear traction; reaction: the force that holds a boundary; stress: "
                    "root of the integral of s : C^-1 s, twice the elastic energy; pressure: of a well, or the mean "
                    "over fractures; flow: of fluid into the domain from a well or through a boundary; flux: root of "
                    "the power that the flow of fluid dissipates");
  s.entry(fractures, "fractures", "-", "over which it is taken together; absent: all");
  s.entry(boundary, "boundary", "-", "of a reaction: where displacements are prescribed; of a flow: where pressure is");
  s.entry(well, "well", "-", "of a pressure: with a rate; of a flow: with a pressure");
  s.choice(component, "component", {"x", "y", "z"}, "of a reaction");
  s.entry(relative, "relative", "-", base::between(1e-8, 1), "error by the value at the end of the run");
  const bool is_length = what.empty() || what == "slip" || what == "opening", is_pressure = what == "pressure";
  s.entry(absolute, "absolute",
          is_length     ? "m"
          : is_pressure ? "Pa"
                        : "-",
          base::positive(),
          "error; of forces in N (2D: N/m), of stress in sqrt(J) (2D: sqrt(J/m)), of flow in m^3/s (2D: m^2/s), of "
          "flux in sqrt(W) (2D: sqrt(W/m)); with relative the larger one counts");
  if (s.complete() && !relative && !absolute) s.fail("needs \"relative\", \"absolute\", or both");
}

void Accuracy::describe(base::Section& s) {
  s.named_sections(quantities, "quantities", "by names of your choice: numbers and the errors they may have");
  s.entry(cells, "cells", "-", base::at_least(1), "no mesh is to have more");
  s.entry(seconds, "seconds", "s", base::positive(), "of the clock, after which no finer mesh is begun; absent: any");
  s.entry(memory, "memory", "-", base::positive(), "bytes of all ranks that no mesh is to need more of; absent: any");
  if (s.complete() && quantities.empty()) s.fail("quantities", "missing; give at least one");
}

}  // namespace sprekk::model
