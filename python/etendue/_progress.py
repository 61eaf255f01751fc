"""How far a render is: the numbers, a line on a terminal, a live picture in a notebook."""

from __future__ import annotations

import importlib
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Optional, Union

from ._errors import Error

if TYPE_CHECKING:
    from ._render import Render


@dataclass(frozen=True)
class Progress:
    """How far a render is."""

    samples: int  #: per pixel, in whole steps
    samples_wanted: int
    fraction: float  #: of the work, by the limit that will probably stop the render first
    seconds: float  #: spent on its steps
    seconds_left: Optional[float]  #: estimated; None: unknown
    samples_per_second: float  #: over the whole picture
    error: Optional[float]  #: mean relative standard error of pixels; only if the job limits it
    finished: bool

    def __str__(self) -> str:
        text = f"{100 * self.fraction:3.0f} %  {self.samples}/{self.samples_wanted} samples"
        text += f"  {self.samples_per_second * 1e-6:.2f} Msamples/s  {_duration(self.seconds)}"
        if self.error:
            text += f"  error {self.error:.4f}"
        if not self.finished and self.seconds_left is not None:
            text += f"  {_duration(self.seconds_left)} left"
        return text


Shown = Union[None, bool, Callable[[Progress], Any]]


def _duration(seconds: float) -> str:
    if seconds < 60:
        return f"{seconds:.1f} s"
    minutes = round(seconds / 60)
    return f"{round(seconds)//60} min {round(seconds) % 60} s" if minutes < 60 else f"{minutes // 60} h {minutes % 60} min"


class Display:
    """Shows the progress of a run; `close` is called at its end, whatever ends it."""

    def show(self, progress: Progress) -> None:
        """Called now and then by the thread that runs the render."""

    def close(self) -> None:
        pass


class _Function(Display):
    def __init__(self, function: Callable[[Progress], Any]) -> None:
        self._function = function

    def show(self, progress: Progress) -> None:
        self._function(progress)


class _Line(Display):
    """A bar on the last line of a terminal, which is erased at the end; without a terminal, a line now and then."""

    _cells = 24

    def __init__(self) -> None:
        self._bar = sys.stderr.isatty()
        self._next = 10.0  # [s]
        self._on_screen = False

    def show(self, progress: Progress) -> None:
        if self._bar:
            full = min(int(progress.fraction * self._cells), self._cells)
            sys.stderr.write(f"\r\x1b[K[{'#' * full}{'.' * (self._cells - full)}] {progress}")
            self._on_screen = True
        elif progress.seconds >= self._next and not progress.finished:
            self._next = progress.seconds + max(10.0, 0.25 * progress.seconds)  # the interval grows with the time
            sys.stderr.write(f"{progress}\n")
        sys.stderr.flush()

    def close(self) -> None:
        if self._on_screen:
            sys.stderr.write("\r\x1b[K")
            sys.stderr.flush()


class _Notebook(Display):
    """The picture so far below the notebook's cell, with a line of text. It is removed at the end: the cell's result follows."""

    def __init__(self, render: Render) -> None:
        self._render = render
        self._handle: Any = None
        self._next = 0.0
        self._cost = 0.0

    def show(self, progress: Progress) -> None:
        # Developing and encoding take at most a tenth of the time.
        now = time.perf_counter()
        if progress.finished or now < self._next:
            return
        from ._widgets import live_html

        ipython = importlib.import_module("IPython.display")
        shown = ipython.HTML(live_html(self._render.snapshot(), str(progress)))
        if self._handle is None:
            self._handle = ipython.display(shown, display_id=True)
        else:
            self._handle.update(shown)
        self._next = time.perf_counter() + max(0.25, 9 * (time.perf_counter() - now))

    def close(self) -> None:
        if self._handle is not None:
            self._handle.update(importlib.import_module("IPython.display").HTML(""))


def in_notebook() -> bool:
    """Whether this is the kernel of a notebook, which can show pictures."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return shell is not None and getattr(shell, "kernel", None) is not None


def display_for(render: Render, progress: Shown) -> Display:
    """True: a picture in a notebook, else a line on standard error. None: the same, but nothing outside of notebooks and
    terminals. False: nothing. A function is called with a Progress."""
    if callable(progress):
        return _Function(progress)
    if progress is not None and not isinstance(progress, bool):
        raise Error(f"progress is True, False, None or a function that takes a Progress, not {progress!r}")
    if progress is False:
        return Display()
    if in_notebook():
        return _Notebook(render)
    if progress or (sys.stderr is not None and sys.stderr.isatty()):
        return _Line()
    return Display()
