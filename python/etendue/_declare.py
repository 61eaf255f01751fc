"""Classes written in Python: `class Stripes(etendue.ObjectMap)`.

Defining a class that derives from an interface declares it to the library: the language, the manual, `describe`, conform,
copies and files know it from then on, and defining it again replaces it. Its members are class attributes:

    class Stripes(etendue.ObjectMap):
        '''Stripes across the surface, along v.'''

        count: float = etendue.member(8, range=(0, None), text="pairs of stripes over u")
        first: etendue.ObjectMap = etendue.member(0.8, unit="1", text="every other stripe")

        def scalar(self, point):
            return point.scalar(self.first) if self.count * point.uv[0] % 1 < 0.5 else 0.1

`help(etendue.ObjectMap)` and those of the other interfaces list the methods. A call of a map's method takes about 1 microsecond, one of
a shader's 2, and one thread at a time runs Python; a renderer's method is called with hundreds or thousands of rays at once.
"""

from __future__ import annotations

import inspect
import json
import os
import pathlib
import re
import sys
import types
import typing
from typing import Any, Callable, ClassVar, Iterable, Mapping, NamedTuple, Optional, Sequence, Union

from . import _classes, _core
from ._classes import Part, class_named
from ._errors import Error, Fault


class _Kind:
    """A kind of value of the language that has no type of its own in Python, for the annotation of a member."""

    def __init__(self, kind: str, text: str) -> None:
        self.kind = kind
        self.__doc__ = text

    def __repr__(self) -> str:
        return f"etendue.{self.__doc__}"


Color: Any = _Kind("color", "Color")  #: annotation of a member: a colour or spectrum
Transform: Any = _Kind("transform", "Transform")  #: annotation of a member: a transform, which may be animated
Vector2: Any = _Kind("vector2", "Vector2")  #: annotation of a member: two numbers
Vector3: Any = _Kind("vector3", "Vector3")  #: annotation of a member: a vector of three numbers
Point3: Any = _Kind("point3", "Point3")  #: annotation of a member: a point in space, in double precision
Normal3: Any = _Kind("normal3", "Normal3")  #: annotation of a member: a normal, three numbers

_numeric = {"number", "vector2", "vector3", "point3", "normal3"}


class Lobe:
    """Kinds of scattering, as bits: Lobe.diffuse_reflection | Lobe.glossy_reflection."""

    diffuse_reflection: ClassVar[int] = _core.lobes["diffuse_reflection"]
    diffuse_transmission: ClassVar[int] = _core.lobes["diffuse_transmission"]
    glossy_reflection: ClassVar[int] = _core.lobes["glossy_reflection"]
    glossy_transmission: ClassVar[int] = _core.lobes["glossy_transmission"]
    specular_reflection: ClassVar[int] = _core.lobes["specular_reflection"]
    specular_transmission: ClassVar[int] = _core.lobes["specular_transmission"]
    null_scattering: ClassVar[int] = _core.lobes["null_scattering"]


class ScatterSample(NamedTuple):
    """A direction that a shader sampled, in local directions: z is along the shading normal."""

    direction: Sequence[float]  #: unit, away from the surface
    value: Any  #: f |cos| at each wavelength [1/sr]; for a specular lobe its reflectance or transmittance
    pdf: float  #: [1/sr] of all lobes that were asked for together; for a specular lobe its probability
    lobe: int  #: one bit of Lobe
    eta: float = 1.0  #: the index on the side of the direction over that on the side of `out`
    dispersive: bool = False  #: whether the direction is that of the first wavelength only


class Condition(NamedTuple):
    """When a member has an effect: see `when` and `unless`."""

    member: str
    values: tuple[Any, ...]
    unless: bool


def when(member: str, *values: Any) -> Condition:
    """The member has an effect only if another member has one of these values; without values: if it is not empty."""
    return Condition(member, values, False)


def unless(member: str, *values: Any) -> Condition:
    """The member has an effect only if another member has none of these values; without values: if it is empty."""
    return Condition(member, values, True)


_missing: Any = object()


class _Member:
    """What `member` returns, until the class is made: then it becomes a property."""

    def __init__(self, default: Any, options: dict[str, Any]) -> None:
        self.default = default
        self.options = options
        self.name = ""

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name


def member(
    default: Any = _missing,
    *,
    text: str,
    unit: Optional[str] = None,
    range: Optional[tuple[Optional[float], Optional[float]]] = None,
    open_low: bool = False,
    soft: Optional[tuple[float, float]] = None,
    logarithmic: bool = False,
    choices: Optional[Sequence[str]] = None,
    meaning: Optional[str] = None,
    effect: Optional[str] = None,
    group: Optional[str] = None,
    required: bool = False,
    conditions: Sequence[Condition] = (),
) -> Any:
    """A member of a class written in Python, declared once: its name and annotation are those of the class attribute.

        radius: float = etendue.member(0.5, unit="m", range=(0, None), text="its radius")

    The annotation is float, int, bool, str, typing.Literal["a", "b"] (a choice), pathlib.Path (a file), etendue.Color, Transform,
    Vector2, Vector3, Point3, Normal3, a class of etendue (a part, Optional[…] for one that may be None), or a list of these.

    default: as the member would be set: a number in the unit, or a text such as "30 cm" or "rgb(1, 0, 0)". Without it a part is
        None, a list empty, a transform the identity; numbers, texts and vectors need a default or required=True.
    text: the documentation, one sentence or more.
    unit: of numbers and vectors, "1" if not given.
    range: the least and the greatest value, in the unit; None: no limit. open_low: the least value itself is not allowed.
    soft, logarithmic: the ends of a slider, and whether it is logarithmic.
    choices: all allowed texts, for a member of type str.
    meaning: what a colour or map is used as: "reflectance", "radiance", "coefficient", "index", or "number".
    effect: the work that a change makes necessary: "none", "retone", "rerender" (the default) or "rebuild".
    group: the heading in a panel.
    required: the member must be set; it has no useful default.
    conditions: when the member has an effect: [etendue.when("kind", "round")].
    """
    given: dict[str, Any] = {"text": text, "required": required}
    for name, value in (
        ("unit", unit),
        ("range", range),
        ("soft", soft),
        ("meaning", meaning),
        ("effect", effect),
        ("group", group),
    ):
        if value is not None:
            given[name] = value
    if choices is not None:
        given["choices"] = list(choices)
    if logarithmic:
        given["logarithmic"] = True
    if open_low:
        given["open_low"] = True
    given["conditions"] = [c._asdict() for c in conditions]
    return _Member(default, given)


# ---- from a Python class to a description ----------------------------------------------------------------------------------


def _kind_of(annotation: Any, where: str) -> dict[str, Any]:
    """The kind of a member by its annotation: {"kind": …, "list": …, "part": …, "choices": …}."""
    if isinstance(annotation, _Kind):
        return {"kind": annotation.kind}
    simple = {float: "number", int: "integer", bool: "boolean", str: "string"}
    if annotation in simple:
        return {"kind": simple[annotation]}
    origin, arguments = typing.get_origin(annotation), typing.get_args(annotation)
    if origin is typing.Literal:
        if not all(isinstance(a, str) for a in arguments):
            raise Error(f"{where}: the choices of a Literal are texts")
        return {"kind": "choice", "choices": list(arguments)}
    if origin in (list, typing.List) and len(arguments) == 1:
        entry = _kind_of(arguments[0], where)
        if entry.get("list"):
            raise Error(f"{where}: a list of lists cannot be a member")
        return {**entry, "list": True}
    if origin in (Union, getattr(types, "UnionType", Union)):
        others = [a for a in arguments if a is not type(None)]
        if len(others) == 1:
            return _kind_of(others[0], where)
    if isinstance(annotation, type):
        if issubclass(annotation, (pathlib.PurePath, os.PathLike)):
            return {"kind": "file"}
        if issubclass(annotation, Part) and annotation is not Part:
            return {"kind": "component", "part": _classes.described(annotation)["name"]}
    raise Error(
        f"{where}: cannot be {getattr(annotation, '__name__', annotation)!s}; a member is annotated as float, int, bool, str, "
        "Literal, pathlib.Path, etendue.Color, Transform, Vector2, Vector3, Point3, Normal3, a class of etendue, or a list of these"
    )


def _evaluated(annotation: Any, frame: Optional[types.FrameType], cls: type, where: str) -> Any:
    """An annotation that is a text, as all are with `from __future__ import annotations`."""
    if not isinstance(annotation, str):
        return annotation
    scope: dict[str, Any] = dict(vars(sys.modules.get(cls.__module__) or types))
    if frame is not None:
        scope = {**frame.f_globals, **frame.f_locals}
    try:
        return eval(annotation, scope)
    except Exception as e:
        raise Error(f"{where}: its annotation {annotation!r} cannot be read: {e}") from e


def _described_members(cls: type, frame: Optional[types.FrameType]) -> list[dict[str, Any]]:
    annotations: Mapping[str, Any] = inspect.get_annotations(cls)
    found: list[dict[str, Any]] = []
    for name, value in list(vars(cls).items()):
        where = f"{cls.__name__}.{name}"
        if isinstance(value, _Member):
            if name not in annotations:
                raise Error(f"{where}: a member needs an annotation, as in {name}: float = etendue.member(…)")
            if name.startswith("_") or not re.fullmatch(r"[a-z][a-z0-9_]*", name):
                raise Error(f"{where}: the name of a member has small letters, digits and underscores, and begins with a letter")
            if hasattr(Part, name):
                raise Error(f"{where}: a member cannot have the name of a method of all parts")
            if name in getattr(cls, "_question_names", ()):
                raise Error(f"{where}: a member cannot have the name of a question: see help(etendue.{_interface(cls)['name']}.{name})")
            found.append(_described_member(name, value, _evaluated(annotations[name], frame, cls, where), where))
    for name, annotation in annotations.items():
        where = f"{cls.__name__}.{name}"
        if isinstance(vars(cls).get(name), _Member) or name.startswith("_"):
            continue
        plain = annotation if isinstance(annotation, str) else str(annotation)
        if "ClassVar" not in plain:
            raise Error(
                f"{where}: members are declared by etendue.member(…); annotate other attributes of the class as ClassVar, or not "
                "at all"
            )
    return found


def _described_member(name: str, declared: _Member, annotation: Any, where: str) -> dict[str, Any]:
    described = {"name": _classes._member_name(name), **_kind_of(annotation, where), **declared.options}
    kind = described["kind"]
    if kind in _numeric:
        described.setdefault("unit", "1")
    if declared.default is not _missing:
        described["default"] = declared.default
    elif not described["required"] and not described.get("list") and kind not in ("component", "color", "transform", "file"):
        raise Error(f"{where}: needs a default, or required=True")
    return described


def _summary_of(cls: type) -> tuple[str, str]:
    """The first paragraph of the docstring, and what follows "Source:" in it."""
    text = inspect.cleandoc(cls.__dict__.get("__doc__") or "")
    if not text:
        raise Error(f"{cls.__name__}: needs a docstring, whose first paragraph says what the class is")
    source = re.search(r"(?ms)^Source:\s*(.+?)(?:\n\s*\n|\Z)", text)
    summary = " ".join(re.split(r"\n\s*\n", text)[0].split())
    return summary, " ".join(source[1].split()) if source else ""


def _interface(cls: type) -> dict[str, Any]:
    """What classes of the interface of this class are made of."""
    for base in cls.__mro__:
        known: dict[str, Any]
        for known in _core.part_interfaces():
            if base.__module__ == "etendue" and known["name"] == base.__name__:
                return known
    return {"name": "", "methods": {}, "required": [], "together": []}  # the library says which interfaces there are


def _own(cls: type, name: str) -> Any:
    """An attribute that a class of Python defines, of itself or of a base that is not the library's; else None."""
    for base in cls.__mro__:
        if base is Part:
            break
        if "_made_by_registry" in vars(base):
            continue
        if name in vars(base):
            return vars(base)[name]
    return None


def _check_methods(cls: type, interface: dict[str, Any]) -> list[str]:
    """The methods and attributes of the interface that the class defines; Error for those that are missing or wrong."""
    methods: dict[str, str] = interface["methods"]
    defined = [name for name in methods if _own(cls, name) is not None]
    for alternatives in interface["required"]:
        if any(name in defined for name in alternatives):
            continue
        near = _near(cls, alternatives, methods)
        wanted = " or ".join(f"{name}({methods[name]})" for name in alternatives)
        raise Error(f"{cls.__name__}: a class of {interface['name']} defines {wanted}{near}")
    together = interface["together"]
    if together and 0 < sum(name in defined for name in together) < len(together):
        raise Error(f"{cls.__name__}: defines only one of {' and '.join(together)}, which must fit together")
    for name in defined:
        _check_signature(cls, name, methods[name])
    return defined


def _near(cls: type, alternatives: Iterable[str], methods: Mapping[str, str]) -> str:
    import difflib

    own = [n for n, v in vars(cls).items() if inspect.isfunction(v) and n not in methods]
    for name in alternatives:
        if close := difflib.get_close_matches(name, own, 1):
            return f" (is '{close[0]}' meant to be '{name}'?)"
    return ""


def _check_signature(cls: type, name: str, arguments: str) -> None:
    function = inspect.getattr_static(cls, name)
    wanted = len(arguments.split(","))
    if isinstance(function, (staticmethod, classmethod)):
        raise Error(f"{cls.__name__}.{name}: is a method with the arguments ({arguments}), no static or class method")
    if not inspect.isfunction(function):
        if wanted > 1:
            raise Error(f"{cls.__name__}.{name}: must be a method with the arguments ({arguments})")
        return
    try:
        inspect.signature(function).bind(*[None] * wanted)
    except TypeError:
        raise Error(f"{cls.__name__}.{name}{inspect.signature(function)}: is called with the arguments ({arguments})") from None


# ---- declaring --------------------------------------------------------------------------------------------------------------

_provider = ""  # the plugin that is being loaded


def declare(cls: type, abstract: bool, frame: Optional[types.FrameType]) -> None:
    """Declares a class of Python to the library. Called when the class is defined."""
    interface = _interface(cls)
    summary, source = _summary_of(cls)
    parent = next(b for b in cls.__mro__[1:] if issubclass(b, Part))
    members = _described_members(cls, frame)
    methods = _check_methods(cls, interface) if not abstract else []
    # What objects need that are made while the class is declared; the library's own description replaces it.
    plain = [{"name": m["name"], "type": m["kind"], "list": m.get("list"), "text": m["text"]} for m in members]
    for described in plain:
        setattr(cls, _classes.python_name(described["name"]), _classes._property(described))
    description = {"name": cls.__name__, "summary": summary, "members": _classes.described(parent)["members"] + plain}
    setattr(cls, "_description", description)
    _core.declare(
        cls,
        {
            "name": cls.__name__,
            "parent": _classes.described(parent)["name"],
            "summary": summary,
            "source": source,
            "provider": _provider,
            "abstract": abstract,
            "methods": methods,
            "members": members,
        },
    )
    description = json.loads(_core.class_json(cls.__name__))
    setattr(cls, "_description", description)
    cls.__signature__ = _classes._signature(description)  # type: ignore[attr-defined]
    for described in description["members"]:
        if described["name"] in {m["name"] for m in members}:
            setattr(cls, _classes.python_name(described["name"]), _classes._property(described))
    _classes._declared[cls.__name__] = cls


_classes._declare = declare


# ---- plugins ----------------------------------------------------------------------------------------------------------------


def _read_plugin(file: str) -> None:
    """Runs a file as a module; the classes that it defines have the file as their provider."""
    import importlib.util

    global _provider
    name = "etendue_plugin_" + re.sub(r"\W", "_", pathlib.Path(file).stem)
    spec = importlib.util.spec_from_file_location(name, file)
    if spec is None or spec.loader is None:
        raise Error(f"'{file}' is no file of Python")
    module = importlib.util.module_from_spec(spec)
    before, _provider = _provider, file
    sys.modules[name] = module
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[name]
        raise
    finally:
        _provider = before


_core.read_python_plugins(_read_plugin)


# ---- errors -----------------------------------------------------------------------------------------------------------------


def _explain(exception: BaseException, class_name: str, method: str) -> tuple[str, str, int, int]:
    """The text of an exception that a method raised, and its place: file, line, column ("" and 0: unknown)."""
    called = f"{class_name}.{method}" if method else class_name
    file, line = _place_of(exception)
    if isinstance(exception, Error):
        fault: Fault = exception.faults[0]
        text = fault.message if fault.message.startswith(class_name) or not method else f"{called}: {fault.message}"
        if fault.file:
            return text, fault.file, fault.line or 0, fault.column or 0
        return text, file, line, 0
    message = str(exception)
    if isinstance(exception, SyntaxError) and exception.filename:
        file, line, message = exception.filename, exception.lineno or 0, exception.msg
    name = type(exception).__name__
    return f"{called} raised {name}{': ' + message if message else ''}", file, line, 0


def _place_of(exception: BaseException) -> tuple[str, int]:
    """The innermost line of the exception's traceback that is not this package's."""
    file, line = "", 0
    at = exception.__traceback__
    while at is not None:
        module = str(at.tb_frame.f_globals.get("__name__", ""))
        if not module.startswith("etendue.") and not module.startswith("importlib"):
            file, line = at.tb_frame.f_code.co_filename, at.tb_lineno
        at = at.tb_next
    return file, line


def _refusal(returned: Any, class_name: str, method: str) -> tuple[str, str, int]:
    """What a method returned, for a message, and where the method is defined."""
    if hasattr(returned, "shape") and hasattr(returned, "dtype"):
        shown = f"an array of shape {returned.shape}"
        if returned.size <= 16:
            shown = repr(returned)
    else:
        shown = repr(returned)
    if len(shown) > 100:
        shown = shown[:97] + "..."
    cls: Any = _classes._declared.get(class_name)
    function: Optional[Callable[..., Any]] = getattr(cls, method, None) if cls is not None else None
    code = getattr(function, "__code__", None)
    return " ".join(shown.split()), code.co_filename if code else "", code.co_firstlineno if code else 0
