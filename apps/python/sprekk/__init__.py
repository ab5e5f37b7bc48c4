"""Simulation of deformation, flow and heat in fractured rock.

    import sprekk
    model = sprekk.Model(sprekk.Scene("xml/seed/push_2d.xml"))
    model.run()
    model.output("slip")

The introduction is docs/use/python.md."""
import mpi4py.MPI as _mpi  # initialises MPI, and finalises it when the interpreter ends

from . import _sprekk
from ._sprekk import Checkpoint, Error, StepReport
from .field import StaleField
from .mesh import Mesh
from .model import Model, NotConverged
from .module import Block, FaceLaw, Module, Unknown
from .network import traces
from .point import PointFailed, drive, fit
from .results import Results
from .scene import Scene
from . import upscale
from .sensitivity import sensitivities
from .study import sweep

__version__ = _sprekk.version
