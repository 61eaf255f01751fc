#!/usr/bin/env python3
"""Imports scenes of other programs, renders them and compares with the pictures those programs made.

    tests/references/references.py --program build/etendue --data ../shared/validation --quick
    tests/references/references.py --program build/etendue --data ../shared/validation --report docs/results/references.md

Two things are asked of a picture, and both are shown. Statistics first: by how many standard errors the mean of the whole
differs from the reference's in X, Y or Z, whichever is most; up to three no difference is seen. The bound second: within how
much of the reference the picture is proven to be, which is the difference and two standard errors. A picture agrees when in each
of X, Y and Z the mean of the whole is within three standard errors + 0.2 % of the reference's, and no tile of 8 x 8 pixels is
further than four standard errors + 1 % (of the tile, or of a hundredth of the whole's mean); and when the standard error is small
enough for that to mean something, at most 0.35 %. Else it is undecided. Samples are taken until the render's own standard error is
0.2 % of the whole; the reference's own is 0.14 % and 0.26 % for the grids under an area light and a point light.
Standard errors are those of both pictures: of the reference by its published variance at 32000 samples a pixel, of the render by
the variance layer of the film, which is of Y; X and Z have it times the ratio in which renders with different seeds scatter.
Where the reference's errors are not known (Tungsten's pictures), the bounds are 1 % and, of tiles of 64 x 64 pixels, 5 %.
Where a reason for a difference is known (scenes.py), the picture is held to these bounds about what the reason explains.
"""

import argparse
import math
import subprocess
import sys
import tempfile
from pathlib import Path

from scenes import EXPORTS, SCENES

NOT_TRIED = 77  # the exit status that the test suite shows as skipped
try:
    import numpy as np
except ImportError:
    print("skipped: NumPy is not there (pip install numpy)")
    sys.exit(NOT_TRIED)

REFERENCE_SAMPLES = 32000
SEEDS = 4
SAMPLES_OF_ALL_PIXELS = 2_000_000  # of the first try, which tells how many are needed
WANTED_ERROR = 0.002  # of the render's mean Y
MOST_SAMPLES_OF_ALL_PIXELS = 400_000_000
DECISIVE_ERROR = 0.0035  # of both pictures: above it agreement says nothing


def run(command):
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, command))}\n{result.stdout}{result.stderr}")
    return result.stderr


def xyz(program, picture, folder):
    """A picture's X, Y, Z."""
    out = Path(folder) / "picture.npy"
    run([program, "image", "tonemap", picture, out, "--tone-map", "NoToneMap {}"])
    return np.load(out).astype(float)


def render(program, scene, data, samples, seed, folder, extra):
    out = Path(folder) / "render.npy"
    command = [program, "render", Path(data) / scene.file, "--allow-path", data, "--quiet", "--samples", samples, "--seed", seed,
               "--set", f'outputs=[NpyOutput {{ file: "{out}", layers: true }}]', "--set", 'image.layers=["variance"]',
               *scene.options, *extra]
    if scene.size:
        command += ["--size", f"{scene.size[0]}x{scene.size[1]}"]
    notes = run([str(c) for c in command])
    return np.load(out).astype(float), notes


def tiles(picture, size):
    """Means over squares; what does not fill a square at the right and below is left out."""
    h, w = picture.shape[0] // size * size, picture.shape[1] // size * size
    return picture[:h, :w].reshape(h // size, size, w // size, size, -1).mean((1, 3))


def mean_error(stack):
    """The standard error of the mean Y of renders with their variances, relative."""
    n = stack[0, ..., 0].size
    return math.sqrt(stack[..., 3].mean(0).sum() / len(stack)) / n / max(stack[..., 1].mean(), 1e-30)


def render_all(program, scene, data, samples, folder, extra):
    renders = [render(program, scene, data, samples, seed, folder, extra) for seed in range(1, SEEDS + 1)]
    return np.array([picture for picture, _ in renders]), renders[0][1]


def compare(program, scene, data, effort, quick, extra=()):
    with tempfile.TemporaryDirectory() as folder:
        reference = xyz(program, Path(data) / scene.reference, folder)
        pixels = reference.shape[0] * reference.shape[1]
        if scene.size:
            pixels = scene.size[0] * scene.size[1]
        samples = max(4, int(SAMPLES_OF_ALL_PIXELS * effort / pixels / SEEDS) * (8 if scene.size else 1))
        samples = max(samples, -(-scene.samples // SEEDS))
        stack, notes = render_all(program, scene, data, samples, folder, extra)
        if not quick and mean_error(stack) > WANTED_ERROR:
            needed = samples * (mean_error(stack) / WANTED_ERROR) ** 2 * 1.1
            samples = max(samples, int(min(needed, effort * MOST_SAMPLES_OF_ALL_PIXELS / pixels / SEEDS)))
            stack, notes = render_all(program, scene, data, samples, folder, extra)
        known = bool(scene.variance)
        reference_variance = xyz(program, Path(data) / scene.variance, folder) / REFERENCE_SAMPLES if known else 0 * reference
    ours = stack[..., :3].mean(0)
    scatter = np.sqrt(np.mean(stack[..., :3].var(0, ddof=1), axis=(0, 1)))
    ratio = (scatter / max(scatter[1], 1e-30)).clip(1, 4)
    variance = stack[..., 3].mean(0)[..., None] / SEEDS * ratio**2
    if scene.size:  # a tile of the reference is a smaller one here
        factor = reference.shape[1] // scene.size[0]
        reference, reference_variance = tiles(reference, factor), tiles(reference_variance, factor)
    size = scene.tile // (factor if scene.size else 1)
    n, in_tile = ours.shape[0] * ours.shape[1], size * size
    # A filter wider than a pixel makes neighbours alike, so that means are less certain than of independent pixels.
    alike = 4 if "texture_interp" in scene.file else 1
    error = np.sqrt((variance.sum((0, 1)) * alike + np.abs(reference_variance).sum((0, 1))) / n**2)
    mean, wanted = ours.mean((0, 1)), reference.mean((0, 1))
    whole_bound = 3 * error + (0.002 if known else 0.01) * wanted
    agrees = bool((np.abs(mean - wanted) <= whole_bound).all())
    away = np.abs(mean - wanted) / np.maximum(error, 1e-30)
    proven = (np.abs(mean - wanted) + 2 * error) / wanted
    explained = bool((np.abs(mean - wanted * (1 + np.array(scene.explained))) <= whole_bound).all())
    t_ours, t_wanted = tiles(ours, size), tiles(reference, size)
    t_error = np.sqrt((tiles(variance, size) * alike + tiles(np.abs(reference_variance), size)) / in_tile)
    t_bound = 4 * t_error + (0.01 if known else 0.05) * np.maximum(t_wanted, wanted / 100)
    over = np.abs(t_ours - t_wanted) / t_bound
    if scene.skip_above:
        h, w = t_ours.shape[:2]
        brightest = reference[:h * size, :w * size, 1].reshape(h, size, w, size).max((1, 3))
        over[brightest > scene.skip_above] = 0
    worst = np.unravel_index(np.argmax(over.max(-1)), over.shape[:2])
    bad_tiles = int((over.max(-1) > 1).sum())
    return {
        "scene": scene, "samples": samples * SEEDS, "mean": mean, "wanted": wanted, "difference": mean / wanted - 1,
        "error": error / wanted, "agrees": agrees and bad_tiles == 0, "away": float(away.max()), "proven": float(proven.max()),
        "decided": quick or not known or float((error / wanted)[1]) <= DECISIVE_ERROR,
        "explained": bool(scene.reason) and explained and bad_tiles <= scene.explained_tiles, "bad_tiles": bad_tiles,
        "count": over.shape[0] * over.shape[1], "worst": worst,
        "worst_difference": (t_ours / np.maximum(t_wanted, 1e-9) - 1)[worst], "worst_over": over[worst].max(), "notes": notes,
        "ours": ours, "reference": reference,
    }


def verdict(r):
    if r["agrees"]:
        return "agrees" if r["decided"] else "undecided"
    return "differs, explained" if r["explained"] else "DIFFERS"


def line(r):
    d, e = 100 * r["difference"], 100 * r["error"]
    return (f"{r['scene'].file.split('/')[-2 if 'bitterli' in r['scene'].file else -1]:55} {verdict(r):18} "
            f"X {d[0]:+.2f} Y {d[1]:+.2f} Z {d[2]:+.2f} % (error {e[1]:.2f} %, {r['away']:.1f} of it, within {100 * r['proven']:.2f} %)  tiles over {r['bad_tiles']}/{r['count']}, worst "
            f"{tuple(int(i) for i in r['worst'])} {np.round(100 * r['worst_difference'], 1)} % = {r['worst_over']:.2f} of the bound")


def rows_of(path):
    """The rows of an earlier report, by scene: those of scenes that are not compared this time stay."""
    if not Path(path).exists():
        return {}
    lines = [line for line in Path(path).read_text().splitlines() if line.startswith(("| mitsuba/", "| bitterli/"))]
    return {line.split("|")[1].strip(): line for line in lines}


def report(results, rows):
    text = ["# References", "", "Random scenes of Mitsuba are compared by `tests/references/differential.py`.", "",
            "Generated by `tests/references/references.py --report`; the bounds are told at its top. Differences are of the whole "
            "picture's X, Y and Z from the reference's; the standard error is that of both, of Y. Up to three standard errors away "
            "no difference is seen; the picture is proven to be within the difference and two standard errors of the reference "
            "(of Tungsten's pictures the error is not known, and counts as none).", "",
            "| scene | samples a pixel | X | Y | Z | standard error | errors away | proven within | tiles beyond the bound | |",
            "|---|---|---|---|---|---|---|---|---|---|"]
    for r in results:
        d = 100 * r["difference"]
        rows[r["scene"].file] = (f"| {r['scene'].file} | {r['samples']} | {d[0]:+.2f} % | {d[1]:+.2f} % | {d[2]:+.2f} % | "
                                 f"{100 * r['error'][1]:.2f} % | {r['away']:.1f} | {100 * r['proven']:.2f} % | {r['bad_tiles']} of {r['count']} | {verdict(r)} |")
    text += [rows[scene.file] for scene in SCENES if scene.file in rows]
    text += ["", "## Why some differ", ""]
    text += [f"- **{scene.file}**: {scene.reason}" for scene in SCENES if scene.reason]
    text += ["", "## Exports", "", EXPORTS]
    return "\n".join(text) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--data", required=True, help="the folder of validation data")
    parser.add_argument("--quick", action="store_true", help="few samples of the scenes that take least")
    parser.add_argument("--effort", type=float, default=1.0, help="factor of the number of samples")
    parser.add_argument("--only", default="", help="scenes whose file name holds this")
    parser.add_argument("--report", help="where to write the table")
    parser.add_argument("--keep", help="a folder for both pictures of each scene, as .npy")
    options = parser.parse_args()
    if not Path(options.data, "mitsuba").is_dir():
        print(f"skipped: there is no validation data in {options.data}")
        return NOT_TRIED
    scenes = [s for s in SCENES if options.only in s.file and (s.quick or not options.quick)]
    results, failed = [], 0
    for scene in scenes:
        try:
            r = compare(options.program, scene, options.data, options.effort / (20 if options.quick else 1), options.quick)
        except RuntimeError as error:
            print(f"{scene.file} FAILED\n{error}", flush=True)
            failed += 1
            continue
        print(line(r), flush=True)
        if verdict(r) in ("DIFFERS", "undecided"):
            failed += 1
        if options.keep:
            name = scene.file.replace("/", "_")
            np.save(Path(options.keep) / f"{name}.ours.npy", r["ours"])
            np.save(Path(options.keep) / f"{name}.reference.npy", r["reference"])
        results.append(r)
        if options.report:
            Path(options.report).write_text(report(results, rows_of(options.report)))
    print(f"{len(scenes) - failed} of {len(scenes)} agree or differ for a reason that is told")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
