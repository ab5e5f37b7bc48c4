// List of all physics. Outside its own folder, a physics is named only here.
#pragma once

#include "physics/flow/flow.hpp"
#include "physics/heat/heat.hpp"
#include "physics/mechanics/mechanics.hpp"
#include "physics/poroelasticity/poroelasticity.hpp"
#include "physics/tracer/tracer.hpp"

namespace sprekk::physics {

template <template <class...> class Of>
using OfAll = Of<Mechanics,       //
                 Flow,            //
                 Poroelasticity,  //
                 Heat,            //
                 Tracer>;

}  // namespace sprekk::physics
