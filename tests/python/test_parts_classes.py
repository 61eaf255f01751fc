"""Classes written in Python are classes of the library: members, the language, copies, files, errors in their definition."""

import copy
import json
import pathlib
import pickle
from typing import ClassVar, Literal, Optional

import pytest

import etendue
from etendue import member


class Everything(etendue.ObjectMap):
    """A member of each kind.

    More text, which is no part of the summary.

    Source: nobody 1900, A paper
    """

    number: float = member("30 cm", unit="m", range=(0, 2), text="a length")
    whole: int = member(3, range=(1, 9), text="a count")
    truth: bool = member(True, text="whether")
    words: str = member("so", text="a text")
    kind: Literal["round", "square"] = member("square", text="a choice")
    paint: etendue.Color = member("rgb(0.5, 0.2, 0.1)", text="a colour")
    place: etendue.Transform = member(text="where")
    pair: etendue.Vector2 = member((1, 2), text="two numbers")
    corner: etendue.Point3 = member((1, 2, 3), unit="m", text="a point")
    inner: etendue.ObjectMap = member(0.25, text="another map")
    maybe: Optional[etendue.Shader] = member(text="a shader or none")
    picture: pathlib.Path = member(text="a file")
    values: list[float] = member([1, 2, 3], unit="1", text="numbers")
    parts: list[etendue.ObjectMap] = member(text="more maps")
    listed: ClassVar[int] = 7

    def scalar(self, point):
        return self.number


def test_members_have_their_defaults_and_are_checked():
    part = Everything()
    assert part.number == pytest.approx(0.3)
    assert (part.whole, part.truth, part.words, part.kind) == (3, True, "so", "square")
    assert part.pair == (1, 2) and part.corner == (1, 2, 3)
    assert isinstance(part.inner, etendue.ConstantMap) and part.maybe is None and len(part.parts) == 0
    assert list(part.values) == [1, 2, 3]
    part.number = "70 cm"
    assert part.number == pytest.approx(0.7)
    for name, value in (("number", 3), ("number", "1 s"), ("whole", 0.5), ("kind", "oval"), ("inner", etendue.PngOutput())):
        with pytest.raises(etendue.Error, match=f"Everything.{name}"):
            setattr(part, name, value)
    with pytest.raises(etendue.Error, match="round, square"):
        part.kind = "oval"


def test_objects_do_not_share_their_parts():
    a, b = Everything(), Everything()
    a.inner.value = 0.75
    assert etendue.dumps(b) == "Everything {}\n"
    assert a.inner is not b.inner and a.inner is a.inner


def test_the_language_knows_the_class():
    part = etendue.loads("Everything { number: 50 cm, kind: round, parts: [ConstantMap { value: 1 }, Everything {}] }")
    assert type(part) is Everything
    assert part.number == pytest.approx(0.5) and type(part.parts[1]) is Everything
    assert etendue.equal(part, etendue.loads(etendue.dumps(part)))
    with pytest.raises(etendue.Error, match="did you mean 'number'"):
        etendue.loads("Everything { nummer: 1 }")
    shader = etendue.Lambertian(color=part)
    assert shader.color is part
    assert type(etendue.copy(shader).color) is Everything and etendue.copy(shader).color is not part


def test_copies_and_pickles_are_equal():
    part = Everything(number=1, parts=[0.5, Everything()], paint="rgb(0, 1, 0)")
    for other in (etendue.copy(part), copy.deepcopy(part), pickle.loads(pickle.dumps(part))):
        assert type(other) is Everything and other is not part and etendue.equal(part, other)


def test_the_description_is_that_of_the_class():
    described = Everything._description
    assert described["summary"] == "A member of each kind." and described["source"] == "nobody 1900, A paper"
    assert described["parent"] == "ObjectMap"
    names = [m["name"] for m in described["members"]]
    assert names[0] == "number" and "listed" not in names
    assert etendue.Everything is Everything
    assert Everything in etendue.classes(etendue.ObjectMap)
    schema = etendue._core.json_schema()
    assert "Everything" in schema and json.loads(schema)
    assert "a length" in Everything.number.__doc__ and "Everything(" in repr(Everything(number=1))


def test_private_attributes_are_the_objects_own():
    part = Everything()
    part._cache = {1: 2}
    assert part._cache == {1: 2}
    with pytest.raises(AttributeError, match="self._cash"):
        part.cash = 1
    with pytest.raises(AttributeError, match="Everything"):
        part.cash


def test_classes_derive_from_each_other():
    class Base(etendue.ObjectMap, abstract=True):
        """What some maps have in common."""

        level: float = member(0.5, range=(0, 1), text="the value")

    class Upper(Base):
        """The value."""

        factor: float = member(1, text="a factor")

        def scalar(self, point):
            return self.level * self.factor

    assert [m["name"] for m in Upper._description["members"]] == ["level", "factor"]
    assert isinstance(etendue.loads("Upper { level: 0.25 }"), Base)
    with pytest.raises(etendue.Error, match="interface"):
        Base()


def test_a_class_that_is_defined_again_replaces_the_first():
    def make(default):
        class Again(etendue.ObjectMap):
            """A map."""

            level: float = member(default, text="the value")

            def scalar(self, point):
                return self.level

        return Again

    first = make(0.25)
    old = first(level=0.5)
    second = make(0.75)
    assert etendue.loads("Again {}").level == 0.75
    assert type(etendue.loads("Again {}")) is second and etendue.Again is second
    assert old.level == 0.5 and type(etendue.copy(old)) is first and first().level == 0.25


def test_init_may_be_the_classes_own():
    class Counted(etendue.ObjectMap):
        """A map."""

        level: float = member(0.5, text="the value")

        def __init__(self, **members):
            super().__init__(**members)
            self._calls = 0

        def scalar(self, point):
            self._calls += 1
            return self.level

    assert etendue.loads("Counted { level: 0.25 }")._calls == 0
    with pytest.raises(etendue.Error, match=r"Needy cannot be used: Needy.__init__ raised TypeError"):

        class Needy(etendue.ObjectMap):
            """A map."""

            def __init__(self, size):
                super().__init__()

            def scalar(self, point):
                return 1


def test_help_says_which_methods_a_class_needs():
    assert "(needed)" in etendue.Shader.__doc__ and "(one of these is needed)" in etendue.ObjectMap.__doc__
    for interface in etendue._core.part_interfaces():
        doc = getattr(etendue, interface["name"]).__doc__
        assert all(f"{name}({arguments}): " in doc for name, arguments in interface["methods"].items())


def scalar(self, point):
    return 1


def refused(match, /, base=etendue.ObjectMap, **namespace):
    namespace.setdefault("__doc__", "A map.")
    namespace.setdefault("scalar", scalar)
    with pytest.raises(etendue.Error, match=match):
        type(base)("Refused", (base,), {"__module__": __name__, **namespace})
    with pytest.raises(etendue.Error, match="no class"):
        etendue.loads("Refused {}")


def test_faults_of_a_definition_are_told():
    refused("Refused: needs a docstring", __doc__="")
    refused(r"Refused.x: a member needs an annotation", x=member(1, text="x"))
    refused(r"Refused.x: needs a default, or required", x=member(text="x"), __annotations__={"x": float})
    refused(r"Refused.*x.*is not documented", x=member(1, text=""), __annotations__={"x": float})
    refused(r"Refused.x: its default .*at least 2", x=member(1, text="x", range=(2, None)), __annotations__={"x": float})
    refused(r"Refused.x: its default", x=member("1 s", unit="m", text="x"), __annotations__={"x": float})
    refused(r"Refused.x: cannot be dict", x=member(1, text="x"), __annotations__={"x": dict})
    refused(r"Refused.x: members are declared by", x=3, __annotations__={"x": float})
    refused(r"Refused._x: the name of a member", _x=member(1, text="x"), __annotations__={"_x": float})
    for name in ("fail", "color"):
        refused(rf"Refused.{name}: a member cannot have the name", **{name: member(1, text="x"), "__annotations__": {name: float}})
    refused(r"Refused: a class of ObjectMap defines scalar\(self, point\) or rgb", scalar=None)
    refused(r"is 'scaler' meant to be 'scalar'", scalar=None, scaler=lambda self, point: 1)
    refused(r"Refused.scalar\(self\): is called with the arguments \(self, point\)", scalar=lambda self: 1)
    refused(r"Refused: a class that is written in Python derives from an interface", base=etendue.Sphere)
    refused(r"Refused.x: its annotation 'nothing' cannot be read", x=member(1, text="x"), __annotations__={"x": "nothing"})
    with pytest.raises(etendue.Error, match="Sphere: the library has a class of this name"):
        type(etendue.ObjectMap)("Sphere", (etendue.ObjectMap,), {"__doc__": "A map.", "scalar": scalar, "__module__": __name__})


def test_required_members_must_be_given():
    class Demanding(etendue.ObjectMap):
        """A map."""

        level: float = member(text="the value", range=(1, 2), required=True)

        def scalar(self, point):
            return self.level

    assert etendue.loads("Demanding { level: 1.5 }").level == 1.5
    with pytest.raises(etendue.Error, match="level"):
        etendue.loads("Demanding {}")


def test_plugins_of_python_are_loaded(tmp_path):
    file = tmp_path / "dots.py"
    file.write_text(
        '"""Dots."""\nimport etendue\n\n\nclass Dots(etendue.ObjectMap):\n    """Dots."""\n\n'
        "    def scalar(self, point):\n        return 0.5\n"
    )
    etendue.load_plugin(file)
    assert type(etendue.loads("Dots {}")).__name__ == "Dots"
    etendue.load_plugin(file)
    assert any(p.endswith("dots.py") for p in etendue._core.plugins())
    again = etendue.loads(f'plugin "{file}"\nJob {{ camera: PerspectiveCamera {{}}, scene: BvhScene {{ objects: [Sphere {{ '
                          "shader: Lambertian { color: Dots {} } }] } }")
    assert type(again["scene.objects[0].shader.color"]) is etendue.Dots
    bad = tmp_path / "bad.py"
    bad.write_text("import etendue\n\nx = 1 / 0\n")
    with pytest.raises(etendue.Error, match=r"plugin '.*bad.py': it raised ZeroDivisionError") as raised:
        etendue.load_plugin(bad)
    assert isinstance(raised.value.__cause__, ZeroDivisionError)
    assert raised.value.faults[0].line == 3 and raised.value.faults[0].file.endswith("bad.py")
    bad.write_text("def broken(:\n")
    with pytest.raises(etendue.Error, match="SyntaxError"):
        etendue.load_plugin(bad)
