// Residual and Jacobian of a model at given unknowns, for Python. `unknowns` are one array per block.
#pragma once

#include "bindings.hpp"
#include "model/model.hpp"

namespace sprekk::python {

/// Returns the residual at x for a step of length dt that ends at t, by blocks. It changes the time of the loads, but
/// no other state. `raw`: the rows of prescribed unknowns are reactions. Collective.
py::list residual_at(model::Model& model, const py::list& unknowns, Real t, Real dt, bool raw);

/// Returns the Jacobian at x as rows, columns and values of this rank's entries. Rows of prescribed unknowns are
/// identity, unless `raw`. Also returns the size of the system and, for each block, the numbers of this rank's
/// unknowns. Collective.
py::tuple jacobian_at(model::Model& model, const py::list& unknowns, Real t, Real dt, bool raw);

/// Returns (module, row, column, error) for each block of the Jacobian at x, compared with differences. Collective.
py::list jacobian_errors(model::Model& model, const py::list& unknowns, Real t, Real dt);

/// Computes the Jacobian A at the present state for a step of length dt, for responses and products. Collective.
void linearise(model::Model& model, Real dt);

/// Returns dx = A^-1 b by blocks, and the number of iterations. Rows of prescribed unknowns are dx_i = b_i. Throws an
/// Error if the solve does not converge. Collective.
py::tuple response_to(model::Model& model, const py::list& b, Real tolerance);

/// Returns the estimated energies of the discretisation errors of responses z at the present state, {name of the
/// estimator: one array for each response, by owned cells}. Empty without an estimator for the scene. Collective.
py::dict error_energies(model::Model& model, const py::list& responses);

/// Returns A x by blocks, also in rows of prescribed unknowns. Collective.
py::list product_with(model::Model& model, const py::list& x);

/// Returns the flags of prescribed unknowns by blocks.
py::list prescribed_in(const model::Model& model);

/// Returns the faces of owned cells on the boundary: number of the boundary, cell, nodes, centre, and area times
/// outward normal; volumes of local cells. With unknowns on facets also the facet of each face, and the centres of
/// owned facets.
py::dict boundary_of(const mesh::Mesh& mesh);

}  // namespace sprekk::python
