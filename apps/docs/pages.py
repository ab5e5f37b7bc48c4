"""The pages of the web site: the Markdown of the repository, and pages made of other files that they link to.

All pages have the paths of their files in the repository, so that relative links hold.
"""
import html
import json
import os
import re
import shutil
from pathlib import Path

import gallery
import python_api

LINK = re.compile(r"(\]\(|^\[[^\]\n]+\]: )(?!\w+:|#)([^)#\s]+)", re.MULTILINE)
CODE = re.compile(r"(^```.*?^```|`[^`\n]*`)", re.DOTALL | re.MULTILINE)
PICTURES = {".png", ".svg", ".webp"}
LANGUAGES = {".cpp": "cpp", ".hpp": "cpp", ".py": "python", ".xml": "xml", ".cmake": "cmake", ".json": "json",
             ".slurm": "bash"}
GALLERY, PYTHON, CPP = "gallery.md", "api/python.md", "api/cpp/index.html"


class PageError(Exception):
    pass


def outside_code(change, text):
    return "".join(part if k % 2 else change(part) for k, part in enumerate(CODE.split(text)))


def fence(text, language):
    return f"````{language}\n{text.rstrip()}\n````\n"


def raw(path):
    return f'<a href="{path.name.lstrip(".")}" download>Download</a>'


def of_folder(path, name):
    entries = sorted(entry for entry in path.iterdir() if not entry.name.startswith((".", "__pycache__")))
    return f"# {name}\n\n" + "".join(f"* [{entry.name}]({entry.name})\n" for entry in entries)


def of_notebook(path, _):
    parts = [raw(path)]
    for cell in json.loads(path.read_text())["cells"]:
        text = "".join(cell["source"])
        parts.append(text if cell["cell_type"] == "markdown" else fence(text, "python"))
    return "\n\n".join(parts) + "\n"


def of_source(path, name):
    try:
        text = fence(path.read_text(), LANGUAGES.get(path.suffix, "text"))
    except UnicodeDecodeError:
        text = "This file is binary.\n"
    return f"# {name}\n\n{raw(path)}\n\n" + text


def of_gallery(root):
    """Cards of all scenes by topic."""
    rows, parts = gallery.read(root / "docs/gallery"), [(Path(__file__).parent / "gallery.md").read_text()]
    topic = None
    for scene in gallery.scenes(root):
        row = rows.get(str(scene))
        if scene.parts[1] != topic:
            topic = scene.parts[1]
            parts += ["</div>\n"] * (len(parts) > 1)
            heading = "Example scenes of sprekk new" if topic == "new" else topic.capitalize()
            parts.append(f'## {heading}\n\n<div class="gallery" markdown>\n')
        picture, time = "", "not measured"
        if row:
            time = row["seconds"].replace(">", "more than ") + " s"
        if row and row["picture"]:
            file = f"docs/gallery/{row['picture']}"
            picture = f"[![{scene.stem}]({file}){{ loading=lazy }}]({file})\n\n"
        text = html.escape(gallery.purpose((root / scene).read_text()) or "", quote=False)
        parts.append(f"<div markdown>\n\n### [{scene.stem}]({scene})\n\n{picture}{text}\n\nRun time: {time}\n\n"
                     f"```sh\n{gallery.command(root, scene)}\n```\n\n</div>\n")
    return "\n".join(parts) + "\n</div>\n"


class Pages:
    """Copies pages to a folder, and the files that they link to."""

    def __init__(self, root, folder):
        self.root, self.folder, self.done = root, folder, set()
        self.searched = [GALLERY, PYTHON]  # no pages of source files

    def add_all(self):
        self.add("README.md")
        for path in sorted((self.root / "docs").rglob("*.md")):
            self.add(path.relative_to(self.root))
        self.write(GALLERY, of_gallery(self.root))
        self.write(PYTHON, python_api.page(self.root / "apps/python/sprekk"))

    def write(self, path, text):
        """A page, with its links turned to pages; what they lead to is added."""
        target = self.folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(outside_code(
            lambda part: LINK.sub(lambda link: link[1] + self.linked(Path(path), link[2]), part), text))

    def linked(self, page, link):
        target = os.path.normpath(page.parent / link)
        if target == CPP:
            return link
        if not (self.root / target).exists():
            raise PageError(f"{page}: the link {link} leads nowhere")
        return os.path.relpath(self.add(target), page.parent)

    def add(self, path):
        """Adds a file or folder of the repository; returns the path of its page."""
        path = Path(path)
        source, page = self.root / path, path
        if source.is_dir():
            page = path / "README.md"
        elif path.suffix not in PICTURES | {".md"}:
            page = path.with_name(path.name.lstrip(".") + ".md")  # MkDocs ignores hidden files
        if page in self.done:
            return page
        self.done.add(page)
        if source.is_dir() and not (source / "README.md").exists():
            self.write(page, of_folder(source, path))
        elif page.suffix == ".md" and (self.root / page).exists():
            self.searched.append(str(page))
            self.write(page, (self.root / page).read_text())
        else:
            copy = self.folder / path.with_name(path.name.lstrip("."))
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, copy)
            if page != path:
                self.write(page, (of_notebook if path.suffix == ".ipynb" else of_source)(source, path))
        return page


def title(text):
    return text[0].upper() + text[1:]


def navigation(root):
    """Sections of docs/README.md, with the links in the first column of their tables; then gallery and interfaces."""
    books = [{"Sprekk": ["README.md"]}]
    for line in (root / "docs/README.md").read_text().splitlines():
        if line.startswith("## "):
            books.append({line[3:]: (pages := [])})
            group = pages
        elif line.startswith("| **"):
            pages.append({line.split("**")[1]: (group := [])})
        elif line.startswith("| ["):
            links = re.findall(r"\[([^\]]+)\]\(([^)#]+)\)", line.split("|")[1])
            group += [{title(name): os.path.normpath(f"docs/{link}")} for name, link in links]
    if len(books) == 1:
        raise PageError("docs/README.md: has no section with a table of pages")
    return books + [{"Gallery": [GALLERY]}, {"Interfaces": [{"Python": PYTHON}, {"C++": CPP}]}]
