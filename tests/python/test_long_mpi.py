"""`mpirun etendue render`, killed again and again: rank 0, another one, or mpirun itself, at any moment. Each time there is a message and
no process is left; the checkpoint is whole, and any number of processes goes on from it to the bytes of one. And the matrix of all
renderers on up to eight processes."""

import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import time

import pytest

PROGRAM = pathlib.Path(os.environ.get("ETENDUE_PROGRAM", "build/etendue")).resolve()

pytestmark = [
    pytest.mark.skipif(not shutil.which("mpirun"), reason="needs mpirun"),
    pytest.mark.skipif(not (PROGRAM.parent / "libetendue_mpi.so").exists(), reason="built without MPI"),
]

SCENE = """
Job {{
    renderer: {renderer}
    camera: PerspectiveCamera {{ from: [0, 0, -5] m, to: [0, 0, 0] m, fov: 40 deg }}
    image: ImageBuffer {{ width: 48, height: 32 }}
    scene: BvhScene {{ objects: [
        Sphere {{ radius: 1 m, shader: Lambertian {{}} }}
        Sphere {{ centre: [0, -101, 0] m, radius: 100 m, shader: Lambertian {{}} }}
        Sphere {{ centre: [0, 3, -1] m, radius: 0.5 m, emission: DiffuseEmission {{ radiance: 5 }} }}
    ] }}
}}
"""
KILLS = int(os.environ.get("ETENDUE_TEST_KILLS", "100"))
PATIENCE = 30  # [s] in which all processes must have ended after a kill


def start(folder, ranks, *arguments):
    """Each process writes its number into a file first."""
    command = ["mpirun", "--oversubscribe", "--allow-run-as-root", "--bind-to", "none", "-n", str(ranks)]
    command += ["sh", "-c", 'echo $$ > "rank.$OMPI_COMM_WORLD_RANK"; exec "$@"', "rank"]
    command += [str(PROGRAM), "render", "a.etd", *arguments]
    with open(folder / "out", "w") as out, open(folder / "err", "w") as err:
        return subprocess.Popen(command, cwd=folder, stdout=out, stderr=err)


def alone(folder, *arguments):
    subprocess.run([PROGRAM, "render", "a.etd", *arguments], cwd=folder, check=True, capture_output=True)


def running(number):
    """A zombie has ended."""
    try:
        return pathlib.Path(f"/proc/{number}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def numbers(folder):
    files = folder.glob("rank.*")
    return {int(f.name[5:]): int(f.read_text()) for f in files if f.read_text().strip()}


def kill_one(folder, team, chance):
    """Kills mpirun (-1) or a rank. Returns which, and how long it took until all had ended."""
    ranks = numbers(folder)
    victim = chance.choice([-1, *ranks])
    try:
        os.kill(ranks.get(victim, team.pid), signal.SIGKILL)
    except ProcessLookupError:
        return None, 0  # it has just finished
    killed = time.monotonic()
    team.wait(timeout=PATIENCE)
    while any(map(running, ranks.values())):
        assert time.monotonic() - killed < PATIENCE, f"processes are left after {victim} was killed"
        time.sleep(0.05)
    return victim, time.monotonic() - killed


def told(folder, victim, began):
    """Whether somebody said what happened. Before the render has begun, mpirun's own death is told by nobody but the shell, and of another
    process mpirun says only that one has failed."""
    said = (folder / "err").read_text()
    if "signal 9" in said or "process " in said and not began:
        return True
    if victim == -1 and (not began or '"event":"done"' in (folder / "out").read_text()):
        return True  # or after it has ended
    deadline = time.monotonic() + 10
    while time.monotonic() < deadline and not (folder / "state.killed.txt").exists():
        time.sleep(0.1)
    return victim == -1 and (folder / "state.killed.txt").exists()


def test_random_kills(tmp_path):
    (tmp_path / "a.etd").write_text(SCENE.format(renderer="GuidedPathTracer {}"))
    chance = random.Random(17)
    samples = 8 * 60
    alone(tmp_path, "--samples", str(samples), "-o", "alone.npy")
    kills, longest, finished = 0, 0.0, 0
    whom = {}
    while kills < KILLS:
        for left in tmp_path.glob("rank.*"):
            left.unlink()
        team = start(tmp_path, chance.choice([2, 3, 4]), "--threads", "1", "--samples", str(samples), "--every", "0s",
                     "--continue", "state", "-o", "team.npy", "--progress", "json")
        # Most kills come while it renders, some while it starts.
        if chance.random() < 0.8:
            while team.poll() is None and (tmp_path / "out").stat().st_size == 0:
                time.sleep(0.01)
        try:
            team.wait(timeout=chance.uniform(0, 3))
        except subprocess.TimeoutExpired:
            began = (tmp_path / "out").stat().st_size > 0
            victim, seconds = kill_one(tmp_path, team, chance)
            if victim is None:
                team.wait(timeout=PATIENCE)
                continue
            kills += 1
            print(kills, victim, began, f"{seconds:.1f} s", flush=True)
            longest = max(longest, seconds)
            whom[min(victim, 1)] = whom.get(min(victim, 1), 0) + 1
            assert told(tmp_path, victim, began), f"{victim}, {began}: " + (tmp_path / "err").read_text() + (tmp_path / "out").read_text()[-300:]
            if (tmp_path / "state").exists():
                subprocess.run([PROGRAM, "image", "merge", "state", "-o", "some.npy"], cwd=tmp_path, check=True, capture_output=True)
            continue
        assert team.returncode == 0, (tmp_path / "err").read_text()
        assert (tmp_path / "team.npy").read_bytes() == (tmp_path / "alone.npy").read_bytes()
        finished += 1
        (tmp_path / "state").unlink()
    print(f"{kills} kills (mpirun {whom.get(-1)}, rank 0 {whom.get(0)}, another {whom.get(1)}), all had ended after at most "
          f"{longest:.1f} s; {finished} renders were finished between them")


def renderers():
    listed = subprocess.run([PROGRAM, "classes", "Renderer"], capture_output=True, text=True).stdout
    return re.findall(r"^  ([A-Z]\w+)  +\S", listed.split("\nClasses\n")[1], re.MULTILINE)


@pytest.mark.parametrize("ranks,threads", [(5, 1), (8, 1), (8, 2)])
def test_every_renderer(tmp_path, ranks, threads):
    tried = 0
    for renderer in renderers():
        (tmp_path / "a.etd").write_text(SCENE.format(renderer=renderer + " { samples: 16 }"))
        one = subprocess.run([PROGRAM, "render", "a.etd", "--threads", "1", "-o", "alone.npy"], cwd=tmp_path, capture_output=True)
        if one.returncode != 0:
            continue  # it needs parts of its own
        team = start(tmp_path, ranks, "--threads", str(threads), "-o", "team.npy")
        assert team.wait(timeout=300) == 0, renderer + (tmp_path / "err").read_text()
        assert (tmp_path / "team.npy").read_bytes() == (tmp_path / "alone.npy").read_bytes(), renderer
        tried += 1
    assert tried >= 10
