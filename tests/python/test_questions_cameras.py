"""Cameras in both directions, primary samples and wavelengths."""

import math

import numpy as np
import pytest

import etendue

FILM = (64, 48)


def camera(far=0.0, **members):
    return etendue.PerspectiveCamera(**{"from": (far, 0, -5), "to": (far, 0, 0), "fov": 40, **members})


@pytest.mark.parametrize("far", [0, 1e7])
@pytest.mark.parametrize("members", [{}, {"lens_radius": 0.1, "focus_distance": 4}], ids=["pinhole", "lens"])
def test_film_points_and_rays_are_inverse(far, members):
    cam = camera(far, **members)
    rng = np.random.default_rng(1)
    film = rng.random((500, 2)) * FILM
    rays = cam.rays(film, FILM, lens=rng.random((500, 2)))
    assert rays.of_camera.all() and np.allclose(np.linalg.norm(rays.direction, axis=1), 1, atol=1e-6)
    back = cam.film_points(rays, FILM)
    assert np.allclose(back.film, film, atol=2e-3 if far == 0 else 5e-3)
    assert (back.importance > 0).all() and (back.pdf_direction > 0).all()
    at = rays.at(7)
    seen = cam.sample_lens(at, FILM, rng.random((500, 2)), [500, 600])
    assert np.allclose(seen.weight, (seen.pdf > 0)[:, None]) and (seen.pdf > 0).mean() > 0.9
    if not members:
        assert np.allclose(seen.film, film, atol=2e-3 if far == 0 else 5e-3)
        assert np.allclose(seen.lens, [far, 0, -5]) and np.allclose(seen.distance, 7, rtol=1e-5)
    behind = cam.sample_lens([far, 0, -9], FILM)
    assert behind.pdf.tolist() == [0] and np.isnan(behind.film).all()
    assert np.isnan(cam.film_points(etendue.Rays([far, 0, -5], [0, 0, -1]), FILM).film).all()


def test_the_middle_ray_looks_ahead():
    rays = camera().rays([32, 24], FILM)
    assert np.allclose(rays.origin, [0, 0, -5]) and np.allclose(rays.direction, [0, 0, 1], atol=1e-6)
    # The pdf of directions over the film integrates to 1: a pixel's solid angle is 1 / (pdf pixels).
    x = camera().rays([[32, 24], [33, 24]], FILM)
    angle = math.acos(min(1.0, float(np.dot(x.direction[0], x.direction[1]))))
    pdf = camera().film_points(rays, FILM).pdf_direction[0]
    assert 1 / (pdf * FILM[0] * FILM[1]) == pytest.approx(angle**2, rel=0.01)


def test_job_knows_its_film():
    job = etendue.Job(camera=camera(), scene=etendue.BvhScene(objects=[etendue.Sphere()]))
    job.image.width, job.image.height = 64, 48
    assert job.film_size() == FILM
    assert np.array_equal(job.rays([10, 20]).direction, job.camera.rays([10, 20], FILM).direction)
    w = job.wavelengths.sample([0.5])
    sampled = job.sample_rays([10, 20], w)
    assert np.allclose(sampled.weight, 1) and not sampled.dispersed.any()
    assert job.scene.nearest(job.rays([32, 24])).distance == pytest.approx(4)
    with pytest.raises(etendue.Error, match="film: expects"):
        job.camera.rays([1, 1], 64)


def test_an_invisible_object_is_not_seen_by_camera_rays():
    scene = etendue.BvhScene(objects=[etendue.Sphere(visible_to_camera=False)])
    rays = camera().rays([32, 24], FILM)
    assert not scene.nearest(rays).hit.any()
    assert scene.nearest(rays.origin, rays.direction).hit.all()


def test_times():
    cam = camera(shutter_open=1, shutter_close=3)
    times = cam.shutter_times([0, 0.25, 0.5])
    assert np.allclose(times, [1, 1.5, 2])
    assert cam.rays([1, 1], FILM).time.tolist() == [1] and cam.rays([1, 1], FILM, time=times).time.tolist() == [1, 1.5, 2]


def test_primary_samples():
    sobol = etendue.SobolSampler()
    pixels, samples = np.repeat([[3, 4]], 64, axis=0), np.arange(64)
    numbers = sobol.numbers(pixels, samples, 5)
    assert numbers.shape == (64, 5) and numbers.min() >= 0 and numbers.max() < 1
    assert np.array_equal(numbers[:, [3]], sobol.numbers(pixels, samples, [3]))
    assert not np.array_equal(numbers, sobol.numbers(pixels, samples, 5, seed=2))
    pairs = sobol.pairs([3, 4], samples, 0)
    # 64 points of a (0, 2) sequence: one in each cell of 8 x 8.
    cells = np.unique((pairs * 8).astype(int), axis=0)
    assert len(cells) == 64
    with pytest.raises(etendue.Error, match="pixels: expects whole numbers"):
        sobol.numbers([0.5, 1], samples, 2)
    with pytest.raises(etendue.Error, match="samples: expects numbers from 0"):
        sobol.numbers([0, 1], [-1], 2)


def test_wavelengths_estimate_colours():
    u = (np.arange(4096) + 0.5) / 4096
    for sampler in (etendue.HeroWavelengths(), etendue.HeroWavelengths(distribution="uniform")):
        w = sampler.sample(u)
        assert w.nm.shape == (4096, 8) and w.nm.min() >= 360 and w.nm.max() <= 830
        for spectrum in (etendue.illuminant("D65"), etendue.rgb(0.9, 0.2, 0.1)):
            estimate = w.to_xyz(etendue.evaluate(spectrum, w)).mean(axis=0)
            assert np.allclose(estimate, etendue.to_xyz(spectrum), rtol=2e-3)
    grid = etendue.GridWavelengths(count=40).sample(np.zeros(40), samples=np.arange(40))
    assert len(np.unique(grid.nm)) == 40
    few = etendue.Wavelengths([[450, 550, 650]])
    assert few.to_xyz([[1, 1, 1]]).shape == (1, 3)
    assert np.allclose(
        few.to_xyz([[0, 3, 0]]), etendue.observer(550) * 470 / etendue._core.observer_y_integral(), rtol=1e-6
    )
