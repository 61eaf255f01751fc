#!/usr/bin/env python3
"""Scenes that others made: fetched, and rendered beside Mitsuba 3.

    python3 benchmarks/scene_set.py bring FOLDER                  clone the repositories and take the scenes out of them
    python3 benchmarks/scene_set.py measure FOLDER -o set.json    time to equal error; --only NAME, --group profiled|measured
    python3 benchmarks/scene_set.py choose FOLDER -o regret.json  what `Automatic` chooses, and the regret against each candidate

None of them is part of this project: scene_set.json has the repository, commit, path and sha256 of each. Half of them may be profiled; the
other half is only measured, so that what is made faster for some scenes is seen to be faster for others.

Every scene is imported here and exported to Mitsuba's XML; both programs read that file. What Mitsuba cannot say of a scene (layered
materials, a sky) is left out for both. Files that are not in the repositories are left out for both, too.

Two comparisons, of like with like: paths of eight wavelengths beside Mitsuba's llvm_ad_spectral (four), and three bands (`--rgb`) beside
llvm_ad_rgb. Mitsuba traces waves in one process, which renders once before its time counts: kernels are compiled by then. Seconds are the
processor's, of rendering alone: of ours the slope between few and many samples, so that reading and building do not count. relMSE is that of
peers.py, from the variance between `--runs` pictures. The ratio's standard error is that of its logarithm, by the jackknife over the runs.
`agrees`: Mitsuba's mean luminance over ours, without the 0.5 % brightest pixels of either.
"""
import argparse
import hashlib
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

import processes

HERE = pathlib.Path(__file__).resolve().parent
LUMINANCE = np.array([0.212671, 0.715160, 0.072169])  # of linear sRGB
MITSUBA = """
import sys, time, resource, numpy as np
variant, scene, samples, runs, out = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4]), sys.argv[5]
import mitsuba as mi
mi.set_variant(variant)
mi.set_log_level(mi.LogLevel.Error)
scene = mi.load_file(scene)
pictures, seconds = [], []
for seed in range(-1, runs):
    begin = time.process_time()
    pictures.append(np.array(mi.render(scene, spp=samples, seed=seed + 100))[:, :, :3])
    seconds.append(time.process_time() - begin)
np.savez(out, pictures=np.array(pictures[1:]), seconds=seconds[1:], megabytes=resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)
"""


def listed(options):
    scenes = json.loads((HERE / "scene_set.json").read_text())
    return [s for s in scenes if (not options.only or s["name"] in options.only) and options.group in (None, s["group"])]


# ---- bringing

def git(directory, *arguments, **more):
    return subprocess.run(["git", f"--git-dir={directory}", *arguments], check=True, capture_output=True, **more).stdout


def files_of(directory, commit, path):
    """(path, contents) of all files below a path that are there; large files may lie elsewhere (Git LFS)."""
    rows = git(directory, "ls-tree", "-r", "-z", commit, "--", path).decode().split("\0")
    names = [(row.split("\t")[1], row.split()[2]) for row in rows if row]
    found = subprocess.run(["git", f"--git-dir={directory}", "cat-file", "--batch"], input="".join(b + "\n" for _, b in names).encode(),
                           capture_output=True).stdout
    at = 0
    for name, _ in names:
        end = found.index(b"\n", at)
        head = found[at:end].split()
        at = end + 1
        if head[-1] == b"missing":
            continue
        size = int(head[2])
        contents = found[at:at + size]
        at += size + 1
        if not contents.startswith(b"version https://git-lfs"):
            yield name, contents


def bring(options):
    for scene in listed(options):
        owner, name = scene["repository"].split("/")
        directory = options.folder / "repositories" / f"{owner}+{name}"
        if options.mirror and (options.mirror / f"{owner}+{name}" / "repo").exists():
            directory = options.mirror / f"{owner}+{name}" / "repo"
        elif not directory.exists():
            subprocess.run(["git", "clone", "--bare", f"https://github.com/{scene['repository']}", str(directory)], check=True)
        digest = hashlib.sha256()
        for path, contents in files_of(directory, scene["commit"], scene["path"]):
            # The hash is of what git stores below the path, without files of 4 MiB and more: not every copy of a repository has them.
            if len(contents) < 4 << 20:
                digest.update(f"{path} {hashlib.sha256(contents).hexdigest()}\n".encode())
            target = options.folder / scene["name"] / pathlib.PurePosixPath(path).relative_to(scene["path"])
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(contents)
        if scene["sha256"] != digest.hexdigest():
            print(f"{scene['name']}: sha256 {digest.hexdigest()}, not {scene['sha256'] or 'listed'}", file=sys.stderr)


def without_absent(file):
    """A file of Mitsuba's without shapes whose meshes are not there and elements of version 0.5 that mean nothing; grey for images."""
    text = file.read_text(errors="replace")
    there = lambda name: "$" in name or (file.parent / name).exists()
    named = re.compile(r'name="filename"\s+value="([^"]+)"')

    def shape(m):
        names = named.findall(m.group(0))
        return m.group(0) if all(there(n) for n in names) else ""

    def texture(m):
        names = named.findall(m.group(0))
        name = re.search(r'\sname="([^"]+)"', m.group(0).split(">")[0])
        if all(there(n) for n in names) or not name:
            return m.group(0)
        return f'<rgb name="{name.group(1)}" value="0.5"/>'
    text = re.sub(r'<mode [^>]*/>', "", text)
    text = re.sub(r'<shape\s(?:(?!</shape>).)*</shape>', shape, text, flags=re.S)
    text = re.sub(r'<texture\s(?:(?!</texture>).)*</texture>', texture, text, flags=re.S)
    target = file.with_name(f"whole_{file.name}")
    target.write_text(text)
    return target


def converted(scene, folder, program):
    """The scene as one file of Mitsuba's that both programs read."""
    file = folder / scene["name"] / scene["file"]
    target = folder / "converted" / scene["name"] / "scene.xml"
    if not target.exists():
        target.parent.mkdir(parents=True, exist_ok=True)
        if file.suffix == ".xml":
            file = without_absent(file)
        width, height = scene["size"]
        command = [program, "export", str(file), "--allow-path", str(folder / scene["name"]), "--set", "image.filter=BoxFilter"]
        for setting in ["renderer=PathTracer", f"renderer.max_depth={scene['depth']}", f"image.width={width}", f"image.height={height}",
                        *scene.get("set", [])]:
            command += ["--set", setting]
        done = subprocess.run(command + ["-o", str(target)], capture_output=True, text=True)
        (target.parent / "notes.txt").write_text(done.stderr)
        if done.returncode:
            raise RuntimeError(done.stderr[-2000:])
    return target


# ---- measuring

def ours(program, file, samples, seed, folder, more):
    out = folder / "ours.npy"
    used = processes.run([program, "render", file, "--samples", samples, "--seed", seed, "--threads", "1", "--set", "image.filter=BoxFilter",
                          "-o", out, "--quiet", *more])
    return used, np.load(out)[:, :, 1]


def measure_ours(program, file, scene, options, folder, more):
    few, many = options.samples
    start = min(ours(program, file, few, 1000 + i, folder, more)[0].seconds for i in range(2))
    used, pictures = zip(*(ours(program, file, many, i, folder, more) for i in range(options.runs)))
    seconds = [(u.seconds - start) / (many - few) for u in used]
    return np.array(pictures), seconds, float(np.median([u.megabytes for u in used]))


def measure_theirs(variant, file, scene, options, folder):
    out = folder / "theirs.npz"
    processes.run([sys.executable, "-c", MITSUBA, variant, file, options.samples[1], options.runs, out])
    data = np.load(out)
    return data["pictures"] @ LUMINANCE, list(data["seconds"] / options.samples[1]), float(data["megabytes"])


def rel_mse(stack, samples):
    mean = stack.mean(axis=0)
    relative = samples * stack.var(axis=0, ddof=1) / (mean ** 2 + 1e-2 * float(mean.mean()) ** 2)
    return float(np.sort(relative.ravel())[: int(0.999 * relative.size)].mean())


def result(measured, samples):
    stack, seconds, megabytes = measured
    cost = lambda keep: rel_mse(stack[keep], samples) * float(np.median(np.array(seconds)[keep]))
    n = len(stack)
    whole = np.arange(n)
    left = [math.log(cost(np.delete(whole, i))) for i in range(n)]
    jackknife = math.sqrt((n - 1) / n * sum((x - np.mean(left)) ** 2 for x in left))
    return {"sample": float(np.median(seconds)), "error": rel_mse(stack, samples), "cost": cost(whole), "spread": jackknife,
            "megabytes": megabytes, "mean": float(np.sort(stack.mean(axis=0).ravel())[: int(0.995 * stack[0].size)].mean())}


def write(options, results):
    if options.output:
        options.output.write_text(json.dumps(results, indent=1) + "\n")


def measure(options):
    results = {}
    for scene in listed(options):
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            row = {"group": scene["group"]}
            for name, render in (
                    ("spectral", lambda f: measure_ours(options.program, f, scene, options, folder, [])),
                    ("llvm_ad_spectral", lambda f: measure_theirs("llvm_ad_spectral", f, scene, options, folder)),
                    ("rgb", lambda f: measure_ours(options.program, f, scene, options, folder, ["--rgb"])),
                    ("llvm_ad_rgb", lambda f: measure_theirs("llvm_ad_rgb", f, scene, options, folder))):
                try:
                    row[name] = result(render(converted(scene, options.folder, options.program)), options.samples[1])
                    r = row[name]
                    print(f"{scene['name']:18} {name:17} {r['sample'] * 1e3:8.2f} ms a sample, relMSE {r['error']:8.3f}, mean {r['mean']:.5g}, "
                          f"{r['megabytes']:.0f} MB", flush=True)
                except RuntimeError as error:
                    print(f"{scene['name']}: {name} failed: {str(error)[-600:]}", file=sys.stderr)
            results[scene["name"]] = row
            write(options, results)
    print(table(results))


def ratio(row, mine, peer):
    if mine not in row or peer not in row:
        return None
    a, b = row[mine], row[peer]
    value = b["cost"] / a["cost"]
    return value, value * math.hypot(a["spread"], b["spread"]), b["mean"] / a["mean"]


def table(results):
    pairs = (("spectral", "llvm_ad_spectral"), ("rgb", "llvm_ad_rgb"))
    lines = ["| scene | ms a sample | relMSE of one | beside llvm_ad_spectral (agrees) | `--rgb` beside llvm_ad_rgb (agrees) | memory, theirs |",
             "|---|---|---|---|---|---|"]
    logs = {pair: [] for pair in pairs}
    for group in ("profiled", "measured"):
        for name, row in results.items():
            if row["group"] != group or "spectral" not in row:
                continue
            cells = []
            for pair in pairs:
                found = ratio(row, *pair)
                cells.append(f"{found[0]:.2f} ± {found[1]:.2f} ({found[2]:.3f})" if found else "-")
                if found:
                    logs[pair].append(math.log(found[0]))
            mine, peer = row["spectral"], row.get("llvm_ad_spectral")
            lines.append(f"| {name} ({group}) | {mine['sample'] * 1e3:.1f} | {mine['error']:.3g} | {cells[0]} | {cells[1]} | "
                         f"{mine['megabytes']:.0f} MB" + (f", {peer['megabytes']:.0f} MB |" if peer else " |"))
    means = ", ".join(f"{p[1]} {math.exp(np.mean(v)):.2f}" for p, v in logs.items() if v)
    return "\n".join(lines) + f"\n\nGeometric means: {means}.\n"


# ---- choosing

CANDIDATES = ("PathTracer", "GuidedPathTracer", "BidirectionalPathTracer")


def choose(options):
    """The cost (relMSE of one sample times its seconds) of Automatic, trials included, over that of each candidate alone."""
    results = {}
    for scene in listed(options):
        file = converted(scene, options.folder, options.program)
        row = {"group": scene["group"]}
        with tempfile.TemporaryDirectory() as temporary:
            for name in ("Automatic", *CANDIDATES):
                try:
                    runs = []
                    for seed in range(options.runs):
                        runs.append(ours(options.program, file, options.samples[1], seed, pathlib.Path(temporary),
                                         ["--set", f"renderer={name}", "--set", f"renderer.max_depth={scene['depth']}"]))
                    seconds = float(np.median([u.seconds for u, _ in runs]))
                    row[name] = seconds * rel_mse(np.array([p for _, p in runs]), 1)
                    print(f"{scene['name']:18} {name:25} {seconds:7.2f} s, relMSE times seconds {row[name]:.4g}", flush=True)
                except RuntimeError as error:
                    print(f"{scene['name']}: {name} failed: {str(error)[-600:]}", file=sys.stderr)
        results[scene["name"]] = row
        write(options, results)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("bring", "measure", "choose"))
    parser.add_argument("folder", type=pathlib.Path, help="where the scenes are, or will be")
    parser.add_argument("--program", default=str(HERE.parent / "build" / "etendue"))
    parser.add_argument("--mirror", type=pathlib.Path, help="a folder of git directories OWNER+NAME/repo that are there already")
    parser.add_argument("--only", action="append")
    parser.add_argument("--group", choices=("profiled", "measured"))
    parser.add_argument("--runs", type=int, default=4)
    parser.add_argument("--samples", type=int, nargs=2, default=(4, 20), metavar=("FEW", "MANY"))
    parser.add_argument("-o", "--output", type=pathlib.Path)
    options = parser.parse_args()
    options.folder = options.folder.resolve()
    if "DRJIT_LIBLLVM_PATH" not in os.environ:
        version = lambda path: max((int(n) for n in re.findall(r"\d+", path.name)), default=0)
        found = [p for pattern in ("*/libLLVM*.so*", "llvm-*/lib/libLLVM*.so*") for p in pathlib.Path("/usr/lib").glob(pattern)]
        if found:
            os.environ["DRJIT_LIBLLVM_PATH"] = str(max(found, key=version))
    {"bring": bring, "measure": measure, "choose": choose}[options.what](options)


if __name__ == "__main__":
    main()
