"""Figures by Matplotlib, where it is installed (python3-matplotlib)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Sequence

import numpy

if TYPE_CHECKING:
    from .results import Frame, Results


def _axes(axes: Any) -> Any:
    try:
        import matplotlib.collections
        import matplotlib.pyplot
    except ImportError as error:
        raise ImportError("figures want Matplotlib: install python3-matplotlib") from error
    return matplotlib.pyplot.subplots()[1] if axes is None else axes


def plot_frame(frame: "Frame", colour: str = "", *, axes: Any = None, **how: Any) -> Any:
    """The blocks of a frame in true proportion, coloured by an array of blocks."""
    axes = _axes(axes)
    from matplotlib.collections import PolyCollection
    how = {"edgecolor": "0.25", "linewidth": 0.5, "facecolor": "0.85", **how}
    blocks = PolyCollection(frame.polygons, **how)
    if colour:
        values = frame.of_blocks(colour)
        blocks.set_array(numpy.linalg.norm(values, axis=1) if values.ndim > 1 else values)
        axes.figure.colorbar(blocks, ax=axes, label=frame.title_of(colour))
    axes.add_collection(blocks)
    axes.autoscale_view()
    axes.set_aspect("equal")
    axes.set_xlabel("x [m]"), axes.set_ylabel("y [m]"), axes.set_title(f"t = {frame.time:.4g} s")
    return axes


def _unit_of(title: str) -> str:
    return title[title.rindex("["):] if "[" in title else ""


def plot_histories(results: "Results", columns: Sequence[str], *, axes: Any = None, **how: Any) -> Any:
    """Columns of histories.csv over time."""
    table = results.histories
    titles = [t for t in table if t not in ("t [s]", "dynamic_time [s]")]
    if columns:
        chosen = []
        for name in columns:
            found = [t for t in titles if t == name] or [t for t in titles if t.startswith(name)]
            if not found:
                raise KeyError(f"{name}: there is {', '.join(titles)}")
            chosen += found
    else:
        if not titles:
            raise ValueError(f"{results.folder}: the model has no monitor")
        chosen = [t for t in titles if _unit_of(t) == _unit_of(titles[0])]
    axes = _axes(axes)
    for title in chosen:
        axes.plot(table["t [s]"], table[title], label=title.rsplit(" [", 1)[0], **how)
    axes.set_xlabel("t [s]"), axes.set_ylabel(", ".join(sorted({_unit_of(t) for t in chosen})))
    axes.legend()
    return axes
