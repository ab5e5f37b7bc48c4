"""Tensors of an inner region, from means of its cells and fracture faces under linear conditions."""
import numpy as np

from .. import _sprekk
from .components import matrix_of, n_components, unit_stresses


class Inner:
    """Cells in the middle of a block: those whose centre lies in its bounding box, reduced by a factor.

    A fracture face counts by half for each adjacent cell in the region. Elastic constants and permeabilities of the
    rock must be numbers, since strains and gradients of the rock follow from its stress and flux."""

    def __init__(self, scene, boundary, share):
        self.scene, self.entries, self.mesh, self.comm = scene, scene.all_entries, boundary.mesh, boundary.model.comm
        mesh, self.dim = self.mesh, self.mesh.dim
        centres = mesh.coordinates[mesh.corners].mean(axis=1)
        low, high = boundary.corners()
        inside = np.all(np.abs(centres - (low + high) / 2) <= share * (high - low) / 2, axis=1)
        self.volumes = np.where(inside, boundary.cell_volume, 0)[:mesh.n_owned_cells]
        self.volume = self.comm.allreduce(float(self.volumes.sum()))
        if not self.volume > 0:
            raise _sprekk.Error(f"{scene.name}: no cell lies in the inner region, a share of {share:g} of the block")
        near = np.where(mesh.face_cells < 0, 0.0, inside[mesh.face_cells])  # [face, side]
        self.areas = mesh.face_area * near.mean(axis=1) if len(mesh.face_area) else np.zeros(0)

    def mean(self, of_cells, of_faces=None):
        """Returns the mean over the region of values of cells, and of values of faces per area."""
        total = np.tensordot(self.volumes, of_cells, 1)
        if of_faces is not None:
            total = total + np.tensordot(self.areas, of_faces, 1)
        return self.comm.allreduce(total) / self.volume

    def of_rock(self, matrix_of):
        """Returns matrix_of(entries of the rock) of each owned cell."""
        matrices = []
        for region in self.mesh.regions:
            own = self.entries.get("Regions", {}).get(region, {}).get("material")
            try:
                matrices.append(matrix_of(self.entries["Materials"][own or self.entries["Bulk"]["material"]]))
            except (TypeError, ValueError):
                raise _sprekk.Error(f"{self.scene.name}: an inner region needs rock with numbers as elastic constants and "
                                    "permeability") from None
        return np.array(matrices)[self.mesh.cell_region[:self.mesh.n_owned_cells]]

    def _refuse_resistant_fractures(self):
        """Raises an error for drops of pressure across fractures, which the mean gradient does not contain."""
        for name, material in self.entries["Materials"].items():
            if str(material.get("normal permeability", "inf")) not in ("inf", "infinite"):
                raise _sprekk.Error(f'{self.scene.name}: Sprekk > Materials > {name} > "normal permeability": must be '
                                    "absent for an inner region: its mean gradient contains no drop of pressure across "
                                    "fractures")

    def permeability(self, model, responses):
        """Returns K from pressures for each direction, given as lists of unknowns by block."""
        self._refuse_resistant_fractures()
        blocks = model._handle.blocks()
        resistance = self.of_rock(lambda rock: np.linalg.inv(permeability_of(rock, self.dim)))
        fluxes, gradients = [], []
        for response in responses:
            with shifted(model, blocks, response):
                flux = model.output("Darcy velocity")[:, :self.dim]
                along = model.output("fluid flux")[:, :self.dim] if self.mesh.fractures else None
            fluxes.append(self.mean(flux, along))
            gradients.append(-self.mean(np.einsum("cij,cj->ci", resistance, flux)))
        return -np.array(fluxes).T @ np.linalg.inv(np.array(gradients).T)

    def compliance(self, model, responses):
        """Returns S from displacements for each unit strain, given as lists of unknowns by block."""
        blocks, order = model._handle.blocks(), [0, 1, 3] if self.dim == 2 else [0, 1, 2, 4, 5, 3]
        rock = self.of_rock(lambda entries: compliance_of(entries, self.dim))
        before, jump_before = outputs(model)
        stresses, strains = [], []
        for response in responses:
            with shifted(model, blocks, response):
                stress, jump = outputs(model)
            stress = (stress - before)[:, order]
            strain = self.mean(np.einsum("cij,cj->ci", rock, stress))
            if jump is not None:
                opened = np.einsum("fi,fj->fij", self.mesh.face_frame[:, 0], jump - jump_before)
                opened = (opened + opened.transpose(0, 2, 1)) / 2
                strain = strain + np.array([np.sum(unit * self.comm.allreduce(np.tensordot(self.areas, opened, 1)))
                                            for unit in unit_stresses(self.dim)]) / self.volume
            stresses.append(self.mean(stress))
            strains.append(strain)
        return np.array(strains).T @ np.linalg.inv(np.array(stresses).T)


def outputs(model):
    return model.output("stress"), model.output("jump") if model.mesh.fractures else None


class shifted:
    """Context in which a response is added to the unknowns of a model."""

    def __init__(self, model, blocks, response):
        self.model, self.blocks, self.response = model, blocks, response

    def __enter__(self):
        self.before = [np.array(self.model.field(name)) for name in self.blocks]
        for name, values, change in zip(self.blocks, self.before, self.response):
            self.model.field(name)[:] = values + np.reshape(change, values.shape)

    def __exit__(self, *_):
        for name, values in zip(self.blocks, self.before):
            self.model.field(name)[:] = values


def permeability_of(rock, dim):
    """Returns the permeability of rock; a scene lists XX, YY, XY or XX, YY, ZZ, XY, YZ, XZ."""
    values = [float(value) for value in rock["permeability"]]
    if len(values) <= dim:
        return np.diag(np.broadcast_to(values, dim))
    return matrix_of(values if dim == 2 else np.array(values)[[0, 1, 2, 4, 5, 3]])


def compliance_of(rock, dim):
    """Returns the compliance of isotropic rock; in 2D in plane strain."""
    young, poisson, G = elastic_constants(rock)
    n = n_components(dim)
    stiffness = np.diag([2 * G] * dim + [G] * (n - dim))
    stiffness[:dim, :dim] += young * poisson / (1 + poisson) / (1 - 2 * poisson)
    return np.linalg.inv(stiffness)


def elastic_constants(rock):
    """Returns E, nu and G from any two of the constants of a scene."""
    E, nu, G, L, K = (None if rock.get(name) is None else float(rock[name]) for name in (
        "Young's modulus", "Poisson's ratio", "shear modulus", "Lame's first parameter", "bulk modulus"))
    if nu is None:
        pairs = (((E, G), lambda: E / 2 / G - 1), ((L, G), lambda: L / 2 / (L + G)),
                 ((K, G), lambda: (3 * K - 2 * G) / (6 * K + 2 * G)), ((E, K), lambda: (3 * K - E) / 6 / K),
                 ((L, K), lambda: L / (3 * K - L)),
                 ((E, L), lambda: 2 * L / (E + L + np.sqrt(E**2 + 9 * L**2 + 2 * E * L))))
        nu = next(value() for given, value in pairs if None not in given)
    if G is None:
        G = (E / 2 / (1 + nu) if E is not None else 3 * K * (1 - 2 * nu) / 2 / (1 + nu) if K is not None else
             L * (1 - 2 * nu) / 2 / nu)
    return 2 * G * (1 + nu), nu, G
