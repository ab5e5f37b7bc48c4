"""Models: scenes brought to life."""
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
    """A step found no solution; the model is where it was. `report` is a StepReport."""

    def __init__(self, report):
        super().__init__(report.reason)
        self.report = report


class Model:
    """A scene brought to life on ranks: mesh, equations, and the present state.

    scene           a Scene, or what makes one
    comm            of mpi4py; all ranks of it call all members in the same order
    given_pressure  the initial pressure (Pa) of a fluid whose pressure is then given by set_fluid_pressure()
    own_pressure    the same of a fluid whose "pressure" (cells) and "face pressure" (facets) are unknowns of a module
    modules         terms and equations of your own, objects of sprekk.Module

    Errors are raised on all ranks alike."""

    def __init__(self, scene, comm=MPI.COMM_WORLD, *, given_pressure=None, own_pressure=None, modules=()):
        scene = scene if isinstance(scene, Scene) else Scene(scene, comm=comm)
        self.scene = with_mesh(scene, comm) if needs_mesh(scene.entries) else scene
        self.comm = comm
        self._made_with = {"given_pressure": given_pressure, "own_pressure": own_pressure, "modules": modules}
        fluids = [(own, float(p)) for own, p in ((False, given_pressure), (True, own_pressure)) if p is not None]
        self._handle = _sprekk.Model(self.scene._handle, comm, fluids[0] if fluids else None, tuple(modules))
        self._epoch = Epoch()
        self._last_mesh = None

    # Steps

    @property
    def time(self):
        """Of the present state, s."""
        return self._handle.time

    def step(self, t):
        """Goes to the time t in one step, in substeps where it must. Raises NotConverged."""
        return self._finished(self._handle.step_to(float(t)))

    def find_equilibrium(self):
        """An equilibrium at the present time, with what has changed since the last. Raises NotConverged."""
        return self._finished(self._handle.find_equilibrium())

    def take_back(self):
        """Goes back to where the last step began, to take it again under other loads."""
        self._handle.take_back()

    def change(self, changed):
        """Goes on as another Scene, or with other entries of this one: {"Bulk.gravity": [0, -9.81]}. Fields must be
        asked for again."""
        scene = changed if isinstance(changed, Scene) else self.scene.changed(changed, self.comm)
        self._handle.change(scene._handle)
        self.scene = scene
        self._renew()

    def save(self):
        """All that the next step depends on, a Checkpoint; checkpoint.write(folder) keeps it on disk."""
        return self._handle.save()

    def restore(self, checkpoint):
        """Goes back to a Checkpoint, or to one in a folder, written on any number of ranks."""
        if isinstance(checkpoint, (str, os.PathLike)):
            checkpoint = _sprekk.Checkpoint.read(os.fspath(checkpoint), self.comm)
        self._handle.restore(checkpoint)

    def run(self, callback=None, *, progress=False, output=None):
        """Takes the steps of the section Time, with its stages, as `./sprekk run` does.

        callback  called as callback(model, step) after each; a dict that it returns goes into the table
        progress  show a bar (tqdm)
        output    a folder for results.json and the files of fields, as `./sprekk run` writes them

        Returns a table, pandas.DataFrame, with a row for each step: time, dt, and what it cost. A scene with the
        section Accuracy needs several meshes and models, which `./sprekk run` makes; here it is an Error."""
        if "Accuracy" in self.scene.entries:
            raise _sprekk.Error(f'{self.scene.name}: Sprekk > Accuracy: a Model has one mesh, so that run() cannot reach an '
                                'error that is asked for; `./sprekk run` does. Leave the section out to run on this mesh')
        steps = _sprekk.Steps(self._handle)
        results = _sprekk.Results(self._handle, os.fspath(output)) if output is not None else None
        rows = []
        with _Bar(progress and self.comm.rank == 0) as bar:
            try:
                while steps.any():
                    taken = steps.take()
                    if taken.stage:
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
        """Names of what may be read and written in place, with what it lives on, components and unit."""
        return self._handle.fields()

    def field(self, name):
        """Unknowns or a history in place, [entity that this rank owns, component]: no copy. Valid until the model is
        changed; then it raises StaleField. np.asarray() of it is a read-only view, whose memory lives on."""
        return Field(self._handle.field(name), self._epoch)

    @property
    def outputs(self):
        """All outputs of the present state by their names, see output()."""
        return {name: values for name, (values, _) in self._handle.outputs().items()}

    def output(self, name):
        """An output of the present state, see docs/use/output.md: [cell or face that this rank owns, component], or [node
        of this rank, component]; of numbers without the last index."""
        return self._output(name)[0]

    def units(self):
        """Those of all outputs and fields."""
        kinds = {**self.fields, **{name: kind for name, (_, kind) in self._handle.outputs().items()}}
        return {name: unit for name, (_, _, unit) in kinds.items()}

    def fractures(self, singles=False):
        """What each set of fractures does, or each single fracture: area, states, means and maxima of outputs, as a
        pandas.DataFrame. Vectors have a column for each component."""
        import pandas
        mesh, columns = self.mesh, {}
        for name, unit, values in self._handle.fracture_table(singles):
            for k in range(values.shape[1]):
                columns[name if values.shape[1] == 1 else f"{name}_{k}"] = values[:, k]
        return pandas.DataFrame(columns, index=mesh.single_fractures if singles else mesh.fractures)

    def single_fractures(self):
        """Set, area, centre, normal, strike and dip of each single fracture, a pandas.DataFrame."""
        import pandas
        return pandas.DataFrame(json.loads(self._handle.described_singles()))

    def reactions(self):
        """What each condition exerts, {condition: {field: force [component], ...}}, in N (2D: N/m), W or m^3/s."""
        reactions = {}
        for condition, field, _, force, _ in self._handle.reactions():
            held = reactions.setdefault(condition, {})
            held[field] = held.get(field, 0) + force
        return reactions

    def totals(self):
        """Numbers of the whole state, "fluid > stored" and the like."""
        return self._handle.totals()

    def warnings(self):
        """What of the scene is allowed and hardly meant."""
        return self._handle.warnings()

    def set_fluid_pressure(self, cells, faces):
        """The pressures (Pa) of the fluid in owned cells and fracture faces from the next step on, of a model with
        given_pressure. The outputs "gained pore volume" and "widening" say what room that makes."""
        self._handle.set_fluid_pressure(np.asarray(cells, float).ravel(), np.asarray(faces, float).ravel())

    # Mesh

    @property
    def mesh(self):
        """The Mesh of this rank."""
        if self._last_mesh is None:
            self._last_mesh = Mesh(self._handle.mesh())
        return self._last_mesh

    def gather(self, name, root=0, *, field=False):
        """An output of all ranks, or a field, which may have the same name, on one of them, in the order of the whole
        mesh; None on others."""
        values, entity = (self.field(name), self.fields[name][0]) if field else self._named(name)
        mesh = self.mesh
        ids = {"node": mesh.node_id, "cell": mesh.cell_id, "fracture face": mesh.face_id}.get(entity)
        if ids is None:
            raise _sprekk.Error(f'"{name}" cannot be gathered: it lives on entities without numbers, "{entity}"')
        return self._gathered(values, ids[:len(values)], root)

    def gather_mesh(self, root=0):
        """The whole Mesh on one rank; None on others."""
        mesh, arrays = self.mesh, self._handle.mesh()
        n = mesh.n_owned_cells
        arrays["cells"] = mesh.node_id[mesh.cells]
        arrays["face_nodes"] = mesh.node_id[np.where(mesh.faces < 0, mesh.faces[:, :1], mesh.faces)]  # side + elsewhere
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
        for name in ("face_cells", "sides", "side_share", "side_bubble"):  # of a rank's part alone
            arrays[name] = None
        arrays.update(n_owned_nodes=len(arrays["node_id"]), n_owned_cells=len(arrays["cells"]))
        return Mesh(arrays)

    def plot(self, name=None, **options):
        """A picture of the plane rock or its fractures with an output or a field, see sprekk.plot.picture."""
        from .plot import picture
        return picture(self, name, **options)

    def check_jacobian(self):
        """How far each part of the Jacobian is from differences of the residual, near the present state: for modules of
        your own, a pandas.DataFrame."""
        import pandas
        x = [np.array(self.field(name)) for name in self._handle.blocks()]
        errors = self._handle.jacobian_errors(x, self.time, max(self.time - self.scene.all_entries["Time"]["start"], 1e-300))
        return pandas.DataFrame(errors, columns=["module", "row", "column", "error"])

    def close(self):
        """Frees the equations; arrays that were asked for keep their memory."""
        self._epoch.over = True
        self._handle.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __repr__(self):
        return f"<sprekk.Model of {self.scene.name!r} at t = {self.time:g} s on {self.comm.size} ranks>"

    # Own

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
        """What a callback returns; if it raises on a rank, an Error on all others."""
        row = raised = None
        try:
            row = callback(self, step) if callback else None
        except Exception as error:
            raised = error
        if callback and self.comm.size > 1:
            told = self.comm.allgather(None if raised is None else f"{type(raised).__name__}: {raised}")
            wrong = [f"rank {rank}: {text}" for rank, text in enumerate(told) if text is not None]
            if wrong and raised is None:
                raise _sprekk.Error(f"the callback failed on another rank: {wrong[0]}")
        if raised is not None:
            raise raised
        return row

    def _output(self, name):
        """Values and entity."""
        outputs = self._handle.outputs()
        if name not in outputs:
            raise _sprekk.Error(f'there is no output "{name}", but ' + ", ".join(f'"{known}"' for known in outputs))
        values, (entity, _, _) = outputs[name]
        return values, entity

    def _named(self, name):
        """An output or a field, and what it lives on."""
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
        """Those of all ranks by their numbers, each once."""
        parts = self.comm.gather((np.array(ids), np.array(values)), root)
        if parts is None:
            return None
        _, first = np.unique(np.concatenate([ids for ids, _ in parts]), return_index=True)
        return np.concatenate([values for _, values in parts])[first]


class _Bar:
    """A bar of progress, or none."""

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
