"""What the model file says, from Python's values."""

from __future__ import annotations

import json
import math
import os
from typing import Any, List, Mapping


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _key(key: Any) -> str:
    if not isinstance(key, str):
        raise TypeError(f"a key of a model is a text, not {key!r}")
    return _quoted(key)


def value_text(value: Any) -> str:
    """A value as TOML writes it, on one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        if math.isfinite(value):
            return repr(value)
        return "nan" if math.isnan(value) else ("inf" if value > 0 else "-inf")
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(k)} = {value_text(v)}" for k, v in value.items()) + " }"
    if isinstance(value, os.PathLike):
        return _quoted(os.fspath(value))
    if hasattr(value, "tolist"):  # NumPy's
        return value_text(value.tolist())
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(value_text(v) for v in value) + "]"
    raise TypeError(f"a model holds numbers, texts, lists and tables, not {type(value).__name__}")


def _is_tables(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and len(value) > 0 and all(isinstance(v, Mapping) for v in value)


def _write(sections: Mapping[str, Any], path: str, lines: List[str]) -> None:
    tables = []
    for key, value in sections.items():
        if not path and isinstance(value, (list, tuple)) and len(value) == 0:
            continue  # a section of which there is none
        if isinstance(value, Mapping) and path.count(".") < 1 or (_is_tables(value) and not path):
            tables.append((key, value))
        else:
            lines.append(f"{_key(key)} = {value_text(value)}")
    for key, value in tables:
        name = path + _key(key)
        for table in value if _is_tables(value) else [value]:
            lines.append(f"[[{name}]]" if _is_tables(value) else f"[{name}]")
            _write(table, name + ".", lines)


def text_of(sections: Mapping[str, Any]) -> str:
    """The text of a model file with these sections."""
    lines: List[str] = []
    _write(sections, "", lines)
    return "\n".join(lines) + "\n"

