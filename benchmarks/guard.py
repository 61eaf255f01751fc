#!/usr/bin/env python3
"""Two builds in turns on the eight scenes of peer_scenes.py: what has become slower?

    git worktree add ../before HEAD~1 && cmake -S ../before -B ../before/build && cmake --build ../before/build --target etendue_program
    python3 benchmarks/guard.py --before ../before/build/etendue --scenes ../shared/validation/bitterli

Needs `pip install numpy scipy`. Exit status: 0 nothing became slower, 1 something did, 2 it could not be measured.

For each scene
  - the number of samples is chosen so that a run of the older build takes about --seconds of the processor's time;
  - both builds render with the same seed, one right after the other, on one thread, --pairs times; which of them comes first changes
    from pair to pair. What counts is the processor's time (user and system) of the whole process, start-up included: unlike the
    clock it does not count the time in which other programs have the processor, though it grows when they take memory and caches;
  - the logarithms of the ratios after / before of the pairs are tested by Wilcoxon's signed-rank test (exact, one-sided) for being above
    log(1 + --tolerance): no assumption is made of how times are spread but that the two builds could change places;
  - "slower" is what stays significant at --significance in all when eight scenes were tried, by Holm's method (1979). "Faster" likewise, by
    the other side of the test, and below 1;
  - the ratio is the Hodges-Lehmann estimate, the median of the means of all two pairs, with the interval that belongs to the test
    at the level divided by the number of scenes. Its upper end says how much slower the build could be unnoticed: look at it before
    a run is called good, and give more --pairs or --seconds if it is too far up;
  - the pictures of the same seed are compared: where they are the same bytes only time can differ. Where not, the root of the mean
    square difference over the mean luminance is told, and times alone decide nothing: compare errors too (peers.py).
"""
import argparse
import json
import math
import pathlib
import sys
import tempfile

import numpy as np
from scipy import stats

import peer_scenes
import processes


def render(program, scene, samples, seed, out):
    return processes.run([program, "render", scene.file, "--allow-path", scene.folder, "--samples", samples, "--seed", seed, "--threads",
                          1, "--set", f"renderer.max_depth={scene.depth}", "-o", out, "--quiet"])


def samples_for(program, scene, seconds, out):
    """So many that a run takes about so long: from what a few and what more of them take."""
    few, more = 1, 4
    start = render(program, scene, few, 0, out).seconds
    each = max((render(program, scene, more, 0, out).seconds - start) / (more - few), 1e-4)
    return max(1, round((seconds - start) / each) + few)


def tested(ratios, tolerance):
    """One-sided probabilities of logarithms of ratios like these if the build is no slower, and no faster."""
    def p(values, side):
        values = values[values != 0]
        return float(stats.wilcoxon(values, alternative=side, method="exact").pvalue) if len(values) else 1.0
    return p(ratios - math.log1p(tolerance), "greater"), p(ratios, "less")


def estimate(ratios, level):
    """The Hodges-Lehmann estimate of the ratio, and the interval of that level: between Walsh averages, as many from each end as the
    distribution of the signed-rank sum allows (Hollander & Wolfe 1999, section 3.2)."""
    n = len(ratios)
    walsh = np.sort([(ratios[i] + ratios[j]) / 2 for i in range(n) for j in range(i, n)])
    ways = np.zeros(n * (n + 1) // 2 + 1)  # in how many ways some of the ranks 1 to n add up to each sum
    ways[0] = 1
    for rank in range(1, n + 1):
        ways[rank:] += ways[:-rank].copy()
    below = np.cumsum(ways) / 2.0 ** n
    out = int(np.searchsorted(below, level / 2, side="right"))  # sums 0 ... out - 1 have a probability of level / 2 at most
    if out == 0:
        return float(np.exp(np.median(walsh))), 0.0, math.inf
    return tuple(float(np.exp(v)) for v in (np.median(walsh), walsh[out - 1], walsh[-out]))


def holm(probabilities, significance):
    """Which of several tests are significant, all together at that level: the least against significance / their number, the next
    against one fewer, until one is not (Holm 1979)."""
    found = {}
    still = True
    for i, name in enumerate(sorted(probabilities, key=probabilities.get)):
        still = still and probabilities[name] <= significance / (len(probabilities) - i)
        found[name] = still
    return found


def difference(a, b):
    if a.tobytes() == b.tobytes():
        return 0.0
    return float(np.sqrt(np.mean((a - b) ** 2)) / max(np.mean(b), 1e-30))


def measure(scene, options, folder):
    out = [folder / "before.npy", folder / "after.npy"]
    programs = [options.before, options.after]
    samples = samples_for(options.before, scene, options.seconds, out[0])
    times, memory, differs = [], [0, 0], 0.0
    for pair in range(options.pairs):
        both = [0.0, 0.0]
        for which in ((0, 1) if pair % 2 == 0 else (1, 0)):
            used = render(programs[which], scene, samples, pair, out[which])
            both[which], memory[which] = used.seconds, max(memory[which], used.megabytes)
        times.append(both)
        differs = max(differs, difference(*(np.load(o)[:, :, 1] for o in out)))
    ratios = np.log([after / before for before, after in times])
    slower, faster = tested(ratios, options.tolerance)
    return {"samples": samples, "seconds": times, "slower": slower, "faster": faster, "differs": differs, "memory": memory,
            "ratios": ratios}


def check():
    """The statistics against values known from elsewhere."""
    rising = np.log(1.1 + 0.01 * np.arange(8))
    assert abs(tested(rising, 0)[0] - 1 / 256) < 1e-12, "all eight pairs slower: 1 / 2^8"
    assert tested(rising, 1)[0] == 1, "none is twice as slow"
    # Hollander & Wolfe, table A.4: P(T+ <= 8) = 0.0488 / 2 or less with n = 10, so the interval leaves out 8 averages at each end.
    values = np.log(1 + np.arange(10) / 100.0)
    walsh = sorted((values[i] + values[j]) / 2 for i in range(10) for j in range(i, 10))
    found = estimate(values, 0.05)
    assert abs(math.log(found[1]) - walsh[8]) < 1e-12 and abs(math.log(found[2]) - walsh[-9]) < 1e-12, found
    assert holm({"a": 0.01, "b": 0.04, "c": 0.02}, 0.05) == {"a": True, "b": True, "c": True}
    assert holm({"a": 0.02, "b": 0.04, "c": 0.03}, 0.05) == {"a": False, "b": False, "c": False}
    # Of builds that do not differ, no more than one in twenty tables of eight scenes may tell of one (400 tables: 20 +- 4.4).
    random = np.random.default_rng(1)
    false = sum(any(holm({s: tested(random.standard_t(3, 12) * 0.02, 0)[0] for s in range(8)}, 0.05).values()) for _ in range(400))
    assert false <= 34, false
    print(f"the statistics are right; {false} of 400 tables of equal builds told of one that is slower, 20 may")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    here = pathlib.Path(__file__).resolve().parent
    parser.add_argument("--before", help="the older program")
    parser.add_argument("--after", default=str(here.parent / "build" / "etendue"))
    parser.add_argument("--scenes", type=pathlib.Path, help="the folder of Bitterli's scenes; without it the four made here alone")
    parser.add_argument("--only", action="append", help="a scene's name; may be repeated")
    parser.add_argument("--pairs", type=int, default=14, help="at least 8: with fewer no result could be significant")
    parser.add_argument("--seconds", type=float, default=3, help="of the processor, for a run")
    parser.add_argument("--tolerance", type=float, default=0.005, help="how much slower is no matter")
    parser.add_argument("--significance", type=float, default=0.05, help="chance that equal builds are told to differ, in all")
    parser.add_argument("--check", action="store_true", help="try the statistics themselves, and measure nothing")
    parser.add_argument("-o", "--output", type=pathlib.Path, help="a JSON file with every time")
    options = parser.parse_args()
    if options.check:
        return check()
    if not options.before:
        parser.error("--before is missing")
    results, failed = {}, False
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        scenes = [s for s in peer_scenes.scenes(folder, options.scenes) if not options.only or s.name in options.only]
        if not scenes:
            parser.error("no scene has such a name")
        if 0.5 ** options.pairs > options.significance / len(scenes):
            parser.error(f"--pairs {options.pairs} are too few for {len(scenes)} scenes: no result could be significant")
        print(f"{len(scenes)} scenes, {options.pairs} pairs each; Wilcoxon's signed-rank test, Holm's correction at "
              f"{options.significance:g} in all, slower by more than {100 * options.tolerance:g} %")
        for scene in scenes:
            try:
                results[scene.name] = measure(scene, options, folder)
            except RuntimeError as error:
                print(f"{scene.name} failed:\n{error}", file=sys.stderr)
                failed = True
                continue
            r = results[scene.name]
            r["ratio"], r["from"], r["to"] = estimate(r.pop("ratios"), options.significance / len(scenes))
            same = "same bytes" if r["differs"] == 0 else f"pictures differ by {100 * r['differs']:.2g} %"
            print(f"  {scene.name:18} {r['samples']:5} samples  after / before {r['ratio']:.4f}, {r['from']:.3f} to {r['to']:.3f}  "
                  f"p {r['slower']:.4f}  {r['memory'][1] / r['memory'][0]:.3f} of the memory  {same}", flush=True)
    slower = [n for n, yes in holm({n: r["slower"] for n, r in results.items()}, options.significance).items() if yes]
    faster = [n for n, yes in holm({n: r["faster"] for n, r in results.items()}, options.significance).items() if yes]
    if results:
        mean = math.exp(sum(math.log(r["ratio"]) for r in results.values()) / len(results))
        print(f"geometric mean {mean:.4f}; slower: {', '.join(slower) or 'none'}; faster: {', '.join(faster) or 'none'}; a scene could be "
              f"slower by {100 * (max(r['to'] for r in results.values()) - 1):.1f} % unnoticed")
    if options.output:
        options.output.write_text(json.dumps({"slower": slower, "faster": faster, "scenes": results}, indent=1) + "\n")
    return 2 if failed else 1 if slower else 0


if __name__ == "__main__":
    sys.exit(main())
