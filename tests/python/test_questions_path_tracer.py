"""The path tracer in NumPy against the program's."""

import importlib.util
import pathlib

import numpy as np

import etendue

ROOT = pathlib.Path(__file__).parents[2]


def example(name):
    spec = importlib.util.spec_from_file_location(name, ROOT / "python" / "examples" / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def tiles(picture, size=8):
    """The means over tiles of the picture, shape (rows, columns, 3)."""
    height, width, channels = picture.shape
    return picture.reshape(height // size, size, width // size, size, channels).mean(axis=(1, 3))


def test_the_cornell_box():
    """X, Y and Z in the mean and in each of 16 tiles lie within 4.5 standard errors of those of the program's PathTracer: by chance one
    of the 51 numbers does not in 3 of 10,000 runs."""
    job = etendue.load(ROOT / "scenes" / "cornell_box.etd", defines={"size": 32})
    xyz, error = example("path_tracer").render(job, samples=256, max_depth=job.renderer.max_depth)
    reference = etendue.render(job, samples=1024).xyz()
    # The program's picture has four times the samples, each with no more variance.
    variance = 1.25 * error**2
    for size in (8, 32):
        difference = tiles(xyz, size) - tiles(reference, size)
        sigma = np.sqrt(tiles(variance, size) / size**2)
        assert (np.abs(difference) < 4.5 * sigma).all(), (difference / sigma, sigma)
    # So that an error of 5 % of the mean would be seen.
    assert (sigma < 0.011 * tiles(xyz, 32)).all()
