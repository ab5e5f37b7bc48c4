"""A page on the Python package, of the signatures and docstrings in its sources. Nothing is imported or built."""
import ast
import html
import inspect
import re

PAGE = re.compile(r"\bdocs/\w+/\w+\.md\b")
RETURNED = {"Unknown": [("State", "module.py")], "fit": [("Estimate", "../../fit/estimate.py")]}  # classes not imported
ENTRY = re.compile(r"^(\w+(?:, \w+)*)(?:  +|: )(\S.*)$")  # of a list of arguments


def public(package):
    """(name, file) of the names that the package imports from its own modules."""
    for node in ast.parse((package / "__init__.py").read_text()).body:
        if isinstance(node, ast.ImportFrom) and node.level == 1 and node.module and node.module != "_sprekk":
            for alias in node.names:
                yield alias.name, package / f"{node.module}.py"
                for name, file in RETURNED.get(alias.name, []):
                    yield name, package / file


def markdown(text):
    """Escaped text, except in code; names of pages become links."""
    parts = re.split(r"(`[^`]*`)", text)
    return "".join(part if k % 2 else PAGE.sub(r"[\g<0>](../\g<0>)", html.escape(part, quote=False))
                   for k, part in enumerate(parts))


def text_of(node):
    """A docstring as Markdown; aligned lists of arguments become lists."""
    lines, found = inspect.cleandoc(ast.get_docstring(node) or "").splitlines(), []
    for line in lines:
        entry = ENTRY.match(line)
        if entry and "  " in line[:len(entry[1]) + 2]:
            if not found or not found[-1].startswith(("* ", "    ")):
                found.append("")
            found.append(f"* `{entry[1]}`: {markdown(entry[2])}")
        elif found and found[-1].startswith(("* ", "    ")) and line.startswith(" "):
            found.append("    " + markdown(line.strip()))
        else:
            if found and found[-1].startswith(("* ", "    ")):
                found.append("")
            found.append(markdown(line))
    return "\n".join(found) + "\n"


def signature(name, node, bound=False):
    arguments = ast.unparse(node.args)
    if bound and not any(ast.unparse(d) == "staticmethod" for d in node.decorator_list):
        arguments = re.sub(r"^\w+(, )?", "", arguments)
    return f"{name}({arguments})"


def is_property(node):
    return any(ast.unparse(decorator) in ("property", "cached_property") for decorator in node.decorator_list)


def declaration(node, source):
    """Constructor of a class, or its lines with class attributes: all of the constructor of a dataclass."""
    begin = next((f for f in node.body if isinstance(f, ast.FunctionDef) and f.name == "__init__"), None)
    if begin:
        return signature(node.name, begin, True)
    lines = source.splitlines()
    bases = f"({', '.join(map(ast.unparse, node.bases))})" if node.bases else ""
    attributes = [line for inner in node.body if isinstance(inner, (ast.Assign, ast.AnnAssign))
                  for line in lines[inner.lineno - 1:inner.end_lineno]]
    head = [f"@{ast.unparse(decorator)}" for decorator in node.decorator_list]
    return "\n".join([*head, f"class {node.name}{bases}" + ":" * bool(attributes), *attributes])


def of_class(node, source):
    functions = [f for f in node.body if isinstance(f, ast.FunctionDef)]
    parts = [f"```python\n{declaration(node, source)}\n```\n", text_of(node)]
    for function in functions:
        if function.name.startswith("_"):
            continue
        head = function.name if is_property(function) else signature(function.name, function, True)
        parts += [f"### {node.name}.{function.name}\n", f"```python\n{head}\n```\n", text_of(function)]
    return parts


def page(package):
    parts = ["# Python\n", "Classes and functions of the package `sprekk`. [Python](../docs/use/python.md) is an "
             "introduction, also to the classes of `sprekk.entries`.\n"]
    for name, file in public(package):
        source = file.read_text()
        node = next((n for n in ast.parse(source).body if getattr(n, "name", None) == name), None)
        if node is None:
            raise ValueError(f"{file}: has no class or function {name}")
        parts.append(f"## {name}\n")
        if isinstance(node, ast.ClassDef):
            parts += of_class(node, source)
        else:
            parts += [f"```python\n{signature(name, node)}\n```\n", text_of(node)]
    return "\n".join(parts)
