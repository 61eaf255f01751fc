"""Mattes of `etendue cryptomatte`, read by a reader of other people."""

import os
import subprocess

import numpy as np
import pytest

cryptomatte_api = pytest.importorskip("cryptomatte_api")
PROGRAM = os.environ.get("ETENDUE_PROGRAM")
pytestmark = pytest.mark.skipif(not PROGRAM, reason="needs the program, named by ETENDUE_PROGRAM")

SCENE = """
paint = Lambertian { color: rgb(0.8, 0.2, 0.1) }
ball = Sphere { radius: 1 m, shader: paint }
dot = Sphere { centre: [1.2, 0, -0.5] m, radius: 0.6 m, shader: paint }
Job {
    renderer: PathTracer { samples: 32, max_depth: 3 }
    camera: PerspectiveCamera { from: [0, 0, -5] m, to: [0, 0, 0] m, fov: 40 deg }
    image: ImageBuffer { width: 24, height: 16 }
    scene: BvhScene { objects: [
        ball
        dot
        Sphere { centre: [-1.2, 0.5, 0] m, radius: 0.5 m, shader: Lambertian {} }
        Environment { emission: EnvironmentEmission {} }
    ] }
}
"""


def run(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], check=True, capture_output=True, text=True).stdout


def test_another_reader_finds_the_same_mattes(tmp_path):
    (tmp_path / "scene.etd").write_text(SCENE)
    mattes = tmp_path / "mattes.exr"
    run("cryptomatte", tmp_path / "scene.etd", "-o", mattes, "--quiet")
    kinds = {m.metadata().name(): m for m in cryptomatte_api.Cryptomatte.load(str(mattes))}
    assert set(kinds) == {"crypto_object", "crypto_material", "crypto_asset"}
    masks = {name: np.asarray(mask) for name, mask in kinds["crypto_object"].masks().items()}
    assert set(masks) == {"ball", "dot", "Sphere 1"}
    for name, mask in masks.items():
        run("image", "cryptomatte", mattes, "--select", name, "--kind", "crypto_object", "-o", tmp_path / "matte.npy")
        ours = np.load(tmp_path / "matte.npy")
        np.testing.assert_allclose(mask.reshape(16, 24), ours[..., 1], atol=1e-6)
    # One material of two objects; nothing is covered twice.
    paint = np.asarray(kinds["crypto_material"].mask("paint")).reshape(16, 24)
    np.testing.assert_allclose(paint, (masks["ball"] + masks["dot"]).reshape(16, 24), atol=1e-6)
    whole = sum(masks.values())
    assert whole.max() <= 1 + 1e-5 and 0.1 < whole.mean() < 0.5


def test_another_reader_finds_the_mattes_in_the_picture(tmp_path):
    """As layers beside the light, with groups."""
    groups = 'groups: [ ObjectGroup { name: "round", objects: ["ball", "d*"] } ]\n}'
    layers = 'layers: ["crypto_object", "depth", "crypto_group"]'
    scene = SCENE.replace("height: 16 }", "height: 16, " + layers + " }").rstrip()[:-1] + groups
    (tmp_path / "scene.etd").write_text(scene)
    picture, alone = tmp_path / "picture.exr", tmp_path / "mattes.exr"
    run("render", tmp_path / "scene.etd", "-o", picture, "--quiet")
    run("cryptomatte", tmp_path / "scene.etd", "-o", alone, "--quiet")
    kinds = {m.metadata().name(): m for m in cryptomatte_api.Cryptomatte.load(str(picture))}
    assert set(kinds) == {"crypto_object", "crypto_group"}
    expected = {m.metadata().name(): m for m in cryptomatte_api.Cryptomatte.load(str(alone))}
    for name, mask in kinds["crypto_object"].masks().items():
        np.testing.assert_array_equal(np.asarray(mask), np.asarray(expected["crypto_object"].mask(name)))
    both = sum(np.asarray(kinds["crypto_object"].mask(name)) for name in ("ball", "dot"))
    np.testing.assert_allclose(np.asarray(kinds["crypto_group"].mask("round")), both, atol=1e-6)


def test_a_crop_is_a_part_of_the_whole(tmp_path):
    """With --crop, and with a crop of the description that --size scales."""
    (tmp_path / "scene.etd").write_text(SCENE)
    cropped = SCENE.replace("height: 16 }", "height: 16, crop: [6, 4, 18, 12] }")
    assert cropped != SCENE
    (tmp_path / "cropped.etd").write_text(cropped)

    def ball(scene, *options):
        run("cryptomatte", tmp_path / scene, "-o", tmp_path / "mattes.exr", "--quiet", *options)
        run("image", "cryptomatte", tmp_path / "mattes.exr", "--select", "ball", "--kind", "crypto_object", "-o", tmp_path / "matte.npy")
        return np.load(tmp_path / "matte.npy")

    whole = ball("scene.etd")
    assert whole[4:12, 6:18].mean() > 0.3
    np.testing.assert_array_equal(ball("scene.etd", "--crop", "6,4,18,12"), whole[4:12, 6:18])
    half = ball("scene.etd", "--size", "12x8")
    np.testing.assert_array_equal(ball("cropped.etd", "--size", "12x8"), half[2:6, 3:9])


def test_the_same_bytes_for_any_number_of_threads(tmp_path):
    (tmp_path / "scene.etd").write_text(SCENE)
    for threads in (1, 2):
        run("cryptomatte", tmp_path / "scene.etd", "-o", tmp_path / f"{threads}.exr", "--quiet", "--threads", threads)
    assert (tmp_path / "1.exr").read_bytes() == (tmp_path / "2.exr").read_bytes()


def test_what_cannot_be_written_or_selected_is_said(tmp_path):
    (tmp_path / "scene.etd").write_text(SCENE)
    wrong = subprocess.run([PROGRAM, "cryptomatte", str(tmp_path / "scene.etd"), "-o", str(tmp_path / "m.png")], capture_output=True, text=True)
    assert wrong.returncode == 2 and "must end in .exr" in wrong.stderr
    mattes = tmp_path / "mattes.exr"
    run("cryptomatte", tmp_path / "scene.etd", "-o", mattes, "--quiet")
    absent = subprocess.run([PROGRAM, "image", "cryptomatte", str(mattes), "--select", "cube", "-o", str(tmp_path / "m.npy")],
                            capture_output=True, text=True)
    assert absent.returncode == 2 and "no matte of 'cube'" in absent.stderr
    assert not (tmp_path / "m.npy").exists()
