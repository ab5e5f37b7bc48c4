// Declarations shared by the translation units of the Python module.
#pragma once

#include "base/types.hpp"

#include <Teuchos_DefaultMpiComm.hpp>
#include <Teuchos_ParameterList.hpp>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <utility>
#include <vector>

namespace sprekk::python {

namespace py = pybind11;

/// Scene as entries, which may be changed to form another scene, and as input of models.
class SceneHandle;

/// Returns the communicator of an mpi4py.MPI.Comm, which must remain alive.
inline RCP<const Comm> comm_of(const py::object& comm) {
  return rcp(new Teuchos::MpiComm<int>(MPI_Comm_f2c(comm.attr("py2f")().cast<MPI_Fint>())));
}

/// Returns an array of this shape that owns the values, without a copy.
template <class T>
py::array_t<T> array_of(std::vector<T> values, std::vector<py::ssize_t> shape) {
  auto* owned = new std::vector<T>(std::move(values));
  const py::capsule owner(owned, [](void* p) { delete static_cast<std::vector<T>*>(p); });
  return py::array_t<T>(std::move(shape), owned->data(), owner);
}
template <class T>
py::array_t<T> array_of(std::vector<T> values) {
  const auto n = static_cast<py::ssize_t>(values.size());
  return array_of(std::move(values), {n});
}

void bind_scene(py::module_& m);
void bind_model(py::module_& m);

}  // namespace sprekk::python
