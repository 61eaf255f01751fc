"""The program with plugins that are written in Python."""

import importlib
import os
import pathlib
import subprocess

import numpy as np
import pytest

PROGRAM = os.environ.get("ETENDUE_PROGRAM")
pytestmark = pytest.mark.skipif(not PROGRAM, reason="needs the program, named by ETENDUE_PROGRAM")

PLUGIN = '''
import etendue

class HalfMap(etendue.ObjectMap):
    """One number everywhere, which a plugin gives."""

    value: float = etendue.member(0.5, range=(0, 1), text="the number")

    def scalar(self, point):
        return self.value
'''

SCENE = """
Job {
    renderer: PathTracer { samples: 4, max_depth: 3 }
    camera: PerspectiveCamera { from: [0, 0, -5] m, to: [0, 0, 0] m, fov: 40 deg }
    image: ImageBuffer { width: 12, height: 8, filter: BoxFilter {} }
    scene: BvhScene { objects: [
        Sphere { radius: 1 m, shader: Lambertian { color: COLOR } }
        Environment { emission: EnvironmentEmission {} }
    ] }
}
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "half.py").write_text(PLUGIN)
    (tmp_path / "half.etd").write_text(SCENE.replace("COLOR", "HalfMap {}"))
    (tmp_path / "plain.etd").write_text(SCENE.replace("COLOR", "0.5"))
    return tmp_path


def run(folder, *arguments, **environment):
    environment = {**os.environ, **environment}
    environment.pop("PYTHONPATH", None)  # the program finds the package beside itself
    tools = pathlib.Path(PROGRAM).parent / "python-tools"
    if tools.is_dir():
        environment["PYTHONPATH"] = str(tools)  # numpy
    return subprocess.run([PROGRAM, *arguments], cwd=folder, env=environment, capture_output=True, text=True, timeout=120)


def test_a_scene_of_a_plugin_is_rendered(folder):
    done = run(folder, "render", "half.etd", "--plugin", "half.py", "-o", "half.npy", "--quiet")
    assert done.returncode == 0 and done.stderr == "", done.stderr
    assert run(folder, "render", "plain.etd", "-o", "plain.npy", "--quiet").returncode == 0
    assert np.allclose(np.load(folder / "half.npy"), np.load(folder / "plain.npy"), rtol=1e-4)


@pytest.mark.parametrize(
    "command", [["classes", "HalfMap"], ["schema"], ["conform", "HalfMap", "--quick", "--drawn", "1"], ["check", "half.etd"]]
)
def test_commands_have_the_classes_of_a_plugin(folder, command):
    done = run(folder, *command, "--plugin", "half.py")
    assert done.returncode == 0, (done.stdout, done.stderr)
    assert "HalfMap" in done.stdout or command[0] == "check"


@pytest.mark.parametrize("renderer, agrees", [("ArrayTracer", True), ("DarkTracer", False)])
def test_a_renderer_of_a_plugin_is_verified(folder, renderer, agrees):
    (folder / "mine.py").write_text(pathlib.Path(__file__).with_name("parts_examples.py").read_text())
    done = run(folder, "verify", "plain.etd", "--plugin", "mine.py", "--renderers", f"PathTracer{{max_depth: 5}},{renderer}", "--samples", "64")
    assert done.returncode == (0 if agrees else 1), (done.stdout, done.stderr)
    assert f"path lengths are not tested apart, as {renderer}" in done.stderr


def test_what_is_missing_is_named(folder):
    done = run(folder, "classes", "--plugin", "half.py", ETENDUE_PYTHON="/nowhere/python3")
    assert done.returncode == 2
    assert "/nowhere/python3" in done.stderr and "written in Python" in done.stderr


def test_errors_of_a_plugin_are_told(folder):
    (folder / "wrong.py").write_text("import etendue\nraise ValueError('mine')\n")
    done = run(folder, "classes", "--plugin", "wrong.py")
    assert done.returncode == 2 and "ValueError: mine" in done.stderr


@pytest.mark.parametrize("named_in", ["file", "arguments"])
def test_the_studio_edits_and_renders_parts_of_a_plugin(folder, named_in, monkeypatch):
    monkeypatch.syspath_prepend(str(pathlib.Path(__file__).parents[1] / "studio"))
    monkeypatch.setenv("PYTHONPATH", str(pathlib.Path(PROGRAM).parent / "python-tools"))  # numpy
    client = importlib.import_module("client")
    scene = folder / "half.etd"
    if named_in == "file":
        scene.write_text('plugin "half.py"\n' + scene.read_text())
    with client.Studio(scene, *([] if named_in == "file" else ["--plugin", "half.py"]), folder=folder) as studio, studio.page() as page:
        page.good("watch")
        components = page.greeting["tree"]["components"]
        half = next(int(i) for i, c in components.items() if c["class"] == "HalfMap")
        page.good("edit", component=half, member="value", text="0.25")
        refused = page.ask("edit", component=half, member="value", text="2")
        assert not refused["ok"] and "from 0 to 1" in str(refused)
        generation = page.ask("hello", protocol=1)["progress"]["generation"]
        page.wait(lambda e: e.get("event") == "progress" and e["state"] == "finished" and e["generation"] >= generation)
        page.good("save")
        page.good("save_picture", file="studio.npy")
    assert "value: 0.25" in scene.read_text()
    assert run(folder, "render", "half.etd", "--plugin", "half.py", "-o", "fresh.npy", "--quiet").returncode == 0
    assert (folder / "studio.npy").read_bytes() == (folder / "fresh.npy").read_bytes()
