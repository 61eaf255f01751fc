"""What members accept and give: numbers with units, arrays, texts, parts, paths, and what is refused."""

import copy
import gc
import os
import pickle

import numpy
import pytest

import etendue

SCENES = os.path.join(os.path.dirname(__file__), "..", "..", "scenes")


def mesh(**more):
    return etendue.TriangleMesh(positions=[[0, 0, 0], [1, 0, 0], [0, 1, 0]], triangles=[[0, 1, 2]], **more)


def test_numbers_units_and_shortest_text():
    assert etendue.Sphere(radius="30 cm").radius == 0.3
    assert etendue.Sphere(radius=numpy.float32(0.3)).radius == 0.3
    assert etendue.Sphere(radius=numpy.array(2)).radius == 2
    assert etendue.Sphere(centre="[1, 2, 3] cm").centre == (0.01, 0.02, 0.03)
    assert isinstance(etendue.PathTracer(samples=numpy.int64(7)).samples, int)


@pytest.mark.parametrize(
    "members, words",
    [
        ({"radus": 1}, "did you mean 'radius'"),
        ({"radius": -1}, "more than 0 m"),
        ({"radius": float("nan")}, "finite"),
        ({"radius": "3 s"}, "length"),
        ({"radius": "3 kg"}, "unknown unit"),
        ({"priority": 0.5}, "whole number"),
        ({"radius": [1, 2]}, "expects a number"),
        ({"radius": object()}, "Python's class object"),
        ({"radius": numpy.array([1j])}, "complex"),
        ({"centre": (1, 2)}, "3 numbers"),
        ({"centre": numpy.zeros((2, 5))}, "shape"),
        ({"shader": 3}, "Shader"),
        ({"transform": numpy.ones((2, 2))}, "(4, 4)"),
        ({"transform": numpy.zeros((4, 4))}, "affine"),
        ({"transform": [[0, 0, 0, 0]] * 3}, "singular"),
        ({"sides": "bothe"}, "did you mean 'both'"),
    ],
)
def test_what_is_wrong_is_an_error_with_the_line(members, words):
    with pytest.raises(etendue.Error) as caught:
        etendue.Sphere(**members)
    assert words in str(caught.value)
    fault = caught.value.faults[0]
    assert fault.file == __file__ and fault.line > 0


def test_limits_of_integers_are_exact():
    limit = 1 << 30
    assert etendue.PathTracer(samples=limit).samples == limit
    with pytest.raises(etendue.Error, match="1073741825"):
        etendue.PathTracer(samples=limit + 1)


def test_a_number_that_raises_keeps_its_exception():
    class Bad:
        def __float__(self):
            raise ZeroDivisionError("no number")

    with pytest.raises(ZeroDivisionError):
        etendue.Sphere(radius=Bad())


def test_a_refused_value_changes_nothing():
    s = etendue.Sphere(radius=2)
    with pytest.raises(etendue.Error):
        s.radius = -1
    assert s.radius == 2
    m = mesh()
    view = m.positions
    with pytest.raises(etendue.Error):
        m.positions = [[0, 0, float("inf")]]
    assert m.positions.tolist() == view.tolist()


def test_lists_of_numbers_share_the_component_s_memory():
    m = mesh()
    a, b = m.positions, m.positions
    assert a.shape == (3, 3) and a.dtype in (numpy.float32, numpy.float64)
    assert a.__array_interface__["data"][0] == b.__array_interface__["data"][0]
    with pytest.raises(ValueError):
        a[0, 0] = 5  # the member would not know of it


def test_arrays_outlive_the_list_they_view():
    m = mesh()
    old = m.positions
    before = old.tolist()
    m.positions = old + 1
    assert old.tolist() == before
    assert m.positions.tolist() == (numpy.array(before) + 1).tolist()
    new = m.positions
    del m
    gc.collect()
    assert new.tolist() == (numpy.array(before) + 1).tolist()


@pytest.mark.parametrize("make", [
    lambda a: a[::-1],
    lambda a: a.astype("float64")[:, :],
    lambda a: numpy.asfortranarray(a),
    lambda a: numpy.broadcast_to(a[0], (3, 3)),
    lambda a: a.astype("int16"),
    lambda a: a.tolist(),
    lambda a: tuple(map(tuple, a)),
])
def test_any_strides_and_types_are_read(make):
    a = numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], dtype=numpy.float32)
    a.flags.writeable = False
    m = etendue.TriangleMesh(positions=make(a), triangles=[[0, 1, 2]])
    assert numpy.array_equal(m.positions, numpy.asarray(make(a), dtype=float))


def test_empty_arrays_are_empty_lists():
    assert len(etendue.TriangleMesh(positions=numpy.zeros((0, 3))).positions) == 0


def test_transforms():
    t = etendue.translate(1, 2, 3)
    s = etendue.Sphere(transform=t.matrix)
    assert numpy.array_equal(s.transform.matrix, t.matrix)
    assert etendue.Sphere(transform="translate(1, 2, 3)").transform == t
    assert numpy.allclose((t @ etendue.scale(2)).matrix, t.matrix @ etendue.scale(2).matrix)


def test_identity_of_parts():
    shader = etendue.Lambertian(color=0.5)
    s = etendue.Sphere(shader=shader)
    assert s.shader is shader
    again = etendue.loads(etendue.dumps(s))
    assert again.shader is again.shader and etendue.equal(s, again)


def test_json_of_a_part_keeps_what_is_shared():
    shader = etendue.Lambertian(color=etendue.rgb(0.1, 0.2, 0.3))
    scene = etendue.BvhScene(objects=[etendue.Sphere(shader=shader), etendue.Sphere(radius=2, shader=shader)])
    again = etendue.loads(etendue.dumps(scene, format="json"), name="scene.json")
    assert etendue.equal(scene, again) and again.objects[0].shader is again.objects[1].shader


def test_lists_of_parts_are_alive():
    scene = etendue.BvhScene()
    scene.objects.append(etendue.Sphere())
    scene.objects += [etendue.Sphere(radius=2)]
    assert [o.radius for o in scene.objects] == [1, 2]
    scene.objects[0] = etendue.Sphere(radius=3)
    del scene.objects[1]
    assert [o.radius for o in scene.objects] == [3]
    with pytest.raises(etendue.Error):
        scene.objects.append(etendue.Lambertian())
    assert len(scene.objects) == 1


def test_paths():
    job = etendue.load(os.path.join(SCENES, "cornell_box.etd"))
    assert job["scene.objects[2].shader"] is job.scene.objects[2].shader
    job["renderer.samples"] = 3
    job["scene.objects[2]"] = etendue.Sphere(radius="1 cm")
    assert job.renderer.samples == 3 and job.scene.objects[2].radius == 0.01
    for path, words in [("renderer.sampels", "samples"), ("scene.objects[99]", "has no entry [99]"), ("a b", "no path")]:
        with pytest.raises(etendue.Error, match=words.replace("[", r"\[").replace("]", r"\]")):
            job[path]
    paths = dict(etendue.walk(job))
    assert all(job[path] is part for path, part in paths.items() if path)


def test_copies_and_pickles():
    job = etendue.load(os.path.join(SCENES, "cornell_box.etd"))
    for other in (copy.deepcopy(job), etendue.copy(job), pickle.loads(pickle.dumps(job))):
        assert etendue.equal(job, other) and other is not job
    other.renderer.samples += 1
    assert not etendue.equal(job, other)


def test_words_of_python_are_written_with_an_underscore():
    names = [m for c in etendue.classes() for m in c._description["members"]]
    assert any(m["name"] == "from" for m in names)
    cls = next(c for c in etendue.classes() if not c._description["abstract"] and any(
        m["name"] == "from" for m in c._description["members"]))
    default = getattr(cls(), "from_")
    assert etendue.equal(cls(**{"from": default}), cls(from_=default))


def test_unknown_names():
    with pytest.raises(AttributeError, match="did you mean 'Sphere'"):
        etendue.Spere
    assert not hasattr(etendue.Sphere(), "radus")
    assert "Sphere" in dir(etendue) and "radius" in dir(etendue.Sphere)


def test_warnings_are_python_s():
    with pytest.warns(etendue.Warning):
        etendue.loads(open(os.path.join(SCENES, "cornell_box.etd")).read() + "\nnobody_asks = 3\n", folder=SCENES)


def test_functions_of_the_language():
    assert repr(etendue.rgb(0.1, 0.2, 0.3)) == "rgb(0.1, 0.2, 0.3)"
    with pytest.raises(etendue.Error, match="rgb"):
        etendue.rgb(1)
    assert etendue.sqrt(2) == pytest.approx(2**0.5)


def test_functions_take_quantities_as_texts():
    assert repr(etendue.rotate("20 deg", "x")) == repr(etendue.rotate(20, "x"))
    assert repr(etendue.translate("10 cm", 0, 0)) == repr(etendue.translate(0.1, 0, 0))
    with pytest.raises(etendue.Error):
        etendue.rotate("20 m", "x")
