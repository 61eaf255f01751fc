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


def test_the_cornell_box():
    """The mean of X, Y and Z lies within 4.5 standard errors of that of the program's PathTracer: 7 in a million by chance."""
    job = etendue.load(ROOT / "scenes" / "cornell_box.etd", defines={"size": 32})
    depth = job.renderer.max_depth
    xyz, error = example("path_tracer").render(job, samples=64, max_depth=depth)
    reference = np.asarray(etendue.render(job, samples=256).xyz)
    # The program's picture has four times the samples, each with less variance.
    sigma = np.sqrt((error**2).sum(axis=(0, 1)) * 1.25) / error[..., 0].size
    difference = xyz.mean(axis=(0, 1)) - reference.mean(axis=(0, 1))
    assert (np.abs(difference) < 4.5 * sigma).all(), (difference, sigma)
    assert (sigma < 0.01 * xyz.mean()).all()  # so that an error of 5 % is seen
