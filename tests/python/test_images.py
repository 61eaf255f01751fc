"""Pictures: memory shared with the library, layers, colours, display, files, comparison, light groups."""

import io
import pathlib
import pickle
import struct
import zlib

import numpy as np
import pytest

import etendue
from etendue import _core

LIT = """
key = Sphere { centre: [0, 3, 0] m, radius: 0.5 m, emission: DiffuseEmission { radiance: 5 } }
fill = Sphere { centre: [-3, 0, -1] m, radius: 0.5 m, emission: DiffuseEmission { radiance: 2 } }
Job {
    renderer: PathTracer { samples: 4, max_depth: 3 }
    camera: PerspectiveCamera { from: [0, 0, -5] m, to: [0, 0, 0] m, fov: 40 deg }
    image: ImageBuffer { width: 16, height: 12, filter: BoxFilter {}
        layers: ["albedo", "normal", "depth", "object", "variance", "samples", "light.key"], path_lengths: 2 }
    scene: BvhScene { objects: [Sphere { radius: 1 m, shader: Lambertian { color: rgb(0.8, 0.4, 0.2) } }, key, fill] }
}
"""


@pytest.fixture(scope="module")
def job():
    return etendue.loads(LIT)


@pytest.fixture(scope="module")
def image(job):
    return etendue.render(job)


# ---- memory -------------------------------------------------------------------------------------------------------------------


def test_pixels_are_the_library_s_memory(image):
    pixels = image.pixels
    address, read_only = pixels.__array_interface__["data"]
    assert address == image._picture.address and read_only
    assert pixels.dtype == np.float64 and pixels.shape == (12, 16, len(image.channels)) and pixels.flags.c_contiguous
    assert np.asarray(image).__array_interface__["data"][0] == address
    assert image.xyz().__array_interface__["data"][0] == address
    depth = image["depth"]
    assert depth.__array_interface__["data"][0] == address + 8 * image.channels.index("depth.Z")
    with pytest.raises(ValueError):
        pixels[0, 0, 0] = 1
    with pytest.raises(ValueError):
        pixels.flags.writeable = True


def test_pixels_outlive_the_picture(job):
    pixels = etendue.render(job).pixels
    other = [etendue.render(job, seed=n) for n in range(3)]
    assert pixels.tobytes() == etendue.render(job).pixels.tobytes() and len(other) == 3


# ---- layers -------------------------------------------------------------------------------------------------------------------


def test_layers(image):
    names = ["albedo", "normal", "depth", "object", "variance", "samples", "length_1", "length_2", "light.key", "light.rest"]
    # In the order of the file, where layers of the light come before those of surfaces.
    assert sorted(image.layers) == sorted(names)
    assert image.layer("albedo").shape == (12, 16, 3) and image["depth"].shape == (12, 16)
    assert (image["samples"] == 4).all()
    middle = image["normal"][6, 8]
    assert np.linalg.norm(middle) == pytest.approx(1, abs=1e-2) and middle[2] < -0.9
    assert image["depth"][6, 8] == pytest.approx(4, abs=0.1)
    assert (image["Y"] == image.pixels[:, :, 1]).all() and (image["albedo.R"] == image["albedo"][:, :, 0]).all()
    assert np.array_equal(image["length_2"] * 0 + image.xyz(), image.xyz())
    assert "depth" in image and "Y" in image and "nonsense" not in image
    with pytest.raises(etendue.Error, match="no layer or channel 'depht'; it has "):
        image["depht"]
    with pytest.raises(etendue.Error, match="image.pixels"):
        image[0, 0]
    assert repr(image).startswith("<etendue.Image 16 x 12, X Y Z, layers ") and "4 samples per pixel" in repr(image)


def test_metadata(image):
    assert image.metadata["samples"] == "4" and image.metadata["renderer"] == "PathTracer"
    image.metadata["samples"] = "5"
    assert image.metadata["samples"] == "4"


def test_light_groups(image):
    groups = etendue.light_groups(image)
    assert list(groups) == ["key", "rest"]
    assert np.allclose(groups["key"] + groups["rest"], image.xyz(), rtol=1e-5, atol=1e-7)
    relit = etendue.relight(image, {"key": 0})
    assert np.allclose(relit.xyz(), groups["rest"], rtol=1e-6, atol=1e-9)
    red = etendue.relight(image, {"key": 0, "rest": (2, 0, 0)})
    assert np.allclose(red.rgb()[:, :, 1:], 0, atol=1e-9)
    assert np.allclose(red.rgb()[:, :, 0], 2 * etendue.relight(image, {"key": 0}).rgb()[:, :, 0], atol=1e-9)
    assert "variance" not in relit and relit.tone_map is image.tone_map
    with pytest.raises(etendue.Error, match="no light group 'kye'; it has key, rest"):
        etendue.relight(image, {"kye": 1})
    with pytest.raises(etendue.Error, match="factor of 'key'"):
        etendue.relight(image, {"key": (1, 2)})
    plain = etendue.Image.from_array(np.ones((2, 2)))
    assert etendue.light_groups(plain) == {}
    with pytest.raises(etendue.Error, match="no light groups"):
        etendue.relight(plain, {"key": 1})


# ---- colours ------------------------------------------------------------------------------------------------------------------

# From the primaries and white points of IEC 61966-2-1 and ITU-R BT.2020, both with D65.
FROM_XYZ = {
    "srgb": [[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]],
    "rec2020": [[1.7167, -0.3557, -0.2534], [-0.6667, 1.6165, 0.0158], [0.0176, -0.0428, 0.9421]],
}


@pytest.mark.parametrize("space", FROM_XYZ)
def test_rgb(image, space):
    expected = image.xyz() @ np.array(FROM_XYZ[space]).T
    assert np.allclose(image.rgb(space), expected, atol=2e-4 * image.pixels[:, :, :3].max())


def test_color_spaces(image):
    assert (image.rgb() == image.rgb("srgb")).all() and (image.rgb("xyz") == image.xyz()).all()
    with pytest.raises(etendue.Error, match="did you mean 'rec2020'"):
        image.rgb("rec2002")
    rgb = etendue.Image.from_array(image.rgb("acescg"), color_space="acescg")
    assert np.allclose(rgb.xyz(), image.xyz(), atol=1e-9) and rgb.rgb("acescg").base is not None


# ---- arrays -------------------------------------------------------------------------------------------------------------------


def test_from_array():
    values = np.arange(24, dtype=np.float32).reshape(2, 4, 3)
    made = etendue.Image.from_array(values)
    assert made.channels == ["R", "G", "B"] and made.width == 4 and made.height == 2 and (made.pixels == values).all()
    values[:] = 0
    assert made.pixels.any(), "the picture has a copy"
    assert etendue.Image.from_array(made.pixels[::-1, ::2]).pixels[0, 1, 2] == 20, "strided arrays"
    assert (etendue.Image.from_array(np.full((2, 3), 0.5, np.float16)).pixels == 0.5).all()
    assert etendue.Image.from_array(np.ones((2, 3, 1))).channels == ["R", "G", "B"]
    assert etendue.Image.from_array(np.ones((2, 3, 3)), color_space="xyz").channels == ["X", "Y", "Z"]
    layered = etendue.Image.from_array(np.ones((2, 3, 4)), channels=["X", "Y", "Z", "depth.Z"], metadata={"note": "mine"})
    assert layered.layers == ["depth"] and layered.metadata["note"] == "mine" and layered.metadata["color_space"] == "xyz"
    display = etendue.Image.from_array(np.full((1, 1, 3), 188, np.uint8), transfer="srgb")
    assert display.pixels[0, 0, 0] == pytest.approx(0.5029, abs=1e-4) and (display.to_uint8() == 188).all()
    assert etendue.Image.from_array(np.full((1, 1), 65535, np.uint16), transfer="linear").pixels[0, 0, 0] == 1


@pytest.mark.parametrize(
    "array, options, message",
    [
        (np.zeros(3), {}, "shape"),
        (np.zeros((2, 2, 3, 1)), {}, "shape"),
        (np.zeros((0, 3, 3)), {}, "shape"),
        (np.zeros((2, 2, 2)), {}, "names of the 2 channels"),
        (np.zeros((2, 2, 3), complex), {}, "complex128"),
        (np.zeros((2, 2, 3), bool), {}, "bool"),
        (np.zeros((2, 2, 3), int), {}, "int64"),
        (np.zeros((2, 2, 3), np.uint32), {}, "8 or 16 bits"),
        ([["a", "b"]], {}, "<U1"),
        (np.zeros((2, 2, 3), np.uint8), {}, "transfer"),
        (np.zeros((2, 2, 3)), {"transfer": "nonsense"}, "no transfer 'nonsense'"),
        (np.zeros((2, 2, 3)), {"color_space": "nonsense"}, "nonsense"),
        (np.zeros((2, 2, 3)), {"channels": ["R", "G"]}, "2 names for 3"),
        (np.zeros((2, 2, 3)), {"channels": ["R", "R", "G"]}, "a name of its own"),
        (np.zeros((2, 2, 3)), {"channels": ["R", "G", "A"]}, "X, Y, Z or R, G, B"),
        (np.zeros((2, 2, 3)), {"channels": ["X", "Y", "Z"], "color_space": "srgb"}, "cannot be in"),
        (np.zeros((2, 2, 3)), {"metadata": {"samples": 3}}, "texts"),
    ],
)
def test_arrays_that_are_no_pictures(array, options, message):
    with pytest.raises(etendue.Error, match=message) as failed:
        etendue.Image.from_array(array, **options)
    assert failed.value.faults[0].file == __file__ and failed.value.faults[0].line > 0


def test_values_that_are_not_finite():
    values = np.ones((4, 5, 3))
    values[2, 3, 1] = np.nan
    with pytest.raises(etendue.Error, match="G of pixel 3,2 is nan"):
        etendue.Image.from_array(values)
    values[3, 4, 0] = np.inf
    with pytest.raises(etendue.Error, match="2 pixels in all"):
        etendue.Image.from_array(values)
    made = etendue.Image.from_array(values, allow_not_finite=True)
    assert np.isnan(made.pixels[2, 3, 1]) and made.to_uint8()[2, 3].tolist() == [0, 0, 0]
    channels = ["R", "G", "B", "variance.Y"]
    etendue.Image.from_array(np.dstack([np.ones((2, 2, 3)), np.full((2, 2), np.inf)]), channels=channels)


def test_arithmetic(image):
    doubled = image.with_pixels(2 * np.asarray(image))
    assert (doubled.pixels == 2 * image.pixels).all() and doubled.channels == image.channels
    assert doubled.tone_map is image.tone_map
    assert image.with_pixels(image.pixels[:4]).height == 4
    with pytest.raises(etendue.Error, match="shape"):
        image.with_pixels(np.zeros((2, 2, 3)))
    again = pickle.loads(pickle.dumps(image))
    assert (again.pixels == image.pixels).all() and again.metadata == image.metadata
    assert etendue.equal(again.tone_map, image.tone_map)


# ---- display and files --------------------------------------------------------------------------------------------------------


def decoded(png):
    """The pixels of a PNG file of 8 bits, by the specification."""
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    at, chunks = 8, {}
    while at < len(png):
        size, kind = struct.unpack(">I4s", png[at : at + 8])
        content = png[at + 8 : at + 8 + size]
        assert zlib.crc32(kind + content) == struct.unpack(">I", png[at + 8 + size : at + 12 + size])[0]
        chunks[kind], at = content, at + 12 + size
    width, height = struct.unpack(">II", chunks[b"IHDR"][:8])
    rows = np.frombuffer(zlib.decompress(chunks[b"IDAT"]), np.uint8).reshape(height, -1)
    result = np.zeros((height + 1, 3 * width + 3), np.uint8)
    for y, row in enumerate(rows):
        for x in range(3 * width):
            left, up = result[y + 1, x], result[y, x + 3]
            result[y + 1, x + 3] = (int(row[x + 1]) + int({0: 0, 1: left, 2: up}[row[0]])) & 255
    return result[1:, 3:].reshape(height, width, 3)


def test_display(image, tmp_path):
    shown = image.to_uint8()
    assert shown.shape == (12, 16, 3) and shown.dtype == np.uint8 and shown.max() > shown.min()
    assert (decoded(image.to_bytes()) == shown).all() and image._repr_png_() == image.to_bytes()
    image.save(tmp_path / "a.png")
    plain = etendue.NoToneMap()
    assert (etendue.read_image(tmp_path / "a.png").to_uint8() == shown).all()
    dark = etendue.ExposureToneMap(exposure="fixed", stops=-3)
    assert image.to_uint8(dark).mean() < image.to_uint8(plain).mean()
    encoded = etendue.Image.from_array(np.linspace(-1, 2, 30).reshape(2, 5, 3))
    linear = np.clip(encoded.pixels, 0, 1)
    curve = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    assert np.abs(encoded.to_uint8() - np.floor(255 * curve + 0.5)).max() <= 1, "IEC 61966-2-1"
    with pytest.raises(etendue.Error, match="tone map"):
        image.to_uint8(etendue.Sphere())


def test_random_png():
    random = np.random.default_rng(7)
    for shape in ((1, 1, 3), (5, 3, 3), (16, 40, 3)):
        pixels = random.integers(0, 256, shape, dtype=np.uint8)
        pixels[: shape[0] // 2] = 17
        assert (decoded(etendue._images.png(pixels)) == pixels).all()


def test_files(image, tmp_path):
    for ending, tolerance in ((".npy", 0), (".exr", 1e-6), (".hdr", 2e-2)):
        file = tmp_path / f"a{ending}"
        image.save(file)
        again = etendue.read_image(file)
        assert np.allclose(again.xyz(), image.xyz(), rtol=tolerance, atol=tolerance * image.pixels.max()), ending
        assert again.tone_map is not None
    assert "depth" in etendue.read_image(tmp_path / "a.exr").layers
    image.save(tmp_path / "b.npy", layers=True)
    assert np.load(tmp_path / "b.npy").shape == image.pixels.shape
    image.save(tmp_path / "b.png", bits=16, tone_map=etendue.NoToneMap())
    assert etendue.read_image(tmp_path / "b.png").metadata["samples"] == "4"
    with pytest.raises(etendue.Error, match="known are .exr"):
        image.save(tmp_path / "a.xyz")
    with pytest.raises(etendue.Error, match="none/a.png"):
        image.save(tmp_path / "none" / "a.png")
    with pytest.raises(etendue.Error, match="has no member 'bit'"):
        image.save(tmp_path / "a.png", bit=16)
    with pytest.raises(etendue.Error, match="no such file"):
        etendue.read_image(tmp_path / "none.png")
    (tmp_path / "bad.png").write_bytes(b"nonsense")
    with pytest.raises(etendue.Error, match="bad.png"):
        etendue.read_image(tmp_path / "bad.png")


def test_a_tone_map_of_a_picture_is_a_copy(job):
    with etendue.Render(job) as render:
        render.run()
        before = render.snapshot()
        job.tone_map.stops = 3
        assert before.tone_map.stops == 0 and render.snapshot().tone_map.stops == 3
        job.tone_map.stops = 0


# ---- comparison ---------------------------------------------------------------------------------------------------------------


def test_compare(image, tmp_path):
    a = image.with_pixels(1.1 * image.pixels)
    found = etendue.compare_images(a, image)
    difference = a.xyz() - image.xyz()
    reference = image.xyz()
    assert found.root_mean_square_error == pytest.approx(np.sqrt((difference**2).mean()))
    floor = 1e-2 * reference.mean() ** 2
    assert found.relative_mean_square_error == pytest.approx((difference**2 / (reference**2 + floor)).mean())
    assert found.maximum_difference == pytest.approx(np.abs(difference).max())
    y, x, c = np.unravel_index(np.abs(difference).argmax(), difference.shape)
    assert (found.maximum_x, found.maximum_y, found.maximum_channel) == (x, y, "XYZ"[c])
    assert [c.name for c in found.channels] == ["X", "Y", "Z"] and found.channels[1].ratio == pytest.approx(1.1)
    assert [c.name for c in etendue.compare_images(a, image, "acescg").channels] == ["R", "G", "B"]
    image.save(tmp_path / "a.npy")
    assert etendue.compare_images(tmp_path / "a.npy", image).maximum_difference == 0
    with pytest.raises(etendue.Error, match="differ in size"):
        etendue.compare_images(image, etendue.Image.from_array(np.ones((2, 2))))
    with pytest.raises(etendue.Error, match="from_array"):
        etendue.compare_images(image, image.pixels)
    with pytest.raises(etendue.Error, match="nonsense"):
        etendue.compare_images(image, image, "nonsense")


def test_tile_ratios(image):
    a = image.with_pixels(2 * image.pixels)
    tiles = etendue.tile_ratios(a, image, 5)
    assert tiles.ratio.shape == tiles.mean_a.shape == (3, 4)
    assert tiles.mean_b[2, 3] == pytest.approx(image["Y"][10:, 15:].mean())
    assert np.allclose(tiles.ratio[tiles.mean_b > 0], 2)
    with pytest.raises(etendue.Error, match="at least one pixel"):
        etendue.tile_ratios(a, image, 0)


# ---- denoising ----------------------------------------------------------------------------------------------------------------


def test_denoise(job):
    pytest.importorskip("pyoidn")
    box = etendue.load(pathlib.Path(__file__).parents[2] / "scenes" / "cornell_box.etd")
    noisy = etendue.render(box, size=(64, 64), samples=8, seed=1, layers=["depth", "variance"])
    good = etendue.render(box, size=(64, 64), samples=256)
    plain, guided = etendue.denoise(noisy), etendue.denoise(noisy, box)
    for denoised in (plain, guided):
        assert (
            denoised.shape[:2] == noisy.shape[:2]
            and "denoiser" in denoised.metadata
            and "denoised" in denoised.metadata["bias"]
        )
        assert "variance" not in denoised and "depth" in denoised
    errors = [etendue.compare_images(i, good).relative_mean_square_error for i in (noisy, plain, guided)]
    assert errors[1] < 0.3 * errors[0] and errors[2] < 0.3 * errors[0] and not np.array_equal(plain.pixels, guided.pixels)
    with etendue.Render(job) as render:
        render.run()
        assert render.denoise().shape[:2] == (12, 16)
        assert etendue.denoise(render.snapshot(), render).pixels.tobytes() == render.denoise().pixels.tobytes()
        with pytest.raises(etendue.Error, match="guides would not fit"):
            etendue.denoise(noisy, render)
    with pytest.raises(etendue.Error, match="a denoiser"):
        etendue.denoise(noisy, denoiser=etendue.Sphere())


def test_the_wrong_class():
    with pytest.raises(etendue.Error, match="from_array"):
        etendue.Image(np.ones((2, 2, 3)))
    assert isinstance(etendue.Image.from_array(np.ones((2, 2)))._picture, _core.Picture)
    assert io.BytesIO(etendue.Image.from_array(np.ones((2, 2))).to_bytes()).read(4) == b"\x89PNG"


def test_a_spectral_picture_has_a_spectrum():
    text = LIT.replace("ImageBuffer { width: 16, height: 12,", "SpectralFilm { width: 5, height: 4, edges: [400, 500.5, 600, 700] nm,")
    image = etendue.render(etendue.loads(text), progress=False)
    assert image.spectrum.shape == (4, 5, 3)
    assert image.wavelengths.tolist() == [450.25, 550.25, 650]
    assert image.band_edges.tolist() == [400, 500.5, 600, 700]
    assert image.spectrum.max() > 0
    assert (image["S0"] == image.spectrum).all()


def test_other_pictures_have_none():
    image = etendue.Image.from_array(np.zeros((2, 3, 3)))
    assert len(image.wavelengths) == len(image.band_edges) == 0
    with pytest.raises(etendue.Error, match="no spectrum"):
        image.spectrum


def test_stokes_vectors_of_a_filter_are_those_of_linear_light():
    job = etendue.loads(
        """Job { renderer: PolarizedPathTracer { samples: 4 }
        camera: OrthographicCamera { from: [0, 0, 5], to: [0, 0, 0], up: [0, 1, 0], width: 1 }
        image: ImageBuffer { width: 3, height: 2, layers: ["stokes"] }
        scene: BruteForceScene { objects: [
            Rectangle { corner: [-2, -2, 0], edge_u: [4, 0, 0], edge_v: [0, 4, 0], shader: LinearPolarizer { angle: 30 deg } }
            Environment { emission: DiffuseEmission { radiance: 1 } } ] } }"""
    )
    image = etendue.render(job, progress=False)
    stokes = image.stokes
    assert stokes.shape == (2, 3, 4, 3)
    assert (stokes[:, :, 0] == image.pixels[:, :, :3]).all() and (stokes[:, :, 1] == image["S1"]).all()
    assert np.allclose(stokes[:, :, 1], stokes[:, :, 0] * 0.5, atol=1e-4)
    assert np.allclose(stokes[:, :, 2], stokes[:, :, 0] * np.sqrt(0.75), atol=1e-4)
    with pytest.raises(etendue.Error, match="no Stokes vectors"):
        etendue.Image.from_array(np.zeros((2, 3, 3))).stokes
