"""What talus raises, and what is wrong with a model."""

from __future__ import annotations

from dataclasses import dataclass
from typing import List


@dataclass(frozen=True)
class Finding:
    """One thing that is wrong (severity "error") or doubtful ("warning") in a model: where, of which key, and what to do.

    line, column  from 1; line 0: not in the file
    override      the text behind --set, or KEY=VALUE of an override, where the value came from there
    """

    severity: str
    file: str
    line: int
    column: int
    key: str
    message: str
    hint: str = ""
    override: str = ""


class Error(Exception):
    """Anything that talus reports."""


class InputError(Error):
    """A model cannot be used. str() is what the command prints; findings holds each thing with its line, key and hint."""

    findings: List[Finding] = []


class FileError(Error):
    """A file or folder cannot be read or written."""


class NumericalError(Error):
    """A run ended on bad numbers: the text says when, at which block and contact, and what may help."""
