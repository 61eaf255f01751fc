#!/usr/bin/env python3
"""Kills renders at random moments and continues them: the picture must be the same, byte for byte.

    python3 tools/kill_and_continue.py [--program build/etendue] [--kills 20] [RENDERER ...]

Without names, all renderers. Each is given enough samples to run for a few seconds, then killed (SIGKILL) the given number of
times and continued to its end.
"""
import argparse
import os
import random
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
SCENE = os.path.join(HERE, "..", "scenes", "cornell_box.etd")
RENDERERS = ["PathTracer", "BidirectionalPathTracer", "LightTracer", "DistributionRenderer", "DirectRenderer", "WhittedRenderer",
             "AmbientOcclusionRenderer", "FeatureRenderer"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=os.path.join(HERE, "..", "build", "etendue"))
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=4, help="about how long an undisturbed render takes")
    parser.add_argument("renderers", nargs="*", default=RENDERERS)
    options = parser.parse_args()
    random.seed(1)
    failed = False
    for renderer in options.renderers:
        with tempfile.TemporaryDirectory() as folder:
            def command(name, samples, *more):
                return [options.program, "render", SCENE, "--quiet", "--size", "160x160", "--samples", str(samples),
                        "--set", "renderer=%s{}" % renderer, "-o", os.path.join(folder, name), *more]

            def seconds(*arguments):
                begun = time.monotonic()
                subprocess.run(command(*arguments), check=True, stderr=subprocess.DEVNULL)
                return time.monotonic() - begun

            first = seconds("one.npy", 64)
            samples = max(64, int(64 * (options.seconds - 0.3) / max(first - 0.3, 0.05)))
            whole = seconds("one.npy", samples)
            going_on = ("two.npy", samples, "--continue", os.path.join(folder, "state"), "--every", "0s")
            kills = states = 0
            while kills < options.kills:
                process = subprocess.Popen(command(*going_on), stderr=subprocess.DEVNULL)
                time.sleep(random.uniform(0.2, 0.3 + 0.4 * whole))
                process.kill()
                if process.wait() == 0:  # finished before: from the beginning
                    os.remove(os.path.join(folder, "state"))
                    continue
                kills += 1
                states += os.path.exists(os.path.join(folder, "state"))
            subprocess.run(command(*going_on), check=True, stderr=subprocess.DEVNULL)
            with open(os.path.join(folder, "one.npy"), "rb") as a, open(os.path.join(folder, "two.npy"), "rb") as b:
                same = a.read() == b.read()
            failed |= not same
            print("%-26s %d samples, %.1f s, killed %d times (%d with a state written): %s" %
                  (renderer, samples, whole, kills, states, "the same bytes" if same else "DIFFERENT"), flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
