"""Studies: one model many times. The runs are processes of the program talus, as those of `talus study`."""

from __future__ import annotations

import html
import operator
import os
import shutil
import signal
import subprocess
import tempfile
from typing import Any, Dict, List, Mapping, Union

from . import _talus
from ._source import Path, folder_text, override_texts
from ._toml import text_of
from .errors import Error, FileError, InputError
from .results import Results, read_table


def program() -> str:
    """The program talus of this package: beside it in a build or an installation, or in the PATH; TALUS_PROGRAM names another.
    Raises FileError."""
    here = os.path.dirname(os.path.abspath(_talus.__file__))
    named = os.environ.get("TALUS_PROGRAM")
    if named is not None:
        if not (os.path.isfile(named) and os.access(named, os.X_OK)):
            raise FileError(f"TALUS_PROGRAM names {named!r}, which is no program")
        return named
    places = [os.path.join(here, "..", "..", "app", "talus")]
    places += [os.path.join(here, *[".."] * up, "bin", "talus") for up in (3, 4)]
    for place in places:
        if os.access(place, os.X_OK) and os.path.isfile(place):
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
        return read_table(os.path.join(self.folder, "results.csv"), ("status", "host", "message"))

    @property
    def fragility(self) -> Dict[str, Any]:
        """fragility.csv, of studies with states of damage."""
        return read_table(os.path.join(self.folder, "fragility.csv"), ("state", "over", "not_valid_as", "trouble"))

    def run(self, number: int) -> Results:
        """The results of one run, where the study keeps them."""
        return Results(os.path.join(self.folder, "runs", f"{number:06d}"))

    def _repr_html_(self) -> str:
        table = self.table
        head = "".join(f"<th>{html.escape(title)}</th>" for title in table)
        rows = "".join("<tr>" + "".join(f"<td>{html.escape(str(c))}</td>" for c in row) + "</tr>" for row in zip(*table.values()))
        return f"<table><tr>{head}</tr>{rows}</table>"

    def __repr__(self) -> str:
        try:
            return f"<talus.StudyResults {self.folder}: {len(next(iter(self.table.values()), []))} runs>"
        except FileError:
            return f"<talus.StudyResults {self.folder}: nothing is gathered yet>"


class Study:
    """A study file (docs/many_runs.md), or its sections as a dictionary; the model that it names counts from the folder of the file,
    of a dictionary from the present one. In a dictionary `set` may be one, too: {"stage.shake.duration": "2 s"}."""

    def __init__(self, source: Union[Path, Mapping[str, Any]]):
        self._sections = dict(source) if isinstance(source, Mapping) else None
        self._file = "" if isinstance(source, Mapping) else os.fspath(source)
        if self._sections is None:
            return
        # what relative paths count from is the present folder, wherever the text is written to
        here = self._sections
        if isinstance(here.get("set"), Mapping):
            here["set"] = override_texts(here["set"])
        if isinstance(here.get("model"), (str, os.PathLike)):
            here["model"] = os.path.abspath(here["model"])
        if isinstance(here.get("vary"), (list, tuple)):
            here["vary"] = [{**v, "files": os.path.abspath(v["files"])} if isinstance(v, Mapping) and "files" in v else v for v in here["vary"]]

    def dry_run(self) -> str:
        """Checks study and model, and says how many runs there are. Raises InputError."""
        return self._call(["--dry-run"], os.devnull)

    def run(self, folder: Path, jobs: int = 0) -> StudyResults:
        """Runs what is not done yet, `jobs` at once (0: one for each processor). Killed or stopped, the same call goes on.

        Raises InputError, FileError with what the command says (without findings), Error where runs are not done (disk, memory, a
        signal: the same call makes them). Runs that are refused or not valid are rows of the table.
        """
        jobs = operator.index(jobs)
        if jobs < 0:
            raise ValueError("jobs: 0, one for each processor, or more")
        self._call(["--jobs", str(jobs)], folder_text(folder))
        return StudyResults(folder)

    def _call(self, options: List[str], folder: str) -> str:
        with tempfile.TemporaryDirectory() as place:
            file = self._file
            if self._sections is not None:
                file = os.path.join(place, "study.toml")
                with open(file, "w", encoding="utf-8") as out:
                    out.write(text_of(self._sections))
            child = subprocess.Popen([program(), "study", file, "-o", folder, *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            try:
                told, trouble = child.communicate()
            except BaseException:
                child.send_signal(signal.SIGTERM)  # it ends its runs, and goes on with them another time
                child.communicate()
                raise
        if child.returncode == 0:
            return told
        kinds: Dict[int, Any] = {3: InputError, 4: FileError}
        raise kinds.get(child.returncode, Error)(trouble.strip() or told.strip())
