// Extension module sprekk._sprekk. mpi4py initialises MPI before the import and finalises it after the interpreter
// ends. Kokkos is initialised here and not finalised, because arrays may exist until the interpreter ends.
#include "bindings.hpp"

#include "base/check.hpp"
#include "base/heap.hpp"

#include <Kokkos_Core.hpp>

#ifndef SPREKK_VERSION
#define SPREKK_VERSION "unknown"
#endif

PYBIND11_MODULE(_sprekk, m) {
  namespace py = pybind11;
  int mpi = 0;
  MPI_Initialized(&mpi);
  if (!mpi) throw py::import_error("sprekk._sprekk needs MPI: import mpi4py.MPI first, as the package sprekk does");
  sprekk::base::keep_heap();
  if (!Kokkos::is_initialized()) Kokkos::initialize();
  py::register_exception<sprekk::Error>(m, "Error").doc() = "What is wrong, in the words of the program.";
  m.attr("version") = SPREKK_VERSION;
  sprekk::python::bind_scene(m);
  sprekk::python::bind_model(m);
}
