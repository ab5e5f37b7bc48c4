"""Results of a run on disk, as tables."""
import json
from pathlib import Path

from . import _sprekk


class Results:
    """Output folder of `./sprekk run` or of model.run(output=...).

    status     "completed", "running", "interrupted" or "failed"; `reason` is the error message
    steps      pandas.DataFrame with the numbers of each step: time, newton_iterations, cuts, ...
    fractures  pandas.DataFrame with the index (time, fracture set); vectors have a column for each component
    single_fractures  the same for single fractures; .unstack("fracture") has one row for each step
    points()   stress intensity factors as a pandas.DataFrame; points("growth"): extensions of growing fractures
    content    results.json as a dict"""

    def __init__(self, folder):
        self.folder = Path(folder)
        try:
            self.content = json.loads((self.folder / "results.json").read_text())
        except OSError as error:
            raise _sprekk.Error(f"{self.folder}: has no results.json: {error.strerror}") from None
        self.status, self.reason = self.content["status"], self.content.get("reason", "")

    @property
    def steps(self):
        import pandas
        return pandas.DataFrame([{name: value for name, value in step.items() if not isinstance(value, (dict, list))}
                                 for step in self.content["steps"]])

    @property
    def fractures(self):
        return table({(step["time"], name): numbers for step in self.content["steps"]
                      for name, numbers in step["fractures"].items()})

    @property
    def single_fractures(self):
        names = [one["name"] for one in self.content.get("single_fractures", [])]
        return table({(step["time"], name): {key: values[k] for key, values in step["single_fractures"].items()}
                      for step in self.content["steps"] for k, name in enumerate(names)})

    def points(self, name="stress_intensity"):
        """Returns the table of quantities at points of fractures: the columns of stress_intensity.csv or growth.csv, times in s.

        `name`: "stress_intensity" or "growth"."""
        import pandas
        known = self.content.get("tables", {})
        if name not in known:
            raise _sprekk.Error(f"{self.folder}: results.json contains no table \"{name}\"; there are: {', '.join(known) or 'none'}")
        names = [one["name"] for one in self.content.get("single_fractures", [])]
        steps = [pandas.DataFrame(step[name]).assign(time=step["time"]) for step in self.content["steps"] if name in step]
        if not steps:
            raise _sprekk.Error(f"{self.folder}: no step has rows of \"{name}\"")
        found = pandas.concat(steps, ignore_index=True)
        return found.assign(fracture=[names[k] for k in found["fracture"]])

    def probe(self, name):
        """Returns the data of a probe, an xarray.Dataset with units and dimensions."""
        import xarray
        return xarray.open_dataset(self.folder / "probes.h5", group=name, engine="h5netcdf")


def table(rows):
    """Returns a pandas.DataFrame of {(time, fracture): nested numbers}."""
    import pandas
    index = pandas.MultiIndex.from_tuples(rows, names=["time", "fracture"])
    return pandas.DataFrame([dict(flat(numbers)) for numbers in rows.values()], index=index)


def flat(numbers, before=""):
    """Yields (name, number) of nested dicts and lists, with names such as "mean_jump_local_0"."""
    for key, value in numbers.items() if isinstance(numbers, dict) else enumerate(numbers):
        if isinstance(value, (dict, list)):
            yield from flat(value, f"{before}{key}_")
        else:
            yield f"{before}{key}", value
