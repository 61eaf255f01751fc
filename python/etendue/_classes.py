"""The classes of the registry as Python classes.

None is written here: each is made when it is first asked for, from the description that parser, manual and studio use, too.
"""

from __future__ import annotations

import inspect
import json
import keyword
import re
import sys
from collections.abc import Iterator, MutableSequence
from typing import TYPE_CHECKING, Any, Iterable, NoReturn, Optional

from . import _core
from ._errors import Error, NoSuchMember

_made: dict[str, type] = {}
_declared: dict[str, type] = {}  # classes written in Python (_declare.py)
_declare: Any = None  # declares such a class; set by _declare.py


class Parts(MutableSequence[Any]):
    """The list of a member that refers to several parts. Changing it changes the member."""

    __slots__ = ("_owner", "_member")

    def __init__(self, owner: "Part", member: str) -> None:
        self._owner = owner
        self._member = member

    def _now(self) -> list[Any]:
        return list(_core.get(self._owner, self._member))

    def _store(self, entries: Iterable[Any]) -> None:
        _core.set(self._owner, self._member, list(entries))

    def __len__(self) -> int:
        return len(_core.get(self._owner, self._member))

    def __getitem__(self, place: Any) -> Any:
        return self._now()[place]

    def __setitem__(self, place: Any, value: Any) -> None:
        entries = self._now()
        entries[place] = value
        self._store(entries)

    def __delitem__(self, place: Any) -> None:
        entries = self._now()
        del entries[place]
        self._store(entries)

    def insert(self, place: int, value: Any) -> None:
        entries = self._now()
        entries.insert(place, value)
        self._store(entries)

    def extend(self, values: Iterable[Any]) -> None:
        self._store(self._now() + list(values))

    def __eq__(self, other: object) -> bool:
        return self._now() == list(other) if isinstance(other, (list, tuple, Parts)) else NotImplemented

    def __repr__(self) -> str:
        return repr(self._now())


class Part(_core.Component):
    """Anything that a scene is made of: the base of all classes (`Component` in the C++ library)."""

    def __init__(self, *literal: Any, **members: Any) -> None:
        _initialize(self, literal, members)

    def __init_subclass__(cls, abstract: bool = False, **options: Any) -> None:
        """A class written in Python: see etendue.member. abstract: only other classes derive from it, and it has no objects."""
        super().__init_subclass__(**options)
        if "_made_by_registry" not in cls.__dict__:
            _declare(cls, abstract, sys._getframe(1))

    def fail(self, member: str, message: str) -> NoReturn:
        """Raises Error about a member, with the place where it was written: for the method `prepare` of classes in Python."""
        _core.fail(self, member, message)
        raise AssertionError

    if not TYPE_CHECKING:  # type checkers have the members from the stubs (_stubs.py)

        def __setattr__(self, name: str, value: Any) -> None:
            if name.startswith("_"):
                object.__setattr__(self, name, value)
            elif type(self).__name__ in _declared and all(
                m["name"] != _member_name(name) for m in described(type(self))["members"]
            ):
                raise NoSuchMember(
                    f"{type(self).__name__} has no member '{name}': declare it by etendue.member, or let the name of an attribute "
                    f"that is no member begin with an underscore: self._{name}"
                )
            else:
                _core.set(self, _member_name(name), value)

        def __getattr__(self, name: str) -> Any:
            # Reached for names that are neither members nor methods.
            if name.startswith("_"):
                raise AttributeError(name)
            try:
                return _core.get(self, _member_name(name))
            except Error as e:
                raise NoSuchMember(str(e), e.faults) from None

    def __delattr__(self, name: str) -> None:
        if name.startswith("_"):
            object.__delattr__(self, name)
        else:
            raise Error(f"{type(self).__name__}.{name} cannot be deleted; set it to another value")

    def __getitem__(self, path: str) -> Any:
        """A part or a value by its path: job["scene.objects[2].shader"]."""
        return _follow(self, _steps(path), path)

    def __setitem__(self, path: str, value: Any) -> None:
        owner, name, changed = self._target(path, value)
        _core.set(owner, name, changed)

    def _target(self, path: str, value: Any) -> tuple["Part", str, Any]:
        """The part whose member has to be set, the member, and its new value, for a value at a path."""
        *way, (name, places) = _steps(path)
        at = _follow(self, way, path)
        owner = _as_part(at, path)
        if not places:
            return owner, name, value
        entries = getattr(owner, name)
        for place in places[:-1]:
            entries = entries[place]
        changed = [list(e) if hasattr(e, "__len__") and not isinstance(e, str) else e for e in entries]
        if not 0 <= places[-1] < len(changed):
            raise Error(f"'{path}': {name} has no entry [{places[-1]}]{_length(entries)}")
        changed[places[-1]] = value
        if len(places) > 1:
            raise Error(f"'{path}': set the whole list instead of a number in it")
        return owner, name, changed

    def __copy__(self) -> Any:
        return _core.copy(self)

    def __deepcopy__(self, memo: dict[int, Any]) -> Any:
        return _core.copy(self)

    def __reduce__(self) -> tuple[Any, ...]:
        return (_read_part, (_core.class_name(self), _core.write_description(self, False, ""), _core.name_of(self)))

    def __repr__(self) -> str:
        shown = []
        for member in described(type(self))["members"]:
            if not _core.has_default(self, member["name"]):
                    shown.append(f"{python_name(member['name'])}={_short(getattr(self, member['name']))}")
        return f"{type(self).__name__}({', '.join(shown)})"


def python_name(member: str) -> str:
    """A member's name as Python can write it: `from` is a word of Python, so the member is `from_`."""
    return f"{member}_" if keyword.iskeyword(member) else member


def _member_name(name: str) -> str:
    return name[:-1] if name.endswith("_") and keyword.iskeyword(name[:-1]) else name


def _as_part(at: Any, path: str) -> Part:
    if not isinstance(at, Part):
        raise Error(f"'{path}': {at!r} is no part and has no members")
    return at


def _follow(at: Any, steps: Iterable[tuple[str, list[int]]], path: str) -> Any:
    """What stands at the end of some steps of a path."""
    for name, places in steps:
        at = getattr(_as_part(at, path), name)
        for place in places:
            try:
                at = at[place]
            except (IndexError, TypeError):
                raise Error(f"'{path}': {name} has no entry [{place}]{_length(at)}") from None
    return at


def _length(entries: Any) -> str:
    try:
        return f"; it has {len(entries)}"
    except TypeError:
        return ""


def _steps(path: str) -> Iterator[tuple[str, list[int]]]:
    for step in path.split("."):
        match = re.fullmatch(r"([A-Za-z_]\w*)((?:\[\d+\])*)", step)
        if not match:
            raise Error(f"'{path}' is no path of members: expected a name, or a name with [number], not '{step}'")
        yield match[1], [int(n) for n in re.findall(r"\d+", match[2])]


def _short(value: Any) -> str:
    if isinstance(value, Part):
        return f"<{type(value).__name__}>"
    if isinstance(value, Parts):
        return f"[{len(value)} parts]" if len(value) else "[]"
    if isinstance(value, float):
        return f"{value:g}"
    if isinstance(value, tuple) and all(isinstance(x, float) for x in value):
        return f"({', '.join(f'{x:g}' for x in value)})"
    if hasattr(value, "shape"):
        return f"<array of shape {value.shape}>"
    text = repr(value)
    return text if len(text) <= 80 else text[:77] + "..."


def _read_part(class_name: str, text: str, name: str) -> Part:
    part: Part = _core.loads(text, "pickle", "", {}, True, 0, 0) if class_name == "Job" else _core.parse_component(text, "pickle", "")
    if name:
        _core.set_name(part, name)
    return part


def _initialize(self: Part, literal: tuple[Any, ...], members: dict[str, Any]) -> None:
    description = described(type(self))
    if literal:
        member = description.get("literal")
        if member is None or len(literal) > 1:
            raise Error(
                f"{description['name']}: members are given by name, as in {description['name']}("
                + ", ".join(f"{m['name']}=…" for m in description["members"][:2])
                + ")"
            )
        if member in members:
            raise Error(f"{description['name']}.{member} is given twice")
        members = {member: literal[0], **members}
    _core.init(self, description["name"], {_member_name(name): value for name, value in members.items()})


def described(cls: type) -> dict[str, Any]:
    """The description of a class: a dict of name, parent, summary, source, members, subclasses."""
    found: dict[str, Any] = getattr(cls, "_description")
    return found


def _property(member: dict[str, Any]) -> property:
    name = member["name"]
    parts = member["type"] == "component" and member.get("list")

    def read(self: Part) -> Any:
        return Parts(self, name) if parts else _core.get(self, name)

    def write(self: Part, value: Any) -> None:
        _core.set(self, name, value)

    return property(read, write, doc=_member_text(member))


def type_text(member: dict[str, Any]) -> str:
    """What may be given for a member, in words: "number [m], at least 0"."""
    text: str = member.get("class") or member["type"]
    if member.get("list"):
        text = f"list of {text}"
    unit = member.get("unit")
    if unit and unit != "1":
        text += f" [{unit}]"
    if member.get("choices"):
        text += ": " + ", ".join(map(str, member["choices"]))
    limits = member.get("range")
    if limits:
        low = limits.get("more_than", limits.get("low"))
        high = limits.get("high")
        words = []
        if low is not None:
            words.append(("more than " if "more_than" in limits else "at least ") + f"{low:g}")
        if high is not None:
            words.append(f"at most {high:g}")
        if words:
            text += ", " + " and ".join(words)
    return text


def _member_text(member: dict[str, Any]) -> str:
    default = "required" if member.get("required") else f"default {member.get('default')}"
    return f"{member['text']} ({type_text(member)}; {default})"


def _class_text(description: dict[str, Any]) -> str:
    text: str = description["summary"]
    if description.get("source"):
        text += f"\n\nSource: {description['source']}"
    if description["members"]:
        text += "\n\nMembers:\n" + "\n".join(f"    {m['name']}: {_member_text(m)}" for m in description["members"])
    for interface in _core.part_interfaces():
        if interface["name"] == description["name"]:
            text += "\n\nMethods of a class written in Python (see etendue.member):\n" + _method_texts(interface)
    if description.get("subclasses"):
        text += "\n\nClasses: " + ", ".join(_names(description["subclasses"]))
    return text


def _method_texts(interface: dict[str, Any]) -> str:
    lines = []
    for name, arguments in interface["methods"].items():
        needed: list[str] = next((names for names in interface["required"] if name in names), [])
        mark = " (needed)" if len(needed) == 1 else " (one of these is needed)" if needed else ""
        lines.append(f"    {name}({arguments}): {interface['texts'][name]}{mark}")
    return "\n".join(lines)


def _names(entries: Iterable[Any]) -> list[str]:
    return [e if isinstance(e, str) else e["name"] for e in entries]


def _signature(description: dict[str, Any]) -> inspect.Signature:
    literal = description.get("literal")
    parameters = []
    for member in sorted(description["members"], key=lambda m: m["name"] != literal):
        default = inspect.Parameter.empty if member.get("required") else member.get("default")
        kind = inspect.Parameter.POSITIONAL_OR_KEYWORD if member["name"] == literal else inspect.Parameter.KEYWORD_ONLY
        parameters.append(inspect.Parameter(python_name(member["name"]), kind, default=default))
    return inspect.Signature(parameters)


def _questions_of(name: str) -> dict[str, Any]:
    from ._questions import questions_of

    return questions_of(name)


def class_named(name: str) -> type:
    """The Python class of a class of the registry; made at the first call."""
    known = _declared.get(name) or _made.get(name)
    if known is not None:
        return known
    description = json.loads(_core.class_json(name))
    parent: type = class_named(description["parent"]) if description.get("parent") else Part
    inherited = {m["name"] for m in getattr(parent, "_description", {}).get("members", ())}
    namespace: dict[str, Any] = {
        "__doc__": _class_text(description),
        "__module__": "etendue",
        "__qualname__": name,
        "_description": description,
        "_made_by_registry": True,
        "__signature__": _signature(description),
    }
    questions = _questions_of(name)
    namespace.update(questions)
    asked = {*questions, *getattr(parent, "_question_names", ())}
    namespace["_question_names"] = asked
    for member in description["members"]:
        if python_name(member["name"]) in asked:
            raise Error(f"{name}: the member '{member['name']}' has the name of a question (etendue/_questions.py)")
        if member["name"] not in inherited:
            namespace[python_name(member["name"])] = _property(member)
    for absent in inherited - {m["name"] for m in description["members"]}:
        namespace[absent] = _absent(absent)
    made = type(name, (parent,), namespace)
    _made[name] = made
    return made


def _absent(name: str) -> property:
    """A member of the interface that has no effect in a class: reading or setting it tells why."""

    def read(self: Part) -> Any:
        try:
            return _core.get(self, name)
        except Error as e:
            raise NoSuchMember(str(e), e.faults) from None

    def write(self: Part, value: Any) -> None:
        _core.set(self, name, value)

    return property(read, write, doc="has no effect in this class")


def forget(name: str) -> None:
    """A class of this name was declared anew, or a plugin brought new subclasses."""
    _made.pop(name, None)


def part_class(name: str) -> Optional[type]:
    """The class of this name, or None."""
    return class_named(name) if name[:1].isupper() and _core.knows_class(name) else None
