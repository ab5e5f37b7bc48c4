"""Sprekk: deformation of fractured rock.

    import sprekk
    model = sprekk.Model(sprekk.Scene("xml/seed/push_2d.xml"))
    model.run()
    model.output("slip")

docs/use/python.md is an introduction."""
import mpi4py.MPI as _mpi  # begins MPI, and ends it after the interpreter

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
from .sensitivity import sensitivities
from .study import sweep

__version__ = _sprekk.version
