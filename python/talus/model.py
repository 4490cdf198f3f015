"""Models: read, checked, run."""

from __future__ import annotations

import html
import os
from typing import Any, Callable, List, Mapping, Optional, Union

from . import _talus
from ._toml import text_of, value_text
from .errors import FileError, Finding

Overrides = Mapping[str, Any]


class Model:
    """A model file, checked as `talus check` does: what is wrong raises InputError with all its findings.

    source     path of a model file
    overrides  values by dotted key, as --set: {"stage.slide.duration": "2 s"}; "new:KEY" where the table is to be made

    findings holds the warnings. Models are not changed: another value is another Model.
    """

    def __init__(self, source: Union[str, os.PathLike], overrides: Optional[Overrides] = None):
        path = os.fspath(source)
        try:
            with open(path, encoding="utf-8") as file:
                text = file.read()
        except (OSError, UnicodeDecodeError) as error:
            raise FileError(f"{path}: {error}") from None
        self._read(path, text, overrides)

    @classmethod
    def from_text(cls, text: str, overrides: Optional[Overrides] = None, file: str = "model.toml") -> "Model":
        """A model from the text of a file; `file` is its name in messages, from whose folder relative paths count."""
        model = cls.__new__(cls)
        model._read(file, text, overrides)
        return model

    @classmethod
    def from_dict(cls, sections: Mapping[str, Any], overrides: Optional[Overrides] = None, file: str = "model.toml") -> "Model":
        """A model from its sections as dictionaries and lists, as tomllib.load gives them. Lines of findings are those of
        the text that is made of it (model.text)."""
        return cls.from_text(text_of(sections), overrides, file)

    def _read(self, file: str, text: str, overrides: Optional[Overrides]) -> None:
        given = [f"{key}={value_text(value)}" for key, value in (overrides or {}).items()]
        self._model = _talus.Model(file, text, given)
        self._known = None

    def _scene(self) -> dict:
        if self._known is None:
            self._known = self._model._scene()
        return self._known

    @property
    def file(self) -> str:
        return self._model.file

    @property
    def text(self) -> str:
        return self._model.text

    @property
    def findings(self) -> List[Finding]:
        """What is doubtful in it."""
        return list(self._model.findings)

    @property
    def title(self) -> str:
        return self._scene()["title"]

    @property
    def stages(self) -> List[str]:
        """Names, in order."""
        return self._scene()["stages"]

    @property
    def time_steps(self) -> List[float]:
        """Step of each stage [s]."""
        return self._scene()["time_steps"]

    @property
    def blocks(self) -> List[str]:
        """Names, in the order of all arrays by block."""
        return self._scene()["blocks"]

    @property
    def polygons(self) -> list:
        """Corners of each block as it was given or cut [m]."""
        return self._scene()["polygons"]

    @property
    def mass(self):
        """Of each block [kg]."""
        return self._scene()["mass"]

    def run(self, folder: Union[None, str, os.PathLike] = None, observer: Optional[Callable[[_talus.Instant], Any]] = None, *,
            every: int = 1, threads: int = 0, until: str = "", force: bool = False) -> _talus.Result:
        """Runs all stages; results have the bits of `talus run`.

        folder    for the results; None writes none
        observer  called with an Instant at every `every`-th step and at the last; returning False ends the run with the
                  step that is under way
        threads   inside a step, 0: as many as pay
        until     name of the stage to end after
        force     replaces the results of an earlier run in that folder

        Raises NumericalError where the run ends on bad numbers (what was written stays), KeyboardInterrupt on Ctrl-C, and
        whatever the observer raises. Other threads of Python go on meanwhile.
        """
        return self._model._run(None if folder is None else os.fspath(folder), observer, every, threads, until, force)

    def _repr_html_(self) -> str:
        known = self._scene()
        rows = "".join(f"<tr><td>{html.escape(name)}</td><td>{step:.3g} s</td></tr>" for name, step in zip(known["stages"], known["time_steps"]))
        return (f"<b>{html.escape(known['title'] or self.file)}</b>: {len(known['blocks'])} blocks, "
                f"{len(self.findings)} warnings<table><tr><th>stage</th><th>step</th></tr>{rows}</table>")

    def __repr__(self) -> str:
        return f"<talus.Model {self.file}: {len(self._scene()['blocks'])} blocks, stages {', '.join(self.stages)}>"
