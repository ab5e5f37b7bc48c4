#!/usr/bin/env python3
"""Checks the documentation.

    check_docs.py quotes ROOT              Code in a ```cpp, ```xml or ```cmake block is equal to text of the file in
                                           the comment before the block (<!-- from PATH -->). Relative links are valid.
                                           The version is that of CMakeLists.txt.
    check_docs.py commands ROOT BINARY MPIEXEC PAGES...
                                           Each command in a ```sh or ```console block ends with status 0, or N if
                                           "# exit N" follows. The lines below a command in a ```console block are part
                                           of its output. Blocks after <!-- not run: REASON --> and commands that build
                                           are skipped. The pages share a folder. A scene that several pages run or plot
                                           in the same way is run and plotted once.
    check_docs.py reference ROOT BINARY    docs/use/reference.md and docs/use/materials.md are equal to the output of
                                           the binary.
    check_docs.py change ROOT PAGE TARGETS...
                                           The ```diff block of the page applies to a copy of the sources, and the
                                           targets build there. The ```console blocks that are "not run" elsewhere have
                                           the given output.
    check_docs.py doxygen ROOT FOLDER      docs/Doxyfile generates FOLDER/doxygen without warnings.

Prints the errors. Exit status 1 after an error, 77 if a program for a command is missing."""
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

BLOCK = re.compile(r"^(?:<!-- (?:from (?P<source>\S+)|not run: (?P<reason>[^\n]+)) -->\n)?```(?P<kind>\w+)\n(?P<content>.*?)^```$",
                   re.DOTALL | re.MULTILINE)
LINK = re.compile(r"\[[^\]]*\]\((?!https?:|#|mailto:)([^)#\s]+)[^)]*\)")


class Skipped(str):
    """Description of a skipped check."""


def pages(root):
    return [root / "README.md", *sorted((root / "docs").rglob("*.md")), *sorted(root.glob("packages/*/README.md"))]


def check_quotes(root):
    version = re.search(r"project\(Sprekk VERSION (\S+)", (root / "CMakeLists.txt").read_text())[1]
    for name, words in (("CITATION.cff", f"version: {version}\n"), ("README.md", f'"Sprekk {version}"'),
                        ("CHANGELOG.md", version)):
        if words not in (root / name).read_text():
            yield f"{name}: does not name the version, {version}"
    for page in pages(root):
        text = page.read_text()
        fences = len(re.findall(r"^```", text, flags=re.MULTILINE))
        if fences != 2 * len(BLOCK.findall(text)):
            yield f"{page.relative_to(root)}: {fences} lines with ```, which make {len(BLOCK.findall(text))} blocks"
        for block in BLOCK.finditer(text):
            place = f"{page.relative_to(root)}:{text.count(chr(10), 0, block.start()) + 1}"
            if block["kind"] not in ("cpp", "xml", "cmake"):
                continue
            if not block["source"]:
                yield f"{place}: the block does not say from which file it is"
            elif block["content"] not in (root / block["source"]).read_text():
                yield f"{place}: {block['source']} does not contain this block"
        for link in LINK.finditer(re.sub(r"```.*?```|`[^`\n]*`", "", text, flags=re.DOTALL)):
            if not (page.parent / link[1]).exists():
                yield f"{page.relative_to(root)}: the link {link[1]} leads nowhere"


# Replacement of ./sprekk for these commands, without a build.
LAUNCHER = """#!/usr/bin/env bash
words=() mpi=() sets=()
while (($#)); do
  if [[ $1 == --set ]]; then sets+=("$1" "$2"); fi
  if [[ $1 == --ranks ]]; then mpi=({mpiexec} --quiet --oversubscribe --bind-to none -np "$2"); shift
  else words+=("$1"); fi
  shift
done
mesh=({python} -B {root}/apps/mesh --program {binary})
if [[ ${{words[0]}} == mesh ]]; then exec "${{mesh[@]}}" "${{words[@]:1}}"; fi
if [[ ${{words[0]}} =~ ^(run|check)$ ]] && grep -q '"network"' "${{words[1]}}"; then
  folder=output/$(basename "${{words[1]}}" .xml)
  "${{mesh[@]}}" "${{words[1]}}" -o "$folder/network.msh" --quiet "${{sets[@]}}" || exit
  words+=(--set "Mesh file.path=$PWD/$folder/network.msh")
  if [[ ${{words[0]}} == run && " ${{words[*]}} " != *" --output "* ]]; then words+=(--output "$folder"); fi
fi
if [[ ${{words[0]}} == new ]]; then exec {root}/sprekk "${{words[@]}}"; fi
if [[ ${{words[0]}} =~ ^(plot|report|export)$ ]]; then exec {python} -B {root}/apps/${{words[0]}} "${{words[@]:1}}"; fi
if [[ ${{words[0]}} == upscale ]]; then export PYTHONPATH={modules}; exec "${{mpi[@]}}" {python} -B -m sprekk.upscale "${{words[@]:1}}"; fi
if [[ ${{words[0]}} =~ ^(network|fit)$ ]]; then exec {python} -B {root}/apps/${{words[0]}} --program {binary} "${{words[@]:1}}" "${{sets[@]}}"; fi
exec "${{mpi[@]}}" {binary} "${{words[@]}}"
"""
REPEATED = re.compile(r"\./sprekk (run xml/\S+|plot output/\S+ --dpi \d+)")
PROGRAM = ("./sprekk", "sprekk")
BUILDS = re.compile(r"\./sprekk (build|test|fuzz)\b")
PLOT_PYTHON = "/usr/bin/python3" if os.path.exists("/usr/bin/python3") else "python3"


def prepare(folder, root, binary, mpiexec):
    """Copies the files of a user to the folder: scenes, pages, ./sprekk, and the program at the place of a build."""
    for name in ("xml", "docs", "tests/data", "perf/experiments"):
        shutil.copytree(root / name, folder / name)
    launcher = folder / "sprekk"
    launcher.write_text(LAUNCHER.format(**{name: shlex.quote(str(value)) for name, value in {
        "mpiexec": mpiexec, "python": PLOT_PYTHON, "root": root, "binary": Path(binary).resolve(),
        "modules": Path(binary).resolve().parents[2] / "python"}.items()}))
    launcher.chmod(0o755)
    program = folder / "build/apps/sprekk/sprekk"
    program.parent.mkdir(parents=True)
    program.symlink_to(Path(binary).resolve())


def commands(block):
    """Returns (command, expected lines) of each command in the block."""
    found = []
    for line in block["content"].replace("\\\n", "").splitlines():
        if block["kind"] == "console" and not line.startswith("$ "):
            found[-1][1].append(line)
        elif line.strip() and not line.startswith("#"):
            found.append((line.removeprefix("$ "), []))
    return [c for c in found if not BUILDS.match(c[0])]


def missing_program(command):
    """Returns the missing program or modules of a command, or None."""
    needs = {"plot": "matplotlib, numpy, vtkmodules", "mesh": "gmsh, matplotlib, numpy, shapely", "network": "numpy, shapely",
             "fit": "matplotlib, numpy, scipy", "upscale": "matplotlib, meshio, mpi4py, numpy, pandas, scipy"}
    words = command.split()
    if words[0] in PROGRAM and words[1] in needs:
        modules = needs[words[1]]
        found = subprocess.run([PLOT_PYTHON, "-c", "import " + modules], stderr=subprocess.DEVNULL).returncode == 0
        return None if found else f"one of {modules} for {PLOT_PYTHON}"
    words = [word for word in shlex.split(command) if "=" not in word]
    return None if words[0] in PROGRAM or "/" in words[0] or shutil.which(words[0]) else words[0]


def run(command, folder, time_limit=600):
    environment = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}", "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                   "OMP_NUM_THREADS": "1"}  # on the path, `sprekk` of an installed package is ./sprekk
    return subprocess.run(["bash", "-o", "pipefail", "-c", command], cwd=folder, env=environment,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          timeout=time_limit)


def check_commands(root, binary, mpiexec, *pages):
    done = {}
    with tempfile.TemporaryDirectory() as folder:
        prepare(Path(folder), root, binary, mpiexec)
        for page in pages:
            for block in BLOCK.finditer((root / page).read_text()):
                if block["kind"] in ("sh", "console") and not block["reason"]:
                    yield from check_block(page, block, folder, done)


def check_change(root, page, *targets):
    """Yields the errors of a page with a change of the sources. With ccache only changed files are compiled."""
    if missing := [program for program in ("cmake", "ninja", "patch") if not shutil.which(program)]:
        yield Skipped(f"not run, this machine lacks {missing[0]}")
        return
    text = (root / page).read_text()
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder).resolve() / "copy"
        shutil.copytree(root, copy, ignore=lambda where, names: [name for name in names if name in (".git", "output") or (
            Path(where) == root and name.startswith("build"))])
        for block in BLOCK.finditer(text):
            if block["kind"] == "diff":
                (copy / "page.diff").write_text(block["content"])
                for command in ("patch -p1 --fuzz=0 < page.diff", "cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release",
                                "ninja -C build " + " ".join(targets)):
                    done = run(command, copy, time_limit=1400)
                    if done.returncode:
                        yield f"{page}: {command}: exit status {done.returncode}\n{done.stdout[-5000:]}"
                        return
            elif block["kind"] == "console" and block["reason"]:
                yield from check_block(page, block, copy)


def check_block(page, block, folder, runs=None):
    """Runs the commands of a block in the folder and yields errors; `runs` stores repeatable commands."""
    for command, expected in commands(block):
        if missing := missing_program(command):
            yield Skipped(f"{page}: {command}: not run, this machine lacks {missing}")
            continue
        done = (runs or {}).get(command) or run(command, folder)
        if runs is not None and REPEATED.fullmatch(command):
            runs[command] = done
        status = re.search(r"# exit (\d)", command)
        if done.returncode != (int(status[1]) if status else 0):
            yield f"{page}: {command}: exit status {done.returncode}\n{done.stdout}"
        for line in expected:
            if line not in done.stdout.splitlines():
                yield f"{page}: {command}: does not print\n  {line}\nbut\n{done.stdout}"


def check_reference(root, binary):
    for command, path in (("reference", "docs/use/reference.md"), ("materials", "docs/use/materials.md")):
        printed = subprocess.run([binary, command], stdout=subprocess.PIPE, text=True, check=True).stdout
        if printed != (root / path).read_text():
            yield f"{path} is out of date; write it again with ./sprekk {command} > {path}"


def check_doxygen(root, folder):
    if not shutil.which("doxygen"):
        yield Skipped("not run, this machine lacks doxygen")
        return
    settings = (root / "docs/Doxyfile").read_text() + f'OUTPUT_DIRECTORY = "{folder}/doxygen"\n'
    done = subprocess.run(["doxygen", "-"], cwd=root, input=settings, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                          text=True)
    if done.returncode or done.stderr:
        yield done.stderr


def main():
    what, root, *rest = sys.argv[1:]
    check = {"quotes": check_quotes, "commands": check_commands, "reference": check_reference,
             "doxygen": check_doxygen, "change": check_change}[what]
    found = list(check(Path(root).resolve(), *rest))
    print("\n".join(found))
    wrong = any(not isinstance(message, Skipped) for message in found)
    sys.exit(1 if wrong else 77 if found else 0)


if __name__ == "__main__":
    main()
