"""Runs that are taken step by step, and their states."""

from __future__ import annotations

import atexit
import html
import inspect
import operator
import os
import time as clock
import weakref
from types import TracebackType
from typing import Any, Callable, Optional, Type

import numpy
from numpy.typing import NDArray

from . import _talus
from ._source import Path, folder_text, shown
from .errors import FileError

Observer = Callable[[_talus.Instant], Any]


class State:
    """Where a run stands: Model.run(state=...) goes on from here, or branches off. States can be pickled.

    path  a file FOLDER/saved/*.h5, or one that write() has made
    """

    def __init__(self, path: Path):
        self._state = _talus.State.read(os.path.abspath(os.fspath(path)))

    @classmethod
    def _of(cls, state: _talus.State) -> "State":
        own = cls.__new__(cls)
        own._state = state
        return own

    @property
    def size(self) -> int:
        """Of its file [bytes]."""
        return self._state.size

    def write(self, path: Path) -> None:
        """Writes the file, which is what `talus run --from` takes."""
        self._state.write(os.fspath(path))

    def __repr__(self) -> str:
        return f"<talus.State {self._state.name}: {self.size} bytes>"


def picture_of(folder: str) -> str:
    """The picture of the end that a run has left, for a page; "" where there is none (output.pictures = false)."""
    try:
        with open(os.path.join(folder, "blocks_end.svg"), encoding="utf-8") as file:
            text = file.read()
        return shown(text[text.index("<svg"):])
    except (OSError, ValueError):
        return ""


_live: "weakref.WeakSet[Run]" = weakref.WeakSet()


def _calls(run: "weakref.ref[Run]") -> Observer:
    # the run holds its observer, which may hold the run: a ring that Python can see and take apart
    def call(now: _talus.Instant) -> Any:
        own = run()
        return None if own is None or own._observer is None else own._observer(now)
    return call


@atexit.register
def _end_all() -> None:
    """Runs that are alive when the interpreter ends are ended in order, those of other threads too."""
    for run in list(_live):
        run._run.interrupt()
    end = clock.monotonic() + 10
    while any(run._run.busy for run in _live) and clock.monotonic() < end:
        clock.sleep(0.01)
    for run in list(_live):
        try:
            run.finish()
        except Exception:  # nobody is there any more to be told
            pass


class Run:
    """A run that goes as far as it is told to; made by Model.start(). The results are those of Model.run(), however the way
    is cut.

        with model.start("out/slope") as run:
            while run.advance(steps=100):
                print(run.time, run.displacement[3])

    At its end, or where the block is left before, results are written and `result` says how it ended.
    """

    def __init__(self, model: _talus.Model, folder: Optional[Path], observer: Optional[Observer], every: int, threads: int, until: str,
                 force: bool, state: "State | Path | None"):
        if observer is not None and (not callable(observer) or inspect.iscoroutinefunction(observer) or inspect.isgeneratorfunction(observer)):
            raise TypeError(f"observer: a function of an Instant, not {observer!r}")
        if state is not None and not isinstance(state, State):
            state = State(state)
        place = None if folder is None else folder_text(folder)
        if place is not None:
            for other in list(_live):
                if other._place == os.path.realpath(place) and not other.over:
                    raise FileError(f"{place}: a Run of this process writes into it; finish() that one first")
        self._place: str = "" if place is None else os.path.realpath(place)
        self._observer: Optional[Observer] = observer
        self._run: _talus.Run = _talus.Run(model, place, None if observer is None else _calls(weakref.ref(self)), operator.index(every),
                               operator.index(threads), until, bool(force), None if state is None else state._state)
        _live.add(self)

    def advance(self, steps: Optional[int] = None, time: Optional[float] = None, stage_end: bool = False) -> bool:
        """Goes on by so many steps, to this time of the run [s], to the end of the stage, whichever comes first; without any
        to the end of the run. True while there is more to come.

        Raises NumericalError where the run ends on bad numbers, KeyboardInterrupt on Ctrl-C, and what the observer raises;
        the run is over then.
        """
        if steps is not None:
            steps = operator.index(steps)
            if not 0 <= steps < 2 ** 63:
                raise ValueError("steps: 0 or more, and less than 2^63")
        return self._run.advance(steps, None if time is None else float(time), bool(stage_end))

    def finish(self) -> _talus.Result:
        """Ends the run where it stands, and its results with it."""
        return self._run.finish()

    def save(self) -> State:
        """The state now, to go on from later or to branch off."""
        return State._of(self._run.save())

    def _to_the_end(self) -> _talus.Result:
        self._run.advance(None, None, False)
        return self._run.result

    @property
    def time(self) -> float:
        """Of the run [s]."""
        return self._run.time

    @property
    def step(self) -> int:
        """Steps completed."""
        return self._run.step

    @property
    def stage(self) -> str:
        """Name of the last stage that has begun, "" before the first."""
        return self._run.stage

    @property
    def over(self) -> bool:
        """Whether nothing more is to come."""
        return self._run.over

    @property
    def result(self) -> _talus.Result:
        """How far it has come, or how it ended."""
        return self._run.result

    @property
    def displacement(self) -> NDArray[numpy.float64]:
        """Displacements of the centroids [m], (blocks, 2): a read-only view, as those of Instant."""
        return self._run.displacement

    @property
    def strain_part(self) -> NDArray[numpy.float64]:
        """Deformation gradients F - I [-], (blocks, 2, 2): a view."""
        return self._run.strain_part

    @property
    def rate(self) -> NDArray[numpy.float64]:
        """Velocities of the centroids in the middle of the last step [m/s], (blocks, 2): a view."""
        return self._run.rate

    @property
    def rate_gradient(self) -> NDArray[numpy.float64]:
        """Rates of the deformation gradients then [1/s], (blocks, 2, 2): a view."""
        return self._run.rate_gradient

    @property
    def stress(self) -> NDArray[numpy.float64]:
        """Cauchy stress of each block, tension > 0 [Pa], (blocks, 2, 2): a copy."""
        return self._run.stress

    @property
    def contacts(self) -> NDArray[Any]:
        """Contact points as at the beginning of the last step, as Instant.contacts: a copy."""
        return self._run.contacts

    def __enter__(self) -> "Run":
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException], trace: Optional[TracebackType]) -> None:
        self.finish()

    def _repr_html_(self) -> str:
        r = self.result
        rows = "".join(f"<tr><td>{html.escape(s['name'])}</td><td>{s['steps']}</td><td>{s['time_step']:.3g} s</td></tr>" for s in r.stages)
        picture = picture_of(r.folder) if self.over else ""
        return f"{html.escape(self._text())}<table><tr><th>stage</th><th>steps</th><th>step</th></tr>{rows}</table>{picture}"

    def _text(self) -> str:
        r = self.result
        state = ("failed" if r.failure else "stopped" if r.interrupted else "ended") if self.over else "goes on"
        return f"t = {self.time:.6g} s, step {self.step}, stage {self.stage or 'none'}: {state}"

    def __repr__(self) -> str:
        return f"<talus.Run {self._text()}>"
