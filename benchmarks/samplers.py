#!/usr/bin/env python3
"""Measures the samplers: writes docs/results/samplers.md.

    ./etendue python
    PYTHONPATH=build/python python3 benchmarks/samplers.py --scenes FOLDER [--runs FOLDER] [--write docs/results/samplers.md]

Needs NumPy. FOLDER has scenes of other programs, a folder each (B. Bitterli's, as Mitsuba's XML). Points: L2 star discrepancy and star
discrepancy of pairs of numbers, errors of four integrals, nanoseconds for a pair. Pictures: `etendue compare` of all samplers, at 16 and
256 samples, on the scenes by which the default is chosen, and on scenes of our own that are looked at afterwards. With --runs the
comparisons stay in a folder, and those that are there are not made again.
"""
import argparse
import json
import math
import os
import subprocess
import tempfile
import time

import etendue
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
SAMPLERS = ["IndependentSampler", "StratifiedSampler", "LatticeSampler", "HaltonSampler", "SobolSampler", "Pmj02Sampler",
            "PairsInQuadsSampler", "ZSobolSampler"]
BLUE = "Pmj02Sampler, blue_noise"
POINTS = SAMPLERS[:6] + [BLUE] + SAMPLERS[6:]
SHORT = {name: name.replace("Sampler", "") for name in POINTS}
CHOICE = ["classroom", "cornell-box", "dining-room", "living-room", "material-testball", "staircase2", "veach-ajar", "veach-mis"]
HELD_OUT = ["cornell_box", "window_room", "depth_of_field", "shader_ball"]
BUDGETS = {16: ("48x27", 8), 256: ("32x18", 3)}  # samples per pixel: the picture's size, and how many independent runs
MORE_RUNS = {("material-testball", 256): 9, ("veach-mis", 256): 9}  # where rare bright paths make the error


def made(name, samples):
    """The sampler, set for so many samples of a pixel."""
    if name == "ZSobolSampler":
        return etendue.ZSobolSampler(samples=samples)
    if name == "StratifiedSampler":
        x = 2 ** (int(math.log2(samples) + 1) // 2)
        return etendue.StratifiedSampler(x=x, y=samples // x)
    if name == BLUE:
        return etendue.Pmj02Sampler(blue_noise=True)
    return getattr(etendue, name)()


def points(sampler, n, pixel, dimension, seed=1):
    pixels = np.tile(np.array([[pixel % 64, pixel // 64]], dtype=np.int32), (n, 1))
    return np.asarray(sampler.pairs(pixels, np.arange(n, dtype=np.uint32), dimension, seed=seed), dtype=np.float64)


# ---- points

def l2_star_discrepancy(p):
    """Warnock 1972."""
    n = len(p)
    once = np.prod(1 - p ** 2, axis=1).sum() / 4
    twice = np.prod(1 - np.maximum(p[:, None, :], p[None, :, :]), axis=2).sum()
    return math.sqrt(max(0.0, 1 / 9 - 2 * once / n + twice / n ** 2))


def star_discrepancy(p):
    """Of points of the plane, exactly: the suprema are at corners made of the points' coordinates (Niederreiter 1972)."""
    n = len(p)
    xs, ys = np.append(np.sort(p[:, 0]), 1.0), np.append(np.sort(p[:, 1]), 1.0)
    below = np.zeros((n + 2, n + 2))
    column, row = np.searchsorted(xs[:-1], p[:, 0]), np.searchsorted(ys[:-1], p[:, 1])
    np.add.at(below, (column + 1, row + 1), 1)
    below = below.cumsum(0).cumsum(1)  # [i, j]: points among the first i of x and j of y
    area = np.outer(xs, ys)
    opened, closed = below[:n + 1, :n + 1], below[1:n + 2, 1:n + 2]
    return max(np.abs(area - opened / n).max(), np.abs(closed / n - area).max())


# Christensen, Kensler & Kilpatrick 2018, section 3: two discontinuous functions, two smooth ones, with their integrals.
INTEGRANDS = {
    "disk": (lambda p: (p[:, 0] ** 2 + p[:, 1] ** 2 < 2 / math.pi).astype(float), 0.5),
    "triangle": (lambda p: (p[:, 1] > p[:, 0]).astype(float), 0.5),
    "gaussian": (lambda p: np.exp(-p[:, 0] ** 2 - p[:, 1] ** 2), math.pi / 4 * math.erf(1) ** 2),
    "bilinear": (lambda p: p[:, 0] * p[:, 1], 0.25),
}
# In four dimensions, the film's point and the first luminaire's: a product of two, and one that is none.
FOUR = {
    "gaussian in 4": (lambda p: np.exp(-(p ** 2).sum(axis=1)), (math.pi / 4 * math.erf(1) ** 2) ** 2),
    "half space in 4": (lambda p: (p.sum(axis=1) < 2).astype(float), 0.5),
}


def errors(name, n, trials):
    """Root mean square errors of the integrands by the first n points of pixels."""
    sampler, sums = made(name, n), {}
    for trial in range(trials):
        p, q = points(sampler, n, trial, 0), points(sampler, n, trial, 7)
        both = np.hstack([p, q])
        for functions, at in ((INTEGRANDS, p), (FOUR, both)):
            for what, (f, integral) in functions.items():
                sums.setdefault(what, []).append((f(at).mean() - integral) ** 2)
    return {what: math.sqrt(np.mean(s)) for what, s in sums.items()}


def slope(counts, values):
    return np.polyfit(np.log(counts), np.log(np.maximum(values, 1e-12)), 1)[0]


def nanoseconds(name, n=1 << 21):
    sampler = made(name, 16)
    rng = np.random.default_rng(1)
    pixels = rng.integers(0, 1000, (n, 2)).astype(np.int32)
    samples = (np.arange(n) % 16).astype(np.uint32)
    best = math.inf
    for _ in range(5):
        before = time.process_time()
        sampler.pairs(pixels, samples, 10)
        best = min(best, time.process_time() - before)
    return best / n * 1e9


def point_tables():
    text = ["## Discrepancy\n", "Means over 64 pixels, pairs of the dimensions 0 and 1: L2 star discrepancy (Warnock 1972), and star discrepancy "
            "(exact).\n", "| | L2: 16 | 64 | 256 | 1024 | slope | star: 16 | 64 | 256 | slope |", "|---|" + "---:|" * 9]
    counts = [16, 64, 256, 1024]
    for name in POINTS:
        l2 = [np.mean([l2_star_discrepancy(points(made(name, n), n, i, 0)) for i in range(64 if n < 1024 else 16)]) for n in counts]
        star = [np.mean([star_discrepancy(points(made(name, n), n, i, 0)) for i in range(64)]) for n in counts[:3]]
        text.append("| %s | %s | %.2f | %s | %.2f |" % (SHORT[name], " | ".join("%.5f" % v for v in l2), slope(counts, l2),
                                                     " | ".join("%.4f" % v for v in star), slope(counts[:3], star)))
    text += ["\n## Convergence\n",
             "Root mean square errors over 256 pixels (64 for more than 1024 samples): at 256 samples, and the slope of their logarithms from "
             "16 to 4096 samples. Independent numbers have −0.5. disk, triangle, gaussian and bilinear are those of Christensen, Kensler & Kilpatrick "
             "2018, over one pair of dimensions; the last two integrate over two pairs, the film's and the first luminaire's: "
             "exp(−x²) in four dimensions, and the half space below the sum 2.\n"]
    names = list(INTEGRANDS) + list(FOUR)
    text += ["| | " + " | ".join(names) + " |", "|---|" + "---:|" * len(names)]
    counts = [16, 64, 256, 1024, 4096]
    for name in POINTS:
        rows = [errors(name, n, 64 if n > 1024 else 256) for n in counts]
        text.append("| %s | %s |" % (SHORT[name], " | ".join("%.1e, %.2f" % (rows[2][w], slope(counts, [r[w] for r in rows])) for w in names)))
    return text


def cost_table():
    own = {name: nanoseconds(name) for name in SAMPLERS}
    return ["\n## Cost\n", "Nanoseconds of processor time for a pair, asked for by Python on arrays, with the array's own share: %s.\n"
            % ", ".join("%s %.0f" % (SHORT[n], t) for n, t in own.items())]


# ---- pictures

def variant(name, samples):
    if name == "ZSobolSampler":
        return "ZSobolSampler{samples: %d}" % samples
    if name == "StratifiedSampler":
        side = int(math.sqrt(samples))
        return "StratifiedSampler{x: %d\ny: %d}" % (side, side)
    return name + "{}"


def compared(program, file, name, samples, folder):
    """The results of `etendue compare` for a scene: of each sampler the relMSE of its runs and its processor time for a run [s]."""
    path = os.path.join(folder, "%s.%d.json" % (name, samples))
    if not os.path.exists(path):
        size, runs = BUDGETS[samples]
        runs = MORE_RUNS.get((name, samples), runs)
        command = [program, "compare", file, "--samples", str(samples), "--runs", str(runs), "--size", size, "--seed", "5", "--quiet",
                   "--json", path, "--csv", path.replace(".json", ".csv")]
        for sampler in SAMPLERS:
            command += ["--variant", "%s: renderer.sampler=%s" % (sampler, variant(sampler, samples))]
        subprocess.run(command, check=True, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    with open(path) as f:
        variants = json.load(f)["scenes"][0]["variants"]
    return {v["name"]: (v["at_equal_samples"]["runs"], v["processor_seconds"]) for v in variants}


def ratio_to_default(results, name):
    """The geometric mean of a sampler's relMSE relative to SobolSampler's, the square of its relative standard error, and the ratio
    of processor times."""
    logs, default = (np.log(results[n][0]) for n in (name, "SobolSampler"))
    variance = 0 if name == "SobolSampler" else logs.var(ddof=1) / len(logs) + default.var(ddof=1) / len(default)
    return logs.mean() - default.mean(), variance, results[name][1] / results["SobolSampler"][1]


def scene_table(program, scenes, samples, folder):
    names = [n for n in SAMPLERS if n != "SobolSampler"]
    text = ["| %d samples | Sobol: relMSE | %s |" % (samples, " | ".join(SHORT[n] for n in names)), "|---|" + "---:|" * (len(names) + 1)]
    sums = {n: [0.0, 0.0, 0.0] for n in names}
    for name, file in scenes.items():
        results = compared(program, file, name, samples, folder)
        row = []
        for n in names:
            log, variance, seconds = ratio_to_default(results, n)
            row.append("%.2f ± %.2f" % (math.exp(log), math.exp(log) * math.sqrt(variance)))
            sums[n] = [sums[n][0] + log / len(scenes), sums[n][1] + variance / len(scenes) ** 2, sums[n][2] + math.log(seconds) / len(scenes)]
        text.append("| %s | %.3g | %s |" % (name, math.exp(np.log(results["SobolSampler"][0]).mean()), " | ".join(row)))
    text.append("| **all** | | %s |" % " | ".join("**%.2f ± %.2f**" % (math.exp(m), math.exp(m) * math.sqrt(v)) for m, v, _ in sums.values()))
    text.append("| processor time | | %s |" % " | ".join("%.2f" % math.exp(t) for _, _, t in sums.values()))
    return text


def picture_tables(program, scenes_folder, runs):
    text = ["\n## Pictures\n",
            "relMSE at equal samples, relative to SobolSampler's, with one standard error, by `etendue compare` with the scene's own renderer and "
            "filter: %s (material-testball and veach-mis: 9). The reference is the mean of all runs but the one that is compared with it. ZSobol and "
            "Stratified are set for the number of samples. Where the standard error is large, a few rare bright paths make the error, whatever the "
            "sampler (window_room, veach-mis, material-testball). Times are of a busy machine.\n"
            % ", ".join("%d samples at %s, %d runs" % (n, *b) for n, b in BUDGETS.items())]
    theirs = {}
    for name in CHOICE:
        here = os.path.join(scenes_folder, name)
        theirs[name] = next(p for p in (os.path.join(here, f) for f in ("scene_v3.xml", "scene.xml")) if os.path.exists(p))
    ours = {name: os.path.join(HERE, "..", "scenes", name + ".etd") for name in HELD_OUT}
    for title, scenes in (("The eight scenes by which the default is chosen", theirs), ("Scenes looked at afterwards", ours)):
        text.append("### %s\n" % title)
        for samples in BUDGETS:
            text += scene_table(program, scenes, samples, runs) + [""]
    return text


def blurred(picture, deviation):
    """By a Gaussian of a standard deviation in pixels, separably; what lies beyond the border is mirrored."""
    if deviation == 0:
        return picture
    reach = int(math.ceil(3 * deviation))
    weights = np.exp(-np.arange(-reach, reach + 1) ** 2 / (2 * deviation ** 2))
    weights /= weights.sum()
    for axis in (0, 1):
        widths = [(reach, reach) if a == axis else (0, 0) for a in (0, 1)]
        padded = np.pad(picture, widths, mode="symmetric")
        picture = np.apply_along_axis(lambda line: np.convolve(line, weights, mode="valid"), axis, padded)
    return picture


BLURRED = ["cornell-box", "dining-room", "veach-mis"]
DEVIATIONS = [0, 1, 2]  # pixels


def blur_table(program, scenes_folder, runs, samples=16, size="48x27", count=6):
    """The variance of Y over runs with different seeds, of pictures after a blur, relative to SobolSampler's."""
    text = ["### Noise after a blur\n",
            "The variance of Y relative to SobolSampler's, in pictures that were blurred by a Gaussian of so many pixels, as eyes and denoisers do: "
            "%d samples at %s, %d runs, with a box filter. Where neighbouring errors compensate each other it falls.\n" % (samples, size, count),
            "| | " + " | ".join("%s: %d px" % (n, d) for n in BLURRED for d in DEVIATIONS) + " |", "|---|" + "---:|" * (len(BLURRED) * len(DEVIATIONS))]
    variances = {}
    for scene in BLURRED:
        here = os.path.join(scenes_folder, scene)
        file = next(p for p in (os.path.join(here, f) for f in ("scene_v3.xml", "scene.xml")) if os.path.exists(p))
        for sampler in ("IndependentSampler", "SobolSampler", "ZSobolSampler"):
            pictures = []
            for seed in range(1, count + 1):
                path = os.path.join(runs, "blur.%s.%s.%d.npy" % (scene, sampler, seed))
                if not os.path.exists(path):
                    subprocess.run([program, "render", file, "--quiet", "--size", size, "--samples", str(samples), "--seed", str(seed), "--set",
                                    "renderer.sampler=" + variant(sampler, samples), "--set", "image.filter=BoxFilter{}", "-o", path],
                                   check=True, stderr=subprocess.DEVNULL)
                pictures.append(np.load(path)[..., 1].astype(np.float64))
            weight = 1 / (np.mean(pictures, axis=0) ** 2 + 0.01 * np.mean(pictures) ** 2)
            for d in DEVIATIONS:
                variances[scene, d, sampler] = (weight * np.var([blurred(x, d) for x in pictures], axis=0, ddof=1)).mean()
    for sampler in ("IndependentSampler", "ZSobolSampler"):
        text.append("| %s | %s |" % (SHORT[sampler], " | ".join("%.2f" % (variances[n, d, sampler] / variances[n, d, "SobolSampler"])
                                                            for n in BLURRED for d in DEVIATIONS)))
    return text


INTRODUCTION = """# The samplers

Made by [`benchmarks/samplers.py`](../../benchmarks/samplers.py); what follows for the default is in
[decision 061](../decisions/061-samplers.md). Each sampler is one file in `src/components/samplers`, with its paper and its derivation.

| | what it promises | best with |
|---|---|---|
| Independent | nothing | any number |
| Stratified | one sample in each cell of a grid | multiples of the cells |
| Lattice | shifted rank-1 lattices of long dual vectors | powers of 2 |
| Halton | strata in a prime base for each dimension | any number |
| Sobol | each pair of dimensions a (0,2)-sequence in base 2 | powers of 2 |
| Pmj02 | the same, otherwise random; points kept apart by `blue_noise` | powers of 2, up to 4096 |
| PairsInQuads | the same, and four dimensions a (0,4)-sequence in base 4 | powers of 4 |
| ZSobol | (0,2)-sequences shared by neighbouring pixels | `samples` |
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=os.path.join(HERE, "..", "build", "etendue"))
    parser.add_argument("--scenes", required=True)
    parser.add_argument("--runs")
    parser.add_argument("--write", default=os.path.join(HERE, "..", "docs", "results", "samplers.md"))
    given = parser.parse_args()
    text = [INTRODUCTION] + point_tables() + cost_table()
    with tempfile.TemporaryDirectory() as temporary:
        text += picture_tables(given.program, given.scenes, given.runs or temporary)
        text += blur_table(given.program, given.scenes, given.runs or temporary)
    with open(given.write, "w") as f:
        f.write("\n".join(text).rstrip() + "\n")


if __name__ == "__main__":
    main()
