// Fractures that a growing tip meets: margin of crossing.
#pragma once

#include "laws/kink.hpp"
#include "physics/mechanics/front_fields.hpp"
#include "physics/mechanics/front_loads.hpp"

#include <functional>

namespace sprekk::physics::front {

/// Point in an owned cell: stress and tensile strength, Pa.
struct InCell {
  Vector x;
  Matrix stress;
  Real strength;
};

/// Returns laws::margin_of_crossing() at the first fracture on the line from a tip along `ahead`; NaN: there is none.
/// The stress is that of the state on the face met (contact) and in the cell beyond, without the crack fields of the
/// tip, K (Pa m^0.5). The bound of the interface is that of its joint without earlier slip. 2D, collective.
///   `traction`: [owned fracture face] of the contact, Pa, global components
Real margin_of_crossing(const Setting& setting, const mesh::FrontPoint& front, const std::array<Real, 3>& K,
                        const Vector& ahead, const std::vector<Real>& traction,
                        const std::function<InCell(LocalIndex)>& in_cell);

}  // namespace sprekk::physics::front
