"""Random calls of the package, drawn from the descriptions of all classes: none may crash, hang, or raise anything but what the package
says it raises.

    PYTHONPATH=build/python python3 tests/python/random_calls.py --calls 100000 --seed 1

Under sanitizers, the extension module has to be built with them, and Python to be started with their library, which the tests of such a
build do (a build of -DETENDUE_SANITIZE=address,undefined -DETENDUE_PYTHON=ON; ctest -R sanitized_random_calls):

    LD_PRELOAD=$(clang++-19 -print-file-name=libclang_rt.asan-x86_64.so) ASAN_OPTIONS=detect_leaks=0 python3 tests/python/random_calls.py

--threads 8 does so in 8 threads at once, each with parts of its own, while all render; with the thread sanitizer likewise.
"""

from __future__ import annotations

import argparse
import copy
import pickle
import random
import threading
import warnings

import numpy as np

import etendue
from etendue._classes import described, python_name

#: What a wrong call may raise.
EXPECTED = (etendue.Error, TypeError, AttributeError, ValueError, IndexError, OverflowError, NotImplementedError)

JOB = """
Job {
    renderer: PathTracer { samples: 1, max_depth: 3 }
    camera: PerspectiveCamera { from: [0, 0, -5] m, to: [0, 0, 0] m, fov: 40 deg }
    image: ImageBuffer { width: 6, height: 4, filter: BoxFilter {} }
    scene: BvhScene { objects: [
        Sphere { radius: 1 m, shader: Lambertian { color: 0.5 } }
        Environment { emission: EnvironmentEmission {} }
    ] }
}
"""


class Caller:
    """Makes parts, keeps some of them, and calls what can be called with them."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)
        self.kept: list[object] = []
        # Importers and outputs read and write files.
        files = (etendue.Importer, etendue.Output)
        self.classes = [c for c in etendue.classes() if not issubclass(c, files)]
        self.raised = 0

    def number(self) -> object:
        r = self.random
        return r.choice(
            [
                r.uniform(-2, 2),
                r.randint(-3, 300),
                0,
                1,
                -1,
                1e300,
                -1e-300,
                float("nan"),
                float("inf"),
                True,
                np.float32(r.random()),
                np.int64(r.randint(0, 9)),
                1 << 70,
            ]
        )

    def value(self, depth: int = 0) -> object:
        r = self.random
        makers = [
            self.number,
            self.number,
            lambda: r.choice(["", "x", "2 m", "30 deg", "rgb(1, 0, 0)", "Sphere {}", "Lambertian { color: 0.3 }", "\0", "é" * 40, "[1, 2"]),
            lambda: [self.number() for _ in range(r.randint(0, 5))],
            lambda: tuple(r.random() for _ in range(3)),
            lambda: np.random.default_rng(r.randint(0, 9)).random(r.choice([(3,), (4, 4), (2, 3), (0, 3), (5, 2), (1, 1, 1)])),
            lambda: np.zeros((4, 3), r.choice(["f4", "f8", "i4", "u8", "?"]))[:: r.choice([1, 2, -1])],
            lambda: (np.ones((2, 3, 4)[: r.randint(1, 3)]) * r.randint(0, 300)).astype(r.choice(["u1", "u2", "f2", "f4", "i8", ">f8"])),
            lambda: etendue.rgb(r.random(), r.random(), r.random()),
            lambda: etendue.translate(r.random(), 0, 0),
            lambda: None,
            lambda: r.choice(self.kept) if self.kept else None,
            lambda: object(),
        ]
        if depth < 2:
            makers += [lambda: self.part(depth + 1), lambda: [self.value(depth + 1) for _ in range(r.randint(0, 3))]]
        return r.choice(makers)()

    def fitting(self, member: dict, depth: int) -> object:
        """A value that probably fits."""
        r = self.random
        if member["type"] == "component" and depth < 3:
            name = member.get("class") or member.get("component") or ""
            of = getattr(etendue, name, None) if name else None
            known = [c for c in self.classes if of is None or issubclass(c, of)]
            made = self.part(depth + 1, r.choice(known)) if known else None
            return [made] if member.get("list") else made
        if member.get("choices"):
            return r.choice(member["choices"])
        if member["type"] == "boolean":
            return r.random() < 0.5
        if member["type"] in ("integer", "number"):
            return [r.randint(0, 3)] if member.get("list") else r.choice([r.random(), r.randint(1, 4)])
        if member["type"] in ("vector3", "point3", "normal3"):
            return (r.random(), r.random(), r.random())
        return self.value(depth)

    def part(self, depth: int = 0, cls: type | None = None) -> object:
        r = self.random
        cls = cls or r.choice(self.classes)
        members = described(cls)["members"]
        chosen = r.sample(members, min(len(members), r.randint(0, 3)))
        given = {python_name(m["name"]): self.fitting(m, depth) if r.random() < 0.7 else self.value(depth) for m in chosen}
        try:
            made = cls(**given)
        except EXPECTED:
            self.raised += 1
            made = None
        if made is not None and len(self.kept) < 60:
            self.kept.append(made)
        elif made is not None:
            self.kept[r.randrange(60)] = made
        return made

    def call(self) -> None:
        """One random call."""
        r = self.random
        part = r.choice(self.kept) if self.kept and r.random() < 0.8 else self.part()
        if part is None:
            return
        members = described(type(part))["members"]
        if not members:
            return
        member = r.choice(members)
        name = python_name(member["name"])
        calls = [
            lambda: setattr(part, name, self.value()),
            lambda: setattr(part, name, self.fitting(member, 1)),
            lambda: getattr(part, name),
            lambda: etendue.dumps(part, all=r.random() < 0.5),
            lambda: etendue.equal(part, etendue.loads(etendue.dumps(part))),
            lambda: etendue.copy(part),
            lambda: copy.deepcopy(part),
            lambda: pickle.loads(pickle.dumps(part)),
            lambda: list(etendue.walk(part)),
            lambda: etendue.from_dict(etendue.to_dict(part)),
            lambda: repr(part),
            lambda: getattr(part, name).append(self.value()),
            lambda: getattr(part, name)[r.randint(-3, 3)],
            lambda: getattr(part, name).__delitem__(r.randint(-3, 3)),
            lambda: etendue.loads(str(self.value())),
            lambda: self.render(part),
        ]
        try:
            r.choice(calls)()
        except EXPECTED:
            self.raised += 1

    def render(self, part: object) -> None:
        if self.random.random() < 0.9:  # the rest of the calls are faster
            return
        job = etendue.loads(JOB)
        shader = part if isinstance(part, etendue.Shader) else etendue.Lambertian(color=self.random.random())
        job.scene.objects[0].shader = etendue.copy(shader)
        with etendue.Render(job, threads=1, warn=False) as render:
            render.step()
            job.camera.fov = self.random.uniform(10, 60)
            render.step()
            render.snapshot()


def run(calls: int, seed: int) -> int:
    """The number of calls that raised what they may raise."""
    caller = Caller(seed)
    for _ in range(calls):
        caller.call()
    return caller.raised


def run_in_threads(calls: int, seed: int, threads: int) -> list[BaseException]:
    """What failed, of threads that share the calls."""
    failures: list[BaseException] = []

    def work(number: int) -> None:
        try:
            run(calls // threads, seed + number)
        except BaseException as e:
            failures.append(e)

    workers = [threading.Thread(target=work, args=(number,)) for number in range(threads)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    return failures


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--calls", type=int, default=3000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--threads", type=int, default=1)
    arguments = parser.parse_args()
    warnings.simplefilter("ignore")
    if failures := run_in_threads(arguments.calls, arguments.seed, arguments.threads):
        raise failures[0]
    print(f"{arguments.calls} calls")


if __name__ == "__main__":
    main()
