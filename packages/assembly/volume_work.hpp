// Work of a scalar field on a volume that depends on a vector field, as terms compiled once for all cells.
#pragma once

#include "assembly/term.hpp"

#include <optional>

namespace sprekk::assembly {

/// Scalar unknown p and the volume V that vector unknowns u change. Its derivative has the shape [entity, m], where m
/// is the number of vector unknowns of an entity.
///
/// | symbol    | shape       | unit          |                          |
/// | loop      |             |               | its entities             |
/// | u         |             | m             | block of vectors         |
/// | p         |             | Pa            | block of the scalar      |
/// | volume    | [entity, m] | m^2           | dV/du                    |
/// | reference | [entity]    | Pa            | p_0; empty: zero         |
struct VolumeCoupling {
  Loop loop;
  int u, p;
  View<Real**> volume;
  ConstView<Real*> reference = {};
};

/// Rows of u: -(p - p_0) dV/du, N. Row of p: rate V, m^3/s (2D: m^2/s). `rate`: default that of the state. `keep`: as
/// in Term.
Term make_volume_work(const Context& context, const VolumeCoupling& of, bool keep, std::optional<Real> rate = {});

/// Rows of u only.
Term make_volume_load(const Context& context, const VolumeCoupling& of, bool keep);

}  // namespace sprekk::assembly
