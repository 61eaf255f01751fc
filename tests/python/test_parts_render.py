"""Pictures with parts that are written in Python."""

import struct

import numpy as np
import pytest
from parts_examples import ArrayTracer, Beam, Matte, Pinhole, Soft, Tent, Waves

import etendue


def box(**members):
    """A scene with a mirror, a diffuse floor and two luminaires."""
    text = """Job {
      camera: PerspectiveCamera { from: [0, 1, -4] m, to: [0, 0.5, 0] m, fov: 50 }
      image: ImageBuffer { width: 40, height: 24 }
      renderer: SimplePathTracer { samples: 8, max_depth: 5 }
      scene: BruteForceScene { objects: [
        Rectangle { corner: [-4, 0, -4] m, edge_u: [0, 0, 8] m, edge_v: [8, 0, 0] m, shader: Lambertian { color: 0.5 } }
        Sphere { centre: [-0.7, 0.5, 0] m, radius: 0.5 m, shader: PerfectSpecular {} }
        Sphere { centre: [0.7, 0.5, 0] m, radius: 0.5 m, shader: Lambertian { color: rgb(0.8, 0.3, 0.1) } }
        Sphere { centre: [0, 3, 0] m, radius: 0.3 m, emission: DiffuseEmission { radiance: 10 } }
        Environment { emission: EnvironmentEmission { radiance: 0.2 } }
      ] } }"""
    job = etendue.loads(text)
    for name, value in members.items():
        setattr(job, name, value)
    return job


def picture(job, **options):
    return np.array(etendue.render(job, **options))


def test_a_renderer_on_arrays_is_the_one_on_paths():
    # The same steps with the same numbers, so the same sums but for their order.
    paths = picture(box())
    arrays = picture(box(renderer=ArrayTracer(samples=8, max_depth=5)))
    assert paths.max() > 0.5
    np.testing.assert_allclose(arrays, paths, rtol=1e-5, atol=1e-6)


def test_pictures_do_not_depend_on_threads():
    renderer = ArrayTracer(samples=8)
    assert np.array_equal(picture(box(renderer=renderer), threads=1), picture(box(renderer=renderer), threads=2))


def test_a_crop_has_the_pixels_of_the_whole():
    whole = box(renderer=ArrayTracer(samples=8))
    part = box(renderer=ArrayTracer(samples=8))
    part.image.crop = (10, 5, 30, 20)
    assert np.array_equal(picture(part), picture(whole)[5:20, 10:30])


def test_features_of_a_renderer_on_arrays():
    layers = ["albedo", "normal", "depth"]
    paths = etendue.render(box(), layers=layers)
    arrays = etendue.render(box(renderer=ArrayTracer(samples=8)), layers=layers)
    np.testing.assert_allclose(np.array(arrays), np.array(paths), rtol=1e-5, atol=1e-6)


def test_layers_of_light_are_refused():
    job = box(renderer=ArrayTracer(samples=1))
    job.image.path_lengths = 3
    with pytest.raises(etendue.Error, match="ArrayTracer, a renderer that is written in Python"):
        picture(job)


def test_other_renderers_may_contain_it():
    job = box(renderer=etendue.AdaptiveSampling(inner=ArrayTracer(max_depth=3), samples=8))
    plain = box(renderer=etendue.AdaptiveSampling(inner=etendue.SimplePathTracer(max_depth=3), samples=8))
    np.testing.assert_allclose(picture(job), picture(plain), rtol=1e-5, atol=1e-6)


def furnace(shader):
    """Emitted radiance 1 everywhere: a grey of 1/2 has the radiance 1 / (1 - 1/2)."""
    return etendue.Job(
        camera=etendue.loads("PerspectiveCamera { from: [0.3, 0.1, 0.2] m, to: [0, 0, 1] m, fov: 90 }"),
        image=etendue.ImageBuffer(width=8, height=8),
        renderer=etendue.PathTracer(samples=32, max_depth=40),
        scene=etendue.BruteForceScene(
            objects=[etendue.Sphere(shader=shader, emission=etendue.DiffuseEmission(radiance=1, sides="back"))]
        ),
    )


def test_a_shader_is_the_librarys():
    # The same formulas with the same numbers; the mean is the known value, with a standard error of 0.3 %.
    made = picture(furnace(Matte()))
    np.testing.assert_allclose(made, picture(furnace(etendue.Lambertian(color=0.5))), rtol=1e-4)
    assert made[..., 1].mean() == pytest.approx(2, rel=0.02)
    np.testing.assert_allclose(picture(furnace(Matte(color=Waves(contrast=0)))), made, rtol=1e-4)


def test_an_emission_of_a_constant_is_the_librarys():
    def lit(emission):
        job = box()
        job["scene.objects[3].emission"] = emission
        return picture(job, renderer=etendue.SimplePathTracer(samples=4))

    np.testing.assert_allclose(lit(Beam(strength=10, exponent=0)), lit(etendue.DiffuseEmission(radiance=10)), rtol=1e-5)


def test_a_camera_sees_what_the_librarys_sees():
    job = box(camera=etendue.loads("PerspectiveCamera { from: [0, 1, -4] m, to: [0, 1, 0] m, fov: 50 }"))
    job.renderer.samples = 64
    mine = box(camera=Pinhole(position=(0, 1, -4), fov=50))
    mine.renderer.samples = 64
    a, b = picture(job)[..., 1], picture(mine)[..., 1]
    np.testing.assert_allclose(a, b, rtol=1e-3, atol=1e-3)


def test_a_filter_is_the_librarys():
    job, mine = box(), box()
    job.image.filter = etendue.TriangleFilter(radius=1)
    mine.image.filter = Tent(width=1)
    np.testing.assert_allclose(picture(job), picture(mine), rtol=1e-4, atol=1e-6)


def test_a_tone_map_gets_the_whole_picture():
    made = etendue.render(box(), samples=1)
    shown = made.to_uint8(Soft())
    y = made.xyz()[..., 1]
    bright = np.unravel_index(np.argmax(y), y.shape)
    assert shown.shape == (24, 40, 3) and shown.max() <= 255
    expected = y[bright] / (1 + y[bright])
    encoded = 255 * (1.055 * expected ** (1 / 2.4) - 0.055)
    assert shown[bright].mean() == pytest.approx(encoded, abs=12)


class Floats(etendue.Output):
    """Portable float maps."""

    extension = ".pfm"

    def encode(self, pixels, channels, metadata):
        assert channels[:3] == ("X", "Y", "Z") and "samples" in metadata
        rows = pixels[::-1, :, :3].astype("<f4")
        return b"PF\n%d %d\n-1.0\n" % (pixels.shape[1], pixels.shape[0]) + rows.tobytes()


def test_an_output_writes_what_python_encodes(tmp_path):
    job = box(outputs=[Floats(file=str(tmp_path / "a.pfm"))])
    job.renderer.samples = 1
    made = np.array(etendue.render(job, outputs=True))
    data = (tmp_path / "a.pfm").read_bytes()
    assert data.startswith(b"PF\n40 24\n")
    values = np.array(struct.unpack(f"<{40 * 24 * 3}f", data[-40 * 24 * 12 :])).reshape(24, 40, 3)[::-1]
    np.testing.assert_allclose(values, made[..., :3], rtol=1e-6)


class Balls(etendue.Importer):
    """Files of balls: a line has a centre and a radius."""

    extensions = ("balls",)

    def read(self, importing):
        objects = []
        for number, line in enumerate(importing.contents().decode("ascii", "replace").splitlines(), 1):
            try:
                x, y, z, radius = map(float, line.split())
            except ValueError:
                importing.error(f"expected four numbers, not '{line}'", number, 1)
            objects.append(etendue.Sphere(centre=(x, y, z), radius=radius))
        return etendue.BvhScene(objects=objects)


def test_an_importer_reads_files(tmp_path):
    file = tmp_path / "some.balls"
    file.write_text("0 0 0 1\n2 0 0 0.5\n")
    job = etendue.load(file)
    radii = [part.radius for _, part in etendue.walk(job) if isinstance(part, etendue.Sphere)]
    assert sorted(radii)[:2] == [0.5, 1]
    file.write_text("0 0 0 1\nnothing\n")
    with pytest.raises(etendue.Error) as raised:
        etendue.load(file)
    assert raised.value.faults[0].line == 2 and raised.value.faults[0].file.endswith("some.balls")
    assert not [o for o in etendue.conform(Balls, drawn=0) if o.result == "failed"]
