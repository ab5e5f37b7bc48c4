"""HTML page of a report, without external references, for screens, phones and paper."""

import base64
import html
import json
from pathlib import Path

from numbers_in_words import quantity

CAPTIONS = {
    "overview": "Slip of fractures and change of the fluid pressure",
    "bulk": "Rock, deformed: displacement, von Mises stress and largest compressive stress",
    "fractures": "Fractures: tangential jump, slip, opening, tractions and contact state",
    "maps": "Slip and opening of fractures in space, and slip tendency by direction",
    "flow": "Pressure and flow in rock and fractures",
    "growth": "Fractures by the time of their growth",
    "temperature": "Temperature and heat flux in the rock",
    "error": "Distribution of the estimated error",
    "loops": "Mean traction against mean jump of fractures, over all steps",
    "mohr": "Stress on fracture faces, compared with the strength of the joints",
    "series": "Over time",
    "events": "Magnitudes of slip events over the injection rate, and cumulated moment",
    "catalogue": "Number of events with at least a given magnitude",
    "magnitudes": "Number of fractures with at least a given magnitude",
    "convergence": "Iterations of each step, and residuals at its end",
}
OPEN_ON_PAPER = (
    "addEventListener('beforeprint', () => document.querySelectorAll('details').forEach((d) => { d.open = true; }))"
)
LARGEST_TABLE = 1_000_000  # bytes
VERDICTS = {"passed": "✓", "failed": "✗", "noted": "○"}


def text(words):
    return html.escape(str(words), quote=False)


def table(content):
    head = "".join(f"<th>{text(column)}</th>" for column in content.columns)
    head = f"<thead><tr>{head}</tr></thead>" if any(content.columns) else ""
    rows = "".join("<tr>" + "".join(f"<td>{text(cell)}</td>" for cell in row) + "</tr>" for row in content.rows)
    note = f"<p class='note'>{text(content.note)}</p>" if content.note else ""
    return f"<h3>{text(content.title)}</h3><div class='wide'><table>{head}<tbody>{rows}</tbody></table></div>{note}"


def count(number, word):
    return f"{number} {word}{'' if number == 1 else 's'}"


def number_of_fractures(results, scene):
    """Returns the numbers of single fractures and of their sets, which are the subsections of `Fractures`."""
    sets = sum(isinstance(value, dict) for value in scene.entries.get("Fractures", {}).values())
    singles = len(results.get("single_fractures", [])) or sets
    return (
        count(singles, "fracture") + (f" in {count(sets, 'set')}" if singles != sets else "")
        if sets
        else "no fractures"
    )


def summary(results, scene, headline):
    mesh, steps = results.get("mesh", {}), results["steps"]
    begun = results.get("initial", {}).get("mesh", mesh).get("cells", 0)
    cells = f"{mesh.get('cells', 0)} cells" + (f" ({begun} at the start)" if begun != mesh.get("cells", 0) else "")
    body = {2: "A plane section of rock", 3: "A body of rock"}.get(mesh.get("dimension"), "Rock")
    fields = {field["name"] for field in results.get("blocks", {}).get("fields", [])}
    places = ["rock"] * ("pressure" in fields) + ["fractures"] * bool(mesh.get("fracture_faces"))
    fluid = f"with flow in {' and '.join(places)}{' only' if places == ['fractures'] else ''}"
    physics = [
        words
        for section, words in (("Flow", fluid), ("Heat", "with heat"), ("Tracer", "with a dissolved tracer"))
        if section in scene.entries
    ]
    return (
        f"{body}{' ' + ' and '.join(physics) if physics else ''}, of {cells}, has {number_of_fractures(results, scene)} "
        f"({mesh.get('fracture_faces', 0)} faces). {count(len(steps), 'step')} up to "
        f"t = {quantity(steps[-1]['time'], 's')}. {headline}"
    )


def scene_in_words(scene):
    """Returns the entries that differ from defaults, for each section, with its path."""
    parts = []
    for names, path, entries in scene.blocks():
        place = " › ".join((*path[:-1], ", ".join(names)))
        inner = "".join(f"<dt>{text(name)}</dt><dd>{text(value)}</dd>" for name, value in entries)
        parts.append(f"<section class='entries'><h4>{text(place)}</h4><dl>{inner}</dl></section>")
    return "".join(parts)


def checks_list(checks):
    items = "".join(
        f"<li class='{check.verdict}'><b>{VERDICTS[check.verdict]} {text(check.name)}</b> {text(check.words)}</li>"
        for check in checks
    )
    return f"<ul class='checks'>{items}</ul>"


def figure(name, png):
    data = base64.b64encode(png).decode()
    caption = text(CAPTIONS.get(name, name.replace("probe_", "Probe ")))
    return (
        f"<figure><img alt='{caption}' src='data:image/png;base64,{data}'><figcaption>{caption}</figcaption></figure>"
    )


def downloads(files):
    """Returns links to tables, which the page contains, and the names of tables that are too large."""
    links = [
        f"<a download='{name}' href='data:text/csv;base64,{base64.b64encode(content.encode()).decode()}'>{name}</a>"
        for name, content in files
        if len(content) <= LARGEST_TABLE
    ]
    large = [name for name, content in files if len(content) > LARGEST_TABLE]
    others = f"; too large for this page, written by <code>sprekk plot</code>: {', '.join(large)}" if large else ""
    return f"<p class='note'>Tables of all steps: {', '.join(links)}{others}</p>" if files else ""


def view_part(view, viewer):
    """Returns the 3D view or a note, and the script for the end of the page."""
    if viewer is None:
        return (
            "<p class='note'>This report has no 3D view: its viewer could not be built when the report was written.</p>",
            "",
        )
    if view is None:
        return "<p class='note'>The run wrote no grids, so there is no 3D view.</p>", ""
    data = json.dumps(view).replace("</", "<\\/")
    place = (
        "<div id='view'></div><div id='view-controls'></div><div id='view-facts' class='wide'></div>"
        "<p class='note'>Drag to turn, pinch or scroll to zoom, shift-drag to move. Click on a fracture for its numbers.</p>"
    )
    return place, f"<script type='application/json' id='view-data'>{data}</script><script>{viewer}</script>"


def of_run(name, results, scene, headline, checks, tables, files, drawn, left_out, view, viewer):
    style = (Path(__file__).parent / "page.css").read_text()
    found, costs = tables
    convergence = [picture for picture in drawn if picture[0] == "convergence"]
    place, script = view_part(view, viewer)
    parts = [
        (
            "scene",
            "Scene",
            f"<p>{text(summary(results, scene, headline))}</p><details><summary>Entries that differ from the defaults</summary>{scene_in_words(scene)}</details>",
        ),
        ("checks", "Checks", checks_list(checks)),
        ("figures", "Key figures", ("".join(map(table, found)) or "<p>None.</p>") + downloads(files)),
        ("turn", "View to turn", place),
        (
            "pictures",
            "Pictures",
            "".join(figure(*one) for one in drawn if one not in convergence)
            + (f"<p class='note'>{text(left_out)}</p>" if left_out else ""),
        ),
        ("convergence", "Convergence", "".join(figure(*one) for one in convergence)),
        ("costs", "Joints, size and time", "".join(map(table, costs))),
    ]
    links = "".join(f"<a href='#{key}'>{title}</a>" for key, title, _ in parts)
    body = "".join(f"<section id='{key}'><h2>{title}</h2>{inner}</section>" for key, title, inner in parts)
    return (
        f"<!DOCTYPE html><html lang='en'><head><meta charset='utf-8'><meta name='viewport' content='width=device-width, initial-scale=1'>"
        f"<link rel='icon' href='data:,'><title>{text(name)} – Sprekk</title><style>{style}</style></head><body><header><h1>{text(name)}</h1>"
        f"<nav>{links}</nav></header><main>{body}</main><script>{OPEN_ON_PAPER}</script>{script}</body></html>\n"
    )
