"""Base of tests of the mesh generator with files and scenes."""
import contextlib
import importlib.util
import io
import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "regression"))

import program  # noqa: E402
from conformity import as_xml  # noqa: E402
from program import ROOT, ProgramTest  # noqa: E402

spec = importlib.util.spec_from_file_location("sprekk_mesh", ROOT / "apps" / "mesh" / "__main__.py")
app = importlib.util.module_from_spec(spec)
spec.loader.exec_module(app)

SQUARE = {"lower corner": [0.0, 0.0], "upper corner": [1.0, 1.0]}
REST = """<ParameterList name="Materials"><ParameterList name="joint"><Parameter name="type" type="string" value="joint"/>
<Parameter name="friction coefficient" type="double" value="0.6"/></ParameterList></ParameterList>
<ParameterList name="Bulk"><Parameter name="material" type="string" value="granite"/></ParameterList>
<ParameterList name="Fractures"><ParameterList name="set"><Parameter name="material" type="string" value="joint"/></ParameterList></ParameterList>
<ParameterList name="Boundary conditions">
<ParameterList name="floor"><Parameter name="boundary" type="string" value="FLOOR"/><Parameter name="displacement" type="Array(double)" value="ZERO"/></ParameterList>
<ParameterList name="roof"><Parameter name="boundary" type="string" value="ROOF"/><Parameter name="displacement" type="Array(double)" value="DOWN"/></ParameterList>
</ParameterList>"""


class MeshTest(ProgramTest):
    def write(self, name, *lines):
        path = self.folder / name
        path.write_text("\n".join(lines) + "\n")
        return path

    def scene(self, name="scene.xml", dim=2, **network):
        """Writes a scene with a network under compression from the top."""
        floor, roof = ("south", "north") if dim == 2 else ("bottom", "top")
        zeros = ", ".join(["0"] * (dim - 1))
        rest = REST.replace("FLOOR", floor).replace("ROOF", roof).replace("ZERO", f"{{{zeros}, 0}}").replace("DOWN", f"{{{zeros}, -1e-3}}")
        if dim == 2:
            network.setdefault("domain", SQUARE)
        described = as_xml("network", {key.replace("_", " "): value for key, value in network.items()})
        return self.write(name, '<ParameterList name="Sprekk"><ParameterList name="Mesh file">', described, "</ParameterList>", rest, "</ParameterList>")

    def mesh(self, scene, *words, expect=0, output="net.msh"):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            status = app.main([str(scene), "-o", str(self.folder / output), "--program", str(program.PROGRAM), *words])
        self.assertEqual(status, expect, out.getvalue() + err.getvalue())
        return err.getvalue() if expect else out.getvalue()

    def report(self, output="net.msh"):
        return json.loads((self.folder / f"{output}.json").read_text())

    def refused(self, file, *expected, kind=None, **network):
        """Checks the error: the number of its lines, and a text in each line."""
        described = {"file": file.name, **({"format": kind} if kind else {})}
        reported = self.mesh(self.scene(fractures={"set": described}, **network), expect=1).splitlines()
        reported = [line.removeprefix("sprekk: ") for line in reported if not line.endswith(" ...")]  # without progress
        self.assertEqual(len(reported), len(expected), reported)
        for line, words in zip(reported, expected):
            self.assertIn(words, line)
