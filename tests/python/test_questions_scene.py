"""Rays and scenes: what is hit, seen and lit."""

import math
import threading

import numpy as np
import pytest

import etendue

NM = [450, 550, 650]


def sphere(centre=(0, 0, 0), radius=1.0, **members):
    return etendue.Sphere(centre=centre, radius=radius, shader=etendue.Lambertian(color=0.5), **members)


def random_directions(count, seed=1):
    d = np.random.default_rng(seed).normal(size=(count, 3))
    return d / np.linalg.norm(d, axis=1, keepdims=True)


@pytest.mark.parametrize("origin", [0, 1e7])
def test_hits_of_a_sphere(origin):
    scene = etendue.BvhScene(objects=[sphere((origin, 1, 2), 0.5)])
    centre = np.array([origin, 1, 2.0])
    d = random_directions(2000)
    hits = scene.nearest(centre - 3 * d, d)
    assert hits.hit.all() and hits.position.dtype == np.float64
    assert np.allclose(hits.distance, 2.5, atol=1e-5)
    assert np.allclose(hits.position, centre - 0.5 * d, rtol=0, atol=2e-6 if origin == 0 else 1e-5)
    assert np.allclose(hits.normal, -d, atol=1e-5)
    assert np.allclose((hits.dpdu * hits.normal).sum(axis=1), 0, atol=1e-5)
    assert (hits.object == 0).all() and hits.parts[0] is scene.objects[0]
    assert (hits.error > 0).all() and (hits.error < 1e-5).all()
    beside = scene.nearest(centre + 0.6 * d, d)
    assert not beside.hit.any() and np.isinf(beside.distance).all() and (beside.object == -1).all()
    assert np.isnan(beside.position).all() and np.isnan(beside.normal).all()


def test_what_arrays_may_be():
    scene = etendue.BruteForceScene(objects=[sphere()])
    o = np.zeros((5, 6))[:, ::2]
    o[:, 2] = -3
    assert scene.nearest(o, [0, 0, 1]).distance.tolist() == [2] * 5
    assert scene.nearest([0, 0, -3], np.array([[0, 0, 7]], np.int16)).distance.tolist() == [2]
    assert len(scene.nearest(np.zeros((0, 3)), np.zeros((0, 3)))) == 0
    assert scene.nearest([], [0, 0, 1]).position.shape == (0, 3)
    assert scene.emitted(scene.nearest([], [0, 0, 1]), NM).shape == (0, 3)
    fixed = np.array([[0, 0, 1.0]], np.float32)
    fixed.flags.writeable = False
    assert scene.occluded([0, 0, -3], fixed).tolist() == [True]
    bad = scene.nearest([0, 0, -3], [[math.nan, 0, 1], [0, 0, 0], [math.inf, 0, 0], [0, 0, 1]])
    assert bad.hit.tolist() == [False, False, False, True]
    assert scene.nearest([math.nan, 0, -3], [0, 0, 1]).hit.tolist() == [False]
    assert scene.nearest([0, 0, -3], [0, 0, 1], maximum=[1.9, 2.1, math.nan]).hit.tolist() == [False, True, False]
    assert scene.scatter_evaluate(bad, [0, 0, -1], [0, 0, -1], NM)[:3].max() == 0
    with pytest.raises(etendue.Error, match=r"directions: expects shape \(N, 3\) or \(3,\), not \(4,\)"):
        scene.nearest([0, 0, -3], [0, 0, 1, 1])
    with pytest.raises(etendue.Error, match="there are 4 origins but 5 directions"):
        scene.nearest(np.zeros((4, 3)), np.ones((5, 3)))
    with pytest.raises(etendue.Error, match="expects an array of numbers"):
        scene.nearest(["a", "b", "c"], [0, 0, 1])


def test_some_of_the_points():
    scene = etendue.BvhScene(objects=[sphere(), sphere((3, 0, 0), 0.25)])
    x = np.array([0, 3, 10, 0.5])
    hits = scene.nearest(np.stack([x, 0 * x, 0 * x - 5], axis=1), [0, 0, 1])
    assert hits.hit.tolist() == [True, True, False, True] and hits.object.tolist() == [0, 1, -1, 0]
    assert hits[hits.hit].object.tolist() == [0, 1, 0] and hits[::-1].object.tolist() == [0, -1, 1, 0]
    assert np.array_equal(hits[[1]].position, hits.position[[1]])
    with pytest.raises(ValueError):
        hits.distance[0] = 1


def test_an_edit_is_seen_and_old_points_are_refused():
    ball = sphere()
    scene = etendue.BvhScene(objects=[ball])
    job = etendue.Job(scene=scene, camera=etendue.PerspectiveCamera())
    before = scene.nearest([0, 0, -3], [0, 0, 1])
    ball.radius = 0.5
    assert scene.nearest([0, 0, -3], [0, 0, 1]).distance == pytest.approx(2.5)
    assert before.distance == pytest.approx(2)  # what was found stays
    with pytest.raises(etendue.Error, match="before an edit"):
        scene.scatter_albedo(before, [0, 0, -1], NM)
    hits = job.scene.nearest([0, 0, -3], [0, 0, 1])
    job.camera.fov = 20  # no part of the scene: its points stay
    ball.shader.color  # reading is no edit
    assert scene.scatter_albedo(hits, [0, 0, -1], NM) == pytest.approx(0.5)
    ball.shader.color = 0.25
    again = scene.nearest([0, 0, -3], [0, 0, 1])
    assert scene.scatter_albedo(again, [0, 0, -1], NM) == pytest.approx(0.25)


def test_points_outlive_their_scene():
    hits = etendue.BvhScene(objects=[sphere()]).nearest([0, 0, -3], [0, 0, 1])
    shader = etendue.Lambertian(color=0.3)
    assert hits.object.tolist() == [0] and hits.parts[0].radius == 1
    assert shader.albedo(hits, [0, 0, -1], NM) == pytest.approx(0.3)


@pytest.mark.parametrize("far", [0, 1e7])
def test_visibility(far):
    scene = etendue.BvhScene(objects=[sphere((far, 0, 0))])
    a, b = np.array([far - 2, 0, 0]), np.array([far + 2, 0, 0])
    c = np.array([far - 2, 5, 0])
    assert scene.visible([a, a, c], [b, c, b]).tolist() == [False, True, True]
    hits = scene.nearest(a, b - a)
    assert scene.visible(hits, a).tolist() == [True] and scene.visible(hits, b).tolist() == [False]
    assert scene.transmittance(hits, a, NM).tolist() == [[1, 1, 1]]
    assert scene.occluded(hits.leave([-1, 0, 0])).tolist() == [False]
    assert scene.occluded(hits.leave([1, 0.1, 0])).tolist() == [True]


def test_transmittance_of_a_medium():
    medium = etendue.HomogeneousVolume(absorption=0.7, scattering=0.3)
    fog = etendue.Sphere(shader=etendue.PassThrough(), interior=medium)
    scene = etendue.BvhScene(objects=[fog])
    assert scene.transmittance([-2, 0, 0], [2, 0, 0], NM) == pytest.approx(math.exp(-2), rel=1e-4)
    assert scene.transmittance([0, 0, 0], [2, 0, 0], NM) == pytest.approx(math.exp(-1), rel=1e-4)


def test_glass_in_glass_gets_the_index_around_it():
    # A ball of the glass that it lies in is invisible: the ray goes straight on.
    outer = etendue.Sphere(radius=2, shader=etendue.Dielectric(ior=1.5), priority=0)
    inner = etendue.Sphere(radius=1, shader=etendue.Dielectric(ior=1.5), priority=1)
    scene = etendue.BvhScene(objects=[outer, inner])
    u = [0.999999, 0.5, 0.5]
    rays = etendue.Rays([0, 0.3, -5], [0, 0, 1])
    for expected in (0, 1):
        x = scene.nearest(rays)
        assert x.object.tolist() == [expected]
        s = scene.scatter_sample(x, -rays.direction, NM, u)
        bent = float(np.dot(s.direction[0], rays.direction[0]))
        assert bent < 0.9999 if expected == 0 else bent == pytest.approx(1, abs=1e-6)
        assert s.transmitted.all() and s.specular.all()
        rays = x.leave(s)


def test_light_of_a_sphere_and_of_the_sky():
    # The irradiance from a sphere of radiance L at the distance d over its centre is pi L (r / d)^2.
    lamp = etendue.Sphere(centre=(0, 0, 4), radius=0.5, emission=etendue.DiffuseEmission(radiance=3))
    scene = etendue.BvhScene(objects=[lamp])
    count = 20000
    u = np.random.default_rng(5).random((count, 3))
    points = etendue.SurfacePoints([0, 0, 0], [0, 0, 1])
    s = scene.sample_light(points, u, NM)
    assert not scene.occluded(s.shadow).any() and (s.object == 0).all() and scene.luminaires() == (lamp,)
    estimate = s.radiance[:, 1] / s.pdf * s.direction[:, 2]
    error = estimate.std() / math.sqrt(count)
    assert abs(estimate.mean() - math.pi * 3 / 64) < 4.5 * error + 1e-5
    found = scene.nearest(points[np.zeros(count, int)].leave(s.direction))
    assert np.allclose(scene.light_pdf(points, found), s.pdf, rtol=1e-3)
    assert np.allclose(scene.emitted(found, NM), 3)
    assert scene.emitted(found, NM, found.ray_direction).max() == 0  # inside
    assert lamp.emitted_power(NM) == pytest.approx(3 * math.pi * 4 * math.pi * 0.25, rel=1e-4)

    sky = etendue.BvhScene(objects=[sphere(), etendue.Environment(emission=etendue.DiffuseEmission(radiance=2))])
    seen = sky.nearest([[0, 0, 5], [0, 0, 5]], [[0, 0, 1], [0, 0, -1]])
    assert sky.emitted(seen, NM).tolist() == [[2, 2, 2], [0, 0, 0]]


def test_light_sampler():
    lamps = [etendue.Sphere(centre=(x, 0, 3), radius=0.1, emission=etendue.DiffuseEmission(radiance=r)) for x, r in ((0, 1), (9, 3))]
    scene = etendue.BvhScene(objects=lamps)
    points = etendue.SurfacePoints([0, 0, 0], [0, 0, 1])
    u = (np.arange(1000) + 0.5) / 1000
    power = etendue.PowerLightSampler(uniform=0).choose(scene, points, u)
    assert np.bincount(power.object).tolist() == [250, 750]
    assert np.allclose(power.probability, np.where(power.object == 0, 0.25, 0.75), rtol=1e-3)
    near = scene.sample_light(points, np.stack([u, u, u], axis=1), NM)
    assert (near.object == 0).mean() > 0.9


def test_questions_of_several_threads_and_edits_between():
    ball = sphere()
    scene = etendue.BvhScene(objects=[ball])
    d = random_directions(2000)
    wrong = []

    def ask():
        for _ in range(30):
            found = np.unique(np.round(scene.nearest(-3 * d, d).distance, 3))
            if len(found) != 1 or found[0] not in (2, 2.5):
                wrong.append(found)

    threads = [threading.Thread(target=ask) for _ in range(3)]
    for t in threads:
        t.start()
    for i in range(40):
        ball.radius = 0.5 if i % 2 else 1.0
    for t in threads:
        t.join()
    assert not wrong


def test_names_of_questions_are_no_members():
    from etendue import _classes, _questions

    for name in _questions.QUESTIONS:
        assert isinstance(getattr(etendue, name), type)
    _questions.QUESTIONS["PhaseFunction"].anisotropy = lambda self: None
    _classes._made.clear()
    try:
        with pytest.raises(etendue.Error, match="HenyeyGreensteinPhase: the member 'anisotropy' has the name of a question"):
            etendue.HenyeyGreensteinPhase
    finally:
        del _questions.QUESTIONS["PhaseFunction"].anisotropy
        _classes._made.clear()
