"""Every class and every member of the registry from Python: values, texts, units, ranges, files, errors, signatures, docstrings."""

import inspect
import math

import numpy
import pytest

import etendue
from etendue._classes import described, python_name

CLASSES = [cls for cls in etendue.classes() if not described(cls)["abstract"]]
VECTORS = {"vector2": 2, "vector3": 3, "point3": 3, "normal3": 3}
SIMPLE_UNITS = {"m": ("km", 1e-3), "s": ("ms", 1e3), "deg": ("rad", math.pi / 180), "nm": ("um", 1e-3), "K": None}


def members():
    return [pytest.param(cls, m, id=f"{cls.__name__}.{m['name']}") for cls in CLASSES for m in described(cls)["members"]]


def numbers_in_range(member):
    """Some numbers that a member allows, in its unit."""
    limits = member.get("range", {})
    low, high, more_than = limits.get("low"), limits.get("high"), limits.get("more_than")
    found = [] if low is None else [low]
    found += [] if high is None else [high]
    lowest = low if low is not None else more_than
    if lowest is None:
        lowest = 0.0 if high is None else high - 8
    highest = high if high is not None else max(lowest, 0) + 8
    found += [lowest + 0.25 * (highest - lowest), lowest + 0.5 * (highest - lowest)]
    if member["type"] == "integer":
        found = [math.ceil(x) for x in found if lowest <= math.ceil(x) <= highest]
    return [x for x in found if abs(x) < 1e9]


# Of interfaces without a class that needs nothing: what is given.
GIVEN = {"ObjectGroup": {"name": "wheels", "objects": ["wheel*"]}}


def concrete(name, avoid=()):
    """A part of an interface's first class that needs nothing, or what is in GIVEN."""
    if name in GIVEN:
        return getattr(etendue, name)(**GIVEN[name])
    for cls in etendue.classes(getattr(etendue, name)):
        description = described(cls)
        if not description["abstract"] and cls.__name__ not in avoid and not any(m.get("required") for m in description["members"]):
            return cls()
    raise AssertionError(f"no class of {name} is without required members")


def scalar_values(member):
    """Pairs of what is given and what is read."""
    kind = member["type"]
    if kind in ("number", "integer"):
        pairs = [(x, x) for x in numbers_in_range(member)]
        x = numbers_in_range(member)[-1]
        pairs += [(numpy.float64(x), x), (str(x), x)]
        unit = member.get("unit")
        if unit in SIMPLE_UNITS:
            pairs.append((f"{x!r} {unit}", x))
            if SIMPLE_UNITS[unit]:
                other, factor = SIMPLE_UNITS[unit]
                pairs.append((f"{x * factor!r} {other}", x))
        return pairs
    if kind == "boolean":
        return [(True, True), (False, False), ("true", True)]
    if kind in ("choice", "string"):
        choices = [c for c in member.get("choices", ["some text", "ü", ""]) if "…" not in c]
        return [(c, c) for c in choices]
    if kind == "file":
        return [("/nowhere/a file.png", "/nowhere/a file.png")]
    if kind in VECTORS:
        values = (0.25, 0.5, 0.75)[: VECTORS[kind]]
        return [(values, values), (list(values), values), (numpy.array(values), values), (str(list(values)), values)]
    if kind == "color":
        return [(c, c) for c in (etendue.rgb(0.2, 0.4, 0.6), etendue.spectrum([400, 700], [1, 2]))]
    if kind == "transform":
        moved = etendue.translate(1, 2, 3)
        return [(moved, moved), (moved.matrix, moved), ("translate(1, 2, 3)", moved)]
    part = concrete(member["class"])
    return [(part, part)]


def values(member):
    if not member.get("list"):
        return scalar_values(member)
    kind = member["type"]
    if kind in ("number", "integer"):
        row = numbers_in_range(member)
        return [(row, row), (numpy.array(row), row)]
    if kind in VECTORS:
        rows = [[0.25, 0.5, 0.75][: VECTORS[kind]], [1.0, 2.0, 3.0][: VECTORS[kind]]]
        return [(rows, rows), (numpy.array(rows), rows)]
    if kind == "component":
        parts = [concrete(member["class"]), concrete(member["class"])]
        return [(parts, parts), (tuple(parts), parts)]
    found = tuple(v for v, _ in scalar_values(member))
    return [(found, found), (list(found), found)]


def equal(read, expected):
    if isinstance(expected, etendue.Part):
        return read is expected
    if isinstance(expected, list) and expected and isinstance(expected[0], etendue.Part):
        return list(read) == expected and all(a is b for a, b in zip(read, expected))
    if isinstance(expected, tuple) and expected and isinstance(expected[0], etendue.Value):
        return tuple(read) == expected
    if isinstance(expected, (bool, str)) or (expected and isinstance(expected, tuple) and isinstance(expected[0], str)):
        return read == expected and type(read) is type(expected)
    if isinstance(expected, (int, float, list, tuple)):
        return numpy.shape(read) == numpy.shape(expected) and numpy.allclose(read, expected, rtol=1e-6, atol=1e-12)
    return read == expected


def assert_saved_equal(part):
    """A part is the same after the texts and dicts it is written as."""
    for all_members in (False, True):
        assert etendue.equal(etendue.loads(etendue.dumps(part, all=all_members)), part)
        assert etendue.equal(etendue.from_dict(etendue.to_dict(part, all=all_members)), part)


@pytest.mark.parametrize("cls, member", members())
def test_member_is_set_and_read(cls, member):
    name = python_name(member["name"])
    for given, expected in values(member):
        part = cls(**{name: given})
        assert equal(getattr(part, name), expected), (given, getattr(part, name))
        other = cls()
        setattr(other, name, given)
        assert etendue.equal(part, other)
        assert etendue.equal(etendue.copy(part), part)


@pytest.mark.parametrize("cls", CLASSES, ids=lambda cls: cls.__name__)
def test_class_is_saved_and_loaded(cls):
    assert_saved_equal(cls())
    for place in range(2):  # all members at once, with other values each time
        part = cls()
        for member in described(cls)["members"]:
            several = values(member)
            setattr(part, python_name(member["name"]), several[place % len(several)][0])
        assert_saved_equal(part)


def test_jobs_are_saved_and_loaded_as_json():
    job = etendue.Job(renderer=etendue.PathTracer(), camera=etendue.PerspectiveCamera(), scene=etendue.BvhScene())
    for format, name in (("json", "job.json"), ("etd", "job.etd")):
        assert etendue.equal(etendue.loads(etendue.dumps(job, format=format), name=name), job)


def wrong_values(member):
    kind = member["type"]
    yield {1}  # of which no value of any kind can be made
    if member.get("list"):
        yield [[[1.0]]] if kind in ("number", "integer") else 5
        return
    if kind in ("number", "integer"):
        yield etendue.Sphere()
        yield math.nan
        yield math.inf
        yield "1 kg m"
        yield "1 s" if member.get("unit") != "s" else "1 m"
        limits = member.get("range", {})
        low, high, more_than = limits.get("low"), limits.get("high"), limits.get("more_than")
        if low is not None:
            yield low - 1
        if more_than is not None:
            yield more_than
        if high is not None:
            yield high + max(1, abs(high))
        if kind == "integer":
            yield 1.5
    elif kind == "boolean":
        yield 5
        yield "perhaps"
    elif kind == "choice" or (kind == "string" and member.get("choices")):
        yield "no such choice"
        yield 5
    elif kind in ("string", "file"):
        yield 5
    elif kind in VECTORS:
        yield 5
        yield [1.0] * (VECTORS[kind] + 1)
        yield [math.nan] * VECTORS[kind]
    elif kind == "color":
        yield etendue.Sphere()
        yield "1 kg"
    elif kind == "transform":
        yield 5
        yield numpy.ones((4, 4))
    else:
        yield etendue.Job() if member["class"] != "Job" else etendue.Sphere()
        yield "text"


@pytest.mark.parametrize("cls, member", members())
def test_wrong_values_are_refused(cls, member):
    name = python_name(member["name"])
    part = cls()
    before = etendue.copy(part)
    for given in wrong_values(member):
        with pytest.raises((etendue.Error, TypeError)) as error:
            setattr(part, name, given)
        assert isinstance(error.value, etendue.Error), (given, error.value)
        assert f"{cls.__name__}.{member['name']}" in str(error.value), (given, str(error.value))
        assert etendue.equal(part, before), given


@pytest.mark.parametrize("cls", CLASSES, ids=lambda cls: cls.__name__)
def test_wrong_names_are_refused(cls):
    part = cls()
    for member in described(cls)["members"]:
        near = member["name"] + "x"
        if near in {m["name"] for m in described(cls)["members"]} or len(near) < 5:
            continue
        for attempt in (lambda: setattr(part, near, 1), lambda: getattr(part, near), lambda: cls(**{near: 1})):
            with pytest.raises(etendue.Error) as error:
                attempt()
            assert f"{cls.__name__} has no member '{near}'" in str(error.value)
            assert "did you mean" in str(error.value) or "here it is" in str(error.value), str(error.value)


@pytest.mark.parametrize("cls", etendue.classes(), ids=lambda cls: cls.__name__)
def test_signature_and_docstrings(cls):
    description = described(cls)
    assert cls.__doc__.startswith(description["summary"])
    if description["abstract"]:
        with pytest.raises(etendue.Error, match="is an interface"):
            cls()
        return
    parameters = inspect.signature(cls).parameters
    assert sorted(parameters) == sorted(python_name(m["name"]) for m in description["members"])
    for member in description["members"]:
        name = python_name(member["name"])
        assert member["text"] in getattr(cls, name).__doc__
        if limit := member.get("range"):
            assert all(f"{x:g}" in getattr(cls, name).__doc__ for x in limit.values())
        assert (parameters[name].default is inspect.Parameter.empty) == bool(member.get("required"))
        assert name in dir(cls)
