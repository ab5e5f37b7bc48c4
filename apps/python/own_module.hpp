// Modules that are written in Python.
#pragma once

#include "bindings.hpp"
#include "model/model.hpp"

#include <memory>
#include <string>

namespace sprekk::python {

using MeshOf = py::dict (*)(const mesh::Mesh&);

/// What went wrong first in Python on this rank, where others cannot know of it at once; empty: nothing.
using Failure = std::shared_ptr<std::string>;

/// What makes C++ modules of a list of sprekk.Module; nothing of an empty one. An exception in a residual goes to
/// `failure`: the solver must then be stopped on all ranks.
model::ModuleFactory own_modules(const py::object& modules, MeshOf mesh_of, const Failure& failure);

}  // namespace sprekk::python
