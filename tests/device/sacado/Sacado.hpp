// In place of Sacado's header of this name: the type of numbers with derivatives, for any Kokkos. The rest of Sacado
// knows the views of the Kokkos that it came with.
#pragma once

#include <Kokkos_Core.hpp>

#define TRILINOS_NO_CONFIG_H
#define HAVE_SACADO_CXX11
#define SACADO_FUNCTION KOKKOS_FUNCTION
#define SACADO_DEFAULTED_FUNCTION KOKKOS_DEFAULTED_FUNCTION
#define SACADO_INLINE_FUNCTION KOKKOS_INLINE_FUNCTION
#define SACADO_FORCEINLINE_FUNCTION KOKKOS_FORCEINLINE_FUNCTION

#include <Sacado_Fad_SFad.hpp>
