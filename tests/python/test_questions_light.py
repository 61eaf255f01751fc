"""Emission, media, phase functions, spectra and colours."""

import math

import numpy as np
import pytest

import etendue

NM = [450, 550, 650]


def sphere_of_directions(count, seed=1):
    d = np.random.default_rng(seed).normal(size=(count, 3))
    return d / np.linalg.norm(d, axis=1, keepdims=True)


def test_emission_of_a_side():
    emission = etendue.DiffuseEmission(radiance=2)
    assert emission.evaluate([0, 0], [[0, 0, 1], [0, 0, -1]], NM).tolist() == [[2, 2, 2], [0, 0, 0]]
    s = emission.sample([0, 0], np.random.default_rng(1).random((1000, 2)))
    assert np.allclose(emission.pdf([0, 0], s.direction), s.pdf, rtol=1e-4)
    assert np.allclose(s.pdf, s.direction[:, 2] / math.pi, rtol=1e-4)
    square = etendue.Rectangle(corner=(0, 0, 0), edge_u=(2, 0, 0), edge_v=(0, 3, 0), emission=emission)
    assert square.emitted_power(NM) == pytest.approx(2 * math.pi * 6, rel=1e-5)
    with pytest.raises(etendue.Error, match="has no emission"):
        etendue.Sphere().emitted_power(NM)


def test_light_of_the_sky_is_sampled():
    sky = etendue.SkyEmission()
    s = sky.sample_incident(np.random.default_rng(1).random((2000, 2)))
    assert (s.pdf > 0).all()
    assert np.allclose(sky.incident_pdf(s.direction), s.pdf, rtol=2e-2)


def test_a_homogeneous_medium():
    fog = etendue.HomogeneousVolume(absorption=0.2, scattering=0.3)
    c = fog.coefficients([[0, 0, 0], [1, 2, 3]], NM)
    assert np.allclose(c.absorption, 0.2) and np.allclose(c.scattering, 0.3) and np.allclose(c.extinction, 0.5)
    assert c.emission.max() == 0 and np.allclose(fog.majorant(NM), 0.5)
    d = np.array([0, 1, 4, np.inf])
    t = fog.transmittance([0, 0, 0], [0, 0, 1], d, NM)
    assert np.allclose(t, np.exp(-0.5 * d)[:, None], rtol=1e-5)
    assert np.isnan(fog.transmittance([0, 0, 0], [0, 0, 0], 1, NM)).all()


def test_ratio_tracking_of_a_heterogeneous_medium():
    # Density x from 0 to 1 along the ray, extinction 2 x: the optical depth is 1.
    fog = etendue.MapVolume(density=etendue.FormulaMap(formula="x"), extinction=2, bound=2.5, low=(0, 0, 0), high=(1, 1, 1))
    count = 20000
    t = fog.transmittance(np.tile([0, 0.5, 0.5], (count, 1)), [1, 0, 0], 1, NM)[:, 0].astype(float)
    assert abs(t.mean() - math.exp(-1)) < 4.5 * t.std() / math.sqrt(count)
    again = fog.transmittance(np.tile([0, 0.5, 0.5], (count, 1)), [1, 0, 0], 1, NM)[:, 0]
    assert np.array_equal(t.astype(np.float32), again)


@pytest.mark.parametrize("phase", [etendue.HenyeyGreensteinPhase(anisotropy=0.6), etendue.RayleighPhase()])
def test_phase_functions(phase):
    c = -1 + 2 * (np.arange(20000) + 0.5) / 20000
    assert phase.evaluate(c).astype(float).mean() * 4 * math.pi == pytest.approx(1, rel=1e-4)
    s = phase.sample((np.arange(4096) + 0.5) / 4096)
    assert np.allclose(phase.evaluate(s.cosine), s.pdf, rtol=1e-3)
    mean = (phase.evaluate(c) * c).astype(float).mean() * 4 * math.pi
    assert s.cosine.mean() == pytest.approx(mean, abs=2e-3)
    assert np.isnan(phase.evaluate([1.1, math.nan])).all()


def test_phase_of_a_medium():
    fog = etendue.HomogeneousVolume(scattering=1, phase=etendue.HenyeyGreensteinPhase(anisotropy=0.5))
    into = sphere_of_directions(100000)
    assert fog.evaluate_phase([0, 0, 0], [0, 0, 1], into).astype(float).mean() * 4 * math.pi == pytest.approx(1, abs=0.02)
    s = fog.sample_phase([0, 0, 0], [0, 0, 1], np.random.default_rng(2).random((20000, 2)))
    assert np.allclose(fog.evaluate_phase([0, 0, 0], [0, 0, 1], s.direction), s.pdf, rtol=1e-3)
    # Light goes on forward: the path came from above, and goes on downward.
    assert s.direction[:, 2].mean() == pytest.approx(-0.5, abs=0.02)


def test_spectra():
    assert etendue.evaluate(0.25, [400.0, 500.0]).tolist() == [0.25, 0.25]
    planck = etendue.evaluate(etendue.blackbody(5000), [500, 600])
    h, c, k = 6.62607015e-34, 299792458.0, 1.380649e-23
    for nm, value in zip((500e-9, 600e-9), planck):
        assert value == pytest.approx(2e-9 * h * c**2 / nm**5 / math.expm1(h * c / (nm * k * 5000)), rel=1e-3)
    assert np.isnan(etendue.evaluate(1, [[300, 900]])).all()
    white = etendue.to_xyz(etendue.illuminant("D65"))
    assert np.allclose(white / white.sum(), [0.3127, 0.3290, 0.3583], atol=2e-4) and white[1] == pytest.approx(1, rel=1e-4)
    for rgb in ([0.9, 0.2, 0.1], [0.3, 0.5, 0.7]):
        xyz = etendue.to_xyz(etendue.rgb(*rgb), illuminant=etendue.illuminant("D65"))
        assert np.allclose(etendue.xyz_to_rgb(xyz), rgb, atol=3e-3)
        assert np.allclose(etendue.rgb_to_xyz(etendue.xyz_to_rgb(xyz)), xyz)
    assert np.allclose(etendue.xyz_to_rgb(white, encode=True), 1, atol=1e-3)
    gold = etendue.metal("Au")
    assert etendue.evaluate(gold, 500, imaginary=True) > 1 > etendue.evaluate(gold, 650)
    assert np.allclose(etendue.observer(555), [0.5121, 1.0, 0.00575], atol=2e-3)
    with pytest.raises(etendue.Error, match="a colour is used as"):
        etendue.evaluate(1, 500, "light")
    with pytest.raises(etendue.Error):
        etendue.evaluate(None, 500)


def test_many_rgb_colours():
    rgb = np.random.default_rng(1).random((50, 3))
    at = np.linspace(400, 700, 31)
    spectra = etendue.rgb_spectra(rgb, at)
    assert spectra.shape == (50, 31) and spectra.min() >= 0 and spectra.max() <= 1
    for i in (0, 17):
        assert np.allclose(spectra[i], etendue.evaluate(etendue.rgb(*rgb[i]), at), atol=1e-2)
    assert etendue.rgb_spectra(np.zeros((0, 3)), at).shape == (0, 31)


def test_maps():
    points = etendue.SurfacePoints(np.random.default_rng(1).random((10, 3)), [0, 0, 1])
    noise = etendue.FbmMap()
    assert noise.scalar(points).shape == (10,) and noise.color(points, NM).shape == (10, 3)
    assert etendue.ConstantMap(value="rgb(1, 0, 0)").color([0, 0], [650], "radiance") > 0.1
