// Replacement of Sacado's header of this name: only the type of numbers with derivatives, for any version of Kokkos.
// Other parts of Sacado depend on the views of its own Kokkos version.
#pragma once

#include <Kokkos_Core.hpp>

#define TRILINOS_NO_CONFIG_H
#define HAVE_SACADO_CXX11
#define SACADO_FUNCTION KOKKOS_FUNCTION
#define SACADO_DEFAULTED_FUNCTION KOKKOS_DEFAULTED_FUNCTION
#define SACADO_INLINE_FUNCTION KOKKOS_INLINE_FUNCTION
#define SACADO_FORCEINLINE_FUNCTION KOKKOS_FORCEINLINE_FUNCTION

#include <Sacado_Fad_SFad.hpp>
