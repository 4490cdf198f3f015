"""Where texts and pictures come from."""

from __future__ import annotations

import os
import tempfile
from typing import Any, Callable, List, Mapping, Optional, Union

from ._toml import value_text
from .errors import FileError

Overrides = Mapping[str, Any]
Path = Union[str, "os.PathLike[str]"]


def read_text(path: Path) -> str:
    try:
        with open(path, encoding="utf-8") as file:
            return file.read()
    except (OSError, UnicodeDecodeError) as error:
        raise FileError(f"{os.fspath(path)}: {error}") from None


def override_texts(overrides: Optional[Overrides]) -> List[str]:
    """As --set takes them."""
    return [f"{key}={value_text(value)}" for key, value in (overrides or {}).items()]


def svg_of(draw: Callable[[str], None]) -> str:
    """The picture that `draw` writes as STEM.svg, to stand within a page."""
    with tempfile.TemporaryDirectory() as folder:
        stem = os.path.join(folder, "picture")
        draw(stem)
        text = read_text(stem + ".svg")
    return text[text.index("<svg"):]
