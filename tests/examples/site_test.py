#!/usr/bin/env python3
"""The web site of the documentation: site_test.py ROOT

Builds the site in a temporary folder, checks its internal links, and opens its pages in headless Chromium. Without
MkDocs, its theme, KaTeX, Doxygen or Chromium it ends with status 77, which ctest shows as skipped."""
import csv
import importlib.util
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "report_app"))
import browser  # noqa: E402

ROOT = Path(sys.argv[1]).resolve()
CPP = "cpp"  # folder of Doxygen's pages, whose links are Doxygen's
WIDE, PHONE = 1280, 390  # pixels
PARTS = {"MkDocs": importlib.util.find_spec("mkdocs"), "Doxygen": shutil.which("doxygen"),
         "Chromium": browser.program(),
         "Material": Path("/usr/share/mkdocs/themes/material").exists(),
         "KaTeX": Path("/usr/share/javascript/katex").exists()}


class Links(HTMLParser):
    """Targets of links, addresses of pictures, styles and scripts, and anchors of a page."""

    def __init__(self, text):
        super().__init__()
        self.links, self.parts, self.anchors = [], [], set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        content = dict(attributes)
        self.anchors |= {content[name] for name in ("id", "name") if content.get(name)}
        if tag == "a" and content.get("href"):
            self.links.append(content["href"])
        self.parts += [content[name] for name in ("src", "href") if tag != "a" and content.get(name)]


class SiteTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.site = Path(folder.name) / "site"
        command = [sys.executable, "-B", ROOT / "apps/docs", "--output", cls.site]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            raise AssertionError(done.stderr)
        pages = [path for path in sorted(cls.site.rglob("*.html")) if CPP not in path.parts]
        cls.files = {path: Links(path.read_text()) for path in pages}

    def open(self, page, width):
        self.browser.open(self.site / page, width, 844, mobile=width == PHONE)
        self.assertEqual(self.browser.complaints, [], page)
        remote = [url for url in self.browser.requests if not url.startswith(("file:", "data:", "blob:"))]
        self.assertEqual(remote, [], page)

    def start_browser(self):
        self.browser = browser.Browser()
        self.addCleanup(self.browser.close)

    def wait_for(self, condition):
        end = time.monotonic() + browser.PATIENCE
        while not self.browser.value(condition):
            self.assertLess(time.monotonic(), end, condition)
            time.sleep(0.1)

    def pages(self):
        """Without those of source files."""
        found = [path.relative_to(self.site) for path in self.files]
        return [page for page in found if len(page.parts) == 1 or page.parts[0] in ("api", "docs", "perf")
                and "." not in page.stem]

    def test_links(self):
        dead = []
        for file, page in self.files.items():
            for link in page.links + page.parts:
                url = urlsplit(link)
                name = file.relative_to(self.site)
                if url.scheme or url.netloc:
                    if link in page.parts and url.scheme not in ("data", "javascript"):
                        dead.append(f"{name}: {link} is loaded from the network")
                    continue
                target = (file.parent / unquote(url.path)).resolve() if url.path else file
                if target.is_dir():
                    target = target / "index.html"
                if not target.exists():
                    dead.append(f"{name}: there is no {link}")
                elif url.fragment and target in self.files and unquote(url.fragment) not in self.files[target].anchors:
                    dead.append(f"{name}: {link} has no such anchor")
        self.assertEqual(dead, [])

    def test_pages(self):
        """Without errors in the console; a phone needs no scrolling sideways; no formula is left as TeX."""
        self.start_browser()
        self.assertGreater(len(self.pages()), 40)
        for page in self.pages():
            self.open(page, PHONE)
            self.assertLessEqual(self.browser.value("document.documentElement.scrollWidth"), PHONE, page)
            self.assertEqual(self.browser.value(
                "[...document.querySelectorAll('.arithmatex')].filter(e => !e.querySelector('.katex'))"
                ".concat([...document.querySelectorAll('.katex-error')]).map(e => e.textContent)"), [], page)
        for page in ("index.html", "gallery.html", "docs/model/flow.html", "docs/use/reference.html"):
            self.open(page, WIDE)
            self.assertLessEqual(self.browser.value("document.documentElement.scrollWidth"), WIDE, page)

    def test_search(self):
        """From a folder, without a server; also of a page of the book on the model."""
        self.start_browser()
        for page, word, found in (("index.html", "excavation", "docs/use/stages.html"),
                                  ("docs/use/input.html", "hybridised", "docs/model/flow.html")):
            self.open(page, WIDE)
            self.wait_for("!document.querySelector('.md-search-result__meta').innerText.includes('Initializing')")
            self.browser.value(
                "document.querySelector('#__search').click();"
                "(query => {"
                f" query.focus(); query.value = '{word}'; query.dispatchEvent(new Event('keyup', {{bubbles: true}}));"
                "})(document.querySelector('[data-md-component=search-query]'))")
            links = "[...document.querySelectorAll('.md-search-result__link')].map(link => link.href)"
            self.wait_for(f"{links}.length")
            links = self.browser.value(links)
            self.assertTrue(any(found in link for link in links), (word, links))
            self.assertEqual(self.browser.complaints, [])

    def test_gallery(self):
        """A row in docs/gallery/scenes.csv and a card for each scene; with a picture unless it takes too long."""
        text = (self.site / "gallery.html").read_text()
        with open(ROOT / "docs/gallery/scenes.csv", newline="") as file:
            rows = {row["scene"]: row for row in csv.DictReader(file)}
        scenes = [path.relative_to(ROOT) for path in (ROOT / "xml").glob("*/*.xml")]
        scenes = [scene for scene in scenes if scene.parts[1] != "verification"]
        self.assertEqual(sorted(rows), sorted(map(str, scenes)), "rewrite the rows: ./sprekk docs --gallery SCENE")
        for scene in scenes:
            comment = re.match(r"\s*<!--(.*?)-->", (ROOT / scene).read_text(), re.DOTALL)
            self.assertTrue(comment and comment[1].strip(), f"{scene}: does not begin with a comment on its purpose")
            self.assertIn(f'href="{scene}.html"', text)
            picture = rows[str(scene)]["picture"]
            self.assertEqual(bool(picture), not rows[str(scene)]["seconds"].startswith(">"), scene)
            self.assertTrue(not picture or f"docs/gallery/{picture}" in text, scene)


if __name__ == "__main__":
    missing = [name for name, found in PARTS.items() if not found]
    if missing:
        print(f"skipped: {', '.join(missing)} missing; ./sprekk test installs all")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1])
