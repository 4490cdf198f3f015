"""Results folders, read without any other library than NumPy."""

from __future__ import annotations

import csv
import html
import json
import os
import re
from typing import Any, Collection, Dict, List

import numpy
from numpy.typing import NDArray

from . import _talus
from ._source import Path
from .errors import FileError
from .run import picture_of


_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?|[-+]?inf|nan")


# Columns of names, which may be of digits.
_NAMES = {"monitor", "quantity", "unit", "stage", "block_a", "block_b", "joint", "set", "state", "name", "kind", "material", "group", "bolt"}


def _column(is_name: bool, cells: List[str]) -> Any:
    """Numbers, where all cells are numbers or empty (NaN) and one at least is a number; else texts, as those of names always are."""
    if not is_name and any(cells) and all(not c or _NUMBER.fullmatch(c) for c in cells):
        return numpy.array([float(c) if c else numpy.nan for c in cells])
    return cells


def read_table(path: str, names: Collection[str] = _NAMES) -> Dict[str, Any]:
    """A CSV file with a head: columns by title, arrays where all cells are numbers or empty (NaN), else lists of texts.
    Columns called as in `names` are texts always."""
    try:
        with open(path, encoding="utf-8", newline="") as file:
            rows = list(csv.reader(file))
    except (OSError, ValueError, csv.Error) as error:
        raise FileError(f"{path}: {error}") from None
    for number, row in enumerate(rows, 1):
        if len(row) != len(rows[0]):
            raise FileError(f"{path}:{number}: has {len(row)} cells, not {len(rows[0])}")
    return {title: _column(title in names, [row[k] for row in rows[1:]]) for k, title in enumerate(rows[0])} if rows else {}


class Frame:
    """All blocks at one time: Results.frame().

    arrays holds every array of the file by its title: of corners "Points" [m] (corners, 3) and "displacement [m]", of blocks
    "block", "stress xx [Pa]", "centroid displacement [m]" and so on.
    """

    def __init__(self, path: Path):
        self.path = os.fspath(path)
        self.time: float
        self.arrays: Dict[str, NDArray[numpy.float64]]
        self.time, self.arrays = _talus.frame(self.path)

    @property
    def polygons(self) -> List[NDArray[numpy.float64]]:
        """Corners of each block as it lies then [m], (corners, 2)."""
        points = self.arrays["Points"][:, :2]
        ends = self.arrays["offsets"].astype(int)
        corners = self.arrays["connectivity"].astype(int)
        return [points[corners[a:b]] for a, b in zip([0, *ends[:-1]], ends)]

    def title_of(self, name: str) -> str:
        """The title of an array by itself, without its unit, or by how it begins. Raises KeyError with all titles."""
        if not name:
            raise KeyError("the title of an array, or how it begins")
        found = [a for a in self.arrays if name in (a, a.split(" [")[0])] or [a for a in self.arrays if a.startswith(name)]
        if not found:
            raise KeyError(f"{name}: there is {', '.join(sorted(self.arrays))}")
        return found[0]

    def of_blocks(self, name: str) -> NDArray[numpy.float64]:
        """An array of blocks by title_of(): "velocity". Values of corners become the mean of each block."""
        values = self.arrays[self.title_of(name)]
        ends = self.arrays["offsets"].astype(int)
        if len(values) == len(ends):
            return values
        corners = self.arrays["connectivity"].astype(int)
        return numpy.array([values[corners[a:b]].mean(axis=0) for a, b in zip([0, *ends[:-1]], ends)])

    def plot(self, colour: str = "", *, axes: Any = None, **how: Any) -> Any:
        """Draws the blocks with Matplotlib, coloured by an array of blocks (its size where it is a vector); returns the axes.
        `how` goes to PolyCollection."""
        from .figures import plot_frame
        return plot_frame(self, colour, axes=axes, **how)


class Results:
    """The folder that a run has written. Tables are dictionaries of columns by their title, which has the unit; pandas.DataFrame
    takes them as they are."""

    def __init__(self, folder: Path):
        self.folder = os.fspath(folder)
        path = os.path.join(self.folder, "summary.json")
        try:
            with open(path, encoding="utf-8") as file:
                self.summary: Dict[str, Any] = json.load(file)
            if not isinstance(self.summary, dict) or "status" not in self.summary:
                raise ValueError("it does not say how a run ended")
        except (OSError, ValueError) as error:
            raise FileError(f"{path}: {error}; is {self.folder} the folder of a run? (A cut has none.)") from None

    def table(self, name: str) -> Dict[str, Any]:
        """A file of columns in the folder: "joints.csv". Columns of numbers are arrays, with NaN where a cell is empty, others lists of texts."""
        return read_table(os.path.join(self.folder, name))

    @property
    def histories(self) -> Dict[str, Any]:
        """Monitors over time: {"t [s]": ..., "block.displacement_x [m]": ...}."""
        return self.table("histories.csv")

    @property
    def steps(self) -> Dict[str, Any]:
        """Solver and energy ledger, step by step."""
        return self.table("steps.csv")

    @property
    def joints(self) -> Dict[str, Any]:
        """Contact points at the end of each stage."""
        return self.table("joints.csv")

    @property
    def times(self) -> List[float]:
        """Of the frames [s]."""
        return [time for time, _ in self._series("blocks")]

    def frame(self, number: int = -1) -> Frame:
        """The blocks of a frame; -1: the last."""
        return Frame(self._file("blocks", number))

    def contact_frame(self, number: int = -1) -> Dict[str, NDArray[numpy.float64]]:
        """The contact points of a frame by the titles of their arrays: "Points", "force [N]" ..."""
        return dict(_talus.frame(self._file("contacts", number))[1])

    def _file(self, name: str, number: int) -> str:
        frames = self._series(name)
        if not -len(frames) <= number < len(frames):
            raise IndexError(f"frame {number}: {self.folder} has {len(frames)}, from 0")
        return str(frames[number][1])

    def _series(self, name: str) -> List[Any]:
        found = _talus.series(os.path.join(self.folder, "fields", f"{name}.pvd"))
        if not found:
            raise FileError(f"{self.folder}: has no frames of {name}")
        return found

    def plot(self, *columns: str, axes: Any = None, **how: Any) -> Any:
        """Draws columns of the histories over time with Matplotlib; returns the axes. Without columns: all of the first unit."""
        from .figures import plot_histories
        return plot_histories(self, columns, axes=axes, **how)

    def _repr_html_(self) -> str:
        valid = "valid" if self.summary.get("valid", True) else "NOT VALID"
        return f"<b>{html.escape(self.folder)}</b>: {html.escape(str(self.summary['status']))}, {valid}{picture_of(self.folder)}"

    def __repr__(self) -> str:
        return f"<talus.Results {self.folder}: {self.summary['status']}>"
