#!/usr/bin/env python3
"""Hashes of small pictures of every scene by every renderer with two seeds: what a change that moves code must leave as it was.

    tests/hashes/hashes.py --program build/etendue --write before.tsv
    tests/hashes/hashes.py --program build/etendue --check before.tsv

Each line of the table is a scene, a renderer with its defaults, a seed, and the SHA-256 of the picture's numbers (float64, one sample of
each of 16 x 12 pixels on one thread), or the first line of why there is none. Numbers depend on the compiler and on the instruction
set, so a table is of one machine and one build's options, and is not kept in the repository. --scenes and --renderers take parts of
names, so that a few can be tried. Exit status: 0 when all are the same, 1 when not, 2 when the table is of other scenes or renderers.
"""

import argparse
import concurrent.futures
import hashlib
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SEEDS = (1, 2)
SECONDS = 300  # of one picture, after which it counts as none


def renderers(program):
    """The concrete classes of Renderer."""
    classes = json.loads(subprocess.run([program, "classes", "--json"], capture_output=True, text=True, check=True).stdout)
    parents = {c["name"]: c.get("parent") for c in classes}

    def renders(name):
        return name == "Renderer" or (name is not None and renders(parents.get(name)))

    return sorted(c["name"] for c in classes if not c["abstract"] and renders(c["name"]))


def scenes():
    """Descriptions with a Job; others are included by these."""
    found = sorted(path for path in (ROOT / "scenes").rglob("*.etd") if "\nJob {" in "\n" + path.read_text())
    return [path.relative_to(ROOT).as_posix() for path in found]


def expression(renderer):
    """Those that hold another one get a path tracer to hold."""
    return f"{renderer} {{ inner: PathTracer {{}} }}" if renderer in ("AdaptiveSampling", "PrimarySampleMetropolis") else f"{renderer} {{}}"


def picture(program, scene, renderer, seed):
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "picture.npy"
        command = [program, "render", ROOT / scene, "--set", f"renderer={expression(renderer)}", "--size", "16x12", "--samples", "1",
                   "--seed", str(seed), "--threads", "1", "--quiet", "-o", out]
        try:
            run = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=SECONDS, cwd=ROOT)
        except subprocess.TimeoutExpired:
            return f"none: not within {SECONDS} s"
        if run.returncode == 0:
            return hashlib.sha256(out.read_bytes()).hexdigest()
        said = [line for line in run.stderr.splitlines() if "warning:" not in line] or ["nothing was said"]
        return "none: " + said[0].replace(str(ROOT) + "/", "").replace("\t", " ")


def read(path):
    table = {}
    for line in Path(path).read_text().splitlines():
        *key, value = line.split("\t")
        table[tuple(key)] = value
    return table


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--scenes", default="", help="only those with this in their name")
    parser.add_argument("--renderers", default="", help="only those with this in their name")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    action = parser.add_mutually_exclusive_group(required=True)
    action.add_argument("--write", metavar="TABLE")
    action.add_argument("--check", metavar="TABLE")
    options = parser.parse_args()
    program = str(Path(options.program).resolve())
    keys = [(scene, renderer, str(seed)) for scene in scenes() if options.scenes in scene
            for renderer in renderers(program) if options.renderers in renderer for seed in SEEDS]
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        values = list(pool.map(lambda key: picture(program, *key), keys))
    if options.write:
        if Path(options.write).exists():
            print(f"{options.write} is there already")
            return 2
        Path(options.write).write_text("".join("\t".join((*key, value)) + "\n" for key, value in zip(keys, values)))
        print(f"{len(keys)} pictures, {sum(v.startswith('none') for v in values)} of which there are none")
        return 0
    before = read(options.check)
    unknown = [key for key in keys if key not in before]
    for key in unknown:
        print("not in the table:", *key)
    changed = [(key, value) for key, value in zip(keys, values) if key in before and before[key] != value]
    for key, value in changed:
        print("changed:", *key, before[key][:60], "->", value[:60])
    print(f"{len(keys) - len(changed) - len(unknown)} of {len(keys)} pictures are the same")
    return 1 if changed else (2 if unknown else 0)


if __name__ == "__main__":
    sys.exit(main())
