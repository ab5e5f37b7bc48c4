#!/usr/bin/env python3
"""Checks the rules of the sources.

    check_rules.py ROOT     prints "file:line: [rule] message" for every violation; exit status 1 if there is any

Rules: include-order, solver-header, host-only, kernel, unfinished, self-contained, static-state, generic-room,
physics-room, trilinos-names, compiler, functor, lambda, host-read, host-pointer."""
import re
import sys
from pathlib import Path

USES = {
    "base": "",
    "laws": "base",
    "mesh": "base",
    "fields": "base mesh",
    "contact": "base mesh fields",
    "assembly": "base mesh fields contact",
    "estimate": "base mesh fields assembly",
    "transport": "base laws mesh fields assembly estimate",
    "physics": "base laws mesh fields contact assembly estimate transport",
    "multigrid": "base fields",
    "solve": "base fields multigrid",
    "laboratory": "base laws physics solve",
    "io": "base mesh fields",
    "model": "base laws mesh fields contact assembly estimate transport physics multigrid solve laboratory io",
}
FOLDERS = ["packages", "apps", "tests", "xml", "perf", "docs", "cmake", ".ci"]  # and the files in the root folder
SOURCES = {".hpp", ".cpp", ".h"}

SOLVER_HEADER = re.compile(r'\s*#\s*include\s*[<"]((?:NOX|Stratimikos|Belos|Teko|MueLu|Amesos2)[^>"]*)')
HOST_ONLY = re.compile(
    r"\bMPI_COMM_WORLD\b|\bgetDefaultComm\b|\bMPI_Init\w*|\bKokkos::initialize\b|\b_?[eE]xit\s*\(|\babort\s*\(|\bstd::abort\b")
# Names that later versions of Trilinos and Kokkos do not have.
OLD_TRILINOS = re.compile(r"\bgetNode(?:Num\w+|ElementList)\b|\bKokkos::Experimental::\w+|\bgetLocalMatrix\s*\(")
TRILINOS_COMPAT = "packages/base/trilinos_compat.hpp"  # and its test

# Packages independent of the physics, checked by words of the present physics.
GENERIC = {"base", "mesh", "fields", "assembly", "estimate", "multigrid", "solve", "io", "model"}
PHYSICS = re.compile(
    r"\b(?:pressures?|fluids?|tractions?|friction|temperatures?|heat|dilation|apertures?|biot|permeability|porosity"
    r"|viscosity|displacements?|jumps?|slips?|stress(?:es)?)\b", re.IGNORECASE)
# Words of a physics, allowed only in its folder of packages/physics and in the list of physics: such a physics is one
# folder and one line.
OF_PHYSICS = {"heat": re.compile(r"heat|temperature", re.IGNORECASE), "tracer": re.compile(r"tracer", re.IGNORECASE)}
LIST = "packages/physics/list.hpp"

NOT_IN_KERNELS = re.compile(
    r"\bstd::(?:vector|map|unordered_map|set|string|cout|cerr|function)\b|\bnew\b|\b(?:malloc|printf)\s*\("
    r"|(?:\.|->)data\s*\(\s*\)|\bthrow\b|\bSPREKK_(?:DEBUG_)?CHECK\b|\bfmt::|\bTeuchos::"
    r"|\b(?:create_mirror\w*|deep_copy|getLocalView\w*)\b")
# Packages whose kernels must compile for a GPU, see tests/device. Other code is host code or declares it.
ON_DEVICE = {"laws", "transport", "physics", "assembly"}
# Extensions of compilers, and the files that may use them.
COMPILERS = re.compile(r"\b__(?:builtin_\w+|attribute__|declspec)\b|\b_mm\d*_\w+")
KNOW_COMPILERS = {"packages/fields/node_kernels.hpp", "packages/multigrid/rounded_matrix.hpp",
                  "packages/solve/condensed_block.cpp"}
FUNCTOR = re.compile(r"\boperator\s*\(\)\s*\(\s*(?:const\s+)?(?:int|LocalIndex|std::size_t)\b[^)]*\)\s*const")
# View in device memory. The group matches an explicit memory space.
DEVICE_VIEW = re.compile(r"\b(Kokkos::)?(?:Const)?View<")
UNFINISHED = re.compile(r"\b(?:TOD[O]|FIXM[E]|XX[X]|HAC[K])\b")
NOT_SELF_CONTAINED = re.compile(r"/wor[k]/|\b[s]essions?\b|\b[i]ssue #", re.IGNORECASE)
KERNEL_MACRO = r"KOKKOS_(?:CLASS_)?LAMBDA|KOKKOS_(?:FORCE)?(?:INLINE_)?FUNCTION"

# Variables with static lifetime: at column 0 (contents of namespaces are not indented), or static at any depth.
IMMUTABLE = r"(?:[\w:<>,\s*&]*\b(?:const|constexpr)\b)"
STATIC = re.compile(r"^[ \t]*(?:inline[ \t]+)?(?:static|thread_local)\b(?!_)(?P<rest>[^;{=]*(?:[;{=]))", re.MULTILINE)
GLOBAL = re.compile(
    r"^(?!(?:using|namespace|template|concept|struct|class|enum|union|typedef|return|friend|extern|static|thread_local"
    r"|public|private|protected|case|default|goto|else|delete)\b)(?:inline[ \t]+)?"
    r"[A-Za-z_][\w:]*(?:<[^;(){}]*>)?[ \t*&]+"
    r"\w[\w:]*(?:\[\w*\])*[ \t]*(?:=[^=]|;|\{)", re.MULTILINE)


def blanked(text):
    """Returns the text with blanks for comments and literals. Line numbers do not change."""
    token = re.compile(
        r'//[^\n]*|/\*.*?\*/|R"(?P<tag>[^\s()\\]*)\(.*?\)(?P=tag)"|"(?:\\.|[^"\\\n])*"|(?<![\w\'])'
        r"'(?:\\.|[^'\\\n])+'", re.DOTALL)
    return token.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), text)


def end_of_braces(code, start):
    """Returns the position after the closing brace of the one at start."""
    depth = 0
    for i in range(start, len(code)):
        depth += {"{": 1, "}": -1}.get(code[i], 0)
        if depth == 0:
            return i + 1
    return len(code)


def kernel_bodies(code, macro):
    """Yields (start, end) of the body after each kernel macro, except declarations."""
    for match in re.finditer(rf"\b(?:{macro})\b", code):
        line_start = code.rfind("\n", 0, match.start()) + 1
        if re.match(r"\s*#", code[line_start:match.start()]):
            continue
        depth, i = 0, match.end()
        while i < len(code):
            depth += {"(": 1, ")": -1}.get(code[i], 0)
            if depth == 0 and code[i] == ";":
                break
            if depth == 0 and code[i] == "{":
                end = end_of_braces(code, i)
                yield i, end
                # member initialisers with braces precede the body of a constructor: a_{x}, b_{y} { ... }
                if "LAMBDA" in match.group() or not re.match(r"\s*[,{]", code[end:]):
                    break
                i = end - 1
            i += 1


def around(code, position):
    """Yields (text before the brace, position) of every open brace at a position, innermost first."""
    depth = 0
    for i in range(position - 1, -1, -1):
        depth += {"}": 1, "{": -1}.get(code[i], 0)
        if depth < 0:
            depth = 0
            begin = max(code.rfind(c, 0, i) for c in ";{}") + 1
            yield code[begin:i], i


def wrong_place(code, position):
    """Returns the reason why GPU compilers reject a lambda kernel at this position, or None."""
    for head, brace in around(code, position):
        if re.search(r"\]\s*\([^)]*\bauto\b", head):
            return "in a generic lambda"
        kind = re.search(r"\b(class|struct)\s+\w+[^()]*$", without_templates(head))
        if not kind:
            continue
        outside = list(code[brace + 1:position])  # without nested code of the class
        depth = 0
        for i, c in enumerate(outside):
            depth += {"{": 1, "}": -1}.get(c, 0)
            if depth > 0:
                outside[i] = " "
        access = re.findall(r"\b(public|protected|private)\s*:", "".join(outside))
        if (access or [{"class": "private", "struct": "public"}[kind[1]]])[-1] != "public":
            return "in a member that is not public"
    return None


def end_of_template(code, start):
    """Returns the position after the closing bracket of the one at start."""
    depth = 0
    for i in range(start, len(code)):
        depth += {"<": 1, ">": -1}.get(code[i], 0)
        if depth == 0:
            return i + 1
    return len(code)


def device_views(code):
    """Returns names that are declared only as View or ConstView, without functions that return one."""
    views, others = set(), set(re.findall(r"\bauto\s*&?\s*(\w+)\s*[=(]", code))
    others.update(re.findall(r"\b(\w+)\s*\([^(){};]*\)\s*(?:const\b|override\b|\{)", code))
    for match in DEVICE_VIEW.finditer(code):
        name = re.compile(r"\s*(?:const\s*)?&?\s*(\w+)\s*(?:[;={,)]|\(\s*,|(\(\s*[^\s,]))").match(
            code, end_of_template(code, match.end() - 1))
        if name:
            (others if name[2] or match[1] else views).add(name[1])
    return views - others


def check_host(code, kernels):
    """Yields accesses of host code to device views, and host pointers used in kernels."""
    def on_host(position):
        return not any(start <= position < end for start, end in kernels)
    for name in device_views(code):
        for match in re.finditer(rf"(?<![\w.>:]){name}\s*\(\s*[^\s,)]", code):  # labels are blank
            if on_host(match.start()):
                yield match.start(), "host-read", f"{name}(...) outside of kernels, without a mirror"
    for match in re.finditer(r"\b(\w+)\s*=\s*[^;{}]*(?:\.|->)data\s*\(\s*\)\s*;", code):
        if on_host(match.start()) and any(re.search(rf"\b{match[1]}\b", code[start:end]) for start, end in kernels):
            yield match.start(), "host-pointer", f"{match[1]} is used in a kernel"


def check_kernels(code):
    """Yields violations in packages whose kernels must compile for a GPU."""
    yield from check_host(code, list(kernel_bodies(code, KERNEL_MACRO)))
    for match in FUNCTOR.finditer(code):
        begin = max(code.rfind(c, 0, match.start()) for c in ";{}:") + 1
        if "KOKKOS_" not in code[begin:match.start()] and "std::" not in match.group():
            yield match.start(), "functor", "operator() of an index without KOKKOS_INLINE_FUNCTION"
    for match in re.finditer(r"\bKOKKOS_LAMBDA\b", code):
        why = wrong_place(code, match.start())
        if why:
            yield match.start(), "lambda", f"KOKKOS_LAMBDA {why}"


def without_templates(text):
    """Returns the text without template arguments, whose parentheses look like those of a function."""
    while True:
        shorter = re.sub(r"<[^<>]*>", "", text)
        if shorter == text:
            return text
        text = shorter


def mutable_statics(code):
    for match in STATIC.finditer(code):
        declaration = without_templates(match["rest"])
        if not re.match(IMMUTABLE, declaration) and "(" not in declaration:
            yield match.start(), match.group().split("\n")[-1].strip()
        elif re.search(r"\(\s*[\d\"'-]", declaration) and not re.match(IMMUTABLE, declaration):
            yield match.start(), match.group().strip()  # e.g. static Thing thing(3);
    for match in GLOBAL.finditer(code):
        if not re.match(IMMUTABLE, match.group()):
            yield match.start(), match.group().strip()


def check_cpp(path, text, aliases):
    """Yields violations (position, rule, message) of a C++ source; the path is relative to the root."""
    parts, code = path.parts, blanked(text)
    for match in OLD_TRILINOS.finditer(code if "trilinos_compat" not in path.name else ""):
        yield match.start(), "trilinos-names", f"{match.group()}: see {TRILINOS_COMPAT}"
    package = parts[1] if parts[0] == "packages" else None
    if parts[0] in ("packages", "apps") and package != "solve":
        for match in re.finditer(SOLVER_HEADER.pattern, text, re.MULTILINE):
            yield match.start(1), "solver-header", f"{match[1]} outside packages/solve"
    if package is None:
        return
    name = str(path)
    if package in GENERIC:
        for match in PHYSICS.finditer(text):
            yield match.start(), "generic-room", f"{match.group()} in packages/{package}"
    for physics, words in OF_PHYSICS.items():
        room = f"packages/physics/{physics}/"
        for match in words.finditer("" if name == LIST or name.startswith(room) else text):
            yield match.start(), "physics-room", f"{match.group()} outside {room}"
    allowed = {package, *USES.get(package, "").split()}
    for match in re.finditer(r'^\s*#\s*include\s*"(\w+)/', text, re.MULTILINE):
        if match[1] not in allowed:
            yield match.start(1), "include-order", f"{package} may not include {match[1]}/"
    for match in HOST_ONLY.finditer(code):
        yield match.start(), "host-only", f"{match.group()} belongs to apps and tests"
    for start, end in kernel_bodies(code, "|".join([KERNEL_MACRO, *aliases])):
        for match in NOT_IN_KERNELS.finditer(code, start, end):
            yield match.start(), "kernel", f"{match.group()} in a kernel"
    for position, what in mutable_statics(code):
        yield position, "static-state", what
    for match in COMPILERS.finditer(code if name not in KNOW_COMPILERS else ""):
        yield match.start(), "compiler", f"{match.group()}: see packages/fields/node_kernels.hpp"
    if package in ON_DEVICE:
        yield from check_kernels(code)


def check_text(text):
    for match in UNFINISHED.finditer(text):
        yield match.start(), "unfinished", match.group()
    for match in NOT_SELF_CONTAINED.finditer(text):
        yield match.start(), "self-contained", match.group()


def check(root):
    """Returns all violations under root as (file, line, rule, message), sorted."""
    files = [f for f in root.iterdir() if f.is_file() and f.name != ".git"]  # .git is a file in worktrees
    for folder in FOLDERS:
        files += [f for f in (root / folder).rglob("*") if f.is_file()]
    texts = {}
    for file in files:
        try:
            texts[file.relative_to(root)] = file.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            pass  # a picture
    aliases = set()
    for path, text in texts.items():
        if path.suffix in SOURCES:
            aliases.update(re.findall(rf"#\s*define\s+(\w+)[^\n]*\b(?:{KERNEL_MACRO})\b", text))
    violations = set()
    for path, text in texts.items():
        found = list(check_text(text))
        if path.suffix in SOURCES and path.parts[0] in ("packages", "apps", "perf", "tests"):
            found += check_cpp(path, text, aliases)
        violations.update((str(path), text.count("\n", 0, at) + 1, rule, what) for at, rule, what in found)
    return sorted(violations)


def main():
    root = Path(sys.argv[1])
    if not (root / "packages").is_dir():
        sys.exit(f"{root}: has no packages/ to check")
    violations = check(root)
    for file, line, rule, what in violations:
        print(f"{file}:{line}: [{rule}] {what}")
    sys.exit(1 if violations else 0)


if __name__ == "__main__":
    main()
