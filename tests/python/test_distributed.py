"""Renders over many machines: the bytes of one process, whatever becomes of the machines; errors."""

import socket
import sys
import time

import clusters
import pytest

import etendue

distributed = pytest.importorskip("etendue.distributed")


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    cluster, client = clusters.start(tmp_path_factory.mktemp("workers"))
    yield cluster, client
    client.close()
    cluster.close(timeout=20)


@pytest.fixture
def client(cluster):
    return cluster[1]


@pytest.fixture
def job(tmp_path):
    """Six steps, the last of which is short."""
    job = etendue.load(clusters.write_scene(tmp_path / "scene"))
    with etendue.Render(job) as render:
        job.renderer.samples = 5 * render.samples_per_step + 7
    return job


def test_killed_workers_lose_their_parts_only(cluster, job):
    killed = []

    def kill_some(progress):
        if progress.samples and len(killed) < 3 and clusters.kill_a_worker(cluster[0]):
            killed.append(progress.samples)

    picture = distributed.render(job, cluster[1], part_seconds=0.1, progress=kill_some)
    assert len(killed) == 3
    assert clusters.same(picture, etendue.render(job))


def test_what_has_arrived_stays_and_is_continued(client, job, tmp_path):
    expected = etendue.render(job)
    checkpoint = tmp_path / "state"
    seen = []

    def interrupt(progress):
        if progress.samples:
            seen.append(progress)
            raise KeyboardInterrupt

    with etendue.Render(job) as render:
        with pytest.raises(KeyboardInterrupt):
            distributed.run(render, client, progress=interrupt, checkpoint=checkpoint)
        assert 0 < render.progress.samples == seen[0].samples < job.renderer.samples
        with etendue.Render(etendue.copy(job)) as other:
            other.load(checkpoint)
            assert other.samples_done == render.samples_done
        assert distributed.run(render, client) == "samples"
        assert clusters.same(render.snapshot(), expected)


def test_steps_and_limits(client, job):
    with etendue.Render(job) as render:
        size = render.samples_per_step
        distributed.run(render, client, steps=(2, 4))
        assert render.samples_done == [(2 * size, 4 * size)]
        assert distributed.run(render, client, error=10) == "error"
        with pytest.raises(etendue.Error, match="no steps 3 to 99"):
            distributed.run(render, client, steps=(3, 99))


def test_nothing_is_left_on_the_cluster(client, job):
    distributed.render(job, client)
    deadline = time.monotonic() + 20
    while client.run_on_scheduler(lambda dask_scheduler: len(dask_scheduler.tasks)):
        assert time.monotonic() < deadline
        time.sleep(0.05)


def test_frames_are_whole_pictures_of_any_algorithm(client, job):
    jobs = []
    for renderer in ("PathTracer", "GuidedPathTracer", "PathTracer"):
        frame = etendue.copy(job)
        frame.renderer = renderer + " { samples: 4 }"
        frame.seed = len(jobs)
        jobs.append(frame)
    found = dict(distributed.frames(iter(jobs), client))
    assert sorted(found) == [0, 1, 2]
    for number, frame in enumerate(jobs):
        assert clusters.same(found[number], etendue.render(frame))


def test_a_worker_with_another_file_is_refused(client, job, tmp_path):
    clusters.write_scene(tmp_path / "other", grey=0.6)
    with pytest.raises(etendue.Error, match=f"on host '{socket.gethostname()}': .*the contents of 'grey.csv' differ"):
        distributed.render(job, client, folder=tmp_path / "other")
    clusters.write_scene(tmp_path / "copy")
    assert distributed.render(job, client, folder=tmp_path / "copy").width == 48


def test_algorithms_with_memory_are_refused(client, job):
    with pytest.raises(etendue.Error, match="GuidedPathTracer learns from one step to the next"):
        distributed.render(job, client, renderer="GuidedPathTracer", samples=8)


def test_what_is_no_client_is_refused(job, monkeypatch):
    with pytest.raises(etendue.Error, match="client is a dask.distributed.Client, not 'tcp://x'"):
        distributed.render(job, "tcp://x")
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(etendue.Error, match=r"pip install etendue\[distributed\]"):
        distributed.render(job, None)


def test_a_comparison_is_that_of_one_process(cluster, job, tmp_path):
    """Errors over samples to the last digit, also where workers die; the runs that were kept are used again."""
    others = {"one bounce": {"renderer.max_depth": 1}}
    how = {"variants": others, "samples": 4, "runs": 3, "size": (24, 16), "seed": 5}
    alone = etendue.compare(job, ["PathTracer", etendue.LightTracer()], **how)
    killed, told = [], []

    def kill_one(fraction, what):
        told.append(fraction)
        if fraction > 0.3 and not killed and clusters.kill_a_worker(cluster[0]):
            killed.append(what)

    kept = tmp_path / "runs"
    found = distributed.compare(job, cluster[1], ["PathTracer", etendue.LightTracer()], state=kept, progress=kill_one, **how)
    assert killed and told == sorted(told) and told[-1] == 1
    errors = [[(p.samples, p.relative_mean_square_error) for p in row.curve] for row in found]
    assert errors == [[(p.samples, p.relative_mean_square_error) for p in row.curve] for row in alone]
    assert [row.name for row in found] == [row.name for row in alone]
    assert len(list(kept.glob("*.run"))) == 9 and not list(kept.glob("*.part"))
    (kept / "scene1-variant2-run3.run").unlink()
    again = distributed.compare(job, cluster[1], ["PathTracer", etendue.LightTracer()], state=kept, **how)
    assert [[(p.samples, p.relative_mean_square_error) for p in row.curve] for row in again] == errors
    with pytest.raises(etendue.Error, match="of another comparison"):
        distributed.compare(job, cluster[1], ["PathTracer"], samples=4, runs=3, state=kept)


def test_a_comparison_that_is_interrupted_keeps_its_runs(client, job, tmp_path):
    kept = tmp_path / "runs"

    def interrupt(fraction, what):
        if fraction > 0.4:
            raise KeyboardInterrupt

    how = {"samples": 2, "runs": 4, "size": (24, 16), "state": kept}
    with pytest.raises(KeyboardInterrupt):
        distributed.compare(job, client, ["PathTracer", "LightTracer"], progress=interrupt, **how)
    assert 3 < len(list(kept.glob("*.run"))) < 8
    assert len(etendue.compare(job, ["PathTracer", "LightTracer"], **how)) == 2


def test_a_comparison_says_what_is_wrong(client, job):
    with pytest.raises(etendue.Error, match="NoSuchTracer"):
        distributed.compare(job, client, ["NoSuchTracer"], samples=2)
    with pytest.raises(etendue.Error, match="give one of time="):
        distributed.compare(job, client, ["PathTracer"])
    with pytest.raises(etendue.Error, match="reference_time"):
        distributed.compare(job, client, ["WhittedRenderer"], samples=2, reference_time=1)
