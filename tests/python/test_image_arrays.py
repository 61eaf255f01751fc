"""Arrays as the images of maps, and as the cells of grids: what they are in a picture, in files, in copies, and what is refused."""

import json
import pickle

import numpy
import pytest

import etendue
from etendue._parts import SentJob

RANDOM = numpy.random.default_rng(4)
FLOATS = RANDOM.random((5, 7, 3)).astype("f4")


def texel_centres(height, width):
    """Coordinates of the middles of an image's texels, row by row from the top."""
    y, x = numpy.mgrid[0:height, 0:width]
    return (x.ravel() + 0.5) / width, 1 - (y.ravel() + 0.5) / height


def looked_up(image_map, height, width):
    return numpy.asarray(image_map.scalar(numpy.stack(texel_centres(height, width), 1))).reshape(height, width)


def linear(encoded):
    """The inverse of sRGB's transfer function (IEC 61966-2-1)."""
    return numpy.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


@pytest.mark.parametrize("dtype", ["f2", "f4", "f8", ">f4", "?"])
@pytest.mark.parametrize("channels", [None, 1, 2, 3, 4])
def test_every_shape_and_type_of_floats_is_looked_up(dtype, channels):
    shape = (5, 7) if channels is None else (5, 7, channels)
    image = (RANDOM.random(shape) > 0.5 if dtype == "?" else RANDOM.random(shape)).astype(dtype)
    found = looked_up(etendue.ImageMap(values=image), 5, 7)
    expected = image.astype("f8").reshape(5, 7, -1)
    expected = expected[:, :, 0] if expected.shape[2] < 3 else expected[:, :, :3].mean(2)
    numpy.testing.assert_allclose(found, expected, atol=1e-6)


@pytest.mark.parametrize("dtype, largest", [("u1", 255), ("u2", 65535), (">u2", 65535)])
def test_integers_are_decoded_as_those_of_files(dtype, largest):
    image = RANDOM.integers(0, largest, (4, 6), endpoint=True).astype(dtype)
    made = etendue.ImageMap(values=image)
    assert made.number_type == f"uint{8 if largest == 255 else 16}" and made.transfer == "auto"
    numpy.testing.assert_allclose(looked_up(made, 4, 6), linear(image / largest), atol=1e-6)
    made = etendue.ImageMap(transfer="linear", values=image)
    numpy.testing.assert_allclose(looked_up(made, 4, 6), image / largest, atol=1e-6)
    # Floats that follow are linear again.
    made.values = image.astype("f4")[:2]
    assert made.number_type == "float" and list(made.resolution) == [6, 2]


@pytest.mark.parametrize(
    "view",
    [
        FLOATS[::-1, ::2],
        FLOATS[:, ::-1, ::-1],
        FLOATS.transpose(1, 0, 2),
        numpy.asfortranarray(FLOATS),
        numpy.broadcast_to(FLOATS[:1, :1], (3, 4, 3)),
        FLOATS[1:4, 2:3],
    ],
)
def test_any_strides_and_arrays_that_cannot_be_written_to(view):
    view = view[...]
    view.flags.writeable = False
    height, width, _ = view.shape
    found = looked_up(etendue.ImageMap(values=view), height, width)
    numpy.testing.assert_allclose(found, view.mean(2), atol=1e-6)


def test_the_array_is_copied_once_it_is_given():
    image = FLOATS.copy()
    made = etendue.ImageMap(values=image)
    image[:] = 0
    assert looked_up(made, 5, 7).min() > 0
    assert numpy.array_equal(made.values.reshape(5, 7, 3), FLOATS)  # a view of the map's own list


def test_channels_by_name():
    image = RANDOM.random((3, 4, 4)).astype("f4")
    for place, name in enumerate("RGBA"):
        numpy.testing.assert_allclose(looked_up(etendue.ImageMap(values=image, channel=name), 3, 4), image[:, :, place], atol=1e-6)
    with pytest.raises(etendue.Error, match="no channel 'Z', but 'R', 'G', 'B', 'A'"):
        looked_up(etendue.ImageMap(values=image, channel="Z"), 3, 4)


def test_an_array_stands_for_a_map():
    shader = etendue.Lambertian(color=FLOATS)
    assert type(shader.color) is etendue.ImageMap and list(shader.color.resolution) == [7, 5]
    shader.color = numpy.full((2, 2), 128, "u1")
    assert shader.color.number_type == "uint8"
    job = etendue.Job(scene=etendue.BvhScene(objects=[etendue.Sphere(shader=shader)]))
    job["scene.objects[0].shader.color"] = FLOATS[:2]
    job["scene.objects[0].shader.color.values"] = FLOATS[:3]
    assert list(shader.color.resolution) == [7, 3]


@pytest.mark.parametrize(
    "value, words",
    [
        (numpy.zeros((2, 2, 5)), "not (2, 2, 5)"),
        (numpy.zeros((2, 2, 3, 1)), "shape (height, width)"),
        (numpy.zeros((0, 4)), "empty"),
        (numpy.zeros((2, 2, 0)), "not (2, 2, 0)"),
        (numpy.zeros((2, 2), "i8"), "floats, uint8 or uint16, not of int64"),
        (numpy.zeros((2, 2), "u4"), "uint32"),
        (numpy.zeros((2, 2), complex), "complex128"),
        (numpy.full((2, 2), "x"), "ImageMap.values"),
        (numpy.zeros((2, 2), "M8[s]"), "datetime64"),
    ],
)
def test_what_is_no_image_is_refused_and_nothing_changes(value, words):
    made = etendue.ImageMap(values=FLOATS)
    with pytest.raises(etendue.Error) as caught:
        made.values = value
    assert words in str(caught.value) and caught.value.faults[0].file == __file__
    assert list(made.resolution) == [7, 5] and made.values.size == FLOATS.size


@pytest.mark.parametrize(
    "members, words",
    [
        ({}, "an image file is needed, or `resolution` and `values`"),
        ({"values": numpy.array([[0.5, numpy.nan]])}, "entry 1: must be a finite number"),
        ({"values": numpy.array([[1e300, 0]])}, "entry 0: must be at most"),
        ({"resolution": [2, 2], "values": [1.0] * 5}, "5 numbers for an image of 2 x 2"),
        ({"resolution": [2, 1], "values": [1, 300], "number_type": "uint8"}, "place 1 is 300"),
        ({"resolution": [2, 1], "values": [1, 0.5], "number_type": "uint8"}, "integers from 0 to 255"),
        ({"resolution": [2], "values": [1, 0.5]}, "width and the height"),
    ],
)
def test_what_does_not_fit_is_an_error_when_it_is_prepared(members, words):
    with pytest.raises(etendue.Error, match=words):
        looked_up(etendue.ImageMap(**members), 1, 1)


def box(image):
    """A textured square that fills the picture, lit evenly."""
    return etendue.Job(
        renderer=etendue.PathTracer(samples=4, max_depth=2),
        camera=etendue.PerspectiveCamera(from_=(0, 0, 2), to=(0, 0, 0), fov=50),
        image=etendue.ImageBuffer(width=28, height=28),
        scene=etendue.BvhScene(
            objects=[
                etendue.Rectangle(corner=(-1, -1, 0), edge_u=(2, 0, 0), edge_v=(0, 2, 0), shader=etendue.Lambertian(color=image)),
                etendue.Environment(emission=etendue.EnvironmentEmission(radiance=1)),
            ]
        ),
    )


def rendered(job):
    return etendue.render(job, progress=False).pixels


def test_files_copies_texts_and_dicts_are_the_same_picture(tmp_path):
    job = box((FLOATS * 255).astype("u1"))
    expected = rendered(job)
    etendue.save(job, tmp_path / "job.etd")
    etendue.save(job, tmp_path / "job.json")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["job.etd", "job.json"]
    for other in (
        etendue.load(tmp_path / "job.etd"),
        etendue.load(tmp_path / "job.json"),
        etendue.loads(etendue.dumps(job)),
        etendue.copy(job),
        pickle.loads(pickle.dumps(job)),
        pickle.loads(pickle.dumps(SentJob.of(job, None, ()))).job(),  # to another machine
        etendue.from_dict(etendue.to_dict(job)),
        etendue.from_dict(json.loads(json.dumps(etendue.to_dict(job)))),
    ):
        assert etendue.equal(job, other)
        assert numpy.array_equal(rendered(other), expected)


def test_an_array_is_the_picture_of_its_file(tmp_path):
    image = (FLOATS * 255).astype("u1")
    etendue.Image.from_array(linear(image / 255.0), color_space="srgb").save(tmp_path / "image.exr")
    from_file = rendered(box(etendue.ImageMap(file=tmp_path / "image.exr")))
    numpy.testing.assert_allclose(rendered(box(image)), from_file, rtol=2e-3, atol=1e-5)  # the file holds halves


@pytest.mark.parametrize("ending", ["xml", "pbrt", "gltf", "glb"])
@pytest.mark.filterwarnings("ignore::etendue.Warning")
def test_other_programs_get_a_file(tmp_path, ending):
    job = box((FLOATS * 255).astype("u1"))
    job.scene.objects[0].shader.color.interpolation = "nearest"
    etendue.save(job, tmp_path / f"job.{ending}")
    beside = [p for p in tmp_path.iterdir() if p.suffix in (".pfm", ".png")]
    assert len(beside) == (0 if ending == "glb" else 1)
    again = etendue.load(tmp_path / f"job.{ending}")
    images = [part for _, part in etendue.walk(again) if isinstance(part, etendue.ImageMap)]
    assert images, "no image in what was written"
    found = looked_up(images[0], 5, 7)
    expected = linear((FLOATS * 255).astype("u1") / 255.0).mean(2)
    assert numpy.allclose(found, expected, atol=2e-3) or numpy.allclose(found[::-1], expected, atol=2e-3)


def test_a_render_is_edited_by_an_array():
    job = box(numpy.full((2, 2), 0.25))
    with etendue.Render(job, warn=False) as render:
        render.run(samples=1, progress=False)
        dark = render.snapshot().pixels[14, 14, 1]
        job["scene.objects[0].shader.color"].values = numpy.full((3, 3), 0.75)
        render.run(samples=1, progress=False)
        assert render.snapshot().pixels[14, 14, 1] == pytest.approx(3 * dark, rel=1e-4)
        render.edit([(job["scene.objects[0].shader.color"], "values", numpy.full((1, 4, 3), 0.5))])
        render.run(samples=1, progress=False)
        assert render.snapshot().pixels[14, 14, 1] == pytest.approx(2 * dark, rel=1e-4)


def test_grids_take_their_resolution_from_the_array():
    cells = RANDOM.random((2, 3, 4))
    assert list(etendue.GridMap(values=cells).resolution) == [4, 3, 2]
    assert list(etendue.GridVolume(density=cells).resolution) == [4, 3, 2]
    assert numpy.allclose(etendue.GridMap(values=cells).values.reshape(2, 3, 4), cells)
    colored = etendue.GridMap(values=RANDOM.random((2, 3, 4, 3)))
    etendue.GridMap(values=numpy.ones((2, 2, 2), "i8"))
    assert colored.values.size == 72
    with pytest.raises(etendue.Error, match="a grid: an array of shape"):
        etendue.GridMap(values=numpy.zeros((4, 4)))
    distances = etendue.SignedDistanceGrid(distances=RANDOM.random((5, 6, 7)))
    assert list(distances.resolution) == [7, 6, 5]
