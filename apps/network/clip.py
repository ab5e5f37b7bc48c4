"""Parts of fractures in a box: lengths of traces and areas of discs."""
import numpy as np


def interval(points, directions, box):
    """Returns the parameters (t0, t1) of the parts of lines `points + t directions` in a box. Without a part t0 > t1.

    points, directions  (n, dim)
    box                 lower and upper corner"""
    low, high = box
    with np.errstate(divide="ignore", invalid="ignore"):
        a, b = (low - points) / directions, (high - points) / directions
    level = directions == 0  # parallel to a side: no bound, or no part
    outside = level & ((points < low) | (points > high))
    first = np.where(level, np.where(outside, np.inf, -np.inf), np.minimum(a, b))
    last = np.where(level, np.where(outside, -np.inf, np.inf), np.maximum(a, b))
    return first.max(axis=1), last.min(axis=1)


def lengths(centres, directions, sizes, box):
    """Returns the lengths in a rectangle of traces with these centres, unit directions and lengths."""
    first, last = interval(centres, directions, box)
    return np.maximum(np.minimum(last, 0.5 * sizes) - np.maximum(first, -0.5 * sizes), 0)


def areas(centres, poles, radii, box):
    """Returns the exact areas in a box of discs with these centres, unit normals and radii.

    Planes through an edge of the box are excluded; random planes have none.

    The plane of a disc meets the box in a convex polygon, one side per face of the box. Seen from the centre, each side
    bounds triangles, where it is inside of the circle, and sectors. The area is the sum of these, with signs."""
    found = np.zeros(len(radii))
    for axis in range(3):
        for end, sign in zip(box, (-1, 1)):
            out = np.zeros(3)
            out[axis] = sign
            along = np.cross(poles, out)  # counter-clockwise about the pole
            sine = np.linalg.norm(along, axis=1)
            meets = sine > 1e-12
            pole, along, x = poles[meets], along[meets] / sine[meets, None], centres[meets]
            inward = np.cross(pole, along)
            foot = x - ((x[:, axis] - end[axis]) / inward[:, axis])[:, None] * inward
            foot[:, axis] = end[axis]
            begin, stop = interval(foot, along, box)
            height = -np.einsum("ij,ij->i", foot - x, inward)
            part = sector(stop, height, radii[meets]) - sector(begin, height, radii[meets])
            found[meets] += np.where(begin < stop, part, 0)
    return np.maximum(found, 0)


def sector(s, height, radius):
    """Returns the area between a line, from its foot to the abscissa s, and the centre of a circle, inside of it.

    height  distance of the centre to the left of the line"""
    half = np.sqrt(np.maximum(radius**2 - height**2, 0))  # of the chord
    inside = np.clip(s, -half, half)
    angle = np.arctan2(s, abs(height)) - np.arctan2(inside, abs(height))
    return 0.5 * (height * inside + radius**2 * np.sign(height) * angle)
