"""Scenes from files and texts, and back."""

from __future__ import annotations

import os
import re
from typing import Any, Iterator, Mapping, Optional, Sequence, Union

from . import _core
from ._classes import Part, Parts, class_named, described
from ._errors import Error

Path = Union[str, "os.PathLike[str]"]


def load(
    file: Path,
    *,
    defines: Optional[Mapping[str, Any]] = None,
    strict: bool = False,
    allow_files: bool = True,
    allowed_folders: Sequence[Path] = (),
    frame: float = 0,
    time: float = 0,
) -> Any:
    """Reads a scene: a description (.etd, .json) or a file of another program (Mitsuba's .xml, .pbrt, .gltf, .glb, .obj, .usd, …).

    defines: values for the description's `param`s, as the program's `-D name=value`.
    strict: what an importer cannot express exactly is an error instead of a warning.
    allow_files: False refuses descriptions that read further files, for descriptions of others.
    frame, time: the frame of an animation, and its time [s].
    Returns the Job. Raises Error with every fault that one reading finds.
    """
    return _core.load(
        os.fspath(file), _texts(defines), allow_files, strict, [os.fspath(f) for f in allowed_folders], frame, time
    )


def loads(
    text: str,
    *,
    name: str = "text",
    folder: Path = "",
    defines: Optional[Mapping[str, Any]] = None,
    allow_files: bool = True,
    frame: float = 0,
    time: float = 0,
) -> Any:
    """Reads a description from a text: that of a whole render gives a Job, that of one part ("Sphere { radius: 2 m }") the part.

    name stands for the file in messages (a name that ends in .json: the text is JSON); paths are relative to folder.
    """
    if not _is_job(text):
        return _core.parse_component(text, name, os.fspath(folder))
    return _core.loads(text, name, os.fspath(folder), _texts(defines), allow_files, frame, time)


def _is_job(text: str) -> bool:
    """Whether a text describes a whole render: `Job` begins a line of it, or is the class of a JSON object."""
    return re.search(r'(?m)^\s*Job\b|"class"\s*:\s*"Job"', text) is not None


def _texts(defines: Optional[Mapping[str, Any]]) -> dict[str, str]:
    return {k: v if isinstance(v, str) else _core.write_value(v) for k, v in (defines or {}).items()}


def dumps(part: Part, *, all: bool = False, folder: Path = "", format: str = "etd") -> str:
    """The description of a part or job as a text that reads back equal; format is "etd" or "json".

    all: write members that have their defaults, too. folder: paths of files are written relative to it.
    """
    if format not in ("etd", "json"):
        raise Error(f"format is 'etd' or 'json', not {format!r}")
    write = _core.write_json if format == "json" else _core.write_description
    return write(part, all, os.fspath(folder))


def save(job: Part, file: Path, *, all: bool = False, strict: bool = False) -> None:
    """Writes a job as a description (.etd, .json) or for another program (.xml, .pbrt, .gltf, …), by the file's ending.

    all: write members that have their defaults, too. strict: what another program cannot express is an error instead of a warning.
    The file is written whole or not at all, and never over a file that the job reads.
    """
    _core.save(job, os.fspath(file), all, strict)


def to_dict(part: Part, *, all: bool = False) -> dict[str, Any]:
    """A part as a dict: its "class", and the members that differ from their defaults (all: every member).

    Parts are dicts, lists are lists, colours and transforms texts of the language; a part that is used twice is written twice.
    """
    result: dict[str, Any] = {"class": _core.class_name(part)}
    for member in described(type(part))["members"]:
        name = member["name"]
        if all or not _core.has_default(part, name):
            result[name] = _plain(getattr(part, name), all)
    return result


def _plain(value: Any, all: bool) -> Any:
    if isinstance(value, Part):
        return to_dict(value, all=all)
    if isinstance(value, (Parts, tuple, list)):
        return [_plain(v, all) for v in value]
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, _core.Value):
        return repr(value)
    return value


def from_dict(description: Mapping[str, Any]) -> Any:
    """The part that a dict describes: {"class": "Sphere", "radius": 2, "shader": {"class": "DiffuseShader"}}.

    Values may be anything that a member accepts: numbers, texts with units, arrays, parts, and dicts for parts.
    """
    if "class" not in description:
        raise Error(f"a part's dict needs a \"class\"; it has {', '.join(map(repr, description)) or 'nothing'}")
    members = {k: _from_plain(v) for k, v in description.items() if k != "class"}
    return class_named(description["class"])(**members)


def _from_plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return from_dict(value)
    if isinstance(value, (list, tuple)):
        return [_from_plain(v) for v in value]
    return value


def walk(part: Part) -> Iterator[tuple[str, Part]]:
    """All parts within a part, each once, with its path: ("scene.objects[2].shader", …). The part itself has the path ""."""
    seen: dict[int, Part] = {}  # they are kept, as another object may get the id of one that is gone
    left: list[tuple[str, Part]] = [("", part)]
    while left:
        path, at = left.pop()
        if id(at) in seen:
            continue
        seen[id(at)] = at
        yield path, at
        inner: list[tuple[str, Part]] = []
        for member in described(type(at))["members"]:
            if member["type"] != "component":
                continue
            value = getattr(at, member["name"])
            name = f"{path}.{member['name']}" if path else member["name"]
            if isinstance(value, Part):
                inner.append((name, value))
            elif isinstance(value, Parts):
                inner += [(f"{name}[{i}]", v) for i, v in enumerate(value) if isinstance(v, Part)]
        left += reversed(inner)
