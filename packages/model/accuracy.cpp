#include "model/accuracy.hpp"

#include "base/parameters.hpp"
#include "base/text.hpp"
#include "physics/scene.hpp"

#include <algorithm>

namespace sprekk::model {

namespace {

std::vector<estimate::QuantityKind> kinds() {
  std::vector<estimate::QuantityKind> all;
  physics::for_each_physics([&]<physics::HasEstimate P>(P) {
    for (auto& kind : P::Estimate::quantities()) all.push_back(std::move(kind));
  });
  return all;
}

/// Kind of the given name; all members are empty if there is none.
estimate::QuantityKind kind_of(const std::string& name) {
  for (const auto& kind : kinds())
    if (kind.name == name) return kind;
  return {};
}

}  // namespace

bool Quantity::is_norm() const { return kind_of(what).is_norm; }

std::string Quantity::unit(int dim) const {
  const auto kind = kind_of(what);
  return dim == 2 ? kind.unit_in_2d : kind.unit;
}

std::string Quantity::title() const {
  const auto kind = kind_of(what);
  if (kind.is_norm) return what;
  if (kind.has_component) return fmt::format("{} {} of \"{}\"", what, component, boundary);
  if (!well.empty()) return fmt::format("{} of \"{}\"", what, well);
  if (!boundary.empty()) return fmt::format("{} through \"{}\"", what, boundary);
  return what + " of " + (fractures.empty() ? "all fractures" : base::quoted_list(fractures));
}

Real Quantity::requested(Real value) const {
  return std::max(relative.value_or(0) * std::abs(value), absolute.value_or(0));
}

void Quantity::describe(base::Section& s) {
  std::vector<std::string> names, texts, units;
  for (const auto& kind : kinds()) {
    names.push_back(kind.name);
    texts.push_back(fmt::format("{}: {}", kind.name, kind.text));
    units.push_back(fmt::format("{} in {}", kind.name, kind.unit) +
                    (kind.unit == kind.unit_in_2d ? "" : fmt::format(" (2D: {})", kind.unit_in_2d)));
  }
  s.required_choice(what, "quantity", names, fmt::format("quantity of interest; {}", fmt::join(texts, "; ")));
  s.entry(fractures, "fractures", "-", "names of the fractures of the quantity; empty: all fractures");
  s.entry(boundary, "boundary", "-", "boundary of the quantity; its field must be prescribed there");
  s.entry(well, "well", "-", "well of the quantity");
  s.choice(component, "component", {"x", "y", "z"}, "direction of a force");
  s.entry(relative, "relative", "-", base::between(1e-8, 1),
          "tolerance of the error relative to the value at the end of the run");
  const auto own = unit(3);
  s.entry(absolute, "absolute",
          own == unit(2) && !own.empty() ? own
          : what.empty()                 ? "m"
                                         : "-",
          base::positive(), fmt::format("tolerance of the absolute error; {}", fmt::join(units, ", ")));
  if (s.complete() && !relative && !absolute) s.fail("needs \"relative\", \"absolute\", or both");
}

void Accuracy::describe(base::Section& s) {
  s.named_sections(quantities, "quantities", "quantities of interest with tolerances, by names of your choice");
  s.entry(cells, "cells", "-", base::at_least(1), "maximum number of cells of a mesh");
  s.entry(seconds, "seconds", "s", base::positive(),
          "wall-clock time after which no finer mesh begins; absent: no limit");
  s.entry(memory, "memory", "-", base::positive(),
          "maximum memory of all ranks for a mesh, in bytes; absent: no limit");
  s.choice(refinement, "refinement", {"repeated runs", "during the run"},
           "repeated runs: each run starts again on a finer mesh; during the run: a step with errors above the "
           "tolerances is repeated on a finer mesh, with the transferred state of its begin");
  if (s.complete() && quantities.empty()) s.fail("quantities", "missing; give at least one");
}

}  // namespace sprekk::model
