#!/usr/bin/env python3
"""How well all algorithms agree on the scenes of scenes/verify: `etendue verify` on each, as one table.

    python3 benchmarks/agreement.py --program build/etendue --time 20s -o agreement.md

Each algorithm that finds all light of a scene renders it for the same time, 64 x 48 pixels. A column tells by how much the light
of its whole picture differs from that of all the others together, their means weighted by the inverse of their variances, with
the standard error of that difference, both in per cent. What `verify` says of the scene, which looks at tiles and path lengths
too, is the last column. Algorithms that are exact in the limit alone are compared in a run of their own with BidirectionalPathTracer,
by their limits. --keep has the JSON of each run, from which a table is made again without rendering.
"""

import argparse
import json
import math
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SCENES = ["cornell_box", "glossy_box", "caustic_through_glass", "door_ajar", "small_opening", "mis_plates", "fog_with_spot",
          "nested_dielectrics", "sphere_and_environment", "mirror_caustic", "sunlit_pool", "iced_water_in_fog", "nested_lamps",
          "tilted_normals"]
CONSISTENT = "BidirectionalPathTracer,VertexConnectionMerging,ProgressivePhotonMapper"
SHORT = {"PathTracer": "Path", "AdaptiveSampling": "Adaptive", "BidirectionalPathTracer": "Bidirectional", "DistributionRenderer": "Distribution",
         "GuidedPathTracer": "Guided", "InstantRadiosity": "Instant", "LightTracer": "Light", "ManifoldPathTracer": "Manifold", "ManyLights": "ManyLights",
         "MultiplexedMetropolis": "Multiplexed", "PathSpaceMetropolis": "PathSpace", "PrimarySampleMetropolis": "PrimarySample",
         "VertexConnectionMerging": "VCM", "ProgressivePhotonMapper": "SPPM"}


def verify(options, scene, renderers, kept):
    """The answer of one run, from its file where there is one."""
    if not kept.exists():
        command = [options.program, "verify", ROOT / "scenes/verify" / f"{scene}.etd", "--size", "64x48", "--time", options.time,
                   "--samples", options.samples, "--threads", options.threads, "--seed", options.seed, "--json"]
        if renderers:
            command += ["--renderers", renderers]
        answer = subprocess.run([str(c) for c in command], capture_output=True, text=True)
        if answer.returncode not in (0, 1):
            raise RuntimeError(answer.stderr)
        kept.write_text(answer.stdout)
    return json.loads(kept.read_text())


def differences(renderers):
    """Of each renderer: its mean over that of the others - 1, and the standard error of that."""
    found = {}
    for r in renderers:
        others = [o for o in renderers if o is not r and o["relative_error"] > 0]
        weights = [1 / (o["relative_error"] * o["mean"]) ** 2 for o in others]
        mean = sum(w * o["mean"] for w, o in zip(weights, others)) / sum(weights)
        found[r["name"]] = (r["mean"] / mean - 1, math.hypot(r["relative_error"], 1 / math.sqrt(sum(weights)) / mean))
    return found


def verdict(answer):
    pairs = answer["pairs"]
    undecided = sum(len(p["undecided"]) > 0 for p in pairs)
    wrong = [f"{SHORT.get(p['a'], p['a'])}, {SHORT.get(p['b'], p['b'])}" for p in pairs if p["verdict"] == "disagree"]
    return ("agree" if not wrong else "DISAGREE: " + "; ".join(wrong)) + (f", {undecided} undecided" if undecided else "")


def table(answers):
    columns = [name for name in SHORT if any(r["name"] == name for _, answer in answers for r in answer["renderers"])]
    lines = ["| scene | " + " | ".join(SHORT[c] for c in columns) + " | |", "|---" * (len(columns) + 2) + "|"]
    for scene, answer in answers:
        found = differences(answer["renderers"])
        cells = [f"{100 * found[c][0]:+.2f} ± {100 * found[c][1]:.2f}" if c in found else "" for c in columns]
        lines.append(f"| {scene} | " + " | ".join(cells) + f" | {verdict(answer)} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--time", default="20s", help="of each renderer on each scene")
    parser.add_argument("--samples", default="512", help="a pixel, in 16 passes: what the size of a pass is")
    parser.add_argument("--threads", default="0")
    parser.add_argument("--seed", default="1")
    parser.add_argument("--only", default="", help="scenes whose name holds this")
    parser.add_argument("--keep", type=Path, default=Path("agreement"), help="a folder for the answers")
    parser.add_argument("-o", "--output", type=Path, required=True)
    options = parser.parse_args()
    options.keep.mkdir(parents=True, exist_ok=True)
    unbiased, consistent = [], []
    for scene in SCENES:
        if options.only not in scene:
            continue
        for answers, renderers, name in ((unbiased, "", scene), (consistent, CONSISTENT, f"{scene}_limits")):
            answers.append((scene, verify(options, scene, renderers, options.keep / f"{name}.json")))
        print(f"{scene}: {verdict(unbiased[-1][1])}; limits: {verdict(consistent[-1][1])}", flush=True)
        options.output.write_text(table(unbiased) + "\n" + table(consistent))
    return 0


if __name__ == "__main__":
    sys.exit(main())
