"""Models: the equations and the state of a scene."""
import json
import os
import sys

import numpy as np
from mpi4py import MPI

from . import _sprekk
from .field import Epoch, Field
from .mesh import Mesh
from .network import needs_mesh, with_mesh
from .scene import Scene


class NotConverged(_sprekk.Error):
    """Failure of a step. The model remains in the last converged state, at model.time. `report` is a StepReport."""

    def __init__(self, report):
        super().__init__(report.reason)
        self.report = report


class Model:
    """Mesh, equations and present state of a scene, distributed over ranks.

    scene           a Scene, or an argument of its constructor
    comm            communicator of mpi4py; all its ranks call all members in the same order
    given_pressure  initial fluid pressure, Pa; set_fluid_pressure() prescribes the later pressures
    own_pressure    initial fluid pressure, Pa; "pressure" (cells) and "face pressure" (facets) are unknowns of a module
    modules         user-defined terms and equations, objects of sprekk.Module

    Errors are raised on all ranks."""

    def __init__(self, scene, comm=MPI.COMM_WORLD, *, given_pressure=None, own_pressure=None, modules=()):
        scene = scene if isinstance(scene, Scene) else Scene(scene, comm=comm)
        self.scene = with_mesh(scene, comm) if needs_mesh(scene.entries) else scene
        self.comm = comm
        self._made_with = {"given_pressure": given_pressure, "own_pressure": own_pressure, "modules": tuple(modules)}
        fluids = [(own, float(p)) for own, p in ((False, given_pressure), (True, own_pressure)) if p is not None]
        self._handle = _sprekk.Model(self.scene._handle, comm, fluids[0] if fluids else None, tuple(modules))
        self._epoch = Epoch()
        self._last_mesh = None

    # Steps

    @property
    def time(self):
        """Time of the present state, s."""
        return self._handle.time

    def step(self, t):
        """Computes the step to the time t, s, with bisection if necessary. Raises NotConverged."""
        return self._finished(self._handle.step_to(float(t)))

    def find_equilibrium(self):
        """Computes an equilibrium at the present time, e.g. after change(). Raises NotConverged."""
        return self._finished(self._handle.find_equilibrium())

    def take_back(self):
        """Returns to the beginning of the last step, e.g. to repeat the step with other loads."""
        self._handle.take_back()

    def change(self, changed):
        """Replaces the scene, or entries such as {"Bulk.gravity": [0, -9.81]}. Keeps the state; invalidates fields."""
        scene = changed if isinstance(changed, Scene) else self.scene.changed(changed, self.comm)
        self._handle.change(scene._handle)
        self.scene = scene
        self._renew()

    def save(self):
        """Returns a Checkpoint with all data of the next step; checkpoint.write(folder) writes it to disk."""
        return self._handle.save()

    def restore(self, checkpoint):
        """Restores a Checkpoint or the checkpoint in a folder, written on any number of ranks."""
        if isinstance(checkpoint, (str, os.PathLike)):
            checkpoint = _sprekk.Checkpoint.read(os.fspath(checkpoint), self.comm)
        self._handle.restore(checkpoint)

    def run(self, callback=None, *, progress=False, output=None):
        """Computes the steps and stages of the section Time, as `./sprekk run`.

        callback  function callback(model, step), called after each step; a returned dict adds columns to the table
        progress  True shows a progress bar (tqdm)
        output    folder for results.json and field files, as written by `./sprekk run`

        With the section Growth, each step may change the mesh, and fields are invalid afterwards.

        Returns a pandas.DataFrame with a row for each step: time, dt, iterations and bisections. Raises NotConverged. A
        scene with the section Accuracy raises an Error: it requires several meshes and `./sprekk run`."""
        if "Accuracy" in self.scene.entries:
            raise _sprekk.Error(f'{self.scene.name}: Sprekk > Accuracy: a Model has one mesh, so run() cannot reach a '
                                'target error; use `./sprekk run`, or remove the section to run on this mesh')
        grows = "Growth" in self.scene.entries
        for name, value in self._made_with.items():
            if grows and value not in (None, ()):
                raise _sprekk.Error(f'{self.scene.name}: Sprekk > Growth: run() cannot extend fractures of a Model with '
                                    f'"{name}", which belongs to one mesh')
        steps = _sprekk.Steps(self._handle)
        if grows:
            self._renew()
        results = _sprekk.Results(self._handle, os.fspath(output)) if output is not None else None
        rows = []
        with _Bar(progress and self.comm.rank == 0) as bar:
            try:
                while steps.any():
                    taken = steps.take()
                    if taken.stage or grows:
                        self._renew()
                    if results and not taken.report.stopped:
                        results.add_step(taken, not steps.any() or not taken.report.converged)
                        if self.comm.rank == 0:
                            for warning in results.take_warnings():
                                print(f"sprekk: warning: {warning}", file=sys.stderr)
                    report = self._finished(taken.report)
                    row = {"time": report.time, "dt": report.time - taken.begin, "newton": report.newton_iterations,
                           "linear": report.linear_iterations, "cuts": report.cuts}
                    row.update(self._called(callback, taken) or {})
                    rows.append(row)
                    bar.show(steps.share_done(), self.time)
            except _sprekk.Error as error:
                if results:
                    results.finish("failed", str(error))
                raise
            except KeyboardInterrupt:
                if results:
                    results.finish("interrupted", "")
                raise
        if results:
            results.finish("completed", "")
        import pandas
        return pandas.DataFrame(rows)

    # The state

    @property
    def fields(self):
        """Fields that can be read and written in place: {name: (entity, components, unit)}."""
        return self._handle.fields()

    def field(self, name):
        """Returns a Field [entity owned by this rank, component], without a copy: unknowns or a history variable.

        After a change of the model the array raises StaleField. np.asarray() returns a read-only view."""
        return Field(self._handle.field(name), self._epoch)

    @property
    def outputs(self):
        """All outputs of the present state, {name: array as in output()}."""
        return {name: values for name, (values, _) in self._handle.outputs().items()}

    def output(self, name):
        """Returns an output of the present state, see docs/use/output.md.

        The shape is [owned cell or face, component], or [local node, component]; scalars have no last index."""
        return self._output(name)[0]

    def units(self):
        """Returns the units of all outputs and fields, {name: unit}."""
        kinds = {**self.fields, **{name: kind for name, (_, kind) in self._handle.outputs().items()}}
        return {name: unit for name, (_, _, unit) in kinds.items()}

    def fractures(self, singles=False):
        """Returns a pandas.DataFrame with a row for each set of fractures, or for each single fracture.

        Columns are area, states, means and maxima of outputs. Vectors have a column for each component."""
        import pandas
        mesh, columns = self.mesh, {}
        for name, unit, values in self._handle.fracture_table(singles):
            for k in range(values.shape[1]):
                columns[name if values.shape[1] == 1 else f"{name}_{k}"] = values[:, k]
        return pandas.DataFrame(columns, index=mesh.single_fractures if singles else mesh.fractures)

    def single_fractures(self):
        """Returns a pandas.DataFrame with set, area, centre, normal, strike and dip of each single fracture."""
        import pandas
        return pandas.DataFrame(json.loads(self._handle.described_singles()))

    def reactions(self):
        """Returns the reactions {condition: {field: [component], ...}}, in N (2D: N/m), W or m^3/s."""
        reactions = {}
        for condition, field, _, force, _ in self._handle.reactions():
            held = reactions.setdefault(condition, {})
            held[field] = held.get(field, 0) + force
        return reactions

    def totals(self):
        """Returns totals over the domain, such as "fluid > stored"."""
        return self._handle.totals()

    def warnings(self):
        """Returns the warnings about implausible input of the scene."""
        return self._handle.warnings()

    def set_fluid_pressure(self, cells, faces):
        """Sets the fluid pressures, Pa, of owned cells and fracture faces from the next step on.

        Requires `given_pressure`. The outputs "gained pore volume" and "widening" contain the change of pore volume and
        aperture."""
        self._handle.set_fluid_pressure(np.asarray(cells, float).ravel(), np.asarray(faces, float).ravel())

    # Mesh

    @property
    def mesh(self):
        """Mesh of this rank."""
        if self._last_mesh is None:
            self._last_mesh = Mesh(self._handle.mesh())
        return self._last_mesh

    def gather(self, name, root=0, *, field=False):
        """Returns an output of all ranks on the rank `root`, in the order of the whole mesh; None on the others.

        With field=True the name is that of a field, since an output may have the same name. Collective."""
        values, entity = (self.field(name), self.fields[name][0]) if field else self._named(name)
        mesh = self.mesh
        ids = {"node": mesh.node_id, "cell": mesh.cell_id, "fracture face": mesh.face_id}.get(entity)
        if ids is None:
            raise _sprekk.Error(f'"{name}" cannot be gathered: it belongs to entities without numbers, "{entity}"')
        return self._gathered(values, ids[:len(values)], root)

    def gather_mesh(self, root=0):
        """Returns the whole Mesh on the rank `root`, None on the others. Collective."""
        mesh, arrays = self.mesh, self._handle.mesh()
        n = mesh.n_owned_cells
        arrays["cells"] = mesh.node_id[mesh.cells]
        arrays["face_nodes"] = mesh.node_id[np.where(mesh.faces < 0, mesh.faces[:, :1], mesh.faces)]  # no local side +
        for ids, count, names in ((mesh.node_id, len(mesh.node_id), ("coordinates", "node_id")),
                                  (mesh.cell_id, n, ("cells", "cell_region", "cell_id")),
                                  (mesh.face_id, len(mesh.face_id), [name for name in arrays if isinstance(
                                      arrays[name], np.ndarray) and name.startswith("face_")])):
            for name in names:
                arrays[name] = self._gathered(arrays[name][:count], ids[:count], root)
        if self.comm.rank != root:
            return None
        for name in ("cells", "face_nodes"):
            arrays[name] = np.searchsorted(arrays["node_id"], arrays[name])
        for name in ("face_cells", "sides", "side_share", "side_bubble"):  # of a local part only
            arrays[name] = None
        arrays.update(n_owned_nodes=len(arrays["node_id"]), n_owned_cells=len(arrays["cells"]))
        return Mesh(arrays)

    def plot(self, name=None, **options):
        """Draws an output or field of a 2D model on the rock or the fractures, see sprekk.plot.picture."""
        from .plot import picture
        return picture(self, name, **options)

    def check_jacobian(self):
        """Compares the Jacobian with differences of the residual near the present state, to verify modules.

        Returns a pandas.DataFrame with the error of each part: module, row, column, error."""
        import pandas
        x = [np.array(self.field(name)) for name in self._handle.blocks()]
        errors = self._handle.jacobian_errors(x, self.time, max(self.time - self.scene.all_entries["Time"]["start"], 1e-300))
        return pandas.DataFrame(errors, columns=["module", "row", "column", "error"])

    def close(self):
        """Frees the equations. The memory of existing arrays remains valid."""
        self._epoch.over = True
        self._handle.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __repr__(self):
        return f"<sprekk.Model of {self.scene.name!r} at t = {self.time:g} s on {self.comm.size} ranks>"

    # Internal

    def _renew(self):
        self._epoch.over = True
        self._epoch, self._last_mesh = Epoch(), None

    def _finished(self, report):
        if report.stopped:
            self._handle.take_back()
            raise KeyboardInterrupt
        if not report.converged:
            raise NotConverged(report)
        return report

    def _called(self, callback, step):
        """Returns the result of the callback. An exception on one rank raises an Error on all others."""
        row = raised = None
        try:
            row = callback(self, step) if callback else None
        except Exception as error:
            raised = error
        if callback and self.comm.size > 1:
            reported = self.comm.allgather(None if raised is None else f"{type(raised).__name__}: {raised}")
            wrong = [f"rank {rank}: {text}" for rank, text in enumerate(reported) if text is not None]
            if wrong and raised is None:
                raise _sprekk.Error(f"the callback failed on another rank: {wrong[0]}")
        if raised is not None:
            raise raised
        return row

    def _output(self, name):
        """Returns an output and its entity."""
        outputs = self._handle.outputs()
        if name not in outputs:
            raise _sprekk.Error(f'there is no output "{name}", but ' + ", ".join(f'"{known}"' for known in outputs))
        values, (entity, _, _) = outputs[name]
        return values, entity

    def _named(self, name):
        """Returns an output or a field, and its entity."""
        fields = self.fields
        outputs = self._handle.outputs()
        if name in outputs:
            values, (entity, _, _) = outputs[name]
            return values, entity
        if name in fields:
            return self.field(name), fields[name][0]
        raise _sprekk.Error(f'there is no output or field "{name}", but ' + ", ".join(f'"{known}"' for known in
                                                                                  sorted({*outputs, *fields})))

    def _gathered(self, values, ids, root):
        """Returns on `root` the values of all ranks in the order of ids, without duplicates."""
        parts = self.comm.gather((np.array(ids), np.array(values)), root)
        if parts is None:
            return None
        _, first = np.unique(np.concatenate([ids for ids, _ in parts]), return_index=True)
        return np.concatenate([values for _, values in parts])[first]


class _Bar:
    """Progress bar, or no effect if not shown."""

    def __init__(self, shown):
        self.bar = None
        if shown:
            from tqdm import tqdm
            self.bar = tqdm(total=100, unit="%", bar_format="{l_bar}{bar}| {elapsed}<{remaining}{postfix}")

    def __enter__(self):
        return self

    def show(self, share, time):
        if self.bar:
            self.bar.set_postfix_str(f"t = {time:.6g} s", refresh=False)
            self.bar.update(round(100 * share, 1) - self.bar.n)

    def __exit__(self, *_):
        if self.bar:
            self.bar.close()
