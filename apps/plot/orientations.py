"""Orientations of fractures: rose diagram of strikes in 2D, stereonet of poles in 3D."""
import numpy as np
from matplotlib.ticker import MaxNLocator


def strikes(lines):
    """Returns strikes (degrees, clockwise from north, in [0, 180)) and lengths of all segments of polylines."""
    along = np.concatenate([np.diff(line, axis=0) for line in lines])
    return np.degrees(np.arctan2(along[:, 0], along[:, 1])) % 180, np.linalg.norm(along, axis=1)


def area_vector(polygon):
    """Returns area times unit normal of a plane polygon (n, 3)."""
    x = polygon - np.mean(polygon, axis=0)
    return 0.5 * np.cross(x, np.roll(x, -1, axis=0)).sum(axis=0)


def poles(polygons):
    """Returns trend (degrees, clockwise from north) and radius of downward poles.

    The stereonet has the radius 1 and is an equal-area projection of the lower hemisphere."""
    normal = np.array([area_vector(x) for x in polygons])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    down = np.where(normal[:, 2:] > 0, -normal, normal)
    return np.degrees(np.arctan2(down[:, 0], down[:, 1])) % 360, np.sqrt(np.maximum(1 - abs(down[:, 2]), 0))


def draw_rose(ax, sets):
    """Draws the share of each strike in the total length, in bars of 10 degrees; `sets` are (colour, lines)."""
    sides = np.arange(-5, 356, 10)  # centres the bars at the directions of axes
    total = sum(strikes(lines)[1].sum() for _, lines in sets)
    base = np.zeros(36)
    for colour, lines in sets:
        strike, length = strikes(lines)
        both = (np.concatenate([strike, strike + 180]) + 5) % 360 - 5
        share = 100 * np.histogram(both, sides, weights=np.tile(length, 2))[0] / total
        ax.bar(np.radians(sides[:-1] + 5), share, width=np.radians(10), bottom=base, color=colour, edgecolor="white", linewidth=0.4)
        base += share
    ax.yaxis.set_major_locator(MaxNLocator(3, prune="lower"))
    ax.yaxis.set_major_formatter("{x:g} %")
    # labels at the shortest bars
    ax.set_rlabel_position(min(np.arange(22.5, 360, 45), key=lambda a: base[np.abs((sides[:-1] + 5 - a + 180) % 360 - 180) < 15].sum()))
    ax.set_title("share of the length by direction", fontsize=9)


def draw_stereonet(ax, sets):
    """Draws the poles of planes; `sets` are (colour, polygons)."""
    for colour, polygons in sets:
        trend, radius = poles(polygons)
        ax.plot(np.radians(trend), radius, "o", color=colour, markersize=4, markeredgecolor="0.2", markeredgewidth=0.3, clip_on=False, zorder=5)
    ax.set_ylim(0, 1)
    ax.set_yticks([])
    ax.set_title("poles, lower hemisphere, equal areas", fontsize=9)


def draw(ax, dim, sets):
    """Draws the diagram on polar axes."""
    ax.set_theta_zero_location("N")
    ax.set_theta_direction(-1)
    (draw_rose if dim == 2 else draw_stereonet)(ax, sets)
    ax.set_xticks(np.radians([0, 90, 180, 270]), ["y", "x", "−y", "−x"] if dim == 2 else ["N", "E", "S", "W"])
    ax.tick_params(labelsize=8)
