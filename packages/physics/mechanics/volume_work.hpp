// Work of a pressure on a volume that depends on displacements, as terms compiled once for all cells.
#pragma once

#include "assembly/term.hpp"

#include <optional>

namespace sprekk::physics {

/// Pressure p (or an equivalent unknown) and the volume V that displacements u change. Its derivative has the shape
/// [entity, m], where m is the number of displacement unknowns of an entity.
///
/// | symbol    | shape       | unit          |                          |
/// | loop      |             |               | its entities             |
/// | u         |             | m             | block of displacements   |
/// | p         |             | Pa            | block of the pressure    |
/// | volume    | [entity, m] | m^2           | dV/du                    |
/// | reference | [entity]    | Pa            | p_0; empty: zero         |
struct VolumeCoupling {
  assembly::Loop loop;
  int u, p;
  View<Real**> volume;
  ConstView<Real*> reference = {};
};

/// Rows of u: -(p - p_0) dV/du, N. Row of p: rate V, m^3/s (2D: m^2/s). `rate`: default that of the state. `keep`: as
/// in assembly::Term.
assembly::Term make_volume_work(const assembly::Context& context, const VolumeCoupling& of, bool keep,
                                std::optional<Real> rate = {});

/// Rows of u only.
assembly::Term make_volume_load(const assembly::Context& context, const VolumeCoupling& of, bool keep);

}  // namespace sprekk::physics
