"""Writes a scene, given as a tree of sections and entries, as XML."""
import xml.etree.ElementTree as xml


def written(value):
    """Returns the XML type and text of an entry."""
    if isinstance(value, (list, tuple)):
        kinds = {written(v)[0] for v in value}
        kind = "string" if "string" in kinds else "double" if "double" in kinds else "int"
        return f"Array({kind})", "{" + ", ".join(written(v)[1] for v in value) + "}"
    kind = {str: "string", bool: "bool", int: "int", float: "double"}[type(value)]
    return kind, value if kind == "string" else str(value).lower() if kind == "bool" else repr(value)


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
