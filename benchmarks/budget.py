#!/usr/bin/env python3
"""Where a path's time goes, on the scenes of peers.py, from profiles.

    python3 benchmarks/budget.py --scenes ../shared/validation/bitterli

Needs Linux' `perf`. One thread renders each scene for --samples samples per pixel; `perf` looks every millisecond of the
processor's time at the function at work, and functions are put together by their names: the first row of GROUPS that matches
counts. What is inlined counts where it was inlined to, so `loop` has what the compiler drew into the path tracer.

With --waves build/benchmarks/etendue_waves (built with ETENDUE_BENCHMARKS) there are two columns more: the time of the paths' rays, and of
all, over that of the same rays in a bare Embree, measured in one run.
"""
import argparse
import collections
import pathlib
import re
import subprocess
import tempfile

import peer_scenes
import processes

GROUPS = (
    ("rays", r"Scene::(nearest|any|all)\b|BlockHit|local_intersect|occlu|::intersect|visible_fraction|coincident|all_hits|Ball::nearest"),
    ("point", r"fill|surface_point|local_point|point_on|::carry|Transform|error_bound|SurfacePoint|object_position_of|tangents"),
    ("numbers", r"Sobol|NumberStream|IndependentSampler"),
    ("light", r"sample_visible|LightSampler|LightTree|Emission|SphericalRect|visible_density|TexelDistribution|Environment"),
    ("colour", r"Wavelengths|igmoid|Rgb|Map\b|Map::|Texture|Texels|to_xyz|Spectrum|ColorUse"),
    ("scatter", r"Scatter|Conductor|Microfacet|Dielectric|::bind|Lambert|Plastic|resnel|obes|scatter|Shader|MultipleReflection"),
    ("media", r"free_flight|Volume|Medium|transmittance|boundary"),
    ("loop", r"PathTracer|Roulette|CameraWalk|Walk<"),
    ("film", r"Film|film|Schedule|RenderProcess|Tile|Filter|Camera|ExactSums"),
)


def group_of(library, symbol):
    if "kernel" in library:
        return "system"
    if "libm." in library:
        return "libm"
    if "libetendue" not in library and "etendue" != library:
        return "other libraries"
    return next((name for name, pattern in GROUPS if re.search(pattern, symbol)), "other")


def profile(program, scene, samples, folder):
    """Shares of the groups [%], and the processor's seconds."""
    data = folder / "perf.data"
    command = ["perf", "record", "-q", "-F", "999", "-e", "cpu-clock", "-o", str(data), program, "render", str(scene.file),
               "--allow-path", str(scene.folder), "--samples", str(samples), "--threads", "1", "--set", "renderer=PathTracer", "--set",
               f"renderer.max_depth={scene.depth}", "--set", "image.filter=BoxFilter", "-o", str(folder / "out.npy"), "--quiet"]
    used = processes.run(command)
    report = subprocess.run(["perf", "report", "-i", str(data), "--no-children", "--sort", "dso,symbol", "--stdio"],
                            capture_output=True, text=True, check=True).stdout
    shares = collections.Counter()
    for share, library, symbol in re.findall(r"^\s+([\d.]+)%\s+(\S+)\s+\[.\]\s+(.*?)\s*$", report, re.MULTILINE):
        shares[group_of(library, symbol)] += float(share)
    return shares, used.seconds


def over_bare_rays(waves, program, scene, samples, folder):
    """The time of a scene's rays, and of all, over that of the same rays among bare triangles."""
    converted = folder / "scene.etd"
    processes.run([program, "convert", str(scene.file), "--allow-path", str(scene.folder), "-o", str(converted)])
    # Not by processes.run: what it says counts. Warnings of the scene's files are no news here.
    said = subprocess.run([waves, str(converted), str(samples), "3", str(scene.folder), str(scene.file.parent)], capture_output=True,
                          text=True, check=True).stdout
    rays, everything = re.search(r"to the bare rays one by one: ([\d.]+) the rays, ([\d.]+) all", said).groups()
    return rays, everything


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    here = pathlib.Path(__file__).resolve().parent
    parser.add_argument("--program", default=str(here.parent / "build" / "etendue"))
    parser.add_argument("--scenes", type=pathlib.Path, help="the folder of Bitterli's scenes")
    parser.add_argument("--only", action="append", help="a scene's name; may be repeated")
    parser.add_argument("--samples", type=int, default=32)
    parser.add_argument("--waves", help="the program that measures bare rays: build/benchmarks/etendue_waves")
    options = parser.parse_args()
    columns = [name for name, _ in GROUPS] + ["libm", "other", "other libraries", "system"]
    more = ["rays over bare ones", "all over bare rays"] if options.waves else []
    print("| scene | s | " + " | ".join(columns + more) + " |\n|" + "---|" * (len(columns + more) + 2))
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        for scene in peer_scenes.scenes(folder, options.scenes):
            if options.only and scene.name not in options.only:
                continue
            shares, seconds = profile(options.program, scene, options.samples, folder)
            cells = [f"{shares[c]:.0f}" for c in columns]
            if options.waves:
                cells += over_bare_rays(options.waves, options.program, scene, 2, folder)
            print(f"| {scene.name} | {seconds:.1f} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
