#!/usr/bin/env python3
"""Renders files as they are found, small, and tells how it went: one table for all of them, and contact sheets to look at.

    tests/hostile/strangers.py --program build/etendue --list tests/hostile/strangers.tsv --root ~/repositories --out /tmp/strangers
    tests/hostile/strangers.py --program build/etendue --out /tmp/strangers scene.pbrt model.glb sky.hdr

--list reads lines of a repository on GitHub, its commit, a path in it, the SHA-256 of the file and the kind it is counted as, with tabs between
(strangers.tsv beside this file); its files lie in --root, in a folder OWNER+NAME for each repository. Scenes and models are rendered as they are. What is no scene gets one: an image becomes the
environment of some balls, a photometric file a lamp before a wall, a grid of densities a cloud in a box, serialized meshes a scene of
Mitsuba. A file may take --seconds of the processor's time, four times as long by the clock, and --memory megabytes of address space.

Each file ends as one of

    right      a picture, and nothing to tell
    told       a picture, with warnings or notes
    refused    an error with the place or the file it is about
    nameless   an error without
    crash      a signal, "unexpected failure", or an exit status that is none of 0, 1, 2
    time       it took too long
    memory     it ran out of memory

and each picture as `seen`, `black` (no light at all), `even` (all pixels the same within a thousandth) or `NaN`. OUT/results.json keeps
all, OUT/said what was said, OUT/pictures the pictures; OUT/sheet-KIND-N.png are 48 of them each, where ImageMagick is installed.
With --before RESULTS.json of an earlier run the table has both. Exit status: 0 unless something was nameless, a crash, time, memory or
NaN.
"""
import argparse
import array
import collections
import concurrent.futures
import json
import math
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import threading
import time
import zlib

OUTCOMES = ("right", "told", "refused", "nameless", "crash", "time", "memory")
BAD = ("nameless", "crash", "time", "memory")
A_SHEET = 48

BALLS = """Job {{
    renderer: PathTracer {{}}
    camera: PerspectiveCamera {{ from: [0, 1.2, -6] m, to: [0, 0.4, 0] m, fov: 50 deg }}
    outputs: [PngOutput {{}}]
    scene: EmbreeScene {{ objects: [
        Environment {{ emission: EnvironmentEmission {{ file: "{file}" }} }}
        Sphere {{ centre: [-1.1, 0.5, 0] m, radius: 1 m, shader: Conductor {{}} }}
        Sphere {{ centre: [1.1, 0.5, 0] m, radius: 1 m, shader: Lambertian {{ color: 0.7 }} }}
        Disc {{ transform: translate([0, -0.5, 0]) * rotate(90 deg, "x"), radius: 3 m, shader: Lambertian {{ color: 0.5 }} }}
    ] }}
}}
"""
LAMP = """Job {{
    renderer: PathTracer {{}}
    camera: PerspectiveCamera {{ from: [0, 1.5, -5] m, to: [0, 1.5, 0] m, fov: 50 deg }}
    tone_map: NormalizeToneMap {{}}
    outputs: [PngOutput {{}}]
    scene: EmbreeScene {{ objects: [
        Point {{ position: [0, 2.2, -0.7] m, emission: IesEmission {{ file: "{file}" }} }}
        Rectangle {{ corner: [-3, 0, 0] m, edge_u: [0, 4, 0] m, edge_v: [6, 0, 0] m, shader: Lambertian {{ color: 0.7 }} }}
        Rectangle {{ corner: [-3, 0, -3] m, edge_u: [0, 0, 3] m, edge_v: [6, 0, 0] m, shader: Lambertian {{ color: 0.7 }} }}
    ] }}
}}
"""
CLOUD = """Job {{
    renderer: PathTracer {{}}
    camera: PerspectiveCamera {{ from: [2.2, 1.4, -2.2] m, to: [0.5, 0.5, 0.5] m, fov: 40 deg }}
    outputs: [PngOutput {{}}]
    scene: EmbreeScene {{ objects: [
        Environment {{ emission: DiffuseEmission {{}} }}
        Box {{ centre: [0.5, 0.5, 0.5] m, size: [1, 1, 1] m, shader: PassThrough {{}}
            interior: GridVolume {{ file: "{file}", extinction: 8, albedo: 0.5 }} }}
    ] }}
}}
"""
SERIALIZED = """<scene version="3.0.0"><integrator type="path"/><emitter type="constant"/>
<sensor type="perspective"><float name="fov" value="45"/><transform name="to_world"><lookat origin="{origin}" target="{target}"
up="0,1,0"/></transform></sensor>
<shape type="serialized"><string name="filename" value="{file}"/><integer name="shape_index" value="0"/>
<bsdf type="twosided"><bsdf type="diffuse"/></bsdf></shape></scene>
"""
SCENES = {"hdr": BALLS, "exr": BALLS, "ies": LAMP, "vol": CLOUD, "nvdb": CLOUD, "serialized": SERIALIZED}


def kind_of(path):
    return path.suffix.lower().lstrip(".") or "none"


def bounds_of_serialized(path):
    """The box around the first mesh of Mitsuba's format: two numbers of 16 bits, then compressed flags, from version 4 on a name, the
    numbers of vertices and triangles, and the vertices. A unit box where it cannot be read."""
    unit = (-1, -1, -1), (1, 1, 1)
    try:
        data = path.read_bytes()
        version = int.from_bytes(data[2:4], "little")
        data = zlib.decompressobj().decompress(data[4:])
        start = data.index(0, 4) + 1 if version >= 4 else 4
        count, begin = int.from_bytes(data[start:start + 8], "little"), start + 16
        values = array.array("d" if data[1] & 0x20 else "f")
        values.frombytes(data[begin:begin + 3 * values.itemsize * count])
        values = array.array("d", [v if math.isfinite(v) else 0 for v in values])
        axes = [values[k::3] for k in range(3)]
        return tuple(map(min, axes)), tuple(map(max, axes))
    except (OSError, ValueError, IndexError, zlib.error):
        return unit


def view_of(low, high):
    """A camera's place, from which an angle of 45 degrees sees the sphere around a box, and the middle of the box."""
    middle = [(a + b) / 2 for a, b in zip(low, high)]
    away = (math.dist(low, high) or 1) / 2 / math.sin(math.radians(22.5))
    direction = (0.5, 0.4, 0.768)  # of length 1
    origin = [m + away * d for m, d in zip(middle, direction)]
    return {name: ",".join(f"{x:.9g}" for x in point) for name, point in (("origin", origin), ("target", middle))}


def scene_for(path, root, folder, name):
    """The file to render: itself, or a scene made around it, and the folders that it may read."""
    text = SCENES.get(kind_of(path))
    if not text:
        return path, []
    ending = "xml" if text is SERIALIZED else "etd"
    made = folder / f"{name}.{ending}"
    view = view_of(*bounds_of_serialized(path)) if text is SERIALIZED else {}
    made.write_text(text.format(file=str(path).replace("\\", "\\\\").replace('"', '\\"'), **view))
    return made, [str(root)]


def limited(arguments):
    def limit():
        # Not the hard limits, which what the program starts may want to set itself.
        resource.setrlimit(resource.RLIMIT_CPU, (arguments.seconds, resource.RLIM_INFINITY))
        resource.setrlimit(resource.RLIMIT_AS, (arguments.memory << 20, resource.RLIM_INFINITY))
        os.setsid()

    return limit


def run(arguments, command, folder):
    """(status or None when it took too long, what it said, the processor's seconds, peak memory [MB])"""
    said = folder / "said"
    begin = time.monotonic()
    with open(said, "wb") as out:
        process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=out, stderr=out,
                                   preexec_fn=limited(arguments))

        def end():
            try:
                os.killpg(process.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass

        timer = threading.Timer(4 * arguments.seconds, end)
        timer.start()
        _, status, usage = os.wait4(process.pid, 0)
        timer.cancel()
        process.returncode = status = os.waitstatus_to_exitcode(status)
    seconds = usage.ru_utime + usage.ru_stime
    late = status == -signal.SIGXCPU or time.monotonic() - begin >= 4 * arguments.seconds or (
        status == -signal.SIGKILL and seconds >= arguments.seconds)
    return None if late else status, said.read_text(errors="replace"), seconds, usage.ru_maxrss >> 10


def picture_of(file):
    """What kind of picture the numbers of an .npy file are, and their mean luminance."""
    data = file.read_bytes()
    length = int.from_bytes(data[8:10], "little")
    values = array.array("d")
    values.frombytes(data[10 + length:])
    luminance = values[1::3]
    if any(math.isnan(v) or math.isinf(v) for v in values):
        return "NaN", None
    mean = sum(luminance) / len(luminance)
    if max(values) <= 0:
        return "black", 0
    return ("even" if max(luminance) - min(luminance) < 1e-3 * mean else "seen"), mean


def located(said, path, root):
    """Whether errors say what they are about: a line of a file, or a file."""
    errors = [line for line in said.splitlines() if not re.search(r"\b(warning|note):", line)]
    return any(re.search(r":\d+(:\d+)?: ", line) or path.name in line or str(root) in line for line in errors)


def outcome(status, said, path, root):
    if status is None:
        return "time"
    if "bad_alloc" in said or "not enough memory" in said or "out of memory" in said.lower():
        return "memory"
    if status not in (0, 1, 2) or "unexpected failure" in said or "terminate called" in said:
        return "crash"
    if status == 0:
        return "told" if re.search(r"\b(warning|note):", said) else "right"
    return "refused" if located(said, path, root) else "nameless"


def render(arguments, number, entry):
    path = pathlib.Path(entry["path"])
    root = pathlib.Path(entry.get("root", path.parent))
    name = f"{number:04d}"
    folder = arguments.out / "work" / name
    folder.mkdir(parents=True, exist_ok=True)
    file, allowed = scene_for(path, root, folder, name)
    picture, numbers = arguments.out / "pictures" / f"{name}.png", folder / "numbers.npy"
    for old in (picture, numbers):
        old.unlink(missing_ok=True)
    command = [arguments.program, "render", str(file), "--size", arguments.size, "--samples", str(arguments.samples), "--threads",
               str(arguments.threads), "--progress", "none", "-o", str(picture), "-o", str(numbers)]
    for folder_name in allowed:
        command += ["--allow-path", folder_name]
    result = run(arguments, command, folder)
    entry = dict(entry, number=number, allowed=False, kind=entry.get("kind") or kind_of(path))
    if result[0] is not None and "--allow-path" in result[1] and not allowed:
        # As its owner would: some of its files lie in other folders of the repository.
        result, entry["allowed"] = run(arguments, [*command, "--allow-path", str(root)], folder), True
    status, said, seconds, memory = result
    (arguments.out / "said" / f"{name}.txt").write_text(f"# {path}\n{said}")
    entry.update(status=status, seconds=round(seconds, 2), memory=memory, outcome=outcome(status, said, path, root),
                 picture=None, mean=None, warnings=len(re.findall(r"\bwarning:", said)), notes=len(re.findall(r"\bnote:", said)))
    if numbers.exists():
        entry["picture"], entry["mean"] = picture_of(numbers)
    shutil.rmtree(folder, ignore_errors=True)
    return entry


def contact_sheets(arguments, results):
    if not shutil.which("montage"):
        print("no contact sheets: ImageMagick's montage is not installed")
        return
    by_kind = collections.defaultdict(list)
    for r in results:
        if (arguments.out / "pictures" / f"{r['number']:04d}.png").exists():
            by_kind[r["kind"]].append(r)
    for kind, list_of in by_kind.items():
        for i in range(0, len(list_of), A_SHEET):
            command = ["montage", "-font", "DejaVu-Sans", "-pointsize", "9", "-background", "white", "-geometry", "160x120+3+2",
                       "-tile", "8x"]
            for r in list_of[i:i + A_SHEET]:
                label = f"{r['number']} {pathlib.Path(r['path']).name[-22:]}" + (f" {r['picture']}" if r["picture"] != "seen" else "")
                command += ["-label", label.replace("%", "%%"), str(arguments.out / "pictures" / f"{r['number']:04d}.png")]
            subprocess.run([*command, str(arguments.out / f"sheet-{kind}-{i // A_SHEET}.png")], check=False)


def table(results, before):
    """Markdown: a line for each kind of file."""
    columns = [*OUTCOMES, "black", "even", "NaN"]
    earlier = {(b["path"], b["kind"]): b for b in before}

    def counts(rows):
        found = collections.Counter(r["outcome"] for r in rows) + collections.Counter(r["picture"] for r in rows if r["picture"])
        return [found[c] for c in columns]

    lines = ["| kind | files | " + " | ".join(columns) + " |", "|---|" + "---|" * (len(columns) + 1)]
    kinds = sorted({r["kind"] for r in results})
    for kind in [*kinds, None]:
        rows = [r for r in results if kind in (None, r["kind"])]
        now = counts(rows)
        if before:
            then = counts([earlier[r["path"], r["kind"]] for r in rows if (r["path"], r["kind"]) in earlier])
            now = [str(n) if n == t else f"{t} → {n}" for t, n in zip(then, now)]
        lines.append(f"| {kind or '**all**'} | {len(rows)} | " + " | ".join(str(n or "") if n != "0" else "" for n in now) + " |")
    return "\n".join(lines)


def listed(file, root):
    entries = []
    for line in file.read_text().splitlines():
        if not line.startswith("#"):
            repository, commit, path, sha256, kind = line.split("\t")
            folder = root.resolve() / repository.replace("/", "+")
            entries.append({"repo": repository, "commit": commit, "path": str(folder / path), "root": str(folder), "sha256": sha256,
                            "kind": kind})
    return entries


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", type=pathlib.Path)
    parser.add_argument("--program", required=True)
    parser.add_argument("--list", type=pathlib.Path)
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path("."), help="where the files of --list lie")
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--before", type=pathlib.Path)
    parser.add_argument("--only", help="numbers of files, with commas between; or a kind")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--threads", type=int, default=2, help="of each")
    parser.add_argument("--seconds", type=int, default=60)
    parser.add_argument("--memory", type=int, default=8192, help="[MB]")
    parser.add_argument("--nice", type=int, default=15)
    parser.add_argument("--size", default="160x120")
    parser.add_argument("--samples", type=int, default=8)
    arguments = parser.parse_args()
    arguments.program = str(pathlib.Path(arguments.program).resolve())
    arguments.out = arguments.out.resolve()
    for folder in ("pictures", "said", "work"):
        (arguments.out / folder).mkdir(parents=True, exist_ok=True)
    entries = listed(arguments.list, arguments.root) if arguments.list else []
    entries += [{"path": str(f.resolve())} for f in arguments.files]
    chosen = list(enumerate(entries))
    if arguments.only:
        wanted = arguments.only.split(",")
        chosen = [(i, e) for i, e in chosen if str(i) in wanted or e.get("kind") in wanted]
    kept = arguments.out / "results.json"
    results = {r["number"]: r for r in json.loads(kept.read_text())} if kept.exists() and arguments.only else {}
    os.nice(arguments.nice)
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for r in pool.map(lambda pair: render(arguments, *pair), chosen):
            results[r["number"]] = r
            if r["outcome"] in BAD or r["picture"] in ("NaN", "black", "even"):
                print(f"{r['number']} {r['outcome']} {r['picture']} {r['seconds']} s {r['memory']} MB {r['path']}", flush=True)
            kept.write_text(json.dumps([results[n] for n in sorted(results)], indent=1))
    shutil.rmtree(arguments.out / "work", ignore_errors=True)
    results = [results[n] for n in sorted(results)]
    contact_sheets(arguments, results)
    print(table(results, json.loads(arguments.before.read_text()) if arguments.before else []))
    return 1 if any(r["outcome"] in BAD or r["picture"] == "NaN" for r in results) else 0


if __name__ == "__main__":
    sys.exit(main())
