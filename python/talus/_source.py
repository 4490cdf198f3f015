"""Where texts and pictures come from."""

from __future__ import annotations

import base64
import os
import tempfile
from typing import Any, Callable, List, Mapping, Optional, Union

from ._toml import value_text
from .errors import FileError

Overrides = Mapping[str, Any]
Path = Union[str, "os.PathLike[str]"]


def read_text(path: Path) -> str:
    try:
        with open(path, encoding="utf-8", newline="") as file:  # as it is: the command reads bytes
            return file.read()
    except (OSError, UnicodeDecodeError) as error:
        raise FileError(f"{os.fspath(path)}: {error}") from None


def override_texts(overrides: Optional[Overrides]) -> List[str]:
    """As --set takes them."""
    if overrides is not None and not isinstance(overrides, Mapping):
        raise TypeError(f"overrides: a dictionary of values by dotted key, not {type(overrides).__name__}")
    texts = []
    for key, value in (overrides or {}).items():
        if not isinstance(key, str) or not key or "=" in key:
            raise ValueError(f"overrides: {key!r} is no dotted key")
        texts.append(f"{key}={value_text(value)}")
    return texts


def folder_text(folder: Path) -> str:
    text = os.fsdecode(folder)
    if not text or "\0" in text:
        raise ValueError(f"{text!r} is no name of a folder; None writes no results")
    return text


def svg_of(draw: Callable[[str], None]) -> str:
    """The picture that `draw` writes as STEM.svg, to stand within a page."""
    with tempfile.TemporaryDirectory() as folder:
        stem = os.path.join(folder, "picture")
        draw(stem)
        text = read_text(stem + ".svg")
    return text[text.index("<svg"):]


def shown(svg: str) -> str:
    """A picture for a page with others: names within it would be mixed up with theirs."""
    data = base64.b64encode(svg.encode()).decode()
    return f'<img style="max-width: 100%; background: white" src="data:image/svg+xml;base64,{data}">'
