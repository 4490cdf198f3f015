"""Results folders, read without any other library than NumPy."""

from __future__ import annotations

import csv
import html
import json
import os
from typing import Any, Dict, List, Union

import numpy

from .errors import FileError


def _number(cell: str) -> Union[float, str]:
    try:
        return float(cell)
    except ValueError:
        return cell


class Results:
    """The folder that a run has written. Tables are dictionaries of columns by their title, which has the unit."""

    def __init__(self, folder: Union[str, os.PathLike]):
        self.folder = os.fspath(folder)
        self.summary: Dict[str, Any] = json.loads(self._text("summary.json"))

    def _text(self, name: str) -> str:
        path = os.path.join(self.folder, name)
        try:
            with open(path, encoding="utf-8") as file:
                return file.read()
        except OSError as error:
            raise FileError(f"{path}: {error.strerror}; is {self.folder} the folder of a run?") from None

    def table(self, name: str) -> Dict[str, Any]:
        """A file of columns in the folder: "joints.csv". Columns of numbers are arrays, others lists."""
        rows = list(csv.reader(self._text(name).splitlines()))
        if not rows:
            return {}
        columns: Dict[str, Any] = {}
        for k, title in enumerate(rows[0]):
            cells: List[Any] = [_number(row[k]) for row in rows[1:]]
            columns[title] = numpy.array(cells) if all(isinstance(c, float) for c in cells) else cells
        return columns

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

    def _repr_html_(self) -> str:
        return f"<b>{html.escape(self.folder)}</b>: {self.summary['status']}, {'valid' if self.summary['valid'] else 'NOT VALID'}"
