"""Clusters of Dask on this machine, for tests: worker processes that can be killed."""

import os
import random
import signal

import pytest

SMALL = """
grey = Lambertian { color: spectrum("grey.csv") }
Job {
    renderer: PathTracer { samples: 8, max_depth: 2 }
    camera: PerspectiveCamera { from: [0, 0, -5] m, to: [0, 0, 0] m, fov: 40 deg }
    image: ImageBuffer { width: 48, height: 32 }
    scene: BvhScene { objects: [
        Sphere { radius: 1 m, shader: grey }
        Sphere { centre: [0, 3, 0] m, radius: 0.5 m, emission: DiffuseEmission { radiance: 5 } }
    ] }
}
"""


def write_scene(folder, grey=0.5):
    """A scene's file with another one beside it that it reads."""
    folder.mkdir(exist_ok=True)
    (folder / "grey.csv").write_text(f"400 {grey}\n700 {grey}\n")
    (folder / "small.etd").write_text(SMALL)
    return folder / "small.etd"


def start(folder, workers=4):
    """A cluster of worker processes of one thread each, and its client."""
    distributed = pytest.importorskip("distributed")
    cluster = distributed.LocalCluster(
        n_workers=workers, threads_per_worker=1, dashboard_address=None, local_directory=str(folder), silence_logs="CRITICAL"
    )
    return cluster, distributed.Client(cluster)


def kill_a_worker(cluster):
    """SIGKILL to one that is up; its nanny starts another. Returns whether there was one."""
    up = [w.process.pid for w in cluster.workers.values() if getattr(w, "process", None) and w.process.pid]
    if not up:
        return False
    os.kill(random.choice(up), signal.SIGKILL)
    return True


def same(a, b):
    return a.channels == b.channels and a.pixels.tobytes() == b.pixels.tobytes()
