"""Replacement of pypardiso, PorePy's preferred direct solver, which Debian does not have.

It calls MUMPS through PETSc, with two steps of iterative refinement (ICNTL(10))."""
import gc

import petsc4py
import scipy.sparse as sps

petsc4py.init(["peer"])
from petsc4py import PETSc  # noqa: E402


def spsolve(matrix, right):
    rows = sps.csr_matrix(matrix)
    rows.sort_indices()
    A = PETSc.Mat().createAIJ(size=rows.shape, csr=(rows.indptr.astype(PETSc.IntType), rows.indices.astype(PETSc.IntType), rows.data),
                              comm=PETSc.COMM_SELF)
    solver = PETSc.KSP().create(PETSc.COMM_SELF)
    solver.setOperators(A)
    solver.setType("preonly")
    factors = solver.getPC()
    factors.setType("lu")
    factors.setFactorSolverType("mumps")
    factors.setFactorSetUpSolverType()
    mumps = factors.getFactorMatrix()
    mumps.setMumpsIcntl(14, 80)  # memory margin over the estimate, per cent
    mumps.setMumpsIcntl(10, 2)
    x, b = A.createVecRight(), PETSc.Vec().createWithArray(right.astype(float), comm=PETSc.COMM_SELF)
    solver.solve(b, x)
    if solver.getConvergedReason() < 0:
        raise RuntimeError(f"MUMPS failed: {solver.getConvergedReason()}")
    found = x.getArray().copy()
    for thing in (mumps, factors, solver, A, x, b):
        thing.destroy()
    gc.collect()
    PETSc.garbage_cleanup()
    return found
