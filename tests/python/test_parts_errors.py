"""What goes wrong in a method of Python names class, method and line, and ends what called it."""

import subprocess
import sys
import textwrap

import numpy as np
import pytest

import etendue

SCENE = """Job {
  camera: PerspectiveCamera { from: [0, 0, -4] m, to: [0, 0, 0] }, image: ImageBuffer { width: 12, height: 12 }
  renderer: SimplePathTracer { samples: 2 }
  scene: BruteForceScene { objects: [ Sphere { shader: Lambertian { color: 0.5 } }, Environment { emission: EnvironmentEmission {} } ] }
}"""


class Fickle(etendue.ObjectMap):
    """A map that returns what it is told to."""

    _result = 0.5

    def scalar(self, point):
        result = type(self)._result
        return result(point) if callable(result) else result


def picture(color=None, threads=2, **parts):
    job = etendue.loads(SCENE)
    if color is not None:
        job["scene.objects[0].shader.color"] = color
    for name, part in parts.items():
        setattr(job, name, part)
    return etendue.render(job, threads=threads)


def test_it_renders():
    Fickle._result = 0.5
    plain = picture()
    assert np.array_equal(plain, picture(Fickle()))
    Fickle._result = lambda point: point.uv[0]
    assert not np.allclose(plain, picture(Fickle()))


@pytest.mark.parametrize("threads", [1, 2])
def test_an_exception_becomes_an_error(threads):
    Fickle._result = lambda point: 1 / 0
    with pytest.raises(etendue.Error, match="Fickle.scalar raised ZeroDivisionError: division by zero") as raised:
        picture(Fickle(), threads)
    assert isinstance(raised.value.__cause__, ZeroDivisionError)
    fault = raised.value.faults[0]
    assert fault.file == __file__ and "1 / 0" in open(__file__).read().splitlines()[fault.line - 1]


@pytest.mark.parametrize("result", [float("nan"), float("inf"), 1e300, "0.5", None, (1, 2), np.zeros(3)])
def test_wrong_numbers_are_refused(result):
    Fickle._result = result
    with pytest.raises(etendue.Error, match="Fickle.scalar returned .*; it must return a finite number") as raised:
        picture(Fickle())
    assert raised.value.faults[0].file == __file__


@pytest.mark.parametrize("result", [np.float32(0.5), np.float64(0.5), np.array(0.5), 1, True])
def test_all_kinds_of_numbers_are_read(result):
    Fickle._result = result
    picture(Fickle())


def test_an_error_of_the_package_keeps_its_text():
    class Picky(etendue.ObjectMap):
        """A map that fails in prepare."""

        level: float = etendue.member(1, text="the value")

        def prepare(self):
            self.fail("level", "is not liked")

        def scalar(self, point):
            return 1

    with pytest.raises(etendue.Error) as raised:
        picture(Picky(level=2))
    assert raised.value.message == "Picky.level: is not liked"
    assert raised.value.faults[0].file == __file__


def test_keyboard_interrupts_are_not_errors():
    def interrupt(point):
        raise KeyboardInterrupt

    Fickle._result = interrupt
    with pytest.raises(KeyboardInterrupt):
        picture(Fickle())
    Fickle._result = 0.5
    picture(Fickle())


class Told(etendue.Renderer):
    """A renderer that returns what it is told to."""

    def radiance(self, context, rays, samples):
        type(self)._kept = context, rays, samples
        return type(self)._result(len(rays))


@pytest.mark.parametrize(
    "result", [lambda n: np.zeros((n, 7)), lambda n: np.zeros(n), lambda n: None, lambda n: [[0] * 8] * n, lambda n: np.zeros((n + 1, 8))]
)
def test_wrong_shapes_are_refused(result):
    Told._result = result
    with pytest.raises(etendue.Error, match=r"Told.radiance returned .*; it must return an array of shape \(\d+, 8\)"):
        picture(renderer=Told(samples=2))


def test_numbers_that_are_not_finite_are_refused():
    Told._result = lambda n: np.full((n, 8), np.nan)
    with pytest.raises(etendue.Error, match="Told.radiance returned nan for ray 0 at wavelength 0"):
        picture(renderer=Told(samples=2))


def test_rays_are_refused_after_their_call():
    Told._result = lambda n: np.zeros((n, 8))
    assert not np.array(picture(renderer=Told(samples=2))).any()
    context, rays, samples = Told._kept
    for use in (lambda: context.intersect(rays), lambda: samples.uniform(1), lambda: context.scene):
        with pytest.raises(etendue.Error, match="only within the call"):
            use()
    assert len(rays) > 0 and rays.direction.shape == (len(rays), 3)


def test_a_tone_map_must_keep_the_shape():
    class Cut(etendue.ToneMap):
        """A tone map that loses a row."""

        def map(self, xyz):
            return xyz[1:]

    found = etendue.conform(Cut, drawn=0)
    assert any("Cut.map returned an array of shape" in o.detail for o in found if o.result == "failed")


def test_a_point_can_be_kept():
    kept = []

    def keep(point):
        kept.append(point)
        return 0.5

    Fickle._result = keep
    picture(Fickle())
    assert len(kept[0].dpdu) == 3 and kept[0].uv != kept[-1].uv


def run(code):
    return subprocess.run([sys.executable, "-X", "faulthandler", "-c", textwrap.dedent(code)], capture_output=True, text=True, timeout=100)


@pytest.mark.parametrize("work", ["etendue.render(job, samples=1)", "etendue.conform('Slow')", "etendue.loads(text)"])
def test_the_interpreter_ends_while_a_thread_comes_back(work):
    """A daemon thread that takes the interpreter's lock too late would be unwound through frames of C++."""
    done = run(
        f'''
        import etendue, threading, time
        class Slow(etendue.ObjectMap):
            """A map."""
            def prepare(self):
                time.sleep(0.2)
            def scalar(self, point):
                return 0.5
        text = ("Job {{ camera: PerspectiveCamera {{ from: [0,0,-4] m, to: [0,0,0] m }}, image: ImageBuffer {{ width: 8, height: 8 }},"
            "renderer: SimplePathTracer {{ samples: 4 }}, scene: BruteForceScene {{ objects: ["
            "Sphere {{ shader: Lambertian {{ color: Slow {{}} }} }}, Environment {{ emission: EnvironmentEmission {{}} }} ] }} }}")
        def loop():
            while True:
                try:
                    job = etendue.loads(text)
                    {work}
                except etendue.Error:
                    pass
        for _ in range(3):
            threading.Thread(target=loop, daemon=True).start()
        time.sleep(0.5)
        '''
    )
    assert done.returncode == 0, (done.returncode, done.stderr)
    assert "terminate" not in done.stderr


def test_the_interpreter_ends_while_parts_live():
    done = run(
        '''
        import etendue, threading
        class Slow(etendue.ObjectMap):
            """A map."""
            def scalar(self, point):
                return 0.5
        kept = etendue.Lambertian(color=Slow())
        job = etendue.loads("Job { camera: PerspectiveCamera { from: [0,0,-4] m, to: [0,0,0] m }, image: ImageBuffer { width: 64, height: 64 },"
            "renderer: SimplePathTracer { samples: 4096 }, scene: BruteForceScene { objects: ["
            "Sphere { shader: Lambertian { color: Slow {} } }, Environment { emission: EnvironmentEmission {} } ] } }")
        def work():
            try:
                etendue.render(job)
            except etendue.Error as e:
                print(e)
        threading.Thread(target=work, daemon=True).start()
        import time; time.sleep(0.5)
        print("end", flush=True)
        '''
    )
    assert done.returncode == 0, (done.returncode, done.stderr)
    assert done.stdout.startswith("end")
