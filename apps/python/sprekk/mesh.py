"""Meshes as arrays."""
import numpy as np

MESHIO = {"triangle": "triangle", "quadrilateral": "quad", "tetrahedron": "tetra", "hexahedron": "hexahedron",
          "triangle6": "triangle6", "quadrilateral9": "quad9", "tetrahedron10": "tetra10", "hexahedron27": "hexahedron27"}


class Mesh:
    """Mesh of this rank, or the whole mesh after gathering. Lengths in m.

    coordinates   [node, dim]
    cells         [cell, node of the cell], in the order of VTK
    cell_region   [cell], index into regions
    faces         [fracture face, side -, +; node of the face], corners first
    face_fracture, face_single    [fracture face], index into fractures, single_fractures
    face_area     [fracture face], m^2 (2D: m)
    face_centre   [fracture face, dim]
    face_frame    [fracture face, n, t1[, t2]; dim], n from side - to side +
    face_cells    [fracture face, side -, +], -1 if the cell is on another rank
    face_share    [fracture face, node of side -], weights of the nodes in the mean over the face
    face_bubble   [fracture face], weight of the side bubble in this mean
    sides         [side of a fracture face with its cell on this rank; index of the face, 0 or 1 for - or +]
    side_share    [side, node], weights as in face_share
    side_bubble   [side], weights as in face_bubble
    node_id, cell_id, face_id     numbers in the whole mesh

    On one rank, the first n_owned_nodes nodes and the first n_owned_cells cells are owned; the others are ghosts."""

    def __init__(self, arrays):
        self.shape, self.dim = arrays["shape"], arrays["dim"]
        self.faces = arrays["face_nodes"]
        for name in ("coordinates", "cells", "cell_region", "node_id", "cell_id", "face_id", "face_fracture", "face_single",
                     "face_area", "face_centre", "face_frame", "face_share", "face_bubble", "face_cells",
                     "sides", "side_share", "side_bubble", "n_owned_nodes", "n_owned_cells", "regions", "boundaries",
                     "fractures", "single_fractures"):
            setattr(self, name, arrays[name])

    @property
    def corners(self):
        """Corner nodes [cell, corner]."""
        return self.cells[:, :{"tri": 3, "qua": 4, "tet": 4, "hex": 8}[self.shape[:3]]]

    @property
    def triangles(self):
        """Triangles [triangle, node] of a 2D mesh and the cell of each. Quadrilaterals are divided in two."""
        corners = self.corners
        if corners.shape[1] == 3:
            return corners, np.arange(len(corners))
        cut = np.stack([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]], axis=1).reshape(-1, 3)
        return cut, np.repeat(np.arange(len(corners)), 2)

    def triangulation(self, displacement=None, scale=1):
        """Returns a triangulation of matplotlib for a 2D mesh, moved by scale * displacement [node, dim]."""
        from matplotlib.tri import Triangulation
        points = self.coordinates if displacement is None else self.coordinates + scale * np.asarray(displacement)
        return Triangulation(points[:, 0], points[:, 1], self.triangles[0])

    def segments(self):
        """Returns the faces [fracture face, end, dim] of a 2D mesh, for matplotlib's LineCollection."""
        return self.coordinates[self.faces[:, 0, :2]]

    def to_meshio(self, point_data=None, cell_data=None):
        """Returns a meshio.Mesh, also for pyvista.from_meshio. Data: dicts of arrays [node, ...] and [cell, ...]."""
        import meshio
        points = np.zeros((len(self.coordinates), 3))
        points[:, :self.dim] = self.coordinates
        return meshio.Mesh(points, [(MESHIO[self.shape], self.cells)], point_data=point_data or {},
                           cell_data={name: [values] for name, values in (cell_data or {}).items()})

    def fractures_to_meshio(self, face_data=None):
        """Returns a meshio.Mesh of the fracture faces at side -. The data are a dict of arrays [fracture face, ...]."""
        import meshio
        n = {"tri": 2, "qua": 2, "tet": 3, "hex": 4}[self.shape[:3]]
        kind = {(2, 2): "line", (3, 3): "triangle", (3, 4): "quad"}[self.dim, n]
        points = np.zeros((len(self.coordinates), 3))
        points[:, :self.dim] = self.coordinates
        return meshio.Mesh(points, [(kind, self.faces[:, 0, :n])],
                           cell_data={name: [values] for name, values in (face_data or {}).items()})

    def __repr__(self):
        return (f"<sprekk.Mesh: {len(self.cells)} cells ({self.shape}), {len(self.coordinates)} nodes, "
                f"{len(self.faces)} fracture faces>")
