"""Studies: one model many times. The runs are processes of the program talus, as those of `talus study`."""

from __future__ import annotations

import hashlib
import html
import os
import shutil
import subprocess
from typing import Any, Dict, List, Mapping, Union

from . import _talus
from ._source import Path, override_texts
from ._toml import text_of
from .errors import Error, FileError, InputError
from .results import Results, read_table


def program() -> str:
    """The program talus of this package: beside it in a build or an installation, or in the PATH; TALUS_PROGRAM names another.
    Raises FileError."""
    here = os.path.dirname(os.path.abspath(_talus.__file__))
    places = [os.environ.get("TALUS_PROGRAM", ""), os.path.join(here, "..", "..", "app", "talus")]
    places += [os.path.join(here, *[".."] * up, "bin", "talus") for up in (3, 4)]
    for place in places:
        if place and os.access(place, os.X_OK) and os.path.isfile(place):
            return os.path.normpath(place)
    found = shutil.which("talus")
    if found is None:
        raise FileError("a study wants the program talus, which was not found; TALUS_PROGRAM names it")
    return found


class StudyResults:
    """The folder of a study: what has come of its runs so far."""

    def __init__(self, folder: Path):
        self.folder = os.fspath(folder)

    @property
    def table(self) -> Dict[str, Any]:
        """results.csv: what varies and the answers by title, a row for each run."""
        return read_table(os.path.join(self.folder, "results.csv"))

    @property
    def fragility(self) -> Dict[str, Any]:
        """fragility.csv, of studies with states of damage."""
        return read_table(os.path.join(self.folder, "fragility.csv"))

    def run(self, number: int) -> Results:
        """The results of one run, where the study keeps them."""
        return Results(os.path.join(self.folder, "runs", f"{number:06d}"))

    def _repr_html_(self) -> str:
        table = self.table
        head = "".join(f"<th>{html.escape(title)}</th>" for title in table)
        rows = "".join("<tr>" + "".join(f"<td>{html.escape(str(c))}</td>" for c in row) + "</tr>" for row in zip(*table.values()))
        return f"<table><tr>{head}</tr>{rows}</table>"

    def __repr__(self) -> str:
        return f"<talus.StudyResults {self.folder}: {len(next(iter(self.table.values()), []))} runs>"


class Study:
    """A study file (docs/many_runs.md), or its sections as a dictionary; the model that it names counts from the folder of the file,
    of a dictionary from the present one. In a dictionary `set` may be one, too: {"stage.shake.duration": "2 s"}."""

    def __init__(self, source: Union[Path, Mapping[str, Any]]):
        self._sections = dict(source) if isinstance(source, Mapping) else None
        if self._sections is not None and isinstance(self._sections.get("set"), Mapping):
            self._sections["set"] = override_texts(self._sections["set"])
        self._file = "" if isinstance(source, Mapping) else os.fspath(source)

    def dry_run(self) -> str:
        """Checks study and model, and says how many runs there are. Raises InputError."""
        return self._call(["--dry-run"], os.devnull)

    def run(self, folder: Path, jobs: int = 0) -> StudyResults:
        """Runs what is not done yet, `jobs` at once (0: one for each processor). Killed or stopped, the same call goes on.
        Raises InputError, FileError with what the command says; runs that fail are rows of the table."""
        self._call(["--jobs", str(jobs)], os.fspath(folder))
        return StudyResults(folder)

    def _call(self, options: List[str], folder: str) -> str:
        file = self._file
        if self._sections is not None:
            # beside what it names; the folder of the study keeps a copy
            text = text_of(self._sections)
            file = f".talus_study_{hashlib.sha256(text.encode()).hexdigest()[:12]}.toml"
            with open(file, "w", encoding="utf-8") as out:
                out.write(text)
        try:
            done = subprocess.run([program(), "study", file, "-o", folder, *options], capture_output=True, text=True)
        finally:
            if self._sections is not None:
                os.remove(file)
        if done.returncode == 0:
            return done.stdout
        kinds: Dict[int, Any] = {3: InputError, 4: FileError}
        raise kinds.get(done.returncode, Error)(done.stderr.strip() or done.stdout.strip())
