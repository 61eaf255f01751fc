"""The laboratory: verify, compare and conform give tables, of jobs made of parts as of files, and end at Ctrl-C."""

import json
import os
import pathlib
import signal
import subprocess
import sys
import threading
import time

import numpy
import pytest

import etendue

SCENE = str(pathlib.Path(__file__).resolve().parents[2] / "scenes/cornell_box.etd")


def small_job(size=16):
    """A ball under an environment, made of parts."""
    return etendue.Job(
        renderer=etendue.PathTracer(samples=16),
        camera=etendue.PerspectiveCamera(from_=(0, -4, 1), to=(0, 0, 0)),
        scene=etendue.BvhScene(
            objects=[
                etendue.Sphere(shader=etendue.Lambertian()),
                etendue.Environment(emission=etendue.DiffuseEmission(radiance=1)),
            ]
        ),
        image=etendue.ImageBuffer(width=size, height=size),
    )


def test_verify_of_a_job_of_parts():
    job = small_job()
    before = etendue.copy(job)
    result = etendue.verify(job, ["PathTracer", etendue.PathTracer(next_event=False)], samples=64, seed=3)
    assert etendue.equal(job, before)  # left as it was
    assert result.agree and len(result) == 1
    assert [r.name for r in result.renderers] == ["PathTracer", "PathTracer(next_event=False)"]
    assert (result[0].a, result[0].b) == ("PathTracer", "PathTracer(next_event=False)")
    assert result.renderers[0].passes == 16 and result.renderers[0].samples == 64 * 16 * 16
    assert "significance 0.01 for all of them together" in str(result)
    assert len(result[0].layers[0].tiles["z"]) == len(result.tiles)
    assert "<table>" in result._repr_html_()
    assert result.columns()["a"] == ["PathTracer"]


def test_verify_finds_what_is_injected():
    result = etendue.verify(small_job(), {"one": "PathTracer", "other": "PathTracer"}, samples=64, inject=1.5, seed=1)
    assert not result.agree and result[0].verdict == "DISAGREE"
    whole = [t for t in result[0].disagreements if t.whole_picture and t.length == 0 and t.channel == "Y"]
    assert whole and abs(whole[0].ratio - 1.5) < 0.05


def test_verify_of_renderers_written_in_python():
    """These do not report light by path length, so all lengths together are compared."""
    from parts_examples import ArrayTracer, DarkTracer

    job = small_job()
    right = etendue.verify(job, ["PathTracer", ArrayTracer(max_depth=64)], samples=64, seed=2)
    assert right.agree and not right[0].by_length and {layer.name[:11] for layer in right[0].layers} == {"all lengths"}
    wrong = etendue.verify(job, ["PathTracer", DarkTracer(max_depth=64)], samples=64, seed=2)
    assert not wrong.agree and wrong[0].verdict == "DISAGREE"


def test_verify_of_all_lengths_together():
    result = etendue.verify(small_job(), ["PathTracer", etendue.PathTracer(next_event=False)], samples=16, lengths=0)
    assert {layer.name[:11] for layer in result[0].layers} == {"all lengths"}


@pytest.mark.skipif("ETENDUE_PROGRAM" not in os.environ, reason="needs the program")
def test_verify_equals_the_program():
    arguments = ["--renderers", "PathTracer,PathTracer{next_event: false}", "--size", "16x16", "--samples", "16", "--json", "--seed", "5"]
    program = subprocess.run([os.environ["ETENDUE_PROGRAM"], "verify", SCENE, *arguments], capture_output=True, text=True)
    expected = json.loads(program.stdout)
    result = etendue.verify(SCENE, "PathTracer,PathTracer{next_event: false}".split(","), size=(16, 16), samples=16, seed=5)
    assert [r.mean for r in result.renderers] == [r["mean"] for r in expected["renderers"]]
    assert result[0].layers[0].tiles == expected["pairs"][0]["layers"][0]["tiles"]
    assert result.agree == expected["agree"]


def test_compare_jobs_and_variants():
    dark = small_job()
    dark.scene.objects[0].shader = etendue.Lambertian(color=0.2)
    seen = []
    result = etendue.compare(
        {"bright": small_job(), "dark": dark},
        ["PathTracer", etendue.PathTracer(next_event=False)],
        variants={"short": {"renderer.max_depth": 2}},
        samples=4,
        runs=3,
        seed=1,
        progress=lambda fraction, what: seen.append((fraction, what)),
    )
    assert [(r.scene, r.name) for r in result][:3] == [("bright", n) for n in ("PathTracer", "PathTracer(next_event=False)", "short")]
    assert len(result) == 6 and len(result.scenes) == 2
    row = result[0]
    error = row.at_equal_samples.relative_mean_square_error
    assert error.band[0] < error.value < error.band[1]
    assert len(row.at_equal_samples.runs) == 3
    assert [p.samples for p in row.curve] == [1, 2, 4]
    assert len(result.curves) == 18 and result.curves[0].scene == "bright"
    assert len(result.contests_at_equal_samples) == 6
    assert "at_equal_time.relative_mean_square_error.value" in result.columns()
    assert "falls with time" in str(result)
    assert result.csv.startswith("scene,variant,samples,processor_seconds,relative_mean_square_error")
    assert seen and all(0 <= f <= 1 for f, _ in seen)


def test_compare_with_a_reference_finds_bias():
    job = small_job(8)
    reference = numpy.full((8, 8, 3), 10.0)  # nothing is as bright
    result = etendue.compare(job, "PathTracer", samples=4, runs=3, reference=reference)
    assert result[0].bias.found
    assert result.scenes[0].reference_relative_variance is None
    assert "taken as exact" in result.scenes[0].reference


def test_compare_goes_on_from_a_folder(tmp_path):
    options = dict(samples=2, runs=3, state=tmp_path / "runs")
    first = etendue.compare(small_job(8), ["PathTracer", "PathTracer{next_event: false}"], **options)
    second = etendue.compare(small_job(8), ["PathTracer", "PathTracer{next_event: false}"], **options)
    assert [r.at_equal_samples for r in first] == [r.at_equal_samples for r in second]
    assert [r.wall_seconds for r in first] == [r.wall_seconds for r in second]  # not rendered again


def test_reports(tmp_path):
    etendue.verify(small_job(8), ["PathTracer", "PathTracer{next_event: false}"], samples=16, report=tmp_path / "v.html")
    etendue.compare(small_job(8), "PathTracer", samples=2, runs=3, report=tmp_path / "c.html")
    etendue.conform("Sphere", drawn=0, report=tmp_path / "f.html")
    for name in ("v", "c", "f"):
        assert "<html" in (tmp_path / f"{name}.html").read_text()


def test_conform():
    result = etendue.conform(etendue.Sphere, drawn=0, seeds=(1, 2))
    assert result.passed and not result.failures
    assert {r.class_name for r in result} == {"Sphere"} and {r.seed for r in result} == {1, 2}
    assert str(result).count("1 classes, ") == 2


@pytest.mark.parametrize(
    "call, words",
    [
        (lambda: etendue.verify(small_job(), "PathTracr"), "did you mean 'PathTracer'?"),
        (lambda: etendue.verify(small_job(), ["Sphere"]), "is no renderer"),
        (lambda: etendue.verify(small_job(), ["PathTracer"]), "there is only PathTracer"),
        (lambda: etendue.verify(small_job(), ["PathTracer", "PathTracer"]), "is named twice"),
        (lambda: etendue.verify(small_job(), passes=2), "passes must be from 8"),
        (lambda: etendue.verify(etendue.Sphere()), "expects a Job"),
        (lambda: etendue.verify("nowhere.etd"), "nowhere.etd"),
        (lambda: etendue.compare(small_job(), "PathTracer"), "give one of time="),
        (lambda: etendue.compare(small_job(), samples=4), "nothing to compare"),
        (lambda: etendue.compare(small_job(), variants={"a": {"renderer.max_dept": 4}}, samples=4), "max_depth"),
        (lambda: etendue.compare(small_job(), "PathTracer", samples=4, reference="x.exr"), "reference: "),
        (lambda: etendue.compare(small_job(), "PathTracer", samples=4, reference=numpy.ones((2, 2, 3))), "has 2 x 2 pixels"),
        (lambda: etendue.compare(small_job(), "FeatureRenderer", samples=4), "give reference, or add a variant"),
        (lambda: etendue.conform("Sfere"), "there is no class 'Sfere'"),
    ],
)
def test_errors_name_the_argument(call, words):
    with pytest.raises(etendue.Error) as error:
        call()
    assert words in str(error.value)
    assert "--" not in str(error.value)


@pytest.mark.parametrize(
    "call",
    [
        lambda job: etendue.verify(job, ["PathTracer", "PathTracer{next_event: false}"], samples=1 << 20),
        lambda job: etendue.compare(job, "PathTracer", samples=1 << 20),
    ],
)
def test_interrupt(call):
    """Ctrl-C ends it within a second or so, and raises KeyboardInterrupt."""
    job = small_job(64)
    timer = threading.Timer(0.3, lambda: signal.raise_signal(signal.SIGINT))
    began = time.monotonic()
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        call(job)
    assert time.monotonic() - began < 20


def test_an_exception_of_progress_ends_it():
    def progress(fraction, what):
        raise ValueError("enough")

    with pytest.raises(ValueError, match="enough"):
        etendue.compare(small_job(64), "PathTracer", samples=1 << 20, progress=progress)


def test_other_threads_run_meanwhile():
    counted = 0
    stop = threading.Event()

    def count():
        nonlocal counted
        while not stop.is_set():
            counted += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    try:
        etendue.compare(small_job(32), "PathTracer", samples=64, runs=3)
    finally:
        stop.set()
        thread.join()
    assert counted > 20


def test_pandas():
    pandas = pytest.importorskip("pandas")
    frame = etendue.compare(small_job(8), "PathTracer", samples=2, runs=3).curves.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and len(frame) == 2
    assert frame["relative_mean_square_error.value"].dtype == float


def test_plots(tmp_path):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    compared = etendue.compare(small_job(8), "PathTracer", samples=4, runs=3)
    axes = compared.plot()
    assert axes.get_xscale() == "log" and axes.get_yscale() == "log"
    assert len(axes.lines) == 1 and len(axes.collections) == 1  # a line and its band
    etendue.verify(small_job(8), ["PathTracer", "PathTracer{next_event: false}"], samples=16).plot()
    etendue.conform("Sphere", drawn=0).plot()
    with pytest.raises(etendue.Error, match="over is 'time' or 'samples'"):
        compared.plot(over="tme")


def test_without_pandas_and_matplotlib_is_said():
    result = etendue.conform("Sphere", drawn=0)
    for module, call in (("pandas", result.to_pandas), ("matplotlib.pyplot", result.plot)):
        hidden = {name: sys.modules.get(name) for name in (module, module.partition(".")[0])}
        sys.modules.update({name: None for name in hidden})
        try:
            with pytest.raises(ImportError, match="pip install"):
                call()
        finally:
            for name, was in hidden.items():
                sys.modules.pop(name) if was is None else sys.modules.__setitem__(name, was)
