"""The laboratory: whether algorithms agree, which is better, and whether classes fulfil the contracts of their interfaces.

The statistics and texts are those of `etendue verify`, `compare` and `conform`; the rows' fields have the names of their JSON.
"""

from __future__ import annotations

import functools
import json
import math
import os
import re
from dataclasses import dataclass, field
from typing import Any, Callable, Iterable, Mapping, Optional, ParamSpec, Sequence, TypeVar, Union

from . import _core
from ._classes import Part
from ._errors import Error, Fault
from ._files import Path, load
from ._tables import Table, optional_module, table_from_json

Progress = Callable[[float, str], None]
#: Renderers of a comparison: classes' names or expressions of the language, parts, or a dict of names and these.
Renderers = Union[str, Part, type, Sequence[Union[str, Part, type]], Mapping[str, Union[str, Part, type]]]

_P = ParamSpec("_P")
_R = TypeVar("_R")


def _options_as_arguments(text: str) -> str:
    """Errors of the program name its options; here these are arguments: "--reference-time" is "reference_time"."""
    return re.sub(r"(?<![\w-])--([a-z][a-z-]*)", lambda option: option[1].replace("-", "_"), text)


def _errors_name_arguments(function: Callable[_P, _R]) -> Callable[_P, _R]:
    @functools.wraps(function)
    def call(*positional: _P.args, **named: _P.kwargs) -> _R:
        try:
            return function(*positional, **named)
        except Error as e:
            if "--" not in str(e):
                raise
            faults = [
                Fault(_options_as_arguments(f.message), f.file and _options_as_arguments(f.file), f.line, f.column) for f in e.faults
            ]
            raise Error(_options_as_arguments(str(e)), faults) from None

    return call


# ---- verify -----------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class MeasuredRenderer:
    """What one renderer found in all passes."""

    name: str
    mean: float  #: mean Y of the whole picture
    relative_error: float  #: its standard error, relative
    passes: int
    samples: int  #: over the whole picture, in all passes
    bad_samples: int  #: negative or not finite; they count as black
    seconds: float
    samples_per_second: float
    tells_lengths: bool
    remark: str


@dataclass(frozen=True)
class LeftOut:
    """A renderer that was not compared, and why."""

    name: str
    reason: str


@dataclass(frozen=True)
class MeanTest:
    """One comparison of two means, over a tile or the whole picture."""

    area: tuple[int, int, int, int]  #: x0, y0, x1, y1 [pixels]
    whole_picture: bool
    length: int  #: of the paths, in segments; 0: all together
    channel: str
    mean_a: float
    mean_b: float
    ratio: Optional[float]
    z: float
    plain_p: float
    p: float
    corrected_p: float
    verdict: str  #: "agree", "undecided" or "DISAGREE"
    why: str = ""  #: of an undecided test


@dataclass(frozen=True)
class Layer:
    """All tests of the light of one path length, or of one channel of all light."""

    name: str
    verdict: str
    tiles_that_disagree: int
    tiles_undecided: int
    whole: MeanTest
    tiles: dict[str, list[float]]  #: lists in the order of Verification.tiles: mean_a, mean_b, z, corrected_p


@dataclass(frozen=True)
class Rate:
    """r of a bias that falls as N^-r, with its standard error."""

    value: float
    standard_error: Optional[float]


@dataclass(frozen=True)
class Convergence:
    """How the bias of a consistent renderer falls."""

    renderer: str
    samples: tuple[float, ...]
    relative_bias_in_tiles: tuple[float, ...]  #: root mean square; 0: not significant
    standard_error: tuple[float, ...]
    rate: Optional[Rate] = None


@dataclass(frozen=True)
class Pair:
    """Two renderers, and whether their expectations are the same."""

    a: str
    b: str
    verdict: str  #: "agree", "undecided" or "DISAGREE"
    would_notice: Optional[float]  #: relative difference of all light that would be found with a probability of 95 %; None: black
    by_length: bool  #: whether path lengths were compared
    layers: Table[Layer] = field(repr=False)
    disagreements: Table[MeanTest] = field(repr=False)
    undecided: Table[MeanTest] = field(repr=False)
    convergence: Optional[Convergence] = None


class Verification(Table[Pair]):
    """The result of `verify`: a row for each pair of renderers. Printed, it is what `etendue verify` prints."""

    agree: bool  #: no disagreement was found
    significance: float
    comparisons: int
    tiles: tuple[tuple[int, int, int, int], ...]  #: x0, y0, x1, y1 of each [pixels]
    renderers: Table[MeasuredRenderer]
    left_out: Table[LeftOut]
    text: str

    def __init__(self, text: str, data: Mapping[str, Any]) -> None:
        super().__init__(table_from_json(Pair, data.get("pairs", ())))
        self.text = text
        self.agree = data["agree"]
        self.significance = data["significance"]
        self.comparisons = data["comparisons"]
        self.tiles = tuple((x0, y0, x1, y1) for x0, y0, x1, y1 in data["tiles"])
        self.renderers = table_from_json(MeasuredRenderer, data["renderers"])
        self.left_out = table_from_json(LeftOut, data["left_out"])

    def __str__(self) -> str:
        return self.text

    def plot(self, axes: Any = None) -> Any:
        """Draws the mean of each renderer with its 95 % interval, relative to the first; returns the axes of matplotlib."""
        axes = _axes(axes)
        reference = self.renderers[0].mean or 1
        for place, r in enumerate(self.renderers):
            axes.errorbar(r.mean / reference, place, xerr=1.96 * r.relative_error * r.mean / reference, fmt="o", capsize=3)
        axes.set_yticks(range(len(self.renderers)), [r.name for r in self.renderers])
        axes.invert_yaxis()
        axes.set_xlabel(f"mean Y over that of {self.renderers[0].name}, 95 %")
        return axes


@_errors_name_arguments
def verify(
    job: Union[Part, Path],
    renderers: Optional[Renderers] = None,
    *,
    samples: Optional[int] = None,
    passes: int = 16,
    time: Optional[float] = None,
    lengths: int = 8,
    tile: int = 0,
    significance: float = 0.01,
    force: bool = False,
    seed: Optional[int] = None,
    size: Optional[tuple[int, int]] = None,
    threads: int = 0,
    inject: float = 1,
    report: Optional[Path] = None,
    progress: Optional[Progress] = None,
) -> Verification:
    """Tests whether renderers agree on a scene, as `etendue verify` does (docs/verify.md).

    job: a Job, which is left as it is, or a scene's file.
    renderers: names of classes, expressions ("PathTracer{next_event: false}"), renderers, or a dict of names and these. None: the
        job's own and all other classes that find all light of the scene.
    samples: per pixel of each renderer, in all passes together; None: those of the job's renderer.
    passes: independent passes of each renderer. time: instead as many passes as fit into this time [s], at least 8.
    lengths: path lengths from 1 to this are compared separately, all longer ones together; 0: all lengths together only, as always where
        a renderer is written in Python, which does not report its light by path length.
    tile: side of the tiles [pixels]; 0: 32, less in small pictures.
    significance: the probability of reporting any disagreement where there is none.
    force: compare named renderers even if they miss light that the scene has.
    seed, size: of the random numbers, and (width, height) of the picture [pixels]; None: the job's.
    threads: 0: all cores.
    inject: a self test: a factor on the first renderer's result, which must be detected.
    report: a file for the page with maps of the differences.
    progress: called now and then with the fraction that is done, from 0 to 1, and what is being done.

    Ctrl-C, or an exception of `progress`, ends it. Raises Error for what is wrong in a scene or an argument.
    """
    _require("passes", passes, 8, 10000)
    _require("lengths", lengths, 0, 63)
    _require_significance(significance)
    _require_positive("time", time)
    described = _described(job, seed, size)
    if samples is not None:
        described.renderer.samples = samples
    text, data = _core.verify(
        described,
        [(name, None if isinstance(r, str) else r) for name, r in _named(renderers)],
        force,
        described.renderer.samples if described.renderer is not None else passes,
        passes,
        time or 0,
        lengths,
        tile,
        significance,
        inject,
        threads,
        _file(report),
        _title(job, 0),
        "etendue.verify",
        progress,
    )
    return Verification(text, json.loads(data))


# ---- compare ----------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Estimate:
    """A number that was estimated from independent runs."""

    value: Optional[float]
    standard_error: Optional[float]  #: None: unknown
    band: Optional[tuple[float, float]] = None  #: its 95 % confidence interval; None: unknown


@dataclass(frozen=True)
class CurvePoint:
    """The errors of a variant after so many samples per pixel and seconds of CPU time."""

    scene: str
    variant: str
    samples: float
    seconds: float
    relative_mean_square_error: Estimate
    symmetric_error: Estimate
    variance: Optional[float]
    square_bias: Optional[Estimate]


@dataclass(frozen=True)
class EqualEffort:
    """The errors of a variant at the time, or number of samples, that all variants have reached."""

    relative_mean_square_error: Optional[Estimate]  #: None: its first step took longer
    runs: tuple[float, ...]  #: the error of each run
    symmetric_error: Optional[float]


@dataclass(frozen=True)
class Bias:
    """The bias of a variant's mean."""

    known: bool  #: False: the variant alone is the reference
    found: bool = False
    verdict: str = ""  #: "agree", "undecided" or "DISAGREE"
    relative_mean: Optional[float] = None
    standard_error: Optional[float] = None
    places_that_differ: int = 0
    smallest_corrected_p: float = 1
    would_notice: Optional[float] = None


@dataclass(frozen=True)
class VariantResult:
    """A variant on a scene."""

    scene: str
    name: str
    at_equal_time: EqualEffort
    at_equal_samples: EqualEffort
    exponent_over_time: Optional[Estimate]  #: of the error; -1 is what independent samples give
    exponent_over_samples: Optional[Estimate]
    bias: Bias
    samples: float  #: per pixel of a run
    processor_seconds: float  #: of a run, over all threads
    wall_seconds: float
    bad_samples: int  #: negative or not finite, in all runs
    misses: tuple[str, ...]  #: light of the scene that the renderer does not find
    says_of_itself: Optional[str]  #: the bias that the renderer declares
    weight_in_reference: Optional[float]  #: None: it is no part of the reference
    curve: Table[CurvePoint] = field(repr=False)


@dataclass(frozen=True)
class Winner:
    """The variant with the least error, and whether it is significantly better than each other one."""

    variant: str
    significant: bool


@dataclass(frozen=True)
class ComparedScene:
    """A scene of a comparison."""

    scene: str
    width: int
    height: int
    runs: int
    reference: str
    reference_relative_variance: Optional[float]  #: None: the reference is taken as exact
    equal_samples: float
    equal_processor_seconds: float
    winner_at_equal_time: Optional[Winner]
    winner_at_equal_samples: Optional[Winner]


@dataclass(frozen=True)
class Contest:
    """Two variants on a scene."""

    scene: str
    a: str
    b: str
    ratio: Optional[float]  #: of a's error to b's
    p: float
    corrected_p: float
    significant: bool


@dataclass(frozen=True)
class MeanOverScenes:
    """The geometric mean over the scenes of a variant's error over that of the first variant, at equal time."""

    variant: str
    scenes: int
    value: Optional[float]
    relative_standard_error: Optional[float]


class ErrorComparison(Table[VariantResult]):
    """The result of `compare`: a row for each scene and variant. Printed, it is what `etendue compare` prints."""

    significance: float
    band_probability: float
    scenes: Table[ComparedScene]
    contests_at_equal_time: Table[Contest]
    contests_at_equal_samples: Table[Contest]
    means_over_scenes: Table[MeanOverScenes]
    text: str
    csv: str  #: the curves, a line for each scene, variant and number of samples

    def __init__(self, text: str, data: Mapping[str, Any], csv: str) -> None:
        rows, scenes = [], []
        for scene in data["scenes"]:
            for variant in scene["variants"]:
                of = {"scene": scene["scene"], "variant": variant["name"]}
                curve = [{**of, **point} for point in variant["curve"]]
                rows.append({"scene": scene["scene"], **variant, "curve": curve})
            scenes.append({k: v for k, v in scene.items() if k != "variants"})
        super().__init__(table_from_json(VariantResult, rows))
        self.text = text
        self.csv = csv
        self.significance = data["significance"]
        self.band_probability = data["band_probability"]
        self.scenes = table_from_json(ComparedScene, scenes)
        self.contests_at_equal_time = table_from_json(Contest, data["contests_at_equal_time"])
        self.contests_at_equal_samples = table_from_json(Contest, data["contests_at_equal_samples"])
        means = data["geometric_mean_error_over_that_of_the_first_at_equal_time"]
        self.means_over_scenes = table_from_json(MeanOverScenes, means)

    @property
    def curves(self) -> Table[CurvePoint]:
        """The errors over samples and time, of all variants."""
        return Table(point for row in self for point in row.curve)

    def __str__(self) -> str:
        return self.text

    def plot(self, axes: Any = None, *, over: str = "time", scene: Optional[str] = None) -> Any:
        """Draws the error over CPU time, or over="samples", on logarithmic scales, with 95 % bands.

        scene: one of `scenes`; None: the first. Returns the axes of matplotlib.
        """
        if over not in ("time", "samples"):
            raise Error(f"over is 'time' or 'samples', not {over!r}")
        name = self.scenes[0].scene if scene is None else scene
        rows = [row for row in self if row.scene == name]
        if not rows:
            raise Error(f"there is no scene {name!r}; there are {', '.join(repr(s.scene) for s in self.scenes)}")
        axes = _axes(axes)
        for row in rows:
            x = [p.seconds if over == "time" else p.samples for p in row.curve]
            y = [_number(p.relative_mean_square_error.value) for p in row.curve]
            bands = [p.relative_mean_square_error.band or (math.nan, math.nan) for p in row.curve]
            (line,) = axes.plot(x, y, marker=".", label=row.name)
            axes.fill_between(x, [b[0] for b in bands], [b[1] for b in bands], color=line.get_color(), alpha=0.2, linewidth=0)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xlabel("CPU time [s]" if over == "time" else "samples per pixel")
        axes.set_ylabel("relative mean square error")
        axes.set_title(name)
        axes.legend()
        return axes


@_errors_name_arguments
def compare(
    jobs: Union[Part, Path, Sequence[Union[Part, Path]], Mapping[str, Union[Part, Path]]],
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
    state: Optional[Path] = None,
    report: Optional[Path] = None,
    progress: Optional[Progress] = None,
) -> ErrorComparison:
    """Measures which algorithm has the smaller error at equal CPU time and at equal samples, as `etendue compare` does.

    jobs: a Job or a scene's file, several of them, or a dict of names and these. Jobs are left as they are.
    renderers: names of classes, expressions, renderers, or a dict of names and these. They take over the sampler, the light
        sampler and max_depth of the job's renderer, unless their own were set.
    variants: further ways to render, by name: {"short paths": {"renderer.max_depth": 4}, "as it is": {}}.
    time: CPU time of each run, over all threads [s]; or samples: per pixel of each run. One of them is needed.
    runs: independent runs of each variant.
    reference: an Image or an array (height, width, 3) of linear Rec. 709 values, or a file of a picture; one for each job where
        there are several. None: the mean of the variants that are unbiased and find all light.
    reference_time: render a reference for this CPU time [s] instead.
    tile: side of the tiles that are tested for bias [pixels]; 0: 32, less in small pictures.
    significance: the probability of calling any of several equal variants better, or biased.
    seed, size: as of `verify`. threads: 0: all cores.
    state: a folder where finished runs are kept; the same call goes on with them.
    report: a file for the page with plots, pictures and tables. insets: x, y, width, height of parts that it shows enlarged.
    progress: called now and then with the fraction that is done, from 0 to 1, and what is being done.

    Ctrl-C, or an exception of `progress`, ends it. Raises Error for what is wrong in a scene or an argument.
    """
    given = comparison_of(
        jobs, renderers, variants, time, samples, runs, reference, reference_time, tile, significance, seed, size, insets
    )
    return given.analysed(threads, _file(state), _file(report), "etendue.compare", progress)


Variants = list[tuple[str, Union[None, str, Part], list[tuple[str, str]]]]


@dataclass(frozen=True)
class Comparison:
    """What `compare` compares: its arguments, checked, and jobs of its own."""

    scenes: list[tuple[str, Any, Any]]  #: name, job, reference
    variants: Variants
    samples: int
    seconds: float
    runs: int
    reference_seconds: float
    tile: int
    significance: float
    insets: list[tuple[int, int, int, int]]

    def arguments(self, threads: int, state: str, report: str) -> tuple[Any, ...]:
        """Of _core.compare and _core.missing_runs."""
        what = (self.scenes, self.variants, self.samples, self.seconds, self.runs, self.reference_seconds, self.tile, self.significance)
        return (*what, threads, self.insets, state, report)

    @_errors_name_arguments
    def missing(self, threads: int, state: str, report: str) -> tuple[int, int, list[tuple[int, int, int, str]]]:
        """The seed, the number of all runs, and those that are not in the folder `state`: (scene, variant, run, name of its file)."""
        seed, count, runs = _core.missing_runs(*self.arguments(threads, state, report))
        return seed, count, runs

    @_errors_name_arguments
    def analysed(self, threads: int, state: str, report: str, call: str, progress: Optional[Progress]) -> ErrorComparison:
        """The result. Renders the runs that are not in the folder `state`."""
        text, data, csv = _core.compare(*self.arguments(threads, state, report), call, progress)
        return ErrorComparison(text, json.loads(data), csv)


@_errors_name_arguments
def comparison_of(
    jobs: Any,
    renderers: Optional[Renderers],
    variants: Optional[Mapping[str, Mapping[str, Any]]],
    time: Optional[float],
    samples: Optional[int],
    runs: int,
    reference: Any,
    reference_time: Optional[float],
    tile: int,
    significance: float,
    seed: Optional[int],
    size: Optional[tuple[int, int]],
    insets: Sequence[tuple[int, int, int, int]],
) -> Comparison:
    """The arguments of `compare`, checked. Raises Error."""
    if (time is None) == (samples is None):
        raise Error("give one of time= (CPU time of each run [s]) and samples= (per pixel of each run)")
    if reference is not None and reference_time is not None:
        raise Error("reference and reference_time exclude each other")
    _require("runs", runs, 3, 1000)
    if samples is not None:
        _require("samples", samples, 1, 1 << 30)
    _require_significance(significance)
    _require_positive("time", time)
    _require_positive("reference_time", reference_time)
    scenes = _scenes(jobs)
    references = _references(reference, len(scenes))
    return Comparison(
        [(name, _described(job, seed, size), r) for (name, job), r in zip(scenes, references)],
        _variants(renderers, variants),
        samples or 0,
        time or 0,
        runs,
        reference_time or 0,
        tile,
        significance,
        list(insets),
    )


# ---- conform ----------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Outcome:
    """One check of one part."""

    class_name: str
    check: str
    result: str  #: "passed", "failed" or "not tried"
    detail: str  #: of a failure what was found and what was expected; of what was not tried the reason
    part: str = field(repr=False)  #: as a text of the language, so that it can be made again
    seed: int = 1


class Conformance(Table[Outcome]):
    """The result of `conform`: a row for each check of each part. Printed, it is what `etendue conform` prints."""

    def __init__(self, texts: Sequence[str], rows: Iterable[Outcome]) -> None:
        super().__init__(rows)
        self.text: str = "\n".join(texts)

    @property
    def passed(self) -> bool:
        """No check failed, and at least one was made."""
        results = [row.result for row in self]
        return "failed" not in results and "passed" in results

    @property
    def failures(self) -> Table[Outcome]:
        """The checks that failed."""
        return Table(row for row in self if row.result == "failed")

    def __str__(self) -> str:
        return self.text

    def plot(self, axes: Any = None) -> Any:
        """Draws how many checks of each class passed, failed and were not tried; returns the axes of matplotlib."""
        axes = _axes(axes)
        names = sorted({row.class_name for row in self})
        left = [0] * len(names)
        for result in ("passed", "failed", "not tried"):
            counts = [sum(row.class_name == n and row.result == result for row in self) for n in names]
            axes.barh(names, counts, left=left, label=result)
            left = [a + b for a, b in zip(left, counts)]
        axes.invert_yaxis()
        axes.set_xlabel("checks")
        axes.legend()
        return axes


@_errors_name_arguments
def conform(
    classes: Union[None, str, type, Sequence[Union[str, type]]] = None,
    *,
    quick: bool = True,
    thorough: bool = False,
    drawn: int = 3,
    seeds: Union[int, Iterable[int]] = 1,
    threads: int = 0,
    report: Optional[Path] = None,
    progress: Optional[Progress] = None,
) -> Conformance:
    """Tests whether classes fulfil the contracts of their interfaces, as `etendue conform` does (docs/conform.md).

    classes: classes or interfaces, or their names; None: all of them, which takes minutes.
    quick: a quarter of the samples; thorough: ten times the samples; neither: the setting of the program's own tests.
    drawn: parts with random members to test of each class, besides the one with its defaults.
    seeds: of the random members and samples; for each of several seeds all is tested anew.
    threads: 0: all cores. report: a file for a page with all outcomes, those of the first seed.
    progress: called now and then with the fraction that is done, from 0 to 1, and the class.

    Ctrl-C, or an exception of `progress`, ends it after the parts that are being tested. Raises Error for a name that is no class.
    """
    _require("drawn", drawn, 0, 100000)
    if thorough and quick:
        quick = False
    names = [classes] if isinstance(classes, (str, type)) else list(classes or ())
    all_seeds = [seeds] if isinstance(seeds, int) else list(seeds)
    texts: list[str] = []
    outcomes: list[Outcome] = []
    for number, seed in enumerate(all_seeds):
        text, rows = _core.conform(
            [n if isinstance(n, str) else n.__name__ for n in names],
            "thorough" if thorough else "quick" if quick else "standard",
            drawn,
            seed,
            threads,
            _file(report) if number == 0 else "",
            "etendue.conform",
            progress and _part_of(progress, number, len(all_seeds)),
        )
        texts.append(text)
        outcomes += [Outcome(name, check, result, detail, part, seed) for name, check, part, detail, result in rows]
    return Conformance(texts, outcomes)


# ---- what they share --------------------------------------------------------------------------------------------------------


def _part_of(progress: Progress, number: int, of: int) -> Progress:
    return lambda fraction, what: progress((number + fraction) / of, what)


def _axes(axes: Any) -> Any:
    return optional_module("matplotlib.pyplot", "plot").subplots()[1] if axes is None else axes


def _number(value: Optional[float]) -> float:
    return math.nan if value is None else value


def _require(name: str, value: float, low: float, high: float) -> None:
    if not low <= value <= high:
        raise Error(f"{name} must be from {low:g} to {high:g}, not {value!r}")


def _require_significance(value: float) -> None:
    _require("significance", value, 1e-12, 0.5)


def _require_positive(name: str, value: Optional[float]) -> None:
    if value is not None and not 0 < value < math.inf:
        raise Error(f"{name} must be more than 0 seconds, not {value!r}")


def _file(path: Optional[Path]) -> str:
    return "" if path is None else os.fspath(path)


def _is_path(given: object) -> bool:
    return isinstance(given, (str, os.PathLike))


def _title(job: Union[Part, Path], number: int) -> str:
    if not isinstance(job, Part):
        return os.fspath(job)
    return _core.name_of(job) or f"job {number + 1}"


def _described(job: Union[Part, Path], seed: Optional[int], size: Optional[tuple[int, int]]) -> Any:
    """A job of its own, which the laboratory may change."""
    described: Any = _core.copy(job) if isinstance(job, Part) else load(job)
    if _core.class_name(described) != "Job":
        raise Error(f"expects a Job or a scene's file, not a {_core.class_name(described)}")
    if seed is not None:
        described.seed = seed
    if size is not None:
        described.image.width, described.image.height = size
    return described


def _scenes(jobs: Any) -> list[tuple[str, Union[Part, Path]]]:
    if isinstance(jobs, Mapping):
        named = list(jobs.items())
    else:
        several = [jobs] if isinstance(jobs, Part) or _is_path(jobs) else list(jobs)
        named = [(_title(job, i), job) for i, job in enumerate(several)]
    if not named:
        raise Error("there is no scene to compare on")
    for name, _ in named:
        if [n for n, _ in named].count(name) > 1:
            raise Error(f"there are two scenes {name!r}: give a dict with names of their own")
    return named


def _named(renderers: Optional[Renderers]) -> list[tuple[str, Union[str, Part]]]:
    """Names and renderers: expressions, which are their own names, or parts."""
    if renderers is None:
        return []
    if isinstance(renderers, Mapping):
        return [(name, _renderer(r)) for name, r in renderers.items()]
    several = [renderers] if isinstance(renderers, (str, Part, type)) else list(renderers)
    return [(r if isinstance(r, str) else _shown(r), _renderer(r, keep=True)) for r in several]


def _renderer(given: Union[str, Part, type], keep: bool = False) -> Union[str, Part]:
    if isinstance(given, type) and issubclass(given, Part):
        return given()
    if isinstance(given, Part) or (isinstance(given, str) and keep):
        return given
    if isinstance(given, str):  # under another name than its own
        parsed: Part = _core.parse_component(given if "{" in given else given + " {}", "renderers", "")
        return parsed
    raise Error(f"expects a renderer, the name of one, or an expression, not {given!r}")


def _shown(renderer: Union[Part, type]) -> str:
    """A name for results: "PathTracer", "PathTracer(next_event=False)"."""
    return renderer.__name__ if isinstance(renderer, type) else repr(renderer).removesuffix("()")


def _variants(renderers: Optional[Renderers], variants: Optional[Mapping[str, Mapping[str, Any]]]) -> Variants:
    all_of_them: Variants = [(n, r, []) for n, r in _named(renderers)]
    for name, sets in (variants or {}).items():
        texts = [(path, value if isinstance(value, str) else _core.write_value(value)) for path, value in sets.items()]
        all_of_them.append((name, None, texts))
    if not all_of_them:
        raise Error("there is nothing to compare: give renderers= or variants=")
    names = [name for name, _, _ in all_of_them]
    for name in names:
        if names.count(name) > 1:
            raise Error(f"there are two variants {name!r}: give a dict with names of their own")
    return all_of_them


def _references(reference: Any, count: int) -> list[Any]:
    if reference is None:
        return [None] * count
    single = _is_path(reference) or hasattr(reference, "xyz") or hasattr(reference, "shape")
    several = [reference] if single else list(reference)
    if len(several) != count:
        raise Error(f"there are {len(several)} references for {count} scenes: give one for each, in the same order")
    return [_reference(r) for r in several]


def _reference(reference: Any) -> Any:
    if _is_path(reference):
        return os.fspath(reference)
    import numpy

    if (xyz := getattr(reference, "xyz", None)) is not None:
        return numpy.ascontiguousarray(xyz() if callable(xyz) else xyz, dtype=numpy.float64), True
    array = numpy.ascontiguousarray(reference, dtype=numpy.float64)
    if array.ndim != 3 or array.shape[2] != 3:
        raise Error(f"reference is an array of shape (height, width, 3), not {array.shape}")
    return array, False
