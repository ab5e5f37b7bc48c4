"""Generates the mesh of a network scene, as `./sprekk run` does before the run."""
import importlib.util
import sys

from program import PROGRAM, ROOT

spec = importlib.util.spec_from_file_location("sprekk_mesh", ROOT / "apps" / "mesh" / "__main__.py")
mesh_app = importlib.util.module_from_spec(spec)
sys.path.insert(0, str(ROOT / "apps" / "mesh"))
spec.loader.exec_module(mesh_app)


def mesh_of(folder, scene, *sets):
    """Generates the mesh; returns the override with its path."""
    path = folder / "network.msh"
    words = [word for entry in sets for word in ("--set", entry)]
    status = mesh_app.main([str(scene), "-o", str(path), "--program", str(PROGRAM), "--quiet", *words])
    assert status == 0, f"no mesh of {scene}"
    return f"Mesh file.path={path}"
