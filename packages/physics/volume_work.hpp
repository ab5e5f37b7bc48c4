// The work of a pressure on a volume that displacements change, as terms that are compiled once for all cells.
#pragma once

#include "assembly/term.hpp"

#include <optional>

namespace sprekk::physics {

/// A pressure p, or an unknown that acts like one, and the volume V [entity, m] that displacements u change, m being
/// the unknowns of u that an entity has.
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

/// Rows of u: -(p - p_0) dV/du, N; row of p: rate V, m^3/s (2D: m^2/s). `rate` is that of the state, unless given.
assembly::Term make_volume_work(const assembly::Context& context, const VolumeCoupling& of, bool keep,
                                std::optional<Real> rate = {});

/// The rows of u alone.
assembly::Term make_volume_load(const assembly::Context& context, const VolumeCoupling& of, bool keep);

}  // namespace sprekk::physics
