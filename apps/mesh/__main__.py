"""Generates the mesh of a fracture network, as described by the section `Mesh file > network` of a scene.

FILE is a mesh for gmsh and Sprekk. FILE.json contains statistics of the mesh and the repairs of the network. An
existing mesh of the same description remains unchanged. If SCENE is a mesh in the format VTU, FILE is the same mesh in
the format of gmsh."""
import argparse
import hashlib
import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

from progress import doing
from shapes import NetworkError

OTHER_TOLERANCES = (0.7, 1.4, 0.5, 2.0)  # factors of the tolerance of repairs, tried if gmsh fails without a place
CELLS_PER_SECOND, BYTES_PER_CELL, LARGE = 3e4, 1e3, 10**6  # rough estimates for gmsh, printed for large meshes
MAX_POOR = 5  # rounds of repairs that leave out fractures at poor cells
MAX_DRAWN = 0.2  # maximum share of random fractures drawn again; a larger share would change the statistics


def arguments(words):
    parser = argparse.ArgumentParser(prog="sprekk mesh", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", help="XML file")
    parser.add_argument("-o", "--output", type=Path, metavar="FILE", required=True, help="the mesh, NAME.msh")
    parser.add_argument("--set", action="append", default=[], metavar="PATH=VALUE", help="override an entry of the scene; may be repeated")
    parser.add_argument("--picture", type=Path, metavar="PNG", help="also draw the mesh")
    parser.add_argument("--strict", action="store_true", help="take warnings as errors")
    parser.add_argument("--run", action="store_true", help=argparse.SUPPRESS)  # for a run with this mesh folder
    parser.add_argument("--quiet", action="store_true", help="print only errors and messages about long operations")
    parser.add_argument("--program", required=True, help=argparse.SUPPRESS)  # path of the program, set by the launcher
    return parser.parse_args(words)


def description(options):
    """Returns the network as XML, with names, units and bounds checked by the program."""
    command = [options.program, "network", options.scene, *(word for entry in options.set for word in ("--set", entry))]
    done = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if done.returncode:
        raise NetworkError(done.stderr.strip().removeprefix("sprekk: "))
    return done.stdout


def fingerprint(text, files):
    """Returns the checksum of all data that determine the mesh."""
    import gmsh
    import numpy
    import shapely
    digest = hashlib.sha256("\n".join((text, *(library.__version__ for library in (gmsh, numpy, shapely)))).encode())
    for path in [*files, *sorted(Path(__file__).parent.glob("*.py"))]:
        digest.update(Path(path).read_bytes())
    return digest.hexdigest()


def known_report(mesh, report, print_of_input):
    """Returns the report of a complete mesh of the same input, or None."""
    try:
        known = json.loads(report.read_text())
        same = known["input"] == print_of_input and known["mesh"] == hashlib.sha256(mesh.read_bytes()).hexdigest()
        return known if same else None
    except (OSError, ValueError, KeyError, TypeError):
        return None


def made(network):
    """Returns plan, sizes and mesh."""
    import checks
    import mesher
    from plan import Plan
    from sizes import Sizes
    with doing(f"intersecting {len(network.fractures)} fractures"):
        plan = Plan(network)
    if network.repair != "report":
        plan.check_movements()
        if plan.dim == 3:
            plan.faces()
    if network.repair != "join":
        with doing(f"checking angles and distances of {len(plan.edges)} edges of fractures"):
            checks.check(plan)
    with doing(f"computing cell sizes at {len(plan.edges)} edges of fractures"):
        sizes = Sizes(plan)
    cells = sizes.expected_number()
    if cells > LARGE:
        print(f"sprekk: about {cells:.2g} cells are expected; gmsh needs about {cells / CELLS_PER_SECOND:.2g} s and "
              f"{cells * BYTES_PER_CELL / 1e9:.2g} GB", file=sys.stderr, flush=True)
    with doing(f"generating a mesh of about {cells:.2g} cells"):
        mesh = (mesher.make_mesh if network.repair == "report" else mesher.make_mesh_apart)(plan, sizes)
    for (owner, other), area in mesh.joined.items():
        network.journal.note(plan.owners[owner], f"{area:.3g} m^2 are joined with {plan.owners[other].name}")
    for (owner, other), area in mesh.removed.items():
        network.journal.note(plan.owners[owner], f"{area:.3g} m^2 are left out at a small angle to {plan.owners[other].name}")
    for owner, size in mesh.omitted.items():
        network.journal.note(plan.owners[owner], f"{size:.3g} {'m' if plan.dim == 2 else 'm^2'} without cells are left out")
    return plan, sizes, mesh


def set_merged_apart(plan, mesh):
    """Makes fractures without faces no fractures. They were merged with others."""
    present = {plan.owners[k].name for k in set(mesh.face_owner.tolist())}
    for k, owner in enumerate(plan.owners):
        if owner.kind == "fracture" and owner.name not in present:
            plan.owners[k] = replace(owner, kind="merged")
            if owner.name not in plan.network.journal.why:
                plan.network.journal.leave_out(owner, "merged with other fractures", "duplicate")


def refuse_poor(plan, mesh):
    """Raises an error with the fractures at cells of poor quality."""
    import numpy
    import report
    from mesher import POOR
    quality, _ = report.gamma(mesh.points, mesh.cells)
    found = {}
    for k in numpy.flatnonzero(quality < POOR):
        at = numpy.isin(mesh.faces, mesh.cells[k]).any(axis=1)
        names = {plan.owners[owner].name for owner in set(mesh.face_owner[at].tolist()) if plan.is_fracture(owner)}
        if names:
            found.setdefault(tuple(sorted(names)), quality[k])
    if found:
        raise NetworkError("\n".join(f"{' and '.join(names)}: a cell has the quality {worst:.3g}" for names, worst in found.items()),
                           features=list(found))


def made_of(text, network):
    """Returns plan, sizes and mesh, where random fractures may be drawn again.

    If fractures cannot be meshed together, the last random one of each conflict is drawn again. Repairs refine the mesh
    in 3D, and then leave out the smallest one."""
    from description import Network
    again, poor_rounds, attempts, given, factors = {}, 0, 0, network.tolerance, list(OTHER_TOLERANCES)
    while True:
        attempts, before = attempts + 1, network.journal.state()
        try:
            plan, *rest = made(network)
            plan.attempts = attempts
            if network.repair != "report" and poor_rounds < MAX_POOR:
                poor_rounds += 1
                refuse_poor(plan, rest[-1])
            if network.repair == "join":
                set_merged_apart(plan, rest[-1])
            plan.repairs[:0] = [f"drawn again{f' {times} times' if times > 1 else ''} due to a conflict with other fractures: {name}"
                                for name, times in again.items()]
            return plan, *rest
        except NetworkError as error:
            network.journal.restore(before, network.fractures)
            drawn = {name: k for k, name in enumerate(network.at_random)}
            if not error.features and network.repair == "join" and "gmsh" in str(error) and factors:
                network.tolerance = given * factors.pop(0)
                network.joined.append(f"the tolerance is {network.tolerance:.3g} m, since gmsh failed with {given:.3g} m")
                continue
            if network.repair != "report" and all(network.conflicting(names) for names in error.features or [()]):
                network.resolved.clear()
                for names in error.features:
                    network.resolve(names)
                continue
            last = {max((name for name in names if name in drawn), key=drawn.get, default=None) for names in error.features}
            if not last or None in last or sum(again.values()) + len(last) > max(1, MAX_DRAWN * len(drawn)):
                raise
        again.update({name: again.get(name, 0) + 1 for name in last})
        network = Network(text, again)


def make(options):
    """Makes the mesh if it does not exist. Returns the text of its report, or None if it exists, and warnings."""
    import vtu
    if vtu.is_vtu(options.scene):
        return vtu.convert(options.scene, options.output), []
    from description import Network
    text = description(options)
    with doing("reading and generating fractures"):
        network = Network(text)
    report_file, changes = (options.output.with_suffix(options.output.suffix + end) for end in (".json", ".csv"))
    print_of_input = fingerprint(text, network.files)
    known = known_report(options.output, report_file, print_of_input)
    if known and not options.picture:
        return None, known["warnings"]
    import checks
    import estimate
    import msh_file
    import report
    estimate.check(network)
    plan, sizes, mesh = made_of(text, network)
    groups = msh_file.groups_of(mesh, plan)
    plan.network.journal.compare(mesh, plan)
    options.output.parent.mkdir(parents=True, exist_ok=True)
    unfinished = options.output.with_name(f"{options.output.name}.{os.getpid()}")
    try:
        msh_file.write(unfinished, mesh.points, groups, msh_file.singles_of(plan))
        content = {"input": print_of_input, "mesh": hashlib.sha256(unfinished.read_bytes()).hexdigest(),
                   "warnings": checks.left_out(plan) + checks.shortened(plan) + ([] if network.repair == "join" else checks.near_fractures(plan)),
                   **report.of_mesh(mesh, plan, sizes)}
        unfinished.replace(options.output)
    finally:
        unfinished.unlink(missing_ok=True)
    plan.network.journal.write(changes, plan.dim)
    report_file.write_text(json.dumps(content, indent=1) + "\n")
    if options.picture:
        import picture
        picture.draw(mesh, plan, options.picture)
    return report.as_text(content), content["warnings"]


def end_results(path, reason):
    """Overwrites results.json, so that results of an earlier run are not taken for those of the failed run."""
    try:
        if path.exists():
            path.write_text(json.dumps({"status": "failed", "reason": reason, "steps": []}, indent=1) + "\n")
    except OSError:  # the error message is printed in any case
        pass


def in_words(error, scene):
    """Returns one line for each error, with the name of a file in front."""
    opens = tuple(getattr(error, "files", ())) + (scene,)
    return "\n".join(line if line.startswith(opens) else f"{scene}: {line}" for line in str(error).splitlines())


def main(words=None):
    options = arguments(words)
    try:
        reported, warnings = make(options)
    except Exception as error:  # includes exceptions of shapely and gmsh
        if isinstance(error, OSError):
            error = NetworkError(f"{error.filename or options.output}: {error.strerror or error}")
        elif not isinstance(error, NetworkError):
            error = NetworkError(f"mesh generation failed: {type(error).__name__}: {error}")
        reason = in_words(error, options.scene)
        print(f"sprekk: {reason}", file=sys.stderr)
        if options.run:
            end_results(options.output.parent / "results.json", reason)
        return 1
    for line in warnings:
        print(f"{'sprekk' if options.strict else 'warning'}: {options.scene}: {line}", file=sys.stderr)
    if warnings and options.strict:
        if options.run:
            end_results(options.output.parent / "results.json", in_words("\n".join(warnings), options.scene))
        return 1
    if not options.quiet:
        print(f"{options.output}: {reported or 'is up to date'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
