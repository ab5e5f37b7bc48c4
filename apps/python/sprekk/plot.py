"""Pictures of 2D models for notebooks. `./sprekk plot` draws runs on disk."""
import numpy as np


def picture(model, name=None, *, component=None, scale=0, axes=None, **options):
    """Draws the rock or the fractures of this rank with the colours of an output; returns axes of matplotlib.

    name       output or field; default: the mesh with its fractures
    component  of a vector; default: the norm
    scale      factor of the displacements in the picture
    options    arguments of tripcolor or LineCollection"""
    import matplotlib.pyplot as plt
    from matplotlib.collections import LineCollection
    mesh = model.mesh
    if mesh.dim != 2:
        raise ValueError("pictures require a 2D model; in 3D use mesh.to_meshio() with PyVista")
    axes = axes or plt.figure(layout="constrained").add_subplot()
    u = model.output("displacement") if scale else np.zeros_like(mesh.coordinates)
    outline = mesh.triangulation(u, scale)
    lines = (mesh.coordinates + scale * u)[mesh.faces[:, 0, :2]]
    values, entity = (None, None) if name is None else model._named(name)
    if values is None:
        axes.triplot(outline, color="0.8", linewidth=0.4)
        axes.add_collection(LineCollection(lines, color="k"))
    else:
        values = np.asarray(values)
        values = values.reshape(len(values), -1)
        values = values[:, component] if component is not None else (
            values[:, 0] if values.shape[1] == 1 else np.linalg.norm(values, axis=1))
        label = f"{name}{'' if component is None else f' {component}'} ({model.units()[name]})"
        if entity == "fracture face":
            axes.triplot(outline, color="0.9", linewidth=0.3)
            drawn = axes.add_collection(LineCollection(lines, array=values, linewidth=3, **options))
        elif entity == "node":
            drawn = axes.tripcolor(outline, values, shading="gouraud", **options)
        else:
            drawn = axes.tripcolor(outline, facecolors=values[mesh.triangles[1]], **options)
        axes.figure.colorbar(drawn, ax=axes, label=label)
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set(xlabel="x (m)", ylabel="y (m)")
    return axes
