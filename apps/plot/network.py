"""Views of fractures in space: fractures with values, edges of the rock, names, and the list of hidden fractures."""

import bulk
import numpy as np
import read
import space
from places import region
from style import FAINT, INK

MAX_NAMES = 12  # of fractures in one view
MAX_LISTED = 8  # hidden fractures
WALLS = 0.2  # opacity of faces of the rock inside of its box: slopes and excavations


class Network:
    """Fractures in space, with the values of their faces in `data`.

    The box is the rock, or the region with slip if it is much smaller. Faces are cut at its sides."""

    def __init__(self, rock, joints, names, singles=(), whole=False, wells=()):
        faces, skin = read.surface(joints), space.outer(read.surface(rock))
        data = faces.cell_data
        body = space.bounds_of(skin.points[np.concatenate(skin.polygons)])
        centres = np.array([faces.points[polygon].mean(axis=0) for polygon in faces.polygons])
        part = None if whole else region(centres, data["slip"], body)
        self.bounds, self.zoomed = (body, False) if part is None else (part, True)
        self.surface = space.clipped(faces, self.bounds) if self.zoomed else faces
        self.data = self.surface.cell_data
        single = singles and "single fracture" in data
        self.numbers = self.data["single fracture" if single else "fracture"].astype(int)
        names = [one["name"] for one in singles] if single else names
        self.names = {k: names[k] if k < len(names) else f"fracture {k}" for k in set(self.numbers.tolist())}
        edges = space.edges(skin)
        if self.zoomed and len(edges.polygons):
            ends = np.array([edges.points[polygon].mean(axis=0) for polygon in edges.polygons])
            edges = edges._replace(
                polygons=[edges.polygons[k] for k in np.flatnonzero(space.inside(ends, self.bounds))]
            )
        centres = np.array([skin.points[polygon].mean(axis=0) for polygon in skin.polygons])
        away = np.min(np.abs(centres[:, None] - body), axis=(1, 2)) > 1e-6 * np.max(body[1] - body[0])
        walls = skin.part(np.flatnonzero(away & space.inside(centres, self.bounds)))
        rims = space.Part(self.surface.points, list(bulk.rim(self.surface, None)), INK)
        self.others = [edges, rims, space.Part(walls.points, walls.polygons, FAINT, WALLS)]
        self.wells = {name: well for name, well in dict(wells).items() if np.all(space.inside(well, self.bounds))}
        self.places = space.visible(self.surface, self.numbers, self.bounds)
        self.hidden = [self.names[k] for k in space.hidden(self.surface, self.numbers, self.places, self.bounds)]

    def draw(self, ax, colours):
        space.draw(ax, [space.Part(self.surface.points, self.surface.polygons, colours), *self.others], self.bounds)
        space.draw_wells(ax, self.wells)

    def write_names(self, ax):
        """Writes names of wells and fractures, those with the largest tangential jumps first.

        Of many fractures only those with a jump have names."""
        jump = np.linalg.norm(self.data["jump local"][:, 1:], axis=1)
        largest = {k: np.max(jump[self.numbers == k]) for k in self.places}
        order = sorted(self.places, key=lambda k: -largest[k])
        if len(order) > MAX_NAMES:
            order = [k for k in order if largest[k] > 1e-3 * largest[order[0]]]
        named = [(self.names[k], self.places[k]) for k in order if len(self.places[k])][:MAX_NAMES]
        space.write_names(ax, named, self.bounds, self.wells)

    def note(self):
        """Returns the remark on the region and on hidden fractures."""
        others = len(self.hidden) - MAX_LISTED
        listed = ", ".join(self.hidden[:MAX_LISTED]) + (f" and {others} more" if others > 0 else "")
        return "; ".join(["region with slip"] * self.zoomed + [f"hidden behind others: {listed}"] * bool(self.hidden))
