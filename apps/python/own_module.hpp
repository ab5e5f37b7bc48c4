// Modules written in Python.
#pragma once

#include "bindings.hpp"
#include "model/model.hpp"

#include <memory>
#include <string>

namespace sprekk::python {

using MeshOf = py::dict (*)(const mesh::Mesh&);

/// First message of a failure in Python on this rank, before other ranks are informed; empty: none.
using Failure = std::shared_ptr<std::string>;

/// Returns a factory of C++ modules for a list of sprekk.Module; empty for an empty list. Exceptions in residuals are
/// saved in `failure`. The solver must then be stopped on all ranks.
model::ModuleFactory own_modules(const py::object& modules, MeshOf mesh_of, const Failure& failure);

}  // namespace sprekk::python
