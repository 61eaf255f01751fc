"""The package's one exception, and warnings of the library."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Optional

from . import _core


@dataclass(frozen=True)
class Fault:
    """One thing that is wrong, and where it was written."""

    message: str
    file: Optional[str] = None  #: the file as it was named, or the Python file; None: unknown
    line: Optional[int] = None  #: from 1
    column: Optional[int] = None  #: from 1, in characters


class Error(Exception):
    """What the user can correct: a wrong name, type, unit or range, a missing file, a scene that cannot be rendered.

    Its text is what the program prints: each fault with its place, the line, and a suggestion. `faults` has them one by one.
    """

    def __init__(self, text: str, faults: object = ()) -> None:
        super().__init__(text)
        self.faults: list[Fault] = [
            f if isinstance(f, Fault) else Fault(**f) for f in faults  # type: ignore[attr-defined]
        ] or [Fault(text)]

    @property
    def message(self) -> str:
        """The first fault's message, without its place."""
        return self.faults[0].message

    def __reduce__(self) -> tuple[type, tuple[str, list[Fault]]]:
        return (Error, (str(self), self.faults))


class NoSuchMember(Error, AttributeError):
    """A member that a class does not have; also an AttributeError, as Python's own functions expect."""


class Warning(UserWarning):
    """What the library warns of: something was given that has no effect, or could not be represented exactly."""


def _warn(text: str) -> None:
    text = text.removeprefix("error: ")
    depth = 2
    import sys

    frame = sys._getframe(1)
    while frame is not None and str(frame.f_globals.get("__name__", "")).startswith("etendue."):
        frame = frame.f_back  # type: ignore[assignment]
        depth += 1
    warnings.warn(text, Warning, stacklevel=depth)


_core._set_error_type(Error)
