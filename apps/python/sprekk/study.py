"""Parameter studies in parallel processes. Interrupted studies can continue."""
import hashlib
import itertools
import json
import os
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from mpi4py import MPI

from . import _sprekk
from .scene import Scene

ALONE = {"OMPI_MCA_ess_singleton_isolated": "1", "OMPI_MCA_orte_create_session_dirs": "0", "OMP_NUM_THREADS": "1"}


def sweep(scene, parameters, measure, *, processes=None, folder=None, progress=False):
    """Runs a scene with all combinations of values. Returns a pandas.DataFrame with a row for each combination.

        sprekk.sweep("scene.xml", {"Materials.joint.friction coefficient": [0.4, 0.6]}, "study.py:measure", processes=4)

    The columns are the values of the parameters and the results of `measure`; "error" is the message of a failed run.

    parameters  {path of an entry: values}, or a list of {path: value}
    measure     function measure(model) -> dict of numbers, called after the last step in a separate process; a function
                of a module or script, or its name, "script.py:function" or "module:function"
    processes   number of simultaneous runs; default: number of available processors
    folder      stores each result under a checksum of scene and measure; existing results are not computed again
    progress    True shows a progress bar (tqdm)"""
    import pandas
    base = scene if isinstance(scene, Scene) else Scene(scene, comm=MPI.COMM_SELF)
    cases = combinations(parameters)
    name = measure if isinstance(measure, str) else name_of(measure)
    with tempfile.TemporaryDirectory() as scratch:
        target = Path(folder) if folder else Path(scratch)
        target.mkdir(parents=True, exist_ok=True)
        with ThreadPoolExecutor(processes or len(os.sched_getaffinity(0))) as pool:
            rows = pool.map(lambda case: run_case(base, case, name, target), cases)
            if progress:
                from tqdm import tqdm
                rows = tqdm(rows, total=len(cases))
            return pandas.DataFrame([{**case, **row} for case, row in zip(cases, rows)])


def combinations(parameters):
    if not isinstance(parameters, dict):
        return [dict(case) for case in parameters]
    return [dict(zip(parameters, values)) for values in itertools.product(*parameters.values())]


def name_of(function):
    """Returns the name by which a new process imports the function."""
    module, name = function.__module__, function.__qualname__
    file = getattr(sys.modules.get(module), "__file__", None)
    if "<" in name or (module == "__main__" and not file):
        raise _sprekk.Error(f'a separate process cannot find "{name}": define it in a script or a module, at its top '
                            'level, or name it, "script.py:function"')
    return f"{file}:{name}" if module == "__main__" else f"{module}:{name}"


def run_case(base, case, measure, folder):
    """Returns the row of one case, from the folder if it exists there."""
    try:
        scene = base.changed(case, MPI.COMM_SELF)
    except _sprekk.Error as error:
        return {"error": str(error)}
    xml = scene.to_xml(defaults=True)
    fingerprint = hashlib.sha256(json.dumps([xml, measure, source_of(measure)]).encode()).hexdigest()[:20]
    result, file = folder / f"{fingerprint}.json", folder / f"{fingerprint}.xml"
    if not result.exists():
        file.write_text(xml)
        done = subprocess.run([sys.executable, "-m", "sprekk.study", str(file), measure, str(result)], capture_output=True,
                              text=True, stdin=subprocess.DEVNULL, env={**surroundings(), **ALONE})
        if not result.exists():
            return {"error": done.stderr.strip().splitlines()[-1] if done.stderr.strip() else f"status {done.returncode}"}
    return json.loads(result.read_text())


def source_of(measure):
    """Returns the text of a script for the checksum, so that a changed script is run again."""
    script = measure.rpartition(":")[0]
    return Path(script).read_text() if script.endswith(".py") else ""


def surroundings():
    """Returns the environment of an independent process, with the import path of this one and without its MPI rank."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("OMPI_", "PMIX_", "PMI_"))}
    environment.update({name: value for name, value in os.environ.items() if name.startswith(("OMPI_MCA_pml", "OMPI_MCA_btl",
                                                                                       "OMPI_ALLOW"))})
    return {**environment, "PYTHONPATH": os.pathsep.join(path or os.getcwd() for path in sys.path)}


def function_of(name):
    import importlib
    import importlib.util
    module, _, function = name.rpartition(":")
    if not module.endswith(".py"):
        return getattr(importlib.import_module(module), function)
    spec = importlib.util.spec_from_file_location("study", module)
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    return getattr(script, function)


def main(scene, measure, result):
    """Runs one case and writes the result atomically."""
    from .model import Model
    try:
        model = Model(Scene(scene, comm=MPI.COMM_SELF), MPI.COMM_SELF)
        model.run()
        row = {name: float(value) for name, value in function_of(measure)(model).items()}
    except _sprekk.Error as error:
        row = {"error": str(error)}
    unfinished = Path(result + ".part")
    unfinished.write_text(json.dumps(row))
    unfinished.replace(result)


if __name__ == "__main__":
    main(*sys.argv[1:])
