#!/usr/bin/env python3
"""Étendue and its peers on the same scenes, in turns on one machine: time to equal error.

    python3 benchmarks/peers.py --scenes ../shared/validation/bitterli -o docs/results/peers.md

Needs `pip install mitsuba numpy pillow matplotlib`, and bpy for Blender's Cycles (in the same Python, or one named by --blender-python;
only of scenes that glTF can say, by our own exporter); the llvm variants need an LLVM library (Debian: libllvm19), named by
DRJIT_LIBLLVM_PATH if it is not found.

For each scene and program
  - the pictures of many samples are compared first: means that differ by more than --agreement are told, and the times then mean
    nothing;
  - `runs` pictures are made with different seeds at two numbers of samples n1 < n2, in turns among the programs. The processor's time
    of the whole process is measured; what a sample costs is the slope (t2 - t1) / (n2 - n1), and the start what is left at 0 samples;
  - the error of one sample per pixel is the variance between runs: relMSE = mean over pixels of n var(Y) / (mean(Y)^2 + e), with
    e = 1e-2 of the squared mean of the picture, which keeps black places from deciding, and without the 0.1 % of pixels of highest
    error, told apart, as a few fireflies decide them;
  - efficiency is 1 / (relMSE of one sample * processor's seconds of one sample); the ratio to a peer is the time it needs over
    the time Étendue needs for the same error.
One standard error of the ratio's logarithm comes from the spread between the runs' halves.
"""
import argparse
import json
import math
import os
import pathlib
import re
import sys
import tempfile

import numpy as np

import peer_scenes
import processes

MITSUBA = """
import sys, numpy as np
variant, scene, samples, out, seed = sys.argv[1], sys.argv[2], int(sys.argv[3]), sys.argv[4], int(sys.argv[5])
import mitsuba as mi
mi.set_variant(variant)
scene = mi.load_file(scene)
image = mi.render(scene, spp=samples, seed=seed)
np.save(out, np.array(image)[:, :, :3])
"""
VARIANTS = ("llvm_ad_spectral", "llvm_ad_rgb", "scalar_spectral", "cycles")
LUMINANCE = np.array([0.212671, 0.715160, 0.072169])  # of linear sRGB


def ours(program, renderer, scene, samples, seed, folder):
    out = folder / "ours.npy"
    command = [program, "render", str(scene.file), "--allow-path", str(scene.folder), "--samples", str(samples), "--seed", str(seed),
               "--threads", "1", "--set", f"renderer={renderer}", "--set", f"renderer.max_depth={scene.depth}", "--set",
               "image.filter=BoxFilter", "-o", str(out), "--quiet"]
    return processes.run(command), np.load(out)[:, :, 1]  # X Y Z


def theirs(variant, scene, samples, seed, folder):
    out = folder / "theirs.npy"
    used = processes.run([sys.executable, "-c", MITSUBA, variant, scene.file, samples, out, seed])
    return used, np.load(out) @ LUMINANCE


def cycles(program, python, scene, samples, seed, folder):
    file, out = folder / f"{scene.name}.glb", folder / "theirs.npy"
    if not file.exists():
        processes.run([program, "export", scene.file, "--allow-path", scene.folder, "-o", file])
    script = pathlib.Path(__file__).resolve().parent / "peer_blender.py"
    return processes.run([python, script, file, *scene.size, scene.depth, samples, seed, out]), np.load(out) @ LUMINANCE


def measure(render, scene, runs, samples):
    """What one program does on one scene: seconds to start and of a sample, relMSE of one sample, memory, the mean picture."""
    few, many = samples
    start = [render(scene, few, 1000 + i)[0].seconds for i in range(2)]
    used, pictures = zip(*(render(scene, many, i) for i in range(runs)))
    per_sample = (float(np.median([u.seconds for u in used])) - min(start)) / (many - few)
    stack = np.array(pictures)
    mean = stack.mean(axis=0)
    floor = 1e-2 * float(mean.mean()) ** 2

    def error(part):
        relative = many * part.var(axis=0, ddof=1) / (mean ** 2 + floor)
        return float(relative.mean()), float(np.sort(relative.ravel())[: int(0.999 * relative.size)].mean())

    whole, trimmed = error(stack)
    halves = [error(stack[i::2])[1] for i in (0, 1)]
    return {"start": min(start) - few * per_sample, "sample": per_sample, "error": trimmed, "whole_error": whole,
            "megabytes": float(np.median([u.megabytes for u in used])),
            "spread": abs(math.log(max(halves[0], 1e-30) / max(halves[1], 1e-30))) / 2, "picture": mean}


def compare_scene(scene, programs, options):
    results = {}
    for name, render in programs.items():
        if name == "cycles" and not scene.gltf:
            continue
        try:
            results[name] = measure(render, scene, options.runs, options.samples)
        except RuntimeError as error:
            print(f"{scene.name}: {name} failed:\n{error}", file=sys.stderr)
    mean = results["etendue"]["picture"].mean() if "etendue" in results else float("nan")
    for name, r in results.items():
        r["mean_ratio"] = float(r.pop("picture").mean() / mean)
        r["efficiency"] = 1 / (r["error"] * r["sample"])
        print(f"{scene.name:18} {name:18} start {r['start']:6.2f} s, sample {r['sample'] * 1e3:8.2f} ms, relMSE {r['error']:8.3f} "
              f"({r['whole_error']:.3f} in all), mean {r['mean_ratio']:.4f}, {r['megabytes']:.0f} MB", flush=True)
    return results


def table(all_results, options):
    peers = [v for v in VARIANTS if any(v in r for r in all_results.values())]
    lines = ["# Time to equal error, beside Mitsuba 3 and Cycles", "",
             "Made by `benchmarks/peers.py`, which says how everything is measured. Ratios above 1: Étendue needs less of the processor's",
             "time for the same error, of rendering alone. `agrees`: the peer's mean luminance over ours.", "",
             "| scene | ms a sample | relMSE of one | " + " | ".join(f"{p}: ratio (agrees)" for p in peers) + " | best peer |",
             "|---|---|---|" + "---|" * (len(peers) + 1)]
    logs = []
    for name, results in all_results.items():
        mine = results.get("etendue")
        if not mine:
            continue
        cells, ratios = [], []
        for p in peers:
            if p not in results:
                cells.append("-")
                continue
            ratio = mine["efficiency"] / results[p]["efficiency"]
            ratios.append(ratio)
            spread = math.hypot(mine["spread"], results[p]["spread"])
            cells.append(f"{ratio:.2f} ± {ratio * spread:.2f} ({results[p]['mean_ratio']:.3f})")
        least = min(ratios) if ratios else float("nan")
        if ratios:
            logs.append(math.log(least))
        lines.append(f"| {name} | {mine['sample'] * 1e3:.1f} | {mine['error']:.3g} | " + " | ".join(cells) + f" | {least:.2f} |")
    if logs:
        lines += ["", f"Geometric mean over the best peer of each scene: **{math.exp(sum(logs) / len(logs)):.2f}**."]
    lines += ["", "## Memory", "", "Of whole processes at the peak (resident), libraries, interpreters and compiled kernels included; the median of the",
              "runs. In brackets: ours over the peer's.", "", "| scene | Étendue | " + " | ".join(peers) + " |", "|---|---|" + "---|" * len(peers)]
    for name, results in all_results.items():
        mine = results.get("etendue")
        if mine:
            cells = [f"{r['megabytes']:.0f} MB ({mine['megabytes'] / r['megabytes']:.2f})" if (r := results.get(p)) else "-" for p in peers]
            lines.append(f"| {name} | {mine['megabytes']:.0f} MB | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def plot(all_results, path):
    """Error against time of each scene: straight lines of slope -1/2, as the error of a mean falls."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plot_
    figure, axes = plot_.subplots(2, 4, figsize=(16, 7), squeeze=False)
    for axis, (name, results) in zip(axes.ravel(), all_results.items()):
        for program, r in results.items():
            seconds = np.logspace(-1, 3, 50)
            samples = np.maximum((seconds - max(r["start"], 0)) / r["sample"], 1e-9)
            shown = samples >= 1
            axis.loglog(seconds[shown], np.sqrt(r["error"] / samples[shown]), label=program)
        axis.set_title(name)
        axis.set_xlabel("processor's seconds, start included")
        axis.set_ylabel("relative error (root of relMSE)")
    axes[0][0].legend()
    figure.tight_layout()
    figure.savefig(path, dpi=80)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    here = pathlib.Path(__file__).resolve().parent
    parser.add_argument("--program", default=str(here.parent / "build" / "etendue"))
    parser.add_argument("--renderer", default="PathTracer")
    parser.add_argument("--scenes", type=pathlib.Path, help="the folder of Bitterli's scenes")
    parser.add_argument("--only", action="append", help="a scene's name; may be repeated")
    parser.add_argument("--variants", default=",".join(VARIANTS))
    parser.add_argument("--blender-python", default=sys.executable, help="a Python that has bpy")
    parser.add_argument("--runs", type=int, default=8)
    parser.add_argument("--samples", type=int, nargs=2, default=(4, 32), metavar=("FEW", "MANY"))
    parser.add_argument("-o", "--output", type=pathlib.Path)
    options = parser.parse_args()
    if "DRJIT_LIBLLVM_PATH" not in os.environ:
        version = lambda path: max((int(n) for n in re.findall(r"\d+", path.name)), default=0)
        found = [p for pattern in ("*/libLLVM*.so*", "llvm-*/lib/libLLVM*.so*") for p in pathlib.Path("/usr/lib").glob(pattern)]
        if found:
            os.environ["DRJIT_LIBLLVM_PATH"] = str(max(found, key=version))
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        programs = {"etendue": lambda *a: ours(options.program, options.renderer, *a, folder)}
        for variant in options.variants.split(","):
            if variant == "cycles":
                programs[variant] = lambda *a: cycles(options.program, options.blender_python, *a, folder)
                continue
            programs[variant] = lambda scene, samples, seed, v=variant: theirs(v, scene, samples, seed, folder)
        results = {}
        for scene in peer_scenes.scenes(folder, options.scenes):
            if not options.only or scene.name in options.only:
                results[scene.name] = compare_scene(scene, programs, options)
    text = table(results, options)
    print(text)
    if options.output:
        options.output.write_text(text)
        options.output.with_suffix(".json").write_text(json.dumps(results, indent=1))
        plot(results, options.output.with_suffix(".png"))


if __name__ == "__main__":
    main()
