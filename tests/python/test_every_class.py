"""Every class of the registry: made, every member set, read, saved and loaded equal, and what is wrong refused by name."""

import json

import numpy
import pytest

import etendue

CONCRETE = [c for c in etendue.classes() if not c._description["abstract"] and c.__name__ != "Job"]


def bounds(member):
    limits = member.get("range", {})
    low = limits.get("low", limits.get("more_than"))
    high = limits.get("high")
    return low, high, "more_than" in limits


def number_for(member):
    low, high, open_low = bounds(member)
    if low is None and high is None:
        x = 2.5
    elif high is None:
        x = low + 2.5
    elif low is None:
        x = high - 2.5
    else:
        x = low + 0.375 * (high - low)
    if member["type"] == "integer":
        x = round(x)
        x = x + 1 if open_low and x <= low else x
    return x


def one(member):
    """A value that the description allows, and that is not its default in most cases."""
    kind = member["type"]
    choices = [c for c in member.get("choices", []) if not c.endswith("…")]
    if kind == "boolean":
        return not member.get("default")
    if kind in ("number", "integer"):
        return number_for(member)
    if kind == "choice" or (kind == "string" and choices):
        return choices[-1]
    if kind in ("string", "file"):
        return "text.png"
    if kind == "vector2":
        return (number_for({**member, "type": "number"}),) * 2
    if kind in ("vector3", "point3", "normal3"):
        return (number_for({**member, "type": "number"}),) * 3
    if kind == "color":
        return etendue.rgb(0.25, 0.5, 0.125)
    if kind == "transform":
        return etendue.translate(1, 2, 3) @ etendue.scale(2)
    assert kind == "component", kind
    return part_for(member["class"])


def part_for(interface):
    made = [c for c in CONCRETE if issubclass(c, getattr(etendue, interface))]
    # One that needs nothing, so that it can be written and read again.
    simple = [c for c in made if not any(m.get("required") for m in c._description["members"])]
    return (simple or made)[0]()


def value_for(member):
    return [one(member)] * 3 if member.get("list") else one(member)


def same(given, read):
    if isinstance(given, etendue.Part):
        return given is read
    if isinstance(given, (list, tuple)):
        return len(given) == len(read) and all(same(a, b) for a, b in zip(given, read))
    if isinstance(given, (int, float)) and not isinstance(given, bool):
        if isinstance(read, etendue.Part):
            return True
        return bool(numpy.allclose(read, given, rtol=1e-6))
    return given == read if not isinstance(read, str) or not isinstance(given, str) else read.endswith(given)


def made_with_required(cls):
    return cls(**{m["name"]: value_for(m) for m in cls._description["members"] if m.get("required")})


@pytest.mark.parametrize("cls", CONCRETE, ids=lambda c: c.__name__)
def test_members_are_set_read_written_and_loaded_equal(cls):
    part = made_with_required(cls)
    for member in cls._description["members"]:
        given = value_for(member)
        setattr(part, member["name"], given)
        assert same(given, getattr(part, member["name"])), member["name"]
        if member["type"] == "number" and not member.get("list") and member.get("unit", "1") not in ("", "1"):
            try:
                setattr(part, member["name"], f"{given!r} {member['unit']}")
            except etendue.Error as e:  # units of the manual that the language does not have, such as W/(m^2 sr nm)
                assert "cannot be read" in str(e)
            assert same(given, getattr(part, member["name"])), member["name"]
    for other in (
        etendue.loads(etendue.dumps(part)),
        etendue.loads(etendue.dumps(part, all=True)),
        etendue.from_dict(json.loads(json.dumps(etendue.to_dict(part)))),
        etendue.copy(part),
    ):
        assert etendue.equal(part, other)


@pytest.mark.parametrize("cls", CONCRETE, ids=lambda c: c.__name__)
def test_what_is_wrong_is_refused_by_name(cls):
    part = made_with_required(cls)
    for member in cls._description["members"]:
        name, kind = member["name"], member["type"]
        wrong = [object(), {"a": 1}, {1, 2}, b"abc"]
        low, high, open_low = bounds(member)
        if kind in ("number", "integer") and not member.get("list"):
            wrong += [float("nan"), [1, 2, 3], True]
            if low is not None:
                wrong.append(low - 1)
            if high is not None:
                wrong.append(1.001 * high + 1)  # limits are compared as floats
            if open_low:
                wrong.append(low)
        if kind == "integer":
            wrong.append(0.5)
        if kind == "choice":
            wrong.append("no such choice")
        if kind == "component":
            wrong.append(etendue.Sphere() if member["class"] != "SceneObject" else etendue.SobolSampler())
        before = getattr(part, name)
        for value in wrong:
            with pytest.raises(etendue.Error) as caught:
                setattr(part, name, value)
            assert f"{cls.__name__}.{name}" in str(caught.value)
        after = getattr(part, name)
        assert after is before or repr(after) == repr(before)
    with pytest.raises(etendue.Error, match="no_such_member"):
        part.no_such_member = 1
    with pytest.raises(AttributeError):
        part.no_such_member


@pytest.mark.parametrize("cls", etendue.classes(), ids=lambda c: c.__name__)
def test_documentation_comes_from_the_description(cls):
    import inspect

    text = cls.__doc__
    assert cls._description["summary"] in text
    names = list(inspect.signature(cls).parameters)
    for member in cls._description["members"]:
        assert member["text"] in text
        assert member["name"] in names or member["name"] + "_" in names
