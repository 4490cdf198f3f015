"""Models: read, checked, run."""

from __future__ import annotations

import html
import os
from typing import Any, Callable, Dict, List, Mapping, Optional, Tuple

import numpy
from numpy.typing import NDArray

from . import _talus
from ._source import Overrides, Path, override_texts, read_text, shown, svg_of
from ._toml import text_of
from .errors import Finding
from .run import Run, State


class Model:
    """A model file, checked as `talus check` does: what is wrong raises InputError with all its findings.

    source     path of a model file
    overrides  values by dotted key, as --set: {"stage.slide.duration": "2 s"}; "new:KEY" where the table is to be made

    Models are not changed: another value is another Model. Files that it names are read at each use, and relative paths count
    from the folder of the file as it was given.
    """

    def __init__(self, source: Path, overrides: Optional[Overrides] = None):
        if isinstance(source, Mapping):
            raise TypeError("Model reads a file; Model.from_dict takes sections, Model.from_text a text")
        self._read(os.fspath(source), read_text(source), overrides)

    @classmethod
    def from_text(cls, text: str, overrides: Optional[Overrides] = None, file: str = "model.toml") -> "Model":
        """A model from the text of a file; `file` is its name in messages, from whose folder relative paths count."""
        if not isinstance(text, str):
            raise TypeError(f"the text of a model, not {type(text).__name__}")
        model = cls.__new__(cls)
        model._read(os.fspath(file), text, overrides)
        return model

    @classmethod
    def from_dict(cls, sections: Mapping[str, Any], overrides: Optional[Overrides] = None, file: str = "model.toml") -> "Model":
        """A model from its sections as dictionaries and lists, as tomllib.load gives them. Lines of findings are those of
        the text that is made of it (`text`)."""
        return cls.from_text(text_of(sections), overrides, file)

    def _read(self, file: str, text: str, overrides: Optional[Overrides]) -> None:
        self._model = _talus.Model(file, text, override_texts(overrides))
        self._known: Optional[Dict[str, Any]] = None

    def _scene(self) -> Dict[str, Any]:
        if self._known is None:
            self._known = self._model.scene()
        return self._known

    @property
    def file(self) -> str:
        """Its name."""
        return self._model.file

    @property
    def text(self) -> str:
        """The text of the file, without the overrides."""
        return self._model.text

    @property
    def findings(self) -> List[Finding]:
        """What is doubtful in it."""
        return list(self._model.findings)

    @property
    def title(self) -> str:
        """The key model.title."""
        return str(self._scene()["title"])

    @property
    def stages(self) -> List[str]:
        """Names, in order."""
        return list(self._scene()["stages"])

    @property
    def time_steps(self) -> List[float]:
        """Step of each stage [s]."""
        return list(self._scene()["time_steps"])

    @property
    def blocks(self) -> List[str]:
        """Names, in the order of all arrays by block."""
        return list(self._scene()["blocks"])

    @property
    def polygons(self) -> List[List[Tuple[float, float]]]:
        """Corners of each block as it was given or cut, counter-clockwise [m]."""
        return list(self._scene()["polygons"])

    @property
    def mass(self) -> NDArray[numpy.float64]:
        """Of each block [kg]."""
        return numpy.array(self._scene()["mass"])

    def check(self) -> str:
        """What `talus check` prints: blocks, stages and steps, slivers, memory, time, output. Takes a second."""
        return self._model.check()

    def start(self, folder: Optional[Path] = None, observer: Optional[Callable[[_talus.Instant], Any]] = None, *, every: int = 1,
              threads: int = 0, until: str = "", force: bool = False, state: "State | Path | None" = None) -> Run:
        """A run at its beginning, to be taken on by Run.advance(); arguments as those of run()."""
        return Run(self._model, folder, observer, every, threads, until, force, state)

    def run(self, folder: Optional[Path] = None, observer: Optional[Callable[[_talus.Instant], Any]] = None, *, every: int = 1,
            threads: int = 0, until: str = "", force: bool = False, state: "State | Path | None" = None) -> _talus.Result:
        """Runs all stages; results have the bits of `talus run`.

        folder    for the results; None writes none
        observer  called with an Instant at step 0, at every `every`-th step and at the last; returning False ends the run with
                  the step that is under way
        threads   inside a step, 0: as many as pay
        until     name of the stage to end after
        force     replaces the results of an earlier run in that folder
        state     a State, or the file of one, to go on from: in the folder where it lies, or as a branch, of which what begins
                  later may differ (docs/file_format.md)

        Raises NumericalError where the run ends on bad numbers (what was written stays), InputError where the state is no
        state of this model (its findings are empty, its text names the keys), KeyboardInterrupt on Ctrl-C where it is run by
        the main thread, and whatever the observer raises. Other threads of Python go on meanwhile.
        """
        return self.start(folder, observer, every=every, threads=threads, until=until, force=force, state=state)._to_the_end()

    def svg(self) -> str:
        """A picture of blocks, joints and what acts on them, as SVG."""
        return svg_of(self._model.picture)

    def _repr_html_(self) -> str:
        known = self._scene()
        rows = "".join(f"<tr><td>{html.escape(name)}</td><td>{step:.3g} s</td></tr>" for name, step in zip(known["stages"], known["time_steps"]))
        return (f"<b>{html.escape(known['title'] or self.file)}</b>: {len(known['blocks'])} blocks, "
                f"{len(self.findings)} warnings<table><tr><th>stage</th><th>step</th></tr>{rows}</table>{shown(self.svg())}")

    def __repr__(self) -> str:
        return f"<talus.Model {self.file}: {len(self.blocks)} blocks, stages {', '.join(self.stages)}>"
