"""Writes a scene, given as a tree of sections and entries, as XML."""
import xml.etree.ElementTree as xml

KINDS = {str: "string", bool: "bool", int: "int", float: "double"}  # bool is a subclass of int


def written(value):
    """Returns the XML type and text of an entry."""
    if isinstance(value, (list, tuple)):
        kinds = {written(v)[0] for v in value}
        kind = next(kind for kind in ("string", "double", "int", "bool") if kind in kinds)
        return f"Array({kind})", "{" + ", ".join(written(v)[1] for v in value) + "}"
    kind = next(kind for of, kind in KINDS.items() if isinstance(value, of))
    return kind, repr(float(value)) if kind == "double" else str(value).lower() if kind == "bool" else str(value)


def section(name, content):
    node = xml.Element("ParameterList", name=name)
    for key, value in content.items():
        if isinstance(value, dict):
            node.append(section(key, value))
        else:
            kind, text = written(value)
            xml.SubElement(node, "Parameter", name=key, type=kind, value=text)
    return node


def save(tree, path, comment):
    root = section("Sprekk", tree)
    xml.indent(root)
    path.write_text(f"<!-- {comment} -->\n{xml.tostring(root, encoding='unicode')}\n")
