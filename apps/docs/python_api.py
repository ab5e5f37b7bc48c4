"""A page on the Python package, of the signatures and docstrings in its sources. Nothing is imported or built."""
import ast
import html
import inspect
import re

ENTRY = re.compile(r"^(\w+(?:, \w+)*)(?:  +|: )(\S.*)$")  # of a list of arguments


def public(package):
    """(name, file) of the names that the package imports from its own modules."""
    for node in ast.parse((package / "__init__.py").read_text()).body:
        if isinstance(node, ast.ImportFrom) and node.level == 1 and node.module and node.module != "_sprekk":
            for alias in node.names:
                yield alias.name, package / f"{node.module}.py"


def text_of(node):
    """A docstring as Markdown; aligned lists of arguments become lists."""
    lines, found = inspect.cleandoc(ast.get_docstring(node) or "").splitlines(), []
    for line in lines:
        entry = ENTRY.match(line)
        if entry and "  " in line[:len(entry[1]) + 2]:
            if not found or not found[-1].startswith(("* ", "    ")):
                found.append("")
            found.append(f"* `{entry[1]}`: {html.escape(entry[2], quote=False)}")
        elif found and found[-1].startswith(("* ", "    ")) and line.startswith(" "):
            found.append("    " + html.escape(line.strip(), quote=False))
        else:
            if found and found[-1].startswith(("* ", "    ")):
                found.append("")
            found.append(html.escape(line, quote=False))
    return "\n".join(found) + "\n"


def signature(name, node, bound=False):
    arguments = ast.unparse(node.args)
    if bound and not any(ast.unparse(d) == "staticmethod" for d in node.decorator_list):
        arguments = re.sub(r"^\w+(, )?", "", arguments)
    return f"{name}({arguments})"


def is_property(node):
    return any(ast.unparse(decorator) in ("property", "cached_property") for decorator in node.decorator_list)


def of_class(node):
    functions = [f for f in node.body if isinstance(f, ast.FunctionDef)]
    begin = next((f for f in functions if f.name == "__init__"), None)
    parts = [f"```python\n{signature(node.name, begin, True) if begin else node.name}\n```\n", text_of(node)]
    for function in functions:
        if function.name.startswith("_"):
            continue
        head = function.name if is_property(function) else signature(function.name, function, True)
        parts += [f"### {node.name}.{function.name}\n", f"```python\n{head}\n```\n", text_of(function)]
    return parts


def page(package):
    parts = ["# Python\n", "Classes and functions of the package `sprekk`. [Python](../docs/use/python.md) is an "
             "introduction. The entries of scenes as classes: [entries.pyi](../apps/python/sprekk/entries.pyi).\n"]
    for name, file in public(package):
        node = next((n for n in ast.parse(file.read_text()).body if getattr(n, "name", None) == name), None)
        if node is None:
            raise ValueError(f"{file}: has no class or function {name}")
        parts.append(f"## {name}\n")
        if isinstance(node, ast.ClassDef):
            parts += of_class(node)
        else:
            parts += [f"```python\n{signature(name, node)}\n```\n", text_of(node)]
    return "\n".join(parts)
