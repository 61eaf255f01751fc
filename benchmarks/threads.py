#!/usr/bin/env python3
"""How long the first pixel takes, and what more threads bring: on an idle machine.

    python3 benchmarks/threads.py scenes/cornell_box.etd --threads 2

For each scene, in turns, the best of --turns by the clock counts:
  - first pixel: the whole process for one sample of one pixel, written to a file: reading, preparing and starting included;
  - speed-up: of a sample, the slope between two numbers of samples, with one thread over that with so many;
  - start: what is left of the time at 0 samples, with one thread and with several: what of it is done by one thread alone;
  - busy: of the time that so many threads had, the part in which they worked (processor's time over clock times threads), with the
    start, and of the slope alone: what is missing there are the ends of steps, at which some wait for others.
The aims: 0.3 s, and 1.95 from two threads.
"""
import argparse
import os
import pathlib
import sys
import tempfile
import time

import processes


def run(program, scene, more, out):
    began = time.perf_counter()
    used = processes.run([program, "render", scene, "-o", out, "--quiet", *more])
    return time.perf_counter() - began, used.seconds


def best(measure, turns):
    """Of several (clock, processor) the one of the least time by the clock."""
    return min((measure() for _ in range(turns)), key=lambda pair: pair[0])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    here = pathlib.Path(__file__).resolve().parent
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--program", default=str(here.parent / "build" / "etendue"))
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--samples", type=int, nargs=2, default=(32, 160), metavar=("FEW", "MANY"))
    parser.add_argument("--turns", type=int, default=5)
    parser.add_argument("--set", action="append", default=[], help="as for etendue render")
    options = parser.parse_args()
    others = os.getloadavg()[0]
    if others > 0.3:
        print(f"the load of this machine is {others:.1f}: these numbers say little", file=sys.stderr)
    given = [part for one in options.set for part in ("--set", one)]
    few, many = options.samples
    print("| scene | first pixel | speed-up | start, 1 thread | start | busy | busy without the start |\n|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "picture.npy"
        for scene in options.scenes:
            first = best(lambda: run(options.program, scene, ["--samples", 1, "--crop", "0,0,1,1", *given], out), options.turns)[0]
            times = {(threads, samples): [] for samples in (few, many) for threads in (1, options.threads)}
            for _ in range(options.turns):  # in turns, so that a slow minute meets all
                for threads, samples in times:
                    times[threads, samples].append(run(options.program, scene, ["--samples", samples, "--threads", threads, *given], out))
            found = {key: min(some) for key, some in times.items()}
            slope = {t: tuple((found[t, many][i] - found[t, few][i]) / (many - few) for i in (0, 1)) for t in (1, options.threads)}
            start = {t: found[t, few][0] - few * slope[t][0] for t in slope}
            n = options.threads
            print(f"| {scene} | {first:.3f} s | {slope[1][0] / slope[n][0]:.3f} | {start[1]:.3f} s | {start[n]:.3f} s | "
                  f"{found[n, many][1] / found[n, many][0] / n:.3f} | {slope[n][1] / slope[n][0] / n:.3f} |", flush=True)


if __name__ == "__main__":
    main()
