#!/usr/bin/env python3
"""Reference of the case free_sides, by an independent finite-element program: writes free_sides.csv. Requires
SciPy.

Unit square in plane strain with the fracture y = 1/2; bottom u = 0, top u = (d_t, d_n), traction-free sides.
The fracture sticks with the tangential stiffness K_t: u_y is continuous, u_x has two values on the fracture.
Quadratic elements are graded towards the corners and the fracture ends. The problem is linear: the solutions
for shear d = (1, 0) and compression d = (0, -1), which has no tangential jump, are superposed. Checks: change
between meshes, energy, equilibrium of the fracture, symmetry, a uniform solution."""
import sys
from pathlib import Path

import numpy as np
import scipy.integrate
import scipy.sparse as sps
import scipy.sparse.linalg as sl


def grade(n, r):
    """Symmetric points on [0, 1] graded towards both ends, n even."""
    t = np.linspace(0, 1, n // 2 + 1) ** r * 0.5
    return np.concatenate([t, 1 - t[-2::-1]])


def fem(n, G, lam, Kt, dt, dn, r=2.5):
    """Solves on n x 2n quadratic elements; returns resultants, jumps, displacements above the fracture, energy."""
    X = grade(n, r)
    Y = np.concatenate([0.5 * grade(n, r), 0.5 + 0.5 * grade(n, r)[1:]])
    nx, ny = n, 2 * n
    gx = np.sort(np.concatenate([X, 0.5 * (X[1:] + X[:-1])]))
    gy = np.sort(np.concatenate([Y, 0.5 * (Y[1:] + Y[:-1])]))
    NX, NY = len(gx), len(gy)
    jf = n * 2  # node row at y = 1/2

    def nid(i, j):
        return j * NX + i

    Nn = NX * NY
    extra = np.arange(NX) + 2 * Nn  # u_x of the upper side of the fracture
    ndof = 2 * Nn + NX
    ql = np.array([-np.sqrt(0.6), 0, np.sqrt(0.6)])
    qw = np.array([5, 8, 5]) / 9

    def L(s):
        return np.array([s * (s - 1) / 2, 1 - s * s, s * (s + 1) / 2])

    def dL(s):
        return np.array([s - 0.5, -2 * s, s + 0.5])

    D = np.array([[lam + 2 * G, lam, 0], [lam, lam + 2 * G, 0], [0, 0, G]])
    I, J, V = [], [], []
    for ey in range(ny):
        for ex in range(nx):
            hx = X[ex + 1] - X[ex]
            hy = Y[ey + 1] - Y[ey]
            ke = np.zeros((18, 18))
            for a, wa in zip(ql, qw):
                for b, wb in zip(ql, qw):
                    dx = np.outer(L(b), dL(a)).ravel() * 2 / hx
                    dy = np.outer(dL(b), L(a)).ravel() * 2 / hy
                    B = np.zeros((3, 18))
                    B[0, ::2] = dx
                    B[1, 1::2] = dy
                    B[2, ::2] = dy
                    B[2, 1::2] = dx
                    ke += B.T @ D @ B * wa * wb * hx * hy / 4
            dof = []
            for jj in range(3):
                for ii in range(3):
                    i, j = 2 * ex + ii, 2 * ey + jj
                    dof += [extra[i] if (j == jf and ey >= n) else 2 * nid(i, j), 2 * nid(i, j) + 1]
            I.append(np.repeat(dof, 18))
            J.append(np.tile(dof, 18))
            V.append(ke.ravel())
    for ex in range(nx):
        hx = X[ex + 1] - X[ex]
        me = np.zeros((3, 3))
        for a, wa in zip(ql, qw):
            me += np.outer(L(a), L(a)) * wa * hx / 2
        lo = [2 * nid(2 * ex + i, jf) for i in range(3)]
        up = [extra[2 * ex + i] for i in range(3)]
        for P, Q, s in ((lo, lo, 1), (up, up, 1), (lo, up, -1), (up, lo, -1)):
            I.append(np.repeat(P, 3))
            J.append(np.tile(Q, 3))
            V.append(s * Kt * me.ravel())
    K = sps.csr_matrix((np.concatenate(V), (np.concatenate(I), np.concatenate(J))), shape=(ndof, ndof))
    u = np.zeros(ndof)
    bot = np.array([nid(i, 0) for i in range(NX)])
    top = np.array([nid(i, NY - 1) for i in range(NX)])
    fix = np.concatenate([2 * bot, 2 * bot + 1, 2 * top, 2 * top + 1])
    u[2 * top] = dt
    u[2 * top + 1] = dn
    fr = np.setdiff1d(np.arange(ndof), fix)
    u[fr] = sl.spsolve(K[fr][:, fr].tocsc(), -(K @ u)[fr])
    R = K @ u
    jump = u[extra] - u[[2 * nid(i, jf) for i in range(NX)]]
    mid = NX // 2
    return dict(
        T=R[2 * top].sum(),
        N=-R[2 * top + 1].sum(),
        jmid=jump[mid],
        j0=jump[0],
        j1=jump[-1],
        ux1=u[extra[-1]],
        uxc=u[extra[mid]],
        E=0.5 * u @ (K @ u),
        jump=jump,
        x=gx,
    )


def main():
    ok = True
    G, lam, Kt = 1.0, 1.0, 2.0
    for name, dt, dn in (("shear d=(1,0)", 1.0, 0.0), ("compression d=(0,-1)", 0.0, -1.0)):
        print("#", name, "G=lam=1, K_t=2")
        p = None
        for n in (8, 16, 32):
            r = fem(n, G, lam, Kt, dt, dn)
            print(
                "  n=%2d resultants per width: T=%.9f N=%.9f  jump_t(centre)=%.9f jump_t(x=0)=%.9f jump_t(x=1)=%.9f u_x+(centre)=%.9f u_x+(x=1)=%.9f energy=%.9f"
                % (n, r["T"], r["N"], r["jmid"], r["j0"], r["j1"], r["uxc"], r["ux1"], r["E"])
            )
            if n == 32:
                ok &= abs(r["T"] - p["T"]) < 1e-4 and abs(r["N"] - p["N"]) < 2e-4 and abs(r["jmid"] - p["jmid"]) < 3e-4
            p = r
        ok &= abs(2 * r["E"] - (r["T"] * dt - r["N"] * dn)) < 1e-8
        if dt:
            ok &= abs(scipy.integrate.trapezoid(Kt * r["jump"], r["x"]) - r["T"]) < 2e-3
        else:
            ok &= np.abs(r["jump"]).max() < 1e-9
    shear, load = (fem(64, G, lam, Kt, *d, r=3.0) for d in ((1.0, 0.0), (0.0, -1.0)))
    with open(Path(__file__).with_suffix(".csv"), "w") as file:
        file.write("# first row: shear force, load; others: x, tangential jump\n")
        file.writelines(f"{a:.10f},{b:.10f}\n" for a, b in [(shear["T"], load["N"]), *zip(shear["x"], shear["jump"])])
    # lam = 0: no lateral strain, uniform compression N = 2G
    r = fem(8, 1.0, 0.0, 2.0, 0.0, -1.0)
    ok &= abs(r["N"] - 2) < 1e-9
    r = fem(16, 1e6, 1e3, 1e-5, 1.0, -1.0)
    print(
        "# push test of the thesis: jump_t(centre)=%.12f, jump_t(x=0)=%.12f, u_x above the fracture between %.9f (centre) and %.9f (x=1), N per width=%.3f (with uniaxial strain: 2.001e6)"
        % (r["jmid"], r["j0"], r["uxc"], r["ux1"], r["N"])
    )
    ok &= abs(r["jmid"] - 1) < 1e-9
    print("PASS" if ok else "FAIL")
    return ok


if __name__ == "__main__":
    sys.exit(0 if main() else 1)
