"""Flow code of a host, in numpy: finite volumes with two-point fluxes, on an own grid and without use of Sprekk.

The C++ version is apps/hosts/reservoir.hpp."""
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve


class Grid:
    """Unit square with n x n cells, and a fracture below the cells of row n/2 in the columns first..last-1."""

    def __init__(self, n):
        self.n, self.h = n, 1 / n
        self.plane, self.first, self.last = n // 2, n // 4, n - n // 4
        self.n_cells, self.n_faces = n * n, self.last - self.first

    def cells_at(self, x):
        """Returns the indices of the cells at points [point, 2]."""
        i, j = np.floor(np.asarray(x) / self.h).astype(int).T
        return i + self.n * j

    def faces_at(self, x):
        return self.n_cells + np.floor(np.asarray(x)[:, 0] / self.h).astype(int) - self.first

    def connections(self):
        """Returns pairs of neighbours [k, 2]: two cells, a cell and a fracture face, two fracture faces."""
        cells = np.arange(self.n_cells).reshape(self.n, self.n)  # [j, i]
        faces = self.n_cells + np.arange(self.n_faces)
        along = np.stack([cells[:, :-1], cells[:, 1:]], axis=-1).reshape(-1, 2)
        across = np.stack([cells[:-1], cells[1:]], axis=-1)
        cut = np.zeros(across.shape[:2], bool)
        cut[self.plane - 1, self.first:self.last] = True
        beside = across[self.plane - 1, self.first:self.last]
        return (np.concatenate([along, across[~cut]]),
                np.concatenate([np.stack([beside[:, side], faces], axis=1) for side in (0, 1)]),
                np.stack([faces[:-1], faces[1:]], axis=1))


class Reservoir:
    """Implicit time steps with given volume changes of the rock.

    The array `room` contains the gained pore volume of cells, m^3, then the widening of faces, m.

    mobility       k/mu, m^2/(Pa s)
    storage        1/M at constant strain, 1/Pa
    stabilisation  1/Pa; times h^2 it is the mobility of dp/dt
    viscosity      Pa s
    aperture       initial value, m
    least          lower bound of the aperture, m
    injection      into the fracture, growth rate of the flux, m/s^2"""

    def __init__(self, grid, mobility, storage, stabilisation, viscosity, aperture, least, injection):
        self.grid, self.mobility, self.storage, self.stabilisation = grid, mobility, storage, stabilisation
        self.viscosity, self.aperture, self.least, self.injection = viscosity, aperture, least, injection
        self.n = grid.n_cells + grid.n_faces
        self.old, self.old_room = np.zeros(self.n), np.zeros(self.n)

    def pressures(self, t, dt, room, last, yields):
        """Returns the pressures, Pa, at the end t of a step dt, s.

        The array `room` belongs to the pressures `last`. The estimates `yields` of its derivative
        by pressure are for rock, 1/Pa, and for the fracture, m/Pa."""
        h, rock = self.grid.h, np.arange(self.n) < self.grid.n_cells
        stored = np.where(rock, h**2 * self.storage, 0)
        guess = np.where(rock, h**2 * yields[0], h * yields[1])
        b = stored * self.old + guess * last - np.where(rock, 1, h) * (room - self.old_room)
        b += np.where(rock, 0, dt * h * self.injection * t)
        rows, columns, values = [np.arange(self.n)], [np.arange(self.n)], [stored + guess]
        for (a, c), T, rate in self.transmissibilities(dt, room):
            rows += [a, c, a, c]
            columns += [a, c, c, a]
            values += [T + rate, T + rate, -T - rate, -T - rate]
            flow = rate * (self.old[a] - self.old[c])
            np.add.at(b, a, flow)
            np.add.at(b, c, -flow)
        A = coo_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))).tocsc()
        return spsolve(A, b)

    def transmissibilities(self, dt, room):
        """Yields (pairs, T dt, factor of the increment of the pressure difference)."""
        cells, sides, faces = self.grid.connections()
        h = self.grid.h
        ones = np.ones(len(cells))
        yield cells.T, self.mobility * dt * ones, self.stabilisation * h**2 * ones
        yield sides.T, 2 * self.mobility * dt * np.ones(len(sides)), np.zeros(len(sides))
        T = np.maximum(self.least, self.aperture + room)**3 / (12 * self.viscosity)
        Ta, Tb = T[faces].T
        yield faces.T, 2 * Ta * Tb / (Ta + Tb) / h * dt, np.zeros(len(faces))

    def accept(self, pressures, room):
        self.old, self.old_room = pressures, room
