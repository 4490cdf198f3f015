"""Rock cut into blocks, without a run."""

from __future__ import annotations

import html
import json
import os
from typing import Any, Dict, List, Mapping, Optional, Tuple

from . import _talus
from ._source import Overrides, Path, folder_text, override_texts, read_text, shown, svg_of
from ._toml import text_of
from .errors import Finding


class Cut:
    """What `talus cut` makes of a model: its maps read, its regions cut by its joints. What is wrong raises InputError.

    source     path of a model file, or its sections as a dictionary
    overrides  values by dotted key, as --set
    file       name of a dictionary in messages, from whose folder relative paths in it count
    """

    def __init__(self, source: "Path | Mapping[str, Any]", overrides: Optional[Overrides] = None, file: str = "model.toml"):
        if isinstance(source, Mapping):
            text = text_of(source)
        else:
            file, text = os.fspath(source), read_text(source)
        self._cut = _talus.Cut(file, text, override_texts(overrides))

    @property
    def blocks(self) -> List[str]:
        """Names of the blocks."""
        return self._cut.blocks

    @property
    def polygons(self) -> List[List[Tuple[float, float]]]:
        """Corners of each block, counter-clockwise [m]."""
        return self._cut.polygons

    @property
    def materials(self) -> List[str]:
        """Name of the material of each block."""
        return self._cut.materials

    @property
    def report(self) -> str:
        """What the command prints: joint sets, dead ends, slivers, blocks, step limits."""
        return self._cut.report

    @property
    def summary(self) -> Dict[str, Any]:
        """The same as numbers, as in cut.json."""
        return dict(json.loads(self._cut.summary))

    @property
    def findings(self) -> List[Finding]:
        """What is doubtful in the model."""
        return list(self._cut.findings)

    def write(self, folder: Path, force: bool = False) -> None:
        """Writes the folder of `talus cut`: pictures, blocks.json, blocks.csv, slivers.csv, report.txt, cut.json, model.toml."""
        self._cut.write(folder_text(folder), force)

    def svg(self) -> str:
        """A picture of blocks, joints and what acts on them, as SVG."""
        return svg_of(self._cut.picture)

    def _repr_html_(self) -> str:
        return f"{shown(self.svg())}<pre>{html.escape(self.report)}</pre>"

    def __repr__(self) -> str:
        return f"<talus.Cut: {len(self.blocks)} blocks>"
