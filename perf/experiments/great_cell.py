"""GREAT cell of DECOVALEX-2023, Task G, in plane strain: volumetric strain along a circle in the sample.

M1 is the intact sample, M2a has a through-going fracture, M2b a fracture that extends 40 mm from the centre.
Pads press on the sheath; opposite pads have the same load. Loads B and C are load A rotated by 45 and 90
degrees, without rotation of the fracture."""
import numpy as np
import read

from perf.common import program, table

SCENE = "networks/great_cell_2d.xml"
RADIUS = 0.065                  # of the circle, m
SIZES = (0.004, 0.002)          # of cells, m
LOADS = (10, 6.64, 4.46, 1.17, 1, 3.82, 7.8, 9.95)  # MPa; pads 1 to 8 clockwise from the x axis, load A
TURNS = {"A": 0, "B": 2, "C": 4}  # rotation in pads
JOINT = "Materials.elastic joint"
INTACT = {f"{JOINT}.tangential stiffness": "infinite", f"{JOINT}.normal stiffness": 1e17}
CASES = {"M1": INTACT, "M2a": {}, "M2b": {"Mesh file.network.fractures.fracture.lines.line.points": "{0, 0, 0.04, 0}"}}
ROCKS = {"greywacke": (26.87e9, 0.27, {}),  # Young's modulus, Poisson's ratio, entries
         "gneiss": (83.9e9, 0.21, {"Regions.sample.material": "gneiss", f"{JOINT}.normal stiffness": "200 GPa/m",
                                   f"{JOINT}.tangential stiffness": "100 GPa/m"})}
# Strain in 1e-4 of M1 under load A: LBNL, phase field in MOOSE, in external_data_dict.py of OpenGeoSys'
# benchmark.
ANGLES = (0.0037, 13.08, 28.51, 46.81, 60.56, 75.32, 90.51, 99.49, 115.80, 131.28, 150.49)  # degrees
KNOWN = {"greywacke": (-3.222, -3.309, -3.183, -2.754, -2.327, -1.901, -1.603, -1.547, -1.683, -2.018, -2.542),
         "gneiss": (-1.239, -1.272, -1.224, -1.059, -0.895, -0.731, -0.616, -0.595, -0.647, -0.776, -0.977)}
WORST = 0.05  # allowed error relative to the largest known strain


def pads(load):
    """Loads at multiples of 22.5 degrees, counter-clockwise, from -9 to 9, in Pa."""
    return "{" + ", ".join(f"{LOADS[(-k - TURNS[load]) % 8]}e6" for k in range(-9, 10)) + "}"


def strains(directory, size, young, poisson):
    """Volumetric strain at ANGLES, from a linear fit through the surrounding cells on the same side of the fracture."""
    grid = read.grid(read.written_steps(directory, "bulk")[-1][1])
    points = read.vtk_to_numpy(grid.GetPoints().GetData())
    centre = np.array([points[cell].mean(axis=0)[:2] for cell in read.cells(grid.GetCells())])
    trace = read.arrays(grid.GetCellData())["stress"][:, :3].sum(axis=1) * (1 - 2 * poisson) / young
    found = []
    for angle in np.radians(ANGLES):
        away = centre - RADIUS * np.array([np.cos(angle), np.sin(angle)])
        near = (np.hypot(*away.T) < 1.5 * size) & (centre[:, 1] > 0)
        found.append(np.linalg.lstsq(np.c_[np.ones(near.sum()), away[near]], trace[near], rcond=None)[0][0])
    return np.array(found)


def computed(options, rock, case, load, size):
    """Runs a case; returns the strains in 1e-4."""
    *elastic, own = ROCKS[rock]
    directory = options.output / f"great_cell/{rock}_{case}_{load}_{1e3 * size:g}mm"
    entries = [f"{path}={value}" for path, value in {**own, **CASES[case], "Tables.load.values": pads(load), "Mesh file.network.size": size}.items()]
    mesh = program.mesh(options.binary, SCENE, directory / "cell.msh", entries)
    program.succeeded(options.binary, SCENE, directory, (f"Mesh file.path={mesh}", *entries), clear=False)
    return 1e4 * strains(directory, size, *elastic)


def run(options):
    """Prints the strains and writes great_cell.csv. Returns True if M1 agrees with the known strains."""
    print("great_cell: volumetric strain in 1e-4 along the circle; finer: what cells of half the size change, of the largest, load A")
    print(f"{'degrees':22}" + "".join(f"{angle:8.1f}" for angle in ANGLES) + "   finer")
    columns, worst = {"angle (degree)": ANGLES}, 0
    for rock, known in KNOWN.items():
        rows = {f"{rock} M1 A, LBNL": known}
        for case in CASES:
            for load in TURNS:
                rows[f"{rock} {case} {load}"] = computed(options, rock, case, load, SIZES[1])
        for name, values in rows.items():
            change = ""
            if name.endswith(" A"):
                coarse = computed(options, *name.split(), SIZES[0])
                change = f"{100 * np.max(abs(values - coarse)) / np.max(abs(values)):6.1f} %"
            print(f"{name:22}" + "".join(f"{value:8.3f}" for value in values) + change)
            columns[f"{name} (1e-4)"] = values
        off = abs(rows[f"{rock} M1 A"] - known) / np.max(np.abs(known))
        worst = max(worst, off.max())
        print(f"{rock} M1 A differs from LBNL by {100 * np.sqrt(np.mean(off**2)):.1f} % rms, {100 * off.max():.1f} % at most, of the largest")
    table.write(options.output / "great_cell.csv", columns, zip(*columns.values()))
    return worst < WORST
