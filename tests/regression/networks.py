"""Makes the mesh of a scene's network, as `./sprekk run` does before it runs."""
import importlib.util
import sys

from program import PROGRAM, ROOT

spec = importlib.util.spec_from_file_location("sprekk_mesh", ROOT / "apps" / "mesh" / "__main__.py")
mesh_app = importlib.util.module_from_spec(spec)
sys.path.insert(0, str(ROOT / "apps" / "mesh"))
spec.loader.exec_module(mesh_app)


def mesh_of(folder, scene, *sets):
    """The override that names the mesh to a run."""
    path = folder / "network.msh"
    words = [word for entry in sets for word in ("--set", entry)]
    status = mesh_app.main([str(scene), "-o", str(path), "--program", str(PROGRAM), "--quiet", *words])
    assert status == 0, f"no mesh of {scene}"
    return f"Mesh file.path={path}"
