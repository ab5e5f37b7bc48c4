// The physics that there are. One line each here, and nothing else outside of its room.
#pragma once

#include "physics/flow/flow.hpp"
#include "physics/heat/heat.hpp"
#include "physics/mechanics/mechanics.hpp"
#include "physics/poroelasticity/poroelasticity.hpp"

namespace sprekk::physics {

template <template <class...> class Of>
using OfAll = Of<Mechanics,       //
                 Flow,            //
                 Poroelasticity,  //
                 Heat>;

}  // namespace sprekk::physics
