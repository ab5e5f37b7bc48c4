"""Equivalent tensors of blocks of fractured rock: permeability, compliance, Biot tensor and storage under stress.

    import sprekk
    found = sprekk.upscale.run("scene.xml", [[-1e6, -1e6, -5e6, 0, 0, 0]])
    found.results[0].permeability["linear"]

The introduction is docs/use/upscaling.md."""
from .components import asymmetry, principal, rotated
from .run import Result, Upscaled, run
