"""Runs the scenes of the gallery and draws one picture of each.

The data are docs/gallery/scenes.csv (scene, picture, processor time in s) and one WebP file per scene. Runs are stopped
after LIMIT seconds of processor time; the time is then ">LIMIT" and there is no picture. See pages.py for the page.
"""
import csv
import importlib.util
import io
import re
import resource
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

LIMIT = 60  # s of processor time of a run
WIDTH = 900  # pixels of a picture
STATUS = {"point/tilt": 1}  # exit status of scenes that do not end with 0: slabs slide
COLUMNS = ("scene", "picture", "seconds")

# Picture of `sprekk plot` by topic or scene; the first that the run has.
PICTURES = {
    "accuracy": "flow bulk",
    "accuracy/doublet_2d": "temperature",
    "contact": "bulk",
    "contact/cycles_2d": "loops",
    "contact/all_change_2d": "loops",
    "contact/all_change_3d": "loops",
    "contact/damage_cycles_2d": "loops",
    "contact/damage_turns_3d": "loops",
    "contact/snap_back_2d": "loops",
    "contact/thin_layers_2d": "loops bulk",
    "contact/turns_3d": "loops",
    "earthquakes/network_3d": "maps bulk",
    "flow": "flow",
    "gmsh": "bulk",
    "growth": "bulk",
    "growth/porous_2d": "growth flow",
    "growth/reorientation_2d": "growth",
    "growth/thermal_cracks_2d": "growth",
    "growth/wing_cracks_2d": "growth",
    "heat": "temperature",
    "networks": "maps bulk",
    "networks/biaxial_2d": "bulk",
    "networks/great_cell_2d": "bulk",
    "networks/triaxial_3d": "bulk",
    "networks/stimulation_2d": "overview",
    "new": "maps bulk",
    "new/doublet": "temperature",
    "new/growth": "growth",
    "new/injection": "overview maps",
    "new/stimulation": "overview maps",
    "new/first_scene": "bulk",
    "performance": "flow bulk",
    "poro": "maps flow bulk",
    "poro/injection_days_2d": "series",
    "poro/injection_shear_2d": "series",
    "poro/shut_in_2d": "series",
    "seed": "bulk",
    "slopes": "bulk",
    "stages": "bulk",
    "thm": "temperature",
    "tracer": "flow",
    "tutorial": "maps",
}

# Entries that shorten scenes which need more than LIMIT, as for `sprekk run --set`
SHORTER = {
    "earthquakes/network_3d": ("Time.end=7 h", "Mesh file.network.relative size=0.08"),
    "earthquakes/rupture_2d": ("Time.end=6.4 d", "Mesh file.network.relative size=0.01"),
    "earthquakes/thrust_2d": ("Time.end=100 year",),
}


class GalleryError(Exception):
    pass


def scenes(root):
    """Paths of all scenes outside verification, relative to the root."""
    paths = sorted((root / "xml").glob("*/*.xml"))
    return [path.relative_to(root) for path in paths if path.parent.name != "verification"]


def purpose(text):
    """The comment at the start of a scene, on one line; None without one."""
    comment = re.match(r"\s*<!--(.*?)-->", text, re.DOTALL)
    return " ".join(comment[1].split()) if comment else None


def is_point(root, scene):
    return 'name="Point"' in (root / scene).read_text()


def command(root, scene):
    verb = "point" if is_point(root, scene) else "run"
    words = ["./sprekk", verb, str(scene), *shorter(scene)]
    return shlex.join(words) + (f" > {scene.stem}.csv" if verb == "point" else "")


def shorter(scene):
    return [word for entry in SHORTER.get(f"{scene.parts[1]}/{scene.stem}", ()) for word in ("--set", entry)]


def read(folder):
    """{scene: row} of scenes.csv"""
    if not (folder / "scenes.csv").exists():
        return {}
    with open(folder / "scenes.csv", newline="") as file:
        return {row["scene"]: row for row in csv.DictReader(file)}


def write(folder, rows):
    with open(folder / "scenes.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows[scene] for scene in sorted(rows))


def processor_time():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def limited():
    resource.setrlimit(resource.RLIMIT_CPU, (LIMIT, LIMIT + 5))


def compute(root, scene, results):
    """Runs a scene: (path for `sprekk plot`, processor time); (None, None) above the limit."""
    program, begin = root / "sprekk", processor_time()
    if is_point(root, scene):
        words, made = [program, "point", scene], results.with_name(results.name + ".csv")
    else:
        words = [program, "run", scene, "--output", results, "--quiet", "--set", "Output.vtu=true", *shorter(scene)]
        made = results
    done = subprocess.run(words, cwd=root, capture_output=True, text=True, preexec_fn=limited)
    seconds = processor_time() - begin
    if seconds > LIMIT - 1:  # the system counts in ticks
        return None, None
    if done.returncode != STATUS.get(f"{scene.parts[1]}/{scene.stem}", 0):
        raise GalleryError(f"{scene}: exit status {done.returncode}: {done.stderr.strip()[-500:]}")
    if made != results:
        made.write_text(done.stdout)
    return made, seconds


def plots(root):
    """The program of `sprekk plot` as a module."""
    sys.path.append(str(root / "apps/plot"))
    spec = importlib.util.spec_from_file_location("sprekk_plot", root / "apps/plot/__main__.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def draw(plot, scene, made, target):
    """Writes the picture of a scene; others are not drawn."""
    from PIL import Image
    from style import plt, save
    topic = scene.parts[1]
    wanted = scene.stem if made.is_file() else PICTURES.get(f"{topic}/{scene.stem}", PICTURES.get(topic, "bulk"))
    names, found = wanted.split(), {}
    try:
        for name, figure in plot.of_run(made, plot.arguments([str(made)])) if made.is_dir() else plot.of_csv(made):
            found[name] = figure
            if name == names[0]:
                break
        figure = next((found[name] for name in names if name in found), None)
        if figure is None:
            raise GalleryError(f"{scene}: has none of the pictures {', '.join(names)}")
        picture = io.BytesIO()
        save(figure, picture, 110)
    except plot.PlotError as error:
        raise GalleryError(f"{scene}: plot: {error}") from None
    finally:
        plt.close("all")
    image = Image.open(picture).convert("RGB")
    image.thumbnail((WIDTH, 2 * WIDTH))
    image.save(target, quality=80, method=6)


def make(root, wanted):
    """Runs the wanted scenes, or all, and rewrites their rows and pictures."""
    folder, known = root / "docs/gallery", scenes(root)
    unknown = [name for name in wanted if Path(name) not in known]
    if unknown:
        allowed = "xml/TOPIC/NAME.xml outside xml/verification"
        raise GalleryError(f"{unknown[0]}: is no scene of the gallery; allowed: {allowed}")
    folder.mkdir(exist_ok=True)
    rows = {name: row for name, row in read(folder).items() if Path(name) in known}
    failed, plot = [], plots(root)
    with tempfile.TemporaryDirectory() as temporary:
        for scene in [Path(name) for name in wanted] or known:
            target = folder / f"{scene.parts[1]}_{scene.stem}.webp"
            try:
                made, seconds = compute(root, scene, Path(temporary) / scene.stem)
                if made:
                    draw(plot, scene, made, target)
                else:
                    target.unlink(missing_ok=True)
            except GalleryError as error:
                failed.append(str(error))
                print(f"sprekk docs: {error}", file=sys.stderr, flush=True)
                continue
            finally:
                shutil.rmtree(Path(temporary) / scene.stem, ignore_errors=True)
            rows[str(scene)] = {"scene": scene, "picture": target.name if made else "",
                                "seconds": f"{float(f'{seconds:.2g}'):g}" if made else f">{LIMIT}"}
            write(folder, rows)
            print(f"{scene}: " + (f"{seconds:.1f} s" if made else f"more than {LIMIT} s"), flush=True)
    pictures = {row["picture"] for row in rows.values()}
    for path in folder.glob("*.webp"):
        if path.name not in pictures:
            path.unlink()
    if failed:
        raise GalleryError(f"{len(failed)} scenes failed")
