"""Shaders without a scene, and with one."""

import math

import numpy as np
import pytest

import etendue

NM = [450, 500, 550, 600, 650]


def grid(n):
    """Directions of the upper hemisphere in cells of equal solid angle, and that of a cell."""
    z = (np.arange(n) + 0.5) / n
    phi = (np.arange(2 * n) + 0.5) * math.pi / n
    z, phi = (a.ravel() for a in np.meshgrid(z, phi))
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=1), 2 * math.pi / len(z)


def test_lambertian_in_closed_form():
    shader = etendue.Lambertian(color=0.6)
    points = etendue.SurfacePoints.on_plane()
    incoming, cell = grid(100)
    f = shader.evaluate(points, [0, 0.6, 0.8], incoming, NM)
    assert f.shape == (20000, 5) and f.dtype == np.float32
    assert np.allclose(f, 0.6 / math.pi * incoming[:, 2:], rtol=1e-5)
    pdf = shader.pdf(points, [0, 0.6, 0.8], incoming, NM)
    assert pdf.shape == (20000,) and pdf.sum() * cell == pytest.approx(1, rel=1e-3)
    assert shader.evaluate(points, [0, 0, 1], [0, 0, -1], NM).max() == 0
    assert shader.albedo(points, [0, 0, 1], NM) == pytest.approx(0.6)
    assert shader.lobes_at(points, [0, 0, 1], NM).tolist() == [etendue.Lobes.DIFFUSE_REFLECTION]
    assert shader.evaluate([0.5, 0.5], [0, 0, 5], [0, 0, 0.1], [500]) == pytest.approx(0.6 / math.pi)


@pytest.mark.parametrize(
    "shader",
    [etendue.Lambertian(color=0.6), etendue.Conductor(ior=etendue.metal("Au"), roughness=0.4), etendue.OrenNayar()],
    ids=lambda s: type(s).__name__,
)
def test_samples_follow_the_pdf(shader):
    points = etendue.SurfacePoints.on_plane()
    out = [0.3, 0, 0.95]
    count = 40000
    s = shader.sample(points, out, NM, np.random.default_rng(3).random((count, 3)))
    there = s.pdf > 0
    assert np.allclose(shader.pdf(points, out, s.direction[there], NM), s.pdf[there], rtol=2e-3)
    f = shader.evaluate(points, out, s.direction[there], NM)
    assert np.allclose(f / s.pdf[there, None], s.weight[there], rtol=5e-3, atol=1e-5)
    # The mean weight is the albedo, as the integral of f over the hemisphere is.
    directions, cell = grid(150)
    albedo = shader.evaluate(points, out, directions, NM).astype(float).sum(axis=0) * cell
    error = s.weight.std(axis=0) / math.sqrt(count)
    assert (abs(s.weight.mean(axis=0) - albedo) < 4.5 * error + 2e-3).all()


def test_mirror_and_glass():
    mirror = etendue.Conductor(ior=etendue.metal("Ag"), roughness=0)
    out = np.array([0.6, 0, 0.8])
    s = mirror.sample([0, 0], out, NM, [0.5, 0.5, 0.5])
    assert np.allclose(s.direction, [[-0.6, 0, 0.8]], atol=1e-6) and s.specular.all() and not s.transmitted.any()
    assert mirror.evaluate([0, 0], out, s.direction, NM).max() == 0
    glass = etendue.Dielectric(ior=1.5)
    assert glass.interior_index(NM) == pytest.approx(1.5)
    s = glass.sample([0, 0], out, NM, [[0.999, 0.5, 0.5]])
    assert s.transmitted.all() and s.direction[0, 0] == pytest.approx(-0.6 / 1.5, abs=1e-6)
    assert s.weight == pytest.approx(1 / 2.25, rel=1e-5) and s.eta == pytest.approx(1.5)
    importance = glass.sample([0, 0], out, NM, [[0.999, 0.5, 0.5]], transport="importance")
    assert importance.weight == pytest.approx(1, rel=1e-5)
    only = glass.sample([0, 0], out, NM, [[0.999, 0.5, 0.5]], lobes=etendue.Lobes.SPECULAR_REFLECTION)
    assert not only.transmitted.any() and only.pdf == pytest.approx(1)


def test_dispersion_drops_wavelengths():
    glass = etendue.Dielectric(ior=etendue.glass("N-SF11"))
    w = etendue.HeroWavelengths().sample([0.1, 0.7])
    s = glass.sample([0, 0], [0.6, 0, 0.8], w, [0.999, 0.5, 0.5])
    assert s.dispersive.all() and s.direction[0, 0] != s.direction[1, 0]
    factor = w.drop_secondary([True, False])
    assert factor.tolist() == [[8, 0, 0, 0, 0, 0, 0, 0], [1] * 8] and w.single.tolist() == [True, False]
    assert w.drop_secondary(True).tolist() == [[1] * 8, [8, 0, 0, 0, 0, 0, 0, 0]]
    assert w[[0]].single.tolist() == [True]


def test_each_hit_has_its_own_shader():
    red, grey = etendue.Lambertian(color="rgb(0.8, 0.1, 0.1)"), etendue.Lambertian(color=0.5)
    scene = etendue.BvhScene(
        objects=[etendue.Sphere(shader=red), etendue.Sphere(centre=(3, 0, 0), shader=grey), etendue.Sphere(centre=(6, 0, 0))]
    )
    hits = scene.nearest([[0, 0, -5], [3, 0, -5], [6, 0, -5], [9, 0, -5]], [0, 0, 1])
    out, into = [0, 0, -1], [0, 0.6, -0.8]
    own = scene.scatter_evaluate(hits, out, into, NM)
    assert np.array_equal(own[:1], red.evaluate(hits[:1], out, into, NM))
    assert own[1] == pytest.approx(0.5 / math.pi * 0.8, rel=1e-5)
    assert own[2:].max() == 0  # an object without a shader is black, and so is no object
    s = scene.scatter_sample(hits, out, NM, [0.5, 0.3, 0.7])
    assert (s.pdf > 0).tolist() == [True, True, False, False]
    assert np.allclose(scene.scatter_pdf(hits, out, s.direction, NM), s.pdf, rtol=1e-4)
    assert scene.scatter_lobes(hits, out, NM).tolist() == [1, 1, 0, 0]
    with pytest.raises(etendue.Error, match="made by hand have no shader"):
        scene.scatter_albedo(etendue.SurfacePoints.on_plane(), out, NM)


def test_what_is_refused():
    shader = etendue.Lambertian()
    with pytest.raises(etendue.Error, match="at most 8"):
        shader.sample([0, 0], [0, 0, 1], np.linspace(400, 700, 9), [0.5, 0.5, 0.5])
    assert shader.albedo([0, 0], [0, 0, 1], np.linspace(400, 700, 19)).shape == (1, 19)
    with pytest.raises(etendue.Error, match="from 360 to 830 nm"):
        shader.albedo([0, 0], [0, 0, 1], [900])
    with pytest.raises(etendue.Error, match="transport is"):
        shader.pdf([0, 0], [0, 0, 1], [0, 0, 1], NM, transport="light")
    with pytest.raises(etendue.Error, match="points: expects SurfacePoints"):
        shader.albedo([[0, 0, 0]], [0, 0, 1], NM)
    with pytest.raises(etendue.Error, match=r"u: expects shape \(N, 3\)"):
        shader.sample([0, 0], [0, 0, 1], NM, [0.5, 0.5])
    assert shader.pdf([0, 0], [0, 0, math.nan], [0, 0, 1], NM).tolist() == [0]
    assert shader.pdf(np.zeros((0, 2)), [0, 0, 1], [0, 0, 1], NM).shape == (0,)


def test_a_map_steers_the_shader():
    shader = etendue.Lambertian(color=etendue.CheckerMap(first=0.2, second=0.9))
    checks = shader.color
    uv = np.random.default_rng(2).random((100, 2)) * 4
    albedo = shader.albedo(uv, [0, 0, 1], NM)
    assert set(np.round(np.unique(albedo), 3)) == {np.float32(0.2), np.float32(0.9)}
    assert np.allclose(checks.color(uv, NM), albedo) and np.allclose(checks.scalar(uv), albedo[:, 0])
