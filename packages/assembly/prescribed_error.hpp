// Interpolation error of prescribed values between nodes.
#pragma once

#include "assembly/constraints.hpp"

#include <vector>

namespace sprekk::assembly {

/// Returns the mean of g - I g over the prescribed faces around a node at time t, in the unit of the field [owned
/// unknown]. g is the prescribed value and I g its nodal interpolant. If g is curved, the difference has the same sign
/// everywhere. Adding the mean to the nodal values corrects this. The result is 0 where nothing is prescribed.
/// Collective; throws an Error on all ranks if g has no value between nodes.
fields::Vector prescribed_error(const mesh::Mesh& mesh, const fields::Layout& layout,
                                const std::vector<DirichletCondition>& conditions, Real t);

}  // namespace sprekk::assembly
