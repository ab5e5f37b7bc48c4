// Residual and Jacobian of a model at given unknowns, for Python. `unknowns` are one array per block.
#pragma once

#include "bindings.hpp"
#include "model/model.hpp"

namespace sprekk::python {

/// Returns the residual at x for a step of length dt that ends at t, by blocks. It changes the time of the loads, but
/// no other state. Collective.
py::list residual_at(model::Model& model, const py::list& unknowns, Real t, Real dt);

/// Returns the Jacobian at x as rows, columns and values of this rank's entries. Rows of prescribed unknowns are
/// identity. Also returns the size of the system and, for each block, the numbers of this rank's unknowns. Collective.
py::tuple jacobian_at(model::Model& model, const py::list& unknowns, Real t, Real dt);

/// Returns (module, row, column, error) for each block of the Jacobian at x, compared with differences. Collective.
py::list jacobian_errors(model::Model& model, const py::list& unknowns, Real t, Real dt);

}  // namespace sprekk::python
