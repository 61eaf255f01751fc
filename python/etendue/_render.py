"""Rendering: `render` makes a picture at one call, `Render` is a render that is watched, edited and continued."""

from __future__ import annotations

import importlib.util
import os
import sys
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, Literal, Optional, Union

from . import _core
from ._classes import Part
from ._errors import Error, Warning
from ._files import load
from ._images import Image, _fail
from ._paths import PathRecord, path_from
from ._progress import Progress, Shown, display_for

FileName = Union[str, "os.PathLike[str]"]
Ended = Literal["samples", "time", "error", "interrupted", "aborted"]

#: The samples per pixel of a render that a limit of time or error ends: a number that is never reached, as in the program.
_OPEN_ENDED = 1000000

if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_core.leave_all_renders)


class Render:
    """A job being rendered.

    As long as a Render lives, its job's parts are edited by setting their members as usual (`job.camera.fov = 30`): the edit is
    made between two steps, and the render continues or starts over, whichever gives the picture that a new render of the edited
    job would give. No other render may have a part of this job at the same time. `close` ends this, as does the end of a `with`
    block.

    One thread may run or step; all other functions may be called at any time, from any thread. The same holds for a progress
    function, which is called by the thread that runs: it may not run, step or close the render.

        with etendue.Render(job) as render:
            render.run(samples=16)
            job.camera.fov = 30
            render.run()
            image = render.snapshot()

    Iterating renders step by step and gives the picture after each: `for image in render`.
    """

    _core: Any = None

    def __init__(
        self,
        job: Part,
        *,
        threads: int = 0,
        checkpoint: Optional[FileName] = None,
        checkpoint_interval: Optional[float] = None,
        passes: Optional[tuple[int, int]] = None,
        warn: bool = True,
    ) -> None:
        """Prepares the job.

        threads: 0 for all cores; the picture does not depend on it.
        checkpoint: a file to which `run` saves its state, every checkpoint_interval seconds (by default 60; 0: after every step).
        passes: only the steps from the first number up to, but without the second.
        warn: of what is no error but hardly meant, as the program does: parts that have no effect, a camera that sees nothing, light
            that the renderer cannot find. Python's `warnings` filter it, too: its category is etendue.Warning.

        Raises Error if the job cannot be rendered, or a part of it is being rendered already.
        """
        if threads < 0:
            _fail(f"threads is a number of threads, or 0 for all cores, not {threads}")
        file = None if checkpoint is None else os.fspath(checkpoint)
        self._job: Any = job
        self._threads = threads
        self._is_part = passes is not None
        self._core = _core.Render(job, threads, file, checkpoint_interval, passes)
        self._bad_samples_told = 0
        if warn:
            try:
                self._core.warn_of_scene()
            except BaseException:
                self._core.close()
                raise

    @property
    def job(self) -> Any:
        """The job that is rendered."""
        return self._job

    # ---- rendering ------------------------------------------------------------------------------------------------------------

    def run(
        self,
        *,
        samples: Optional[int] = None,
        seconds: Optional[float] = None,
        error: Optional[float] = None,
        progress: Shown = None,
    ) -> Ended:
        """Renders until a limit is reached, or `stop` or `abort` is called. Returns why it ended.

        samples: until each pixel has this many. seconds: for this long [s], to the end of a step. error: until the mean relative
            standard error of pixels is below this. Without these the job's own limits hold; with seconds or error but without
            samples, no number of samples ends the render earlier.
        progress: True: a line on standard error, or a live picture in a notebook; a function that is called with a Progress; False:
            nothing; None: as True on terminals and in notebooks only.

        The limits are those of this call, except that job.renderer.samples is raised if the picture gets more samples. An exception
        of a progress function, and Ctrl-C, end the render in the middle of a step, which leaves nothing: the picture so far can be
        taken, and the render can go on. Raises Error if the scene cannot be rendered.
        """
        self._refuse_copies()
        limits = self._limits(samples, seconds, error)
        display = display_for(self, progress)
        before = {(part, name): getattr(part, name) for part, name in limits}
        try:
            if samples is not None and self.progress.samples >= samples:
                return "samples"
            if limits:
                self.edit([(part, name, value) for (part, name), value in limits.items()])
            ended: Ended = self._run(self._core.run, display)
            return ended
        finally:
            display.close()
            if limits:
                self._put_back(before, limits)

    def _refuse_copies(self) -> None:
        """Of the processes that mpirun or srun has started, each would render the whole picture. Workers of Dask, which may be such, get
        parts of it."""
        count = _core.processes_started()
        if count == 1 or self._is_part or "distributed.worker" in sys.modules:
            return
        _fail(
            f"this is one of {count} processes that mpirun or srun has started, and each would render the whole picture. So that they render it "
            f"together, save the job (etendue.save(job, 'box.etd')) and run: mpirun -n {count} etendue render box.etd. Or give each its passes "
            "(etendue.Render(job, passes=…)), or set ETENDUE_MPI=off if each renders another picture"
        )

    def _limits(
        self, samples: Optional[int], seconds: Optional[float], error: Optional[float]
    ) -> dict[tuple[Part, str], Union[int, float]]:
        if samples is not None and samples < 1:
            _fail(f"samples is a number of samples per pixel, at least 1, not {samples}")
        if seconds is not None and not seconds > 0:
            _fail(f"seconds is a time, more than 0, not {seconds}")
        if error is not None and not error > 0:
            _fail(f"an error of {error} is no limit: give one that a picture can reach, such as 0.01")
        limits: dict[tuple[Part, str], Union[int, float]] = {}
        if samples is not None:
            limits[self._job.renderer, "samples"] = samples
        elif seconds is not None or error is not None:
            limits[self._job.renderer, "samples"] = _OPEN_ENDED
        if limits:
            limits[self._job, "time_limit"] = 0 if seconds is None else self.progress.seconds + seconds
            limits[self._job, "error_limit"] = 0 if error is None else error
        return limits

    def _put_back(self, before: dict[tuple[Part, str], Any], limits: dict[tuple[Part, str], Union[int, float]]) -> None:
        """Restores the job's own limits, unless they were changed meanwhile."""
        edits = []
        for (part, name), value in before.items():
            if getattr(part, name) != limits[part, name]:
                continue
            # Fewer samples than the picture has would be another picture.
            edits.append((part, name, max(value, self.progress.samples) if name == "samples" else value))
        if self._core.closed:
            for part, name, value in edits:
                setattr(part, name, value)
        else:
            self.edit(edits)

    def _run(self, function: Callable[[Callable[[], None]], Any], display: Any) -> Any:
        def wake() -> None:
            progress = self._core.take_progress()
            if progress is not None:
                display.show(Progress(**progress))

        try:
            return function(wake)
        finally:
            self._warn_of_bad_samples()

    def step(self) -> bool:
        """Renders the next step, a pass over the picture. Returns whether there was one: False if all samples are done, or after
        `stop` or `abort`."""
        self._refuse_copies()
        return self._run(self._core.step, display_for(self, False)) is None

    def __iter__(self) -> Iterator[Image]:
        """Renders step by step, up to the job's samples, and gives the picture after each."""
        while self.step():
            yield self.snapshot()

    def stop(self) -> None:
        """Ends the current run after its step, or else the next run. May be called by any thread, and by progress functions."""
        self._core.stop()

    def abort(self) -> None:
        """Ends the current run at once, in the middle of a step, which leaves nothing; or else the next run."""
        self._core.abort()

    def restart(self, seed: Optional[int] = None) -> None:
        """Starts over, with other random numbers if a seed is given, which becomes the job's."""
        self._core.restart(seed)

    # ---- results --------------------------------------------------------------------------------------------------------------

    @property
    def progress(self) -> Progress:
        """How far the render is."""
        return Progress(**self._core.progress())

    def snapshot(self) -> Image:
        """The picture so far, with its layers. It does not change when the render goes on."""
        picture, _ = self._core.snapshot()
        return Image(picture, None if self._job.tone_map is None else _core.copy(self._job.tone_map))

    @property
    def samples_done(self) -> list[tuple[int, int]]:
        """The samples of each pixel that the picture contains: ranges (begin, end) in order, where end is the first left out."""
        return list(self._core.samples_done())

    @property
    def samples_per_step(self) -> int:
        """Samples of each pixel per step; the last step of a render may have fewer."""
        return int(self._core.samples_per_step())

    @property
    def relative_error(self) -> float:
        """The mean over pixels of the standard error of Y, relative to Y + 1e-3 of its mean; infinite if it is unknown."""
        return float(self._core.relative_error())

    @property
    def bad_samples(self) -> int:
        """The number of samples that were negative or not finite; they count as black."""
        return int(self._core.bad_samples()[0])

    @property
    def first_bad_samples(self) -> list[tuple[int, int, int, str]]:
        """The first ones as (x, y, sample, what it was), for `replay`; at most 32."""
        return list(self._core.bad_samples()[2])

    def _warn_of_bad_samples(self) -> None:
        if self._core.closed:
            return
        count, samples, first = self._core.bad_samples()
        if count > self._bad_samples_told:
            x, y, sample, kind = first[0]
            warnings.warn(
                f"{count} of {samples} samples were negative or not finite; they count as black. "
                f"Sample {sample} of pixel {x},{y} was {kind}: see Render.replay({x}, {y}, {sample})",
                Warning,
                stacklevel=4,
            )
        self._bad_samples_told = count

    def replay(self, x: int, y: int, sample: int) -> PathRecord:
        """Renders one sample of a pixel alone, and returns its path, vertex by vertex.

        Waits for the end of the current step. Raises Error if there is no such pixel, or if the renderer's samples do not belong
        to pixels.
        """
        return path_from(self._core.replay(x, y, sample))

    def write_outputs(self, stem: Optional[FileName] = None) -> list[str]:
        """Writes the picture so far by all outputs of the job. Returns the files.

        stem: names outputs that have no file, without the ending: "folder/name", or a folder; by default the name of the job's file,
            in the current folder.
        """
        _find_denoising_library()
        return list(self._core.write_outputs(_stem(self._job, stem)))

    def denoise(self, denoiser: Optional[Part] = None) -> Image:
        """The picture so far, denoised with guides that are rendered for it (see `denoise`); edits wait for it."""
        _find_denoising_library()
        image = self.snapshot()
        return Image(self._core.denoise(image._picture, denoiser, self._threads), image.tone_map)

    # ---- editing --------------------------------------------------------------------------------------------------------------

    def edit(self, changes: Union[Mapping[str, Any], Sequence[tuple[Part, str, Any]]]) -> None:
        """Sets members of the job's parts between two steps, either all or none.

        changes: values by path, {"camera.fov": 30, "scene.objects[2].shader": shader}, or a list of (part, member, value).
        The current step is aborted for it, unless only the display changes. Raises Error, with everything unchanged, if a value or
        its consequence is invalid, or a part does not belong to the job.
        """
        if isinstance(changes, Mapping):
            changes = [self._job._target(path, value) for path, value in changes.items()]
        self._core.edit([(part, member, value) for part, member, value in changes])

    # ---- state ----------------------------------------------------------------------------------------------------------------

    def save(self, file: Optional[FileName] = None) -> Optional[bytes]:
        """Saves the state at the end of the last step, from which another process can continue, to a file, which is written whole
        or stays unchanged; without a file, returns it as bytes. The same samples give the same bytes."""
        if file is None:
            return bytes(self._core.save_bytes())
        self._core.save_file(os.fspath(file))
        return None

    def load(self, state: Union[FileName, bytes]) -> None:
        """Replaces the state by a saved one of this job: a file, or bytes. Raises Error, before anything changes, if the state is
        damaged, belongs to another job, or holds too many samples."""
        if isinstance(state, (bytes, bytearray, memoryview)):
            self._core.load_bytes(bytes(state))
        else:
            self._core.load_file(os.fspath(state))

    def add(self, state: Union[FileName, bytes]) -> None:
        """Adds samples that another process rendered and this one lacks: a file, or bytes; in any order, with the same bits."""
        if not isinstance(state, (bytes, bytearray, memoryview)):
            try:
                with open(state, "rb") as file:
                    state = file.read()
            except OSError as e:
                raise Error(f"cannot read '{os.fsdecode(state)}': {e.strerror}") from None
        self._core.add_bytes(bytes(state))

    # ---- end ------------------------------------------------------------------------------------------------------------------

    def close(self) -> None:
        """Aborts a run, and gives the job free: its members are set as usual, and other renders may have its parts."""
        self._core.close()

    @property
    def closed(self) -> bool:
        return self._core is None or bool(self._core.closed)

    def __enter__(self) -> Render:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return "<etendue.Render, closed>" if self.closed else f"<etendue.Render, {self.progress}>"


# ---- functions ------------------------------------------------------------------------------------------------------------------


def _stem(job: Any, stem: Optional[FileName]) -> str:
    """Where outputs without a file go, without their endings."""
    own = os.path.splitext(os.path.basename(_core.file_of(job)))[0]
    given = "" if stem is None else os.fspath(stem)
    if given and not os.path.isdir(given) and not given.endswith(os.sep):
        return given
    if not own and any(not output.file for output in job.outputs):
        _fail("the job was not read from a file that could name its outputs: give a stem, or set the outputs' files")
    return os.path.join(given, own)


def _find_denoising_library() -> None:
    """Lets the library find Open Image Denoise in this interpreter's own packages, wherever they are."""
    if "ETENDUE_OIDN" in os.environ:
        return
    package = importlib.util.find_spec("pyoidn")
    for folder in (package.submodule_search_locations or []) if package is not None else []:
        file = os.path.join(folder, "oidn", "lib", "libOpenImageDenoise.so.2")
        if os.path.exists(file):
            os.environ["ETENDUE_OIDN"] = file
            return


def _overridden(
    job: Any,
    samples: Optional[int],
    time: Optional[float],
    error: Optional[float],
    seed: Optional[int],
    renderer: Union[None, str, Part],
    size: Optional[tuple[int, int]],
    layers: Optional[Sequence[str]],
    changes: Optional[Mapping[str, Any]],
) -> Any:
    """A job with other values; the caller's keeps its own, and both share the parts that are the same."""
    if changes:
        job = _core.copy(job)
        for path, value in changes.items():
            job[path] = value
    if all(v is None for v in (samples, time, error, seed, renderer, size, layers)):
        return job
    job = _core.shallow_copy(job)
    if renderer is not None:
        job.renderer = renderer if not isinstance(renderer, str) or "{" in renderer else renderer + " {}"
    open_ended = samples is None and (time is not None or error is not None)
    if samples is not None or open_ended:
        job.renderer = _core.shallow_copy(job.renderer)
        job.renderer.samples = _OPEN_ENDED if open_ended else samples
    if time is not None:
        job.time_limit = time
    if error is not None:
        if isinstance(error, (int, float)) and not error > 0:
            _fail(f"an error of {error} is no limit: give one that a picture can reach, such as 0.01")
        job.error_limit = error
    if seed is not None:
        job.seed = seed
    if size is not None or layers is not None:
        job.image = _core.shallow_copy(job.image)
    if size is not None:
        if len(job.image.crop):
            _fail("the job has a crop, which another size would move: set both by changes={'image.crop': …, 'image.width': …}")
        job.image.width, job.image.height = size
    if layers is not None:
        job.image.layers = list(layers)
    return job


def _loaded(job: Union[Part, FileName]) -> Any:
    """The job itself, or that of a file."""
    if isinstance(job, Part):
        return job
    if not isinstance(job, (str, os.PathLike)):
        _fail(f"expects a Job or the name of a file, not {type(job).__name__}")
    return load(job)


def _prepared_outputs(job: Any, outputs: Union[bool, FileName]) -> Optional[str]:
    """What the names of a job's pictures begin with; None: none are written. Raises Error, before a long render, if they cannot be."""
    if outputs is False or outputs is None:
        return None
    if not len(job.outputs):
        _fail("the job has no outputs that could be written; Image.save writes a picture")
    stem = _stem(job, None if isinstance(outputs, bool) else outputs)
    _find_denoising_library()
    _core.require_outputs(job, stem)
    return stem


def _result(made: Render, stem: Optional[str], warn: bool) -> Image:
    """The picture of a render that has ended, whose outputs are written if there is a stem."""
    if stem is not None:
        made.write_outputs(stem)
    if warn:
        made._core.warn_of_picture(stem is not None)
    return made.snapshot()


def render(
    job: Union[Part, FileName],
    *,
    samples: Optional[int] = None,
    threads: int = 0,
    time: Optional[float] = None,
    error: Optional[float] = None,
    seed: Optional[int] = None,
    renderer: Union[None, str, Part] = None,
    size: Optional[tuple[int, int]] = None,
    layers: Optional[Sequence[str]] = None,
    changes: Optional[Mapping[str, Any]] = None,
    checkpoint: Optional[FileName] = None,
    outputs: Union[bool, FileName] = False,
    progress: Shown = None,
    warn: bool = True,
) -> Image:
    """Renders a job, and returns its picture. Nothing is written unless `outputs` or `checkpoint` say so.

    job: a Job, or a file that is loaded.
    samples: per pixel. time: stops after the pass in which this time [s] is over. error: stops when the mean relative standard error
        of pixels is below this. With time or error but without samples, no number of samples stops the render earlier.
    seed: of the random numbers. renderer: a renderer, or the name of its class. size: (width, height) [pixels]. layers: of the
        picture, as ["albedo", "depth", "light.key"]. changes: other members by path, as {"camera.fov": 30}.
    threads: 0 for all cores; the picture does not depend on it.
    checkpoint: a file to which the state is saved every minute, and from which the render continues if the file exists.
    outputs: True: writes the job's outputs as the program would; a folder, or a folder and a name without ending, does so there.
    progress: see Render.run. warn: see Render; also of a picture that is black.

    These values are for this render alone: the caller's job does not change. The picture is, byte for byte, that of the program.
    Raises Error if the scene cannot be rendered. Ctrl-C raises KeyboardInterrupt at once.
    """
    rendered = _overridden(_loaded(job), samples, time, error, seed, renderer, size, layers, changes)
    stem = _prepared_outputs(rendered, outputs)
    with Render(rendered, threads=threads, checkpoint=checkpoint, warn=warn) as made:
        if checkpoint is not None and os.path.exists(checkpoint):
            made.load(checkpoint)
        made.run(progress=progress)
        return _result(made, stem, warn)


def denoise(image: Image, job: Union[None, Part, Render] = None, *, denoiser: Optional[Part] = None, threads: int = 0) -> Image:
    """A denoised picture. It is biased: what looked like noise is smoothed, and no number of samples gives a bound of the error.

    job: the job that the picture was rendered from, or its Render. Guides of albedo and normal are rendered from it, by which edges
        are distinguished from noise, in the picture's size; without a job there are none. Layers of the noise and of parts of the light are left out.
    denoiser: by default OpenImageDenoiser, which needs the package pyoidn.

    Noise should be independent from pixel to pixel: render with `filter: BoxFilter {}`. Raises Error if the denoiser cannot work on
    this machine, or if the picture does not have the size of the Render's.
    """
    _find_denoising_library()
    if job is None:
        return Image(_core.denoise(image._picture, denoiser, threads), image.tone_map)
    if isinstance(job, Render):
        return Image(job._core.denoise(image._picture, denoiser, threads), image.tone_map)
    sized: Any = job
    if not len(sized.image.crop):
        sized = _overridden(job, None, None, None, None, None, (image.width, image.height), None, None)
    with Render(sized, threads=threads, warn=False) as prepared:
        return Image(prepared._core.denoise(image._picture, denoiser, threads), image.tone_map)
