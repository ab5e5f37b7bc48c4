"""Draws outcrop maps with the defects of digitised ones: gaps of millimetres, duplicates, short traces, no geometry."""
import json

import numpy as np

ORIGIN = np.array([432100.0, 5278300.0])  # of UTM coordinates, m
SETS, SCATTER = (20, 75, 140), 12  # strikes and their standard deviation, degrees
STEP, VERTICES = 0.015, 60  # distance of vertices, m, and their largest number
GAP, OFFSET = 0.004, 0.002  # standard deviations of gaps and of duplicates, m


def traces(n, size, seed):
    """Returns n polylines in a square window; some leave it."""
    random, found = np.random.default_rng(seed), []
    while len(found) < n:
        length = min((random.random() + 1e-9) ** (-1 / 1.2), 0.6 * size) if random.random() > 0.03 else random.uniform(0.03, 0.3)
        strike = np.radians(random.choice(SETS) + random.normal(0, SCATTER))
        along = np.array([np.sin(strike), np.cos(strike)])
        count = int(np.clip(length / STEP, 2, VERTICES))
        rough = np.cumsum(random.normal(size=count))
        rough -= np.linspace(rough[0], rough[-1], count)
        line = random.uniform(-0.02 * size, 1.02 * size, 2) + np.linspace(-0.5, 0.5, count)[:, None] * length * along
        line += 0.003 * length / np.sqrt(count) * rough[:, None] * np.array([along[1], -along[0]])
        if found and random.random() < 0.3:  # begins near a vertex of another trace
            other = found[random.integers(len(found))]
            line += other[random.integers(len(other))] + random.normal(0, GAP, 2) - line[0]
        found.append(line)
        if random.random() < 0.03:
            found.append(line + random.normal(0, OFFSET * random.integers(2), 2))
    return found[:n]


def geojson(lines):
    """Returns a GeoJSON file without coordinate system, with quotation marks and features without geometry."""
    features = []
    for k, line in enumerate(lines):
        geometry = None if k % 97 == 5 else {"type": "LineString", "coordinates": (line + ORIGIN).round(4).tolist()}
        remark = 'the "main" joint, 3" wide' if k % 7 == 0 else ""
        features.append({"type": "Feature", "properties": {"fid": k + 1, "remark": remark}, "geometry": geometry})
    return json.dumps({"type": "FeatureCollection", "features": features})


def points(lines):
    """Returns a table with semicolons and one point per line."""
    rows = [f"{k + 1};{x:.4f};{y:.4f}".replace(".", ",") for k, line in enumerate(lines) for x, y in line + ORIGIN]
    return "\n".join(["id;x [m];y [m]", *rows, ""])
