"""What the machines of a cluster do: they read a job that was sent to them, and render some of its steps, or all of them.

Nothing here imports Dask: a machine that runs these functions is a worker of Dask already.
"""

from __future__ import annotations

import os
import socket
import sys
import threading
import weakref
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Optional

from . import _core
from ._classes import Part
from ._errors import Error, Fault
from ._laboratory import Comparison
from ._progress import Progress
from ._render import Render


@dataclass(frozen=True, eq=False)
class SentJob:
    """A job on its way to other machines. Its files do not travel: they are read there, and compared with those here."""

    text: str  #: the description; paths of files are relative to `folder`
    folder: str  #: the scene's folder on the other machines
    plugins: tuple[str, ...]  #: files that are opened first
    identity: bytes  #: what determines the samples, with the hashes of all files

    @staticmethod
    def of(job: Part, folder: Optional[str], plugins: tuple[str, ...]) -> SentJob:
        own = os.path.dirname(os.path.abspath(_core.file_of(job) or "job"))
        text = _core.write_description(job, False, own)
        return SentJob(text, folder or own, tuple(os.path.abspath(p) for p in plugins), _core.identity_bytes(job))

    def job(self) -> Any:
        """The job, read on this machine. Raises Error with the machine's name if it would not give the same samples."""
        try:
            for plugin in self.plugins:
                _load_once(plugin)
            # Names of files are compared relative to the folder of the description, which needs a name in it.
            job = _core.loads(self.text, os.path.join(self.folder, "job"), self.folder, {}, True, 0, 0)
            reason = _core.identity_mismatch(job, "this machine", self.identity, "the client")
            if reason:
                raise Error(f"it would render another picture: {reason}")
            return job
        except Error as e:
            raise located(e) from None


_loaded: set[str] = set()


def _load_once(plugin: str) -> None:
    if plugin not in _loaded:
        _core.load_plugin(plugin)
        _loaded.add(plugin)


def located(error: Error) -> Error:
    """The same error, with the name of this machine."""
    host = f"on host '{socket.gethostname()}': "
    return Error(host + str(error), [Fault(host + f.message, f.file, f.line, f.column) for f in error.faults])


# ---- parts of a render ----------------------------------------------------------------------------------------------------------

#: The prepared renders of this process. Dask drops a SentJob when the client needs it no more; its render goes with it.
_renders: weakref.WeakKeyDictionary[SentJob, Render] = weakref.WeakKeyDictionary()
#: A worker of several threads gives all of them to one part after the other, so that its memory holds one scene and one film.
_rendering = threading.Lock()


@dataclass(frozen=True)
class RenderedPart:
    """The state of some steps, from which they are added to a render."""

    state: bytes
    seconds: float  #: spent on these steps
    host: str


def render_part(sent: SentJob, begin: int, end: int, threads: int) -> RenderedPart:
    """Renders the steps from begin to end - 1 and nothing else. threads: 0: as many as the worker of Dask has."""
    with _rendering:
        render = _renders.get(sent)
        if render is None:
            _renders.clear()  # another job's, which may be waiting for more parts, but memory holds one
            _scenes.clear()
            job = sent.job()
            job.time_limit = job.error_limit = 0  # the client observes the limits of the whole picture
            render = _renders[sent] = _prepared(job, threads, warn=False)  # the client warns of the scene
        try:
            render.restart()
            render._core.select_steps(begin, end)
            render.run(progress=_ends_when_unwanted())
            state = render.save()
            assert state is not None
            return RenderedPart(state, render.progress.seconds, socket.gethostname())
        except Error as e:
            raise located(e) from None


def render_whole(sent: SentJob, threads: int) -> tuple[Any, list[str], dict[str, str]]:
    """Renders all of a job: pixels, names of the channels, metadata."""
    with _rendering:
        _renders.clear()
        _scenes.clear()
        job = sent.job()
        try:
            with _prepared(job, threads, warn=True) as render:
                render.run(progress=_ends_when_unwanted())
                picture = render.snapshot()
        except Error as e:
            raise located(e) from None
        return picture.pixels, picture.channels, picture.metadata


def _prepared(job: Any, threads: int, warn: bool) -> Render:
    worker, _ = _worker_and_task()
    try:
        return Render(job, threads=threads or (worker.state.nthreads if worker is not None else 0), warn=warn)
    except Error as e:
        raise located(e) from None


class Unwanted(Exception):
    """The client has cancelled the part, or is gone."""


def _worker_and_task() -> tuple[Any, Optional[str]]:
    """The worker of Dask that runs this thread, and the key of the task; None where there is none."""
    state = getattr(sys.modules.get("distributed.worker"), "thread_state", None)
    worker = getattr(state, "execution_state", {}).get("worker") if state is not None else None
    return worker, getattr(state, "key", None)


def _ends_when_unwanted() -> Callable[[Optional[Progress]], None]:
    """A progress function that aborts the render once the scheduler has withdrawn the task. Dask by itself would go on to its end."""
    worker, key = _worker_and_task()

    def look(progress: Optional[Progress]) -> None:
        task = worker.state.tasks.get(key) if worker is not None else None
        if worker is not None and (task is None or task.state == "cancelled"):
            raise Unwanted()

    return look


# ---- runs of a comparison -------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class SentScene:
    """A scene of a comparison on its way to other machines, with what is compared on it."""

    name: str
    job: SentJob
    variants: tuple[tuple[str, bool, Optional[str], tuple[tuple[str, str], ...]], ...]  #: name, whether a part, text, members
    samples: int
    seconds: float
    reference_seconds: float

    @staticmethod
    def of(given: Comparison, scene: int, folder: Optional[str], plugins: tuple[str, ...]) -> SentScene:
        name, job, _ = given.scenes[scene]
        variants = []
        for variant, renderer, sets in given.variants:
            text = _core.write_description(renderer, False, "") if isinstance(renderer, Part) else renderer
            variants.append((variant, isinstance(renderer, Part), text, tuple(sets)))
        sent = SentJob.of(job, folder, plugins)
        return SentScene(name, sent, tuple(variants), given.samples, given.seconds, given.reference_seconds)

    def cells(self, threads: int) -> Any:
        """What renders the scene's runs on this machine."""
        job = self.job.job()
        variants = [
            (name, _core.parse_component(text, "variants", "") if is_part else text, list(sets))
            for name, is_part, text, sets in self.variants
        ]
        return _core.Cells(self.name, job, variants, self.samples, self.seconds, self.reference_seconds, threads)


@dataclass(frozen=True)
class RenderedCell:
    """A run of a comparison, as its file in the folder of runs."""

    content: bytes
    processor: str


#: The scenes of comparisons that this process has prepared.
_scenes: weakref.WeakKeyDictionary[SentScene, Any] = weakref.WeakKeyDictionary()


def render_cell(sent: SentScene, seed: int, key: tuple[int, int, int], threads: int) -> RenderedCell:
    """Renders one run: (scene, variant, run). threads: 0: as many as the worker of Dask has."""
    with _rendering:
        _renders.clear()
        worker, _ = _worker_and_task()
        unwanted = _ends_when_unwanted()
        try:
            cells = _scenes.get(sent)
            if cells is None:
                _scenes.clear()
                cells = _scenes[sent] = sent.cells(threads or (worker.state.nthreads if worker is not None else 0))
            return RenderedCell(cells.render(seed, *key, lambda fraction, what: unwanted(None)), _processor())
        except Error as e:
            raise located(e) from None


def _processor() -> str:
    """The model of this machine's processor."""
    try:
        with open("/proc/cpuinfo", encoding="ascii", errors="replace") as file:
            return next((line.partition(":")[2].strip() for line in file if line.startswith("model name")), "unknown")
    except OSError:
        return "unknown"
