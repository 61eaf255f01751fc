"""Renders over many machines, by Dask: `pip install etendue[distributed]`.

    import etendue.distributed
    from dask.distributed import Client

    client = Client("tcp://scheduler:8786")             # or LocalCluster, SLURMCluster, KubeCluster, SSHCluster, …
    picture = etendue.distributed.render("box.etd", client, samples=4096)

A part of a render is a task of Dask: some steps of the picture. Machines may come and go: a part whose machine is lost is rendered
again by another. Parts are added in the order in which they arrive, and the picture has, byte for byte, the pixels that one process
renders. The job travels as a description; its files do not, but are read by each machine at the same path (docs/cluster.md).
"""

from __future__ import annotations

import contextlib
import math
import os
import tempfile
import time as clock
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, Literal, Optional, Union

from . import _core
from ._classes import Part
from ._errors import Error, _warn
from ._images import Image
from ._laboratory import ErrorComparison, Renderers, comparison_of
from ._laboratory import Progress as ToldProgress
from ._parts import RenderedPart, SentJob, SentScene, render_cell, render_part, render_whole
from ._progress import Progress, Shown, display_for
from ._render import FileName, Render, _loaded, _overridden, _prepared_outputs, _result
from ._tasks import Sent, Tasks, dask

__all__ = ["compare", "frames", "render", "run"]

_CHECKPOINT_INTERVAL = 60.0  # [s]


# ---- parts of one render --------------------------------------------------------------------------------------------------------


class _Steps:
    """The steps that are left, divided into parts of some seconds each."""

    def __init__(self, render: Render, steps: Optional[tuple[int, int]], part_seconds: float) -> None:
        size = render.samples_per_step
        samples = render.job.renderer.samples
        begin, end = (0, math.ceil(samples / size)) if steps is None else steps
        if not 0 <= begin < end <= math.ceil(samples / size):
            raise Error(f"there are no steps {begin} to {end}: {samples} samples per pixel are {math.ceil(samples / size)} steps")
        done = render.samples_done
        self.left = [k for k in range(begin, end) if not any(a < min((k + 1) * size, samples) and k * size < b for a, b in done)]
        for k in range(begin, end):
            whole = any(a <= k * size and min((k + 1) * size, samples) <= b for a, b in done)
            if k not in self.left and not whole:
                raise Error(
                    f"only some of the samples {k * size} to {(k + 1) * size - 1}, a step, are in the picture, and machines render "
                    f"whole steps: start over, with a multiple of {size} samples"
                )
        self.left.reverse()
        self.total = end - begin
        self._part_seconds = part_seconds
        self._step_seconds: Optional[float] = None

    def measure(self, steps: int, seconds: float) -> None:
        self._step_seconds = seconds / steps

    def take(self, workers: int) -> tuple[int, int]:
        """The next part, as a range. Parts are small at first, while their time is unknown, and at the end, when machines would wait
        for each other."""
        wanted = 1
        if self._step_seconds is not None:
            wanted = int(min(self._part_seconds / max(self._step_seconds, 1e-6), len(self.left) / (2 * workers)))
        begin = end = self.left.pop()
        while self.left and self.left[-1] == end + 1 and end + 1 - begin < wanted:
            end = self.left.pop()
        return begin, end + 1


def _require_independent_steps(render: Render) -> None:
    if render._core.steps_depend():
        raise Error(
            f"{type(render.job.renderer).__name__} learns from one step to the next, so its steps cannot be rendered on several "
            "machines; etendue.distributed.frames renders whole pictures, each on one machine"
        )


class _Clock:
    """The progress of the whole picture, over wall-clock time."""

    def __init__(self, render: Render) -> None:
        self._render = render
        self._began = clock.monotonic()
        self._had = render.progress.samples

    @property
    def seconds(self) -> float:
        return clock.monotonic() - self._began

    def progress(self, finished: bool) -> Progress:
        now = self._render.progress
        seconds = max(self.seconds, 1e-6)
        new = now.samples - self._had
        pixels = now.samples_per_second * now.seconds / max(now.samples, 1)
        left = None if new <= 0 else (now.samples_wanted - now.samples) * seconds / new
        return replace(
            now,
            fraction=now.samples / max(now.samples_wanted, 1),
            seconds=seconds,
            seconds_left=left,
            samples_per_second=new * pixels / seconds,
            finished=finished,
        )


class _Checkpoint:
    """Saves what has arrived. A file that cannot be written is warned of: it is no reason to lose the render."""

    def __init__(self, render: Render, file: Optional[FileName]) -> None:
        self._render = render
        self._file = file
        self._saved = clock.monotonic()

    def save_now_and_then(self) -> None:
        if clock.monotonic() - self._saved >= _CHECKPOINT_INTERVAL:
            self.save()

    def save(self) -> None:
        if self._file is None or self._render.closed:
            return
        try:
            self._render.save(self._file)
        except Error as e:
            _warn(str(e))
        self._saved = clock.monotonic()


def run(
    render: Render,
    client: Any,
    *,
    samples: Optional[int] = None,
    steps: Optional[tuple[int, int]] = None,
    seconds: Optional[float] = None,
    error: Optional[float] = None,
    checkpoint: Optional[FileName] = None,
    part_seconds: float = 30,
    threads: int = 0,
    folder: Optional[FileName] = None,
    plugins: Sequence[FileName] = (),
    progress: Shown = None,
) -> Literal["samples", "time", "error"]:
    """Renders what a Render lacks on the machines of a client, and adds it. Returns what ended it.

    render: what has arrived is in it at any time, for snapshots, for Render.save, and to go on with here or by Render.run.
    client: a dask.distributed.Client of any cluster. Its workers may come, go and be killed meanwhile.
    samples: until each pixel has this many; by default the job's. steps: only the steps (passes) from the first number up to, but
        without the second. seconds: for this long [s]. error: until the mean relative standard error of pixels is below this. Which
        samples a picture has that these two end depends on the machines; all other pictures are the same on any.
    checkpoint: a file to which what has arrived is saved every minute, and at the end, whatever it is; Render.load and
        `etendue render --continue` go on from it.
    part_seconds: how long a machine is to render between two results [s]. A result is as large as a saved state.
    threads: of each worker; 0: as many as Dask gives it.
    folder: where the folder of the job's file is on the workers; by default at the same path.
    plugins: files that the workers open first, at these paths: those whose classes the job has.
    progress: as of Render.run, called as parts arrive.

    Ctrl-C, and an exception of a progress function, withdraw what is under way and leave what has arrived. Raises Error if the
    algorithm's steps depend on each other; if a machine would render another picture, as one of its files differs or its version
    of Étendue is another: with the machine's name; and if a part has lost its machine ten times.
    """
    tasks = Tasks(client)
    _require_independent_steps(render)
    if not part_seconds > 0:
        raise Error(f"part_seconds is a time, more than 0, not {part_seconds}")
    limits = render._limits(samples, seconds, error)
    before = {(part, name): getattr(part, name) for part, name in limits}
    display = display_for(render, progress)
    try:
        if limits:
            render.edit([(part, name, value) for (part, name), value in limits.items()])
        left = _Steps(render, steps, part_seconds)
        sent = Sent(client, SentJob.of(render.job, None if folder is None else os.fspath(folder), _paths(plugins)))
        return _collect(render, tasks, left, sent, threads, seconds, _Checkpoint(render, checkpoint), display)
    finally:
        tasks.cancel()
        display.close()
        _Checkpoint(render, checkpoint).save()
        render._warn_of_bad_samples()
        if limits:
            render._put_back(before, limits)


def _collect(
    render: Render,
    tasks: Tasks,
    left: _Steps,
    sent: Sent,
    threads: int,
    seconds: Optional[float],
    checkpoint: _Checkpoint,
    display: Any,
) -> Literal["samples", "time", "error"]:
    """Submits parts and adds their results, until nothing is left or a limit is reached."""
    time = _Clock(render)
    job = render.job
    while True:
        if seconds is not None and time.seconds >= seconds:
            return "time"
        if seconds is None and job.time_limit > 0 and render.progress.seconds >= job.time_limit:
            return "time"
        while left.left and tasks.wanted:
            begin, end = left.take(tasks.workers)
            tasks.submit((begin, end), render_part, sent, begin, end, threads)
        if not len(tasks):
            display.show(time.progress(True))
            return "samples"
        arrived = tasks.next(0.25)
        if arrived is not None:
            (begin, end), part = arrived
            _add(render, part)
            left.measure(end - begin, part.seconds)
            checkpoint.save_now_and_then()
            if job.error_limit > 0 and render.relative_error <= job.error_limit:
                return "error"
        display.show(time.progress(False))


def _add(render: Render, part: RenderedPart) -> None:
    try:
        render.add(part.state)
    except Error as e:
        raise Error(f"a part of host '{part.host}': {e}") from None


def _paths(files: Sequence[FileName]) -> tuple[str, ...]:
    if isinstance(files, (str, os.PathLike)):
        raise Error("plugins is a list of files")
    return tuple(os.fspath(f) for f in files)


def render(
    job: Union[Part, FileName],
    client: Any,
    *,
    samples: Optional[int] = None,
    steps: Optional[tuple[int, int]] = None,
    time: Optional[float] = None,
    error: Optional[float] = None,
    seed: Optional[int] = None,
    renderer: Union[None, str, Part] = None,
    size: Optional[tuple[int, int]] = None,
    layers: Optional[Sequence[str]] = None,
    changes: Optional[Mapping[str, Any]] = None,
    checkpoint: Optional[FileName] = None,
    outputs: Union[bool, FileName] = False,
    part_seconds: float = 30,
    threads: int = 0,
    folder: Optional[FileName] = None,
    plugins: Sequence[FileName] = (),
    progress: Shown = None,
    warn: bool = True,
) -> Image:
    """Renders a job on the machines of a client, and returns its picture: etendue.render, over many machines.

    job, samples, error, seed, renderer, size, layers, changes, outputs, progress, warn: as of etendue.render; time is wall-clock time [s].
    client, steps, part_seconds, threads, folder, plugins: as of `run`.
    checkpoint: as of `run`; the render continues from it if the file exists.

    The picture is, byte for byte, that of one process, unless a limit of time or error ends it. Ctrl-C raises KeyboardInterrupt;
    `run` with a Render of one's own keeps what has arrived in memory. Raises Error as `run` does.
    """
    dask(client)
    rendered = _overridden(_loaded(job), samples, None, error, seed, renderer, size, layers, changes)
    stem = _prepared_outputs(rendered, outputs)
    with Render(rendered, warn=warn) as made:
        if checkpoint is not None and os.path.exists(checkpoint):
            made.load(checkpoint)
        run(
            made,
            client,
            steps=steps,
            seconds=time,
            error=error,
            checkpoint=checkpoint,
            part_seconds=part_seconds,
            threads=threads,
            folder=folder,
            plugins=plugins,
            progress=progress,
        )
        return _result(made, stem, warn)


def frames(
    jobs: Iterable[Union[Part, FileName]],
    client: Any,
    *,
    threads: int = 0,
    folder: Optional[FileName] = None,
    plugins: Sequence[FileName] = (),
) -> Iterator[tuple[int, Image]]:
    """Renders whole pictures, each on one machine, and yields them as they are done: (number from 0, Image).

    jobs: of the frames of an animation, or any others; of any algorithm. An iterator is advanced only as far as machines are free.
    client, threads, folder, plugins: as of `run`.

        jobs = (etendue.load("film.etd", frame=n, time=n / 24) for n in range(240))
        for number, picture in etendue.distributed.frames(jobs, client):
            picture.save(f"film.{number:04}.png")

    Each job's own limits end its picture. Leaving the loop withdraws all that is under way. Raises Error as `run` does.
    """
    tasks = Tasks(client)
    there = None if folder is None else os.fspath(folder)
    files = _paths(plugins)
    waiting = enumerate(jobs)
    tone_maps: dict[int, Optional[Part]] = {}
    exhausted = False
    try:
        while True:
            while not exhausted and tasks.wanted:
                number, given = next(waiting, (-1, None))
                if given is None:
                    exhausted = True
                    break
                job = _loaded(given)
                tone_maps[number] = None if job.tone_map is None else _core.copy(job.tone_map)
                tasks.submit(number, render_whole, Sent(client, SentJob.of(job, there, files)), threads)
            if not len(tasks):
                return
            arrived = tasks.next(0.25)
            if arrived is not None:
                number, (pixels, channels, metadata) = arrived
                yield number, Image(_core.picture_from(pixels, channels, metadata), tone_maps.pop(number))
    finally:
        tasks.cancel()


# ---- comparisons ----------------------------------------------------------------------------------------------------------------


def compare(
    jobs: Union[Part, FileName, Sequence[Union[Part, FileName]], Mapping[str, Union[Part, FileName]]],
    client: Any,
    renderers: Optional[Renderers] = None,
    *,
    variants: Optional[Mapping[str, Mapping[str, Any]]] = None,
    time: Optional[float] = None,
    samples: Optional[int] = None,
    runs: int = 8,
    reference: Any = None,
    reference_time: Optional[float] = None,
    tile: int = 0,
    significance: float = 0.01,
    seed: Optional[int] = None,
    size: Optional[tuple[int, int]] = None,
    insets: Sequence[tuple[int, int, int, int]] = (),
    threads: int = 0,
    state: Optional[FileName] = None,
    report: Optional[FileName] = None,
    folder: Optional[FileName] = None,
    plugins: Sequence[FileName] = (),
    progress: Optional[ToldProgress] = None,
) -> ErrorComparison:
    """etendue.compare over many machines: each run of a variant on a scene is a task of its own.

    client, folder, plugins: as of `run`. threads: of each worker; 0: as many as Dask gives it. All other arguments are those of
    etendue.compare. With equal samples, the errors are those of one process, to the last digit. CPU time is measured where a run is
    rendered: for `time`, all workers should have the same processor, and a warning says if they have not.

    state: the folder on this machine where finished runs are kept. Ctrl-C, or an exception of `progress`, withdraws what is under
    way; the same call, or etendue.compare with that folder, goes on with the runs that are kept. Raises Error as etendue.compare
    and `run` do.
    """
    tasks = Tasks(client)
    given = comparison_of(
        jobs, renderers, variants, time, samples, runs, reference, reference_time, tile, significance, seed, size, insets
    )
    there, files = None if folder is None else os.fspath(folder), _paths(plugins)
    shown = "" if report is None else os.fspath(report)
    with contextlib.ExitStack() as temporary:
        kept = os.fspath(state) if state is not None else temporary.enter_context(tempfile.TemporaryDirectory())
        first_seed, all_runs, missing = given.missing(threads, kept, shown)
        scenes = [Sent(client, SentScene.of(given, number, there, files)) for number in range(len(given.scenes))]
        missing.reverse()
        done = all_runs - len(missing)
        processors: set[str] = set()
        try:
            while missing or len(tasks):
                while missing and tasks.wanted:
                    scene, variant, run_number, name = missing.pop()
                    tasks.submit(name, render_cell, scenes[scene], first_seed, (scene, variant, run_number), threads)
                arrived = tasks.next(0.25)
                if arrived is not None:
                    name, cell = arrived
                    _write_whole(os.path.join(kept, name), cell.content)
                    processors.add(cell.processor)
                    done += 1
                if progress is not None:
                    progress(done / max(all_runs, 1), f"{done} of {all_runs} runs")
        finally:
            tasks.cancel()
        if len(processors) > 1 and (time is not None or reference_time is not None):
            _warn(
                f"the runs were rendered on {len(processors)} kinds of processors ({', '.join(sorted(processors))}), so that CPU times "
                "cannot be compared: give samples=, or use workers of one kind"
            )
        return given.analysed(threads, kept, shown, "etendue.distributed.compare", None)


def _write_whole(path: str, content: bytes) -> None:
    with open(path + ".part", "wb") as file:
        file.write(content)
    os.replace(path + ".part", path)
