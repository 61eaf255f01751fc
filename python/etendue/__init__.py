"""Étendue: physically based, spectral Monte Carlo image synthesis.

    import etendue
    job = etendue.load("scenes/cornell_box.etd")
    etendue.render(job, samples=64)

Every class that the program knows (`etendue classes`) is a class of this module: etendue.Sphere(radius="30 cm"). Every function of
the description language is a function of it: etendue.rgb(0.8, 0.2, 0.1), etendue.translate(0, 0, 1).
"""

from __future__ import annotations

from typing import Any

from . import _installation

__path__.append(_installation.folder_of_build())  # where the extension module is

from . import _core, _errors
from ._classes import Part, Parts, described
from ._errors import Error, Fault, Warning
from ._installation import build_info
from ._files import dumps, from_dict, load, loads, save, to_dict, walk
from ._images import (
    ChannelComparison,
    Comparison,
    Image,
    TileRatios,
    compare_images,
    light_groups,
    read_image,
    relight,
    tile_ratios,
)
from ._paths import PathContributions, PathRecord, PathVertices
from ._progress import Progress
from ._render import Render, denoise, render
from ._widgets import Widget, difference, show, side_by_side
from ._laboratory import Conformance, ErrorComparison, Verification, compare, conform, verify
from ._tables import Table

__version__: str = _core.__version__
Value = _core.Value


def copy(part: Part) -> Any:
    """A deep copy of a part: parts that it shares within itself are shared in the copy, too."""
    return _core.copy(part)


def equal(a: Part, b: Part) -> bool:
    """Whether two parts are of one class and have equal members, down to the last."""
    return _core.equal(a, b)


def classes(interface: Any = None) -> list[type]:
    """All classes, or those of an interface: classes(etendue.Shader)."""
    every = [getattr(_this(), name) for name in _core.class_names()]
    return every if interface is None else [c for c in every if issubclass(c, interface)]


def load_plugin(file: Any) -> None:
    """Opens a plugin: a shared library, or a Python file that declares classes."""
    import os

    from . import _classes

    _core.load_plugin(os.fspath(file))
    _classes._made.clear()


def _this() -> Any:
    import sys

    return sys.modules[__name__]


def _language_function(name: str) -> Any:
    def call(*arguments: Any) -> Any:
        return _core.call(name, *arguments)

    call.__name__ = call.__qualname__ = name
    call.__doc__ = f"The function {name} of the description language."
    return call


def __getattr__(name: str) -> Any:
    from ._classes import part_class

    if not name.startswith("_"):
        if (found := part_class(name)) is not None:
            return found
        if _core.is_function(name):
            made = globals()[name] = _language_function(name)
            return made
    meant = _core.meant_class(name) if name[:1].isupper() else ""
    raise AttributeError(f"etendue has no class or function '{name}'{meant}")


def __dir__() -> list[str]:
    return sorted([*globals(), *_core.class_names()])
