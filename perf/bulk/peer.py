"""Solves the block of bulk.py in DOLFINx with conjugate gradients of PETSc, as a separate program on one rank.

    peer.py DIR EDGE YOUNG POISSON TRACTION_X,Y,Z RESIDUAL NAME...    a NAME is one of SOLVERS

Writes CPU seconds, iterations and true residual of each solver to DIR/peer.json, and its displacement, [point
of the lattice, component], to DIR/NAME.npy."""
import json
import sys
from pathlib import Path
from time import process_time

import numpy as np
import ufl
from dolfinx import fem, la, mesh
from mpi4py import MPI
from petsc4py import PETSc

SMOOTHER = {"mg_levels_ksp_type": "chebyshev", "mg_levels_pc_type": "jacobi", "mg_levels_esteig_ksp_type": "cg", "mg_levels_ksp_chebyshev_esteig_steps": 20}
SOLVERS = {  # preconditioner options
    "gamg": {"pc_type": "gamg", **SMOOTHER},
    "hypre": {"pc_type": "hypre", "pc_hypre_type": "boomeramg", "pc_hypre_boomeramg_strong_threshold": 0.5, "pc_hypre_boomeramg_coarsen_type": "HMIS",
              "pc_hypre_boomeramg_interp_type": "ext+i", "pc_hypre_boomeramg_P_max": 4},
}
COMPILER = {"cffi_extra_compile_args": ["-O3", "-march=native"]}


def timed(seconds, name, work):
    """Returns the result of work() and adds its CPU seconds under `name`."""
    begin = process_time()
    result = work()
    seconds[name] = seconds.get(name, 0) + process_time() - begin
    return result


def forms(space, young, poisson, traction):
    """Compiled forms of stiffness and load."""
    domain = space.mesh
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    mu, lam = young / 2 / (1 + poisson), young * poisson / (1 + poisson) / (1 - 2 * poisson)
    stress = 2 * mu * ufl.sym(ufl.grad(u)) + lam * ufl.tr(ufl.grad(u)) * ufl.Identity(3)
    top = mesh.locate_entities_boundary(domain, 2, lambda x: np.isclose(x[2], 1))
    ds = ufl.Measure("ds", domain, subdomain_data=mesh.meshtags(domain, 2, np.sort(top), np.full(len(top), 1, np.int32)))
    force = fem.Constant(domain, np.array(traction))
    return (fem.form(ufl.inner(stress, ufl.sym(ufl.grad(v))) * ufl.dx, jit_params=COMPILER), fem.form(ufl.inner(force, v) * ds(1), jit_params=COMPILER))


def assemble(stiffness, load, condition, seconds):
    def fill():
        A = fem.petsc.create_matrix(stiffness)
        fem.petsc.assemble_matrix(A, stiffness, bcs=[condition])
        A.assemble()
        b = fem.petsc.assemble_vector(load)
        fem.petsc.apply_lifting(b, [stiffness], bcs=[[condition]])
        fem.petsc.set_bc(b, [condition])
        return A, b

    return timed(seconds, "assembly", fill)


def rigid_modes(space):
    """Near-null space of three translations and three rotations, orthonormal."""
    x = space.tabulate_dof_coordinates()
    modes = [la.create_petsc_vector(space.dofmap.index_map, space.dofmap.index_map_bs) for _ in range(6)]
    for k, mode in enumerate(modes):
        values = np.zeros((len(x), 3))
        if k < 3:
            values[:, k] = 1
        else:
            i, j = (k - 2) % 3, (k - 1) % 3
            values[:, i], values[:, j] = -x[:, j], x[:, i]
        mode.array[:] = values.ravel()
    la.orthonormalize(modes)
    return PETSc.NullSpace().create(vectors=modes)


def solve(A, b, options, residual, space, seconds):
    """Returns the solution and the number of iterations, from zero to the relative residual."""
    database = PETSc.Options()
    for name, value in options.items():
        database[name] = value
    solver = PETSc.KSP().create(A.comm)
    solver.setType("cg")
    solver.setNormType(PETSc.KSP.NormType.UNPRECONDITIONED)
    solver.setTolerances(rtol=residual)
    solver.setFromOptions()
    solver.setOperators(A)

    def setup():
        A.setNearNullSpace(rigid_modes(space))
        solver.setUp()

    u = b.duplicate()
    timed(seconds, "set-up", setup)
    timed(seconds, "solve", lambda: solver.solve(b, u))
    for name in options:
        database.delValue(name)
    return u, solver.getIterationNumber()


def main(directory, edge, young, poisson, traction, residual, *names):
    domain = mesh.create_box(MPI.COMM_WORLD, [[0, 0, 0], [1, 1, 1]], [int(edge)] * 3, mesh.CellType.tetrahedron)
    fem.VectorFunctionSpace(domain, ("Lagrange", 1))  # compiles
    numbering = {}
    space = timed(numbering, "assembly", lambda: fem.VectorFunctionSpace(domain, ("Lagrange", 1)))
    bottom = mesh.locate_entities_boundary(domain, 2, lambda x: np.isclose(x[2], 0))
    condition = fem.dirichletbc(np.zeros(3), fem.locate_dofs_topological(space, 2, bottom), space)
    stiffness, load = forms(space, float(young), float(poisson), [float(t) for t in traction.split(",")])
    place = np.rint(space.tabulate_dof_coordinates() * int(edge)).astype(int) @ (1, int(edge) + 1, (int(edge) + 1)**2)
    found = {}
    for name in names:
        seconds = dict(numbering)
        A, b = assemble(stiffness, load, condition, seconds)
        u, iterations = solve(A, b, SOLVERS[name], float(residual), space, seconds)
        found[name] = {"unknowns": A.getSize()[0], "iterations": iterations, "residual": (b - A * u).norm() / b.norm(), "seconds": seconds}
        values = np.empty((len(place), 3))
        values[place] = u.array.reshape(-1, 3)
        np.save(Path(directory) / f"{name}.npy", values)
    (Path(directory) / "peer.json").write_text(json.dumps(found))


if __name__ == "__main__":
    main(*sys.argv[1:])
