"""Rendering: the bits of the program's pictures, limits, edits, states, interruptions, threads, memory."""

import ctypes
import gc
import os
import pathlib
import signal
import subprocess
import sys
import threading
import time
import warnings

import numpy as np
import pytest

import etendue

ROOT = pathlib.Path(__file__).parents[2]
SCENES = ROOT / "scenes"
# Twenty small ones: algorithms, media, lenses, meshes, constructive solids, textures, measured metals.
SAME_SCENES = [
    *(
        f"scenes/{name}"
        for name in "cloister cornell_box csg depth_of_field forest glass_caustic glass_of_water gold_figure metals misty_meadow"
        " shader_ball small_vcm teapot window_room".split()
    ),
    *(f"tests/references/exports/{name}" for name in "glass textures shapes emitters media metals".split()),
]

SMALL = """
grey = Lambertian { color: 0.5 }
key = Sphere { centre: [0, 3, 0] m, radius: 0.5 m, emission: DiffuseEmission { radiance: 5 } }
fill = Sphere { centre: [-3, 0, -1] m, radius: 0.5 m, emission: DiffuseEmission { radiance: 2 } }
Job {
    renderer: PathTracer { samples: 8, max_depth: 4 }
    camera: PerspectiveCamera { from: [0, 0, -5] m, to: [0, 0, 0] m, fov: 40 deg }
    image: ImageBuffer { width: 16, height: 12, filter: BoxFilter {} }
    scene: BvhScene { objects: [
        Sphere { radius: 1 m, shader: grey }
        TriangleMesh { positions: [[-4, -1, -4], [4, -1, -4], [0, -1, 6]] m, triangles: [[0, 1, 2]], shader: grey }
        key
        fill
    ] }
}
"""


def small_job(**changes):
    job = etendue.loads(SMALL)
    for path, value in changes.items():
        job[path.replace("__", ".")] = value
    return job


def long_job():
    """Renders for minutes, in steps of a second or so."""
    return small_job(renderer__samples=1 << 20, image__width=512, image__height=512)


def same(a, b):
    return a.pixels.shape == b.pixels.shape and a.pixels.tobytes() == b.pixels.tobytes()


def program():
    """The program beside the library that the package uses; None: there is none."""
    maps = pathlib.Path("/proc/self/maps").read_text()
    folder = next(line.split()[-1] for line in maps.splitlines() if "libetendue.so" in line)
    found = pathlib.Path(folder).parent / "etendue"
    return found if found.exists() else None


def run_python(text, **environment):
    """Runs a program of its own; returns what it prints."""
    path = os.pathsep.join([str(pathlib.Path(etendue.__file__).parents[1]), *sys.path])
    done = subprocess.run(
        [sys.executable, "-c", text],
        env={**os.environ, "PYTHONPATH": path, **environment},
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


# ---- the program's pictures ---------------------------------------------------------------------------------------------------


@pytest.mark.skipif(program() is None, reason="needs the program beside the library")
@pytest.mark.parametrize("scene", SAME_SCENES)
def test_bytes_of_the_program(scene, tmp_path):
    file = ROOT / f"{scene}.etd"
    image = etendue.render(file, samples=2, size=(20, 14), seed=5, warn=False)
    npy = tmp_path / "picture.npy"
    options = ["--samples", "2", "--size", "20x14", "--seed", "5", "--quiet"]
    subprocess.run([program(), "render", file, *options, "-o", npy], check=True)
    written = np.load(npy)
    assert image.pixels.shape == written.shape
    assert image.pixels.tobytes() == written.tobytes()


@pytest.mark.skipif(program() is None, reason="needs the program beside the library")
def test_png_of_the_program(tmp_path):
    file = SCENES / "cornell_box.etd"
    png = tmp_path / "picture.png"
    options = ["--samples", "4", "--size", "32x32", "--quiet"]
    subprocess.run([program(), "render", file, *options, "-o", png], check=True)
    image = etendue.render(file, samples=4, size=(32, 32))
    plain = etendue.NoToneMap()
    assert (etendue.read_image(png).to_uint8(plain) == image.to_uint8()).all()


def test_threads_do_not_matter():
    assert same(etendue.render(small_job(), threads=1), etendue.render(small_job(), threads=2))


# ---- render -------------------------------------------------------------------------------------------------------------------


def test_overrides_leave_the_job():
    job = small_job()
    before = etendue.dumps(job, all=True)
    renderer = job.renderer
    image = etendue.render(
        job, samples=3, seed=7, size=(9, 5), layers=["depth"], renderer="LightTracer", changes={"camera.fov": 20}, time=1000
    )
    assert etendue.dumps(job, all=True) == before and job.renderer is renderer
    assert image.shape == (5, 9, 4)
    assert image.metadata["samples"] == "3" and image.metadata["seed"] == "7" and image.metadata["renderer"] == "LightTracer"
    changed = small_job(renderer=etendue.LightTracer(samples=3), seed=7, camera__fov=20)
    changed.image.width, changed.image.height, changed.image.layers = 9, 5, ["depth"]
    assert same(image, etendue.render(changed))


def test_limits_without_samples_are_open_ended():
    job = small_job(renderer__samples=1)
    image = etendue.render(job, error=0.2)
    assert int(image.metadata["samples"]) > 1
    with pytest.raises(etendue.Error, match="no limit"):
        etendue.render(job, error=0)
    with pytest.raises(etendue.Error, match="samples"):
        etendue.render(job, samples=0)


def test_what_the_program_warns_of_is_a_warning():
    dark = "\n".join(line for line in SMALL.splitlines() if line.strip().split(" ")[0] not in ("key", "fill"))
    with pytest.warns(etendue.Warning, match="nothing emits light"):
        etendue.render(etendue.loads(dark), samples=1)
    with pytest.warns(etendue.Warning, match="the picture is black"):
        etendue.render(etendue.loads(dark), samples=1)
    with pytest.warns(etendue.Warning, match="sees none of the objects"):
        etendue.Render(small_job(camera__from=(0, 0, -50), camera__to=(0, 0, -90))).close()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        etendue.render(etendue.loads(dark), samples=1, warn=False)
        etendue.render(small_job(), samples=1)
        job = etendue.loads(dark)
        with pytest.raises(etendue.Warning):
            etendue.render(job, samples=1)
        etendue.render(job, samples=1, warn=False)  # the failed render has left the job free


def test_written_pictures_name_their_files_by_a_hash(tmp_path):
    def hash_of(job, name):
        job.outputs = [etendue.PngOutput()]
        etendue.render(job, samples=1, outputs=tmp_path / name)
        return etendue.read_image(tmp_path / f"{name}.png").metadata["file_hash"]

    first = hash_of(small_job(), "a")
    assert len(first) == 16 and first == hash_of(small_job(), "b") != hash_of(small_job(camera__fov=41), "c")


def test_a_size_does_not_move_a_crop():
    job = small_job(image__crop=[2, 2, 8, 8])
    with pytest.raises(etendue.Error, match="crop"):
        etendue.render(job, size=(4, 4))
    assert etendue.render(job).shape == (6, 6, 3)


def test_nothing_is_written_unless_asked(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "small.etd").write_text(SMALL.replace("scene: Bvh", "outputs: [PngOutput {}, NpyOutput {}]\n    scene: Bvh"))
    job = etendue.load("small.etd")
    etendue.render(job)
    assert os.listdir(tmp_path) == ["small.etd"]
    image = etendue.render(job, outputs=True)
    assert sorted(os.listdir(tmp_path)) == ["small.etd", "small.npy", "small.png"]
    assert np.load("small.npy").tobytes() == image.pixels.tobytes()
    os.mkdir("folder")
    etendue.render(job, outputs="folder")
    etendue.render(job, outputs="folder/other")
    assert sorted(os.listdir("folder")) == ["other.npy", "other.png", "small.npy", "small.png"]
    with pytest.raises(etendue.Error, match="no outputs"):
        etendue.render(small_job(), outputs=True)


def test_outputs_are_checked_before_the_render(tmp_path):
    job = long_job()
    job.outputs = [etendue.NpyOutput(file=str(tmp_path / "none" / "a.npy"))]
    with pytest.raises(etendue.Error, match="a.npy"):
        etendue.render(job, outputs=True)


def test_wrong_arguments():
    with pytest.raises(etendue.Error, match="Job"):
        etendue.render(etendue.Sphere())
    with pytest.raises(etendue.Error, match="int"):
        etendue.render(3)
    with pytest.raises(etendue.Error, match="progress"):
        etendue.render(small_job(), progress="bar")
    with pytest.raises(etendue.Error, match="threads"):
        etendue.render(small_job(), threads=-1)
    with pytest.raises(etendue.Error) as failed:
        etendue.render(small_job(camera=None))
    assert "camera" in str(failed.value)


def test_checkpoint(tmp_path):
    file = tmp_path / "state"
    etendue.render(small_job(), samples=4, checkpoint=file)
    assert file.exists()
    continued = etendue.render(small_job(), samples=8, checkpoint=file)
    assert same(continued, etendue.render(small_job(), samples=8))
    with pytest.raises(etendue.Error, match="cannot continue"):
        etendue.render(small_job(camera__fov=10), samples=8, checkpoint=file)


# ---- Render -------------------------------------------------------------------------------------------------------------------


def test_run_until():
    job = small_job(image__width=300, image__height=300)  # small steps
    with etendue.Render(job) as render:
        step = render.samples_per_step
        assert step < 8
        assert render.run(samples=3) == "samples"
        assert render.samples_done == [(0, 3)] and render.progress.samples == 3
        assert job.renderer.samples == 8, "the job's own limits are put back"
        assert render.run(samples=2) == "samples" and render.progress.samples == 3
        assert render.run(error=10.0) == "error"
        assert render.run() == "samples" and render.progress.samples == 8
        assert render.run(samples=9) == "samples" and job.renderer.samples == 9
        whole = render.snapshot()
        assert render.run(seconds=1e-6) == "time" and job.renderer.samples == render.progress.samples > 9
        assert job.time_limit == 0 and job.error_limit == 0
        for wrong in ({"samples": 0}, {"seconds": 0}, {"error": -1}):
            with pytest.raises(etendue.Error):
                render.run(**wrong)
    assert same(whole, etendue.render(job, samples=9))


def test_steps_and_snapshots():
    job = small_job(image__width=300, image__height=300)
    with etendue.Render(job) as render:
        pictures = list(render)
        assert len(pictures) == 8 // render.samples_per_step
        assert not render.step()
        assert render.progress.samples == 8 and render.progress.fraction == 1
    # Snapshots are independent of the render.
    assert not same(pictures[0], pictures[-1])
    assert same(pictures[-1], etendue.render(job))
    assert same(pictures[0], etendue.render(job, samples=int(pictures[0].metadata["samples"])))
    with pytest.raises(etendue.Error, match="closed"):
        render.snapshot()


def test_restart():
    job = small_job()
    with etendue.Render(job) as render:
        render.run()
        first = render.snapshot()
        render.restart(seed=3)
        assert render.progress.samples == 0 and job.seed == 3
        render.run()
        assert not same(first, render.snapshot())
        assert same(render.snapshot(), etendue.render(small_job(seed=3)))


def test_states(tmp_path):
    job, file = small_job(image__width=300, image__height=300), tmp_path / "state"
    with etendue.Render(job) as render:
        render.run(samples=4)
        state = render.save()
        assert render.save(file) is None and file.read_bytes() == state
    whole = etendue.render(job)
    for saved in (state, file, str(file)):
        with etendue.Render(job) as render:
            render.load(saved)
            assert render.progress.samples == 4
            render.run()
            assert same(render.snapshot(), whole)
    steps = 8 // render_step_of(job)
    with etendue.Render(job, passes=(0, 1)) as first, etendue.Render(etendue.copy(job), passes=(1, steps)) as second:
        first.run()
        second.run()
        second.add(first.save())
        assert same(second.snapshot(), etendue.render(etendue.copy(job)))
        with pytest.raises(etendue.Error, match="both hold"):
            second.add(first.save())
        with pytest.raises(etendue.Error, match="cannot read"):
            second.add(tmp_path / "none")
        with pytest.raises(etendue.Error):
            second.load(b"nonsense")


def render_step_of(job):
    with etendue.Render(job) as render:
        return render.samples_per_step


def test_replay():
    job = small_job(renderer__samples=1)
    with etendue.Render(job) as render:
        render.run()
        image = render.snapshot()
        path = render.replay(8, 6, 0)
        with pytest.raises(etendue.Error, match="no pixel"):
            render.replay(100, 0, 0)
    assert path.vertices.kind[0] == "camera" and np.allclose(path.vertices.position[0], [0, 0, -5], atol=1e-6)
    n = len(path.vertices)
    assert path.vertices.position.shape == (n, 3) and path.vertices.throughput.shape == (n, len(path.wavelengths))
    assert 8 <= path.film[0] < 9 and 6 <= path.film[1] < 7
    assert np.allclose(path.contributions.value.sum(axis=0), path.result, rtol=1e-4)
    assert (image.pixels[6, 8] > 0).all() == bool(path.result.any())
    assert "vertex 0: camera" in str(path)


# ---- edits --------------------------------------------------------------------------------------------------------------------


def test_setting_a_member_edits_the_living_render():
    job = small_job()
    with etendue.Render(job) as render:
        render.run()
        job.camera.fov = 25
        assert render.progress.samples == 0, "another view starts over"
        render.run()
        assert same(render.snapshot(), etendue.render(small_job(camera__fov=25)))
        job.scene.objects[0].shader = etendue.Lambertian(color=0.9)
        job.scene.objects[0].radius = "50 cm"
        render.run()
        edited = render.snapshot()
        job.renderer.samples = 16
        assert render.progress.samples == 8, "more samples continue"
        job.tone_map.stops = 2
        assert render.progress.samples == 8 and render.snapshot().tone_map.stops == 2
        job.renderer.samples = 8
    assert same(edited, etendue.render(etendue.loads(etendue.dumps(job))))
    job.camera.fov = 90  # a plain member again
    with pytest.raises(etendue.Error, match="closed"):
        render.progress


def test_edits_are_made_all_or_none():
    job = small_job()
    with etendue.Render(job) as render:
        render.run()
        before = etendue.dumps(job)
        with pytest.raises(etendue.Error, match="fov"):
            render.edit({"renderer.max_depth": 2, "camera.fov": -1})
        with pytest.raises(etendue.Error, match="no member|has no"):
            render.edit({"renderer.max_depth": 2, "camera.nonsense": 1})
        with pytest.raises(etendue.Error, match="no part"):
            render.edit([(job.renderer, "max_depth", 2), (etendue.Sphere(), "radius", 1)])
        with pytest.raises(etendue.Error) as failed:
            job.camera.fov = -1
        assert failed.value.faults[0].file == __file__
        assert etendue.dumps(job) == before and render.progress.samples == 8
        render.edit({"renderer.max_depth": 2, "scene.objects[0].radius": 0.5})
        render.edit([(job.camera, "fov", 30)])
        assert job.renderer.max_depth == 2 and job.scene.objects[0].radius == 0.5 and job.camera.fov == 30


def test_lists_that_arrays_view_are_refused():
    job = small_job()
    mesh = job.scene.objects[1]
    with etendue.Render(job) as render:
        positions = mesh.positions
        changed = np.array(positions) + 0.25
        with pytest.raises(etendue.Error, match="array views"):
            mesh.positions = changed
        with pytest.raises(etendue.Error, match="array views"):
            render.edit([(mesh, "positions", changed)])
        del positions
        gc.collect()
        mesh.positions = changed
        assert np.allclose(mesh.positions, changed)
        render.run()
        edited = render.snapshot()
    assert same(edited, etendue.render(etendue.copy(job)))


def test_parts_belong_to_one_render():
    job, other = small_job(), small_job()
    with etendue.Render(job) as render:
        for again in (lambda: etendue.Render(job), lambda: etendue.render(job, samples=1)):
            with pytest.raises(etendue.Error, match="belongs to a render"):
                again()
        with pytest.raises(etendue.Error, match="belongs to a render"):
            etendue.Render(etendue.Job(scene=job.scene, camera=other.camera))
        with etendue.Render(other):
            with pytest.raises(etendue.Error, match="belongs to a render"):
                job.scene.objects = [other.scene.objects[0]]
        with etendue.Render(etendue.copy(job)):
            pass
        shader = etendue.Lambertian(color=0.1)
        job.scene.objects[0].shader = shader
        render.run()
        shader.color = "rgb(0.2, 0.3, 0.4)"
        assert render.progress.samples == 0, "a part that was added is edited, too"
        job.scene.objects[0].shader = job.scene.objects[1].shader
        render.run()
        shader.color = 0.5
        assert render.progress.samples == 8, "a part that was removed is not"
    etendue.render(job)
    render = etendue.Render(job)
    del render  # what nobody refers to is closed
    gc.collect()
    etendue.render(job)


def test_a_job_that_cannot_be_rendered_is_free_again():
    job = small_job(camera=None)
    with pytest.raises(etendue.Error):
        etendue.Render(job)
    job.camera = small_job().camera
    etendue.render(job)


# ---- progress -----------------------------------------------------------------------------------------------------------------


def test_progress_functions():
    told = []
    etendue.render(small_job(), progress=told.append)
    assert told and told[-1].finished and told[-1].samples == 8 and told[-1].fraction == 1
    assert isinstance(told[-1], etendue.Progress) and "100 %" in str(told[-1])


def test_progress_functions_may_use_the_render():
    job = long_job()
    with etendue.Render(job) as render:
        refused, seen = [], []

        def progress(p):
            seen.append((render.progress.samples, render.snapshot().shape))
            for forbidden in (render.run, render.step, render.close):
                with pytest.raises(etendue.Error, match="progress function") as failed:
                    forbidden()
                refused.append(failed.value)
            if len(seen) == 1:
                job.camera.fov = 35  # does not wait for itself
            else:
                render.stop()

        assert render.run(progress=progress) == "interrupted"
        assert len(seen) >= 2 and len(refused) == 3 * len(seen) and job.camera.fov == 35


def test_exceptions_of_progress_functions():
    with etendue.Render(long_job()) as render:

        def progress(p):
            raise ZeroDivisionError("mine")

        begin = time.perf_counter()
        with pytest.raises(ZeroDivisionError, match="mine"):
            render.run(progress=progress)
        assert time.perf_counter() - begin < 20
        assert render.job.renderer.samples == 1 << 20
        assert render.step(), "the abortion is not left for the next step"


def test_a_line_on_a_terminal(capsys, monkeypatch):
    etendue.render(small_job(), progress=True)
    etendue.render(small_job())
    assert capsys.readouterr() == ("", "")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    etendue.render(small_job())
    text = capsys.readouterr().err
    assert "8/8 samples" in text and text.endswith("\r\x1b[K")
    etendue.render(small_job(), progress=False)
    assert capsys.readouterr() == ("", "")


# ---- interruptions ------------------------------------------------------------------------------------------------------------


def interrupt_after(seconds):
    timer = threading.Timer(seconds, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    return timer


def test_control_c_ends_a_step_at_once():
    # One step takes minutes: the render must end in the middle of it.
    job = small_job(renderer__samples=1 << 14, image__width=5, image__height=5)
    job.renderer.max_depth = 200
    job.scene.objects += [etendue.Sphere(centre=(0, 0, 0), radius=50, shader=etendue.Lambertian(color=1))]
    with etendue.Render(job) as render:
        assert render.samples_per_step == 1 << 14
        timer = interrupt_after(0.3)
        begin = time.perf_counter()
        with pytest.raises(KeyboardInterrupt):
            render.run()
        assert time.perf_counter() - begin < 1.5
        timer.join()
        assert render.progress.samples == 0 and render.samples_done == []
        assert not render.snapshot().pixels.any(), "the step leaves nothing"
        assert job.renderer.samples == 1 << 14


def test_control_c_leaves_the_state_whole():
    job = small_job(renderer__samples=64, image__width=300, image__height=300)
    with etendue.Render(job) as render:
        timer = interrupt_after(0.2)
        with pytest.raises(KeyboardInterrupt):
            while True:
                render.run(samples=render.progress.samples + 1)
        timer.join()
        done = render.progress.samples
        if done:
            assert same(render.snapshot(), etendue.render(etendue.copy(job), samples=done))
        render.run(samples=done + 3)
        assert same(render.snapshot(), etendue.render(etendue.copy(job), samples=done + 3))


def test_exceptions_for_other_threads():
    caught = []

    def work():
        with etendue.Render(long_job()) as render:
            try:
                render.run()
            except KeyboardInterrupt:
                caught.append(render.progress)

    thread = threading.Thread(target=work)
    thread.start()
    time.sleep(0.3)
    ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread.ident), ctypes.py_object(KeyboardInterrupt))
    thread.join(timeout=10)
    assert not thread.is_alive() and len(caught) == 1


def test_stop_and_abort_of_another_thread():
    for end, reason in ((etendue.Render.stop, "interrupted"), (etendue.Render.abort, "aborted")):
        with etendue.Render(long_job()) as render:
            timer = threading.Timer(0.2, end, (render,))
            timer.start()
            assert render.run() == reason
            timer.join()


# ---- threads and processes ----------------------------------------------------------------------------------------------------


def test_other_threads_go_on():
    with etendue.Render(long_job(), threads=1) as render:
        thread = threading.Thread(target=render.run)
        thread.start()
        time.sleep(0.1)
        # A run that kept the interpreter's lock while it waits would stop this loop for 50 ms twenty times a second.
        pauses, last = 0, time.perf_counter()
        end = last + 1
        while last < end:
            now = time.perf_counter()
            pauses += now - last > 0.04
            last = now
        with pytest.raises(etendue.Error, match="another thread"):
            render.run()
        render.abort()
        thread.join()
    assert pauses < 5


def test_eight_threads():
    """Renders and edits of different jobs at once, while every thread reads the jobs of all others."""
    jobs = [small_job(seed=n) for n in range(8)]
    failures = []

    def work(n):
        try:
            for turn in range(3):
                with etendue.Render(jobs[n], threads=1) as render:
                    editor = threading.Thread(target=edit, args=(n, turn))
                    editor.start()
                    render.run()
                    editor.join()
                    for other in jobs:
                        repr(other.camera.fov), len(other.scene.objects), other.scene.objects[0].radius
                    render.run()
                    image = render.snapshot()
                alone = etendue.render(etendue.loads(etendue.dumps(jobs[n])), threads=1)
                assert same(image, alone)
        except BaseException as e:
            failures.append(e)

    def edit(n, turn):
        try:
            for value in range(5):
                jobs[n].camera.fov = 20 + turn + value
                jobs[n].scene.objects[0].radius = 0.5 + 0.1 * value
                jobs[n].scene.objects[1].positions = np.array([[-4, -1, -4], [4, -1, -4], [0, -1, 6 + value]], float)
        except BaseException as e:
            failures.append(e)

    threads = [threading.Thread(target=work, args=(n,)) for n in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failures


def test_a_forked_process_is_refused():
    text = f"""
import os, sys
import etendue
job = etendue.loads('''{SMALL}''')

def in_child(work):
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            answer = work()
        except etendue.Error as e:
            answer = e.message
        os.write(writer, str(answer).encode())
        os._exit(0)
    os.waitpid(child, 0)
    return os.read(reader, 10000).decode()

# Nothing was used before: the child renders.
print(in_child(lambda: etendue.render(job).shape))
render = etendue.Render(job)
render.run()
print(in_child(lambda: render.snapshot()))
print(in_child(lambda: render.close()))
print(in_child(lambda: etendue.render(etendue.copy(job))))
print(render.snapshot().shape)
"""
    lines = run_python(text).splitlines()
    assert lines[0] == "(12, 16, 3)" and lines[4] == "(12, 16, 3)" and lines[2] == "None"
    assert "before the process was forked" in lines[1] and "forked from one that has rendered" in lines[3]


def test_the_interpreter_ends_during_a_render():
    text = f"""
import threading, time
import etendue
job = etendue.loads('''{SMALL}''')
job.renderer.samples, job.image.width, job.image.height = 1 << 20, 512, 512
render = etendue.Render(job)
threading.Thread(target=render.run, daemon=True).start()
time.sleep(0.3)
print(render.progress.seconds > 0)
"""
    assert run_python(text) == "True\n"


# ---- memory -------------------------------------------------------------------------------------------------------------------


def resident():
    """[bytes]"""
    gc.collect()
    return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


RENDERS = int(os.environ.get("ETENDUE_LEAK_RENDERS", 300))
PARTS = int(os.environ.get("ETENDUE_LEAK_PARTS", 100000))


def test_renders_leave_no_memory():
    def renders(count):
        for _ in range(count):
            image = etendue.render(small_job(image__width=40, image__height=8, renderer__samples=1), progress=lambda p: None)
            assert image.pixels.shape == (8, 40, 3) and image.to_uint8().any()

    renders(RENDERS // 3)
    before = resident()
    renders(RENDERS)
    # The pixels of a picture alone take 7.5 kB.
    assert resident() - before < 1e6 + 100 * RENDERS


def test_parts_leave_no_memory():
    def parts(count):
        for n in range(count):
            sphere = etendue.Sphere(radius=1.5, centre=(n, 0, 0))
            assert sphere.radius == 1.5

    parts(PARTS // 10)
    before = resident()
    parts(PARTS)
    assert resident() - before < 1e6 + PARTS


def test_one_of_many_processes_says_what_to_do_instead(monkeypatch, tmp_path):
    monkeypatch.setenv("OMPI_COMM_WORLD_SIZE", "4")
    monkeypatch.delitem(sys.modules, "distributed.worker", raising=False)
    with pytest.raises(etendue.Error, match="mpirun -n 4 etendue render"):
        etendue.render(small_job())
    with etendue.Render(small_job(), passes=(0, 1)) as part:
        assert part.step()
    monkeypatch.setenv("ETENDUE_MPI", "off")
    assert etendue.render(small_job(), samples=1).pixels.max() > 0
