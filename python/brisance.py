"""Read what a run of brisance has left, with numpy alone.

    import brisance
    run = brisance.Run("out/sod")
    for frame in run.frames("npz"):           # from `brisance run --export npz` or `brisance convert DIR --to npz`
        print(frame.time, frame["density"].max(), frame.unit("density"))
    table = run.table("diagnostics")          # columns by name
"""
import csv
import json
from pathlib import Path

import numpy

FOLDERS = {"npz": "arrays", "fields": "states", "states": "states", "checkpoints": "checkpoints"}


class Frame:
    """One stored time: named arrays, with what they are and their units."""

    def __init__(self, path):
        self.path = Path(path)
        self.arrays = numpy.load(self.path)
        self.head = json.loads(self.arrays["head.json"])
        if self.head["format"] != "brisance state" or self.head["version"] > 2:
            raise ValueError(f"{path}: version {self.head['version']} of {self.head['format']}; this reader knows 2")
        self.time, self.step = self.head["time"], self.head["step"]

    def __getitem__(self, name):
        return self.arrays[name]

    def names(self):
        return sorted(self.head["arrays"])

    def unit(self, name):
        """What an array is, its symbol and its unit."""
        return self.head["arrays"][name]

    def scene(self):
        """The scene as it was run, as TOML."""
        return self.arrays["scene.toml"].decode()


class Run:
    """The folder of a run."""

    def __init__(self, folder):
        self.folder = Path(folder)
        self.index = json.loads((self.folder / "run.json").read_text())
        if self.index["version"] > 1:
            raise ValueError(f"{folder}: run.json has form {self.index['version']}; this reader knows 1")

    def frames(self, form="npz"):
        """All stored times of a form: `npz`, `states` or `checkpoints`."""
        return [Frame(path) for path in sorted((self.folder / FOLDERS[form]).glob("*.npz"))]

    def table(self, name):
        """A table as a dictionary of columns: numbers as arrays, names as lists."""
        with open(self.folder / f"{name}.csv", newline="") as file:
            head, *rows = csv.reader(file)
        columns = dict(zip(head, zip(*rows))) if rows else {key: () for key in head}
        return {key: _numbers(values) for key, values in columns.items()}


def _numbers(values):
    try:
        return numpy.array(values, dtype=float)
    except ValueError:
        return list(values)
