"""Builds the web site of the documentation.

Without options the site is written to build/site; index.html opens it in a browser, without a server or a network.
"""
import argparse
import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import gallery
import pages

ROOT = Path(__file__).resolve().parents[2]
KATEX = Path("/usr/share/javascript/katex")


def arguments(words):
    parser = argparse.ArgumentParser(prog="sprekk docs", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--output", type=Path, default=ROOT / "build/site", metavar="DIR",
                        help="write the site there; DIR is replaced (default: build/site)")
    parser.add_argument("--gallery", nargs="*", metavar="SCENE",
                        help="run all scenes of the gallery, or some, and rewrite docs/gallery; builds no site")
    return parser.parse_args(words)


def doxygen(folder):
    folder.mkdir(parents=True)
    settings = (ROOT / "docs/Doxyfile").read_text()
    settings += f'OUTPUT_DIRECTORY = "{folder.parent}"\nHTML_OUTPUT = {folder.name}\n'
    done = subprocess.run(["doxygen", "-"], cwd=ROOT, input=settings, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                          text=True)
    if done.returncode:
        raise pages.PageError(f"docs/Doxyfile: doxygen failed:\n{done.stderr}")


def write_offline_search(site, searched):
    """Leaves pages of source files out of the index, and writes offline.js, see theme/main.html."""
    file = site / "search/search_index.json"
    index = json.loads(file.read_text())
    found = {page.replace("README.md", "index.md")[:-2] + "html" for page in searched}
    index["docs"] = [entry for entry in index["docs"] if entry["location"].split("#")[0] in found]
    file.write_text(json.dumps(index))
    (worker,) = (site / "assets/javascripts/workers").glob("search.*.js")
    (site / "search/offline.js").write_text(
        f"var __search = {{index: Promise.resolve({json.dumps(index)})}};\n"
        f"const searchWorker = URL.createObjectURL(new Blob([{json.dumps(worker.read_text())}]));\n"
        "window.Worker = class extends Worker { constructor() { super(searchWorker); } };\n")


def build(site):
    if site.is_dir() and any(site.iterdir()) and not (site / "search/offline.js").exists():
        raise pages.PageError(f"{site}: holds other files than a site, which would be removed; name another directory")
    from mkdocs.commands.build import build as build_site
    from mkdocs.config import load_config
    from mkdocs.exceptions import Abort
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        made = pages.Pages(ROOT, folder)
        made.add_all()
        doxygen(folder / "api/cpp")
        shutil.copytree(KATEX / "fonts", folder / "assets/katex/fonts")
        for name in ("katex.min.js", "katex.min.css"):
            shutil.copy(KATEX / name, folder / "assets/katex" / name)
        shutil.copy("/usr/share/doc/libjs-katex/copyright", folder / "assets/katex")
        config = load_config(str(ROOT / "docs/mkdocs.yml"), docs_dir=temporary, site_dir=str(site), strict=True)
        config["nav"] = pages.navigation(ROOT)
        try:
            build_site(config)
        except Abort as error:  # MkDocs has printed its warnings
            raise pages.PageError(f"MkDocs: {error}".replace("\n", "")) from None
    (site / "404.html").unlink()  # of a server; its links are none of a folder
    write_offline_search(site, made.searched)


def main(words=None):
    options = arguments(words)
    try:
        if options.gallery is not None:
            gallery.make(ROOT, options.gallery)
        else:
            build(options.output.resolve())
            print(options.output / "index.html")
    except (pages.PageError, gallery.GalleryError, OSError) as error:
        print(f"sprekk docs: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
