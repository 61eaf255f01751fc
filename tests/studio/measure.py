"""Measures what a person waits for: `python3 tests/studio/measure.py [FILE]` on a machine that does nothing else.

1. From the command to the first pixels [s]: best and median of several beginnings.
2. From an orbit step to the first pixels of the moved picture [ms].
3. How much slower a render is while it is watched [%]: samples of a time, watched and not in turns."""

import argparse
import os
import pathlib
import statistics
import sys
import tempfile
import time

import client


def first_pixels(file, folder):
    began = time.monotonic()
    with client.Studio(file, folder=folder, threads=0) as studio, studio.page(hello=False) as page:
        page.good("watch")
        while not page.pixels or page.pixels[-1].samples == 0:
            page.note(page.receive())
        return time.monotonic() - began


def orbit_steps(file, folder, steps=40):
    times = []
    with client.Studio(file, folder=folder, threads=0) as studio, studio.page(hello=False) as page:
        page.good("watch")
        page.drain(1.5)
        for step in range(steps):
            generation = page.pixels[-1].generation
            page.pixels.clear()
            began = time.monotonic()
            page.good("orbit", x=0.02, y=0.003)
            while not (page.pixels and page.pixels[-1].generation > generation and page.pixels[-1].samples > 0):
                page.note(page.receive())
            times.append(time.monotonic() - began)
            page.drain(0.03)
        page.ask("shutdown", discard=True)  # else the moved camera is kept beside the file
    return times


def samples_in(page, seconds):
    """Samples per pixel that are made in a time."""
    before = page.good("hello", protocol=1)["progress"]
    page.drain(seconds)
    after = page.good("hello", protocol=1)["progress"]
    done = [p["fraction"] * p["samples_wanted"] for p in (before, after)]  # with the part of the step at hand
    return done[1] - done[0]


def watched_loss(file, folder, seconds, turns):
    ratios = []
    with client.Studio(file, folder=folder, threads=0) as studio, studio.page() as page:
        page.good("goals", samples=1000000)
        page.drain(2)
        for _ in range(turns):
            page.good("watch", what="none")
            alone = samples_in(page, seconds)
            page.good("watch", what="linear")
            watched = samples_in(page, seconds)
            ratios.append(watched / alone)
    return ratios


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", nargs="?", default=str(pathlib.Path(__file__).parents[2] / "scenes" / "cornell_box.etd"))
    parser.add_argument("--program", default=os.environ.get("ETENDUE_PROGRAM", "build/etendue"))
    parser.add_argument("--seconds", type=float, default=8, help="of each part of the third measurement")
    parser.add_argument("--turns", type=int, default=5)
    options = parser.parse_args()
    client.PROGRAM = options.program
    file = os.path.abspath(options.file)
    with tempfile.TemporaryDirectory() as folder:
        begins = [first_pixels(file, folder) for _ in range(5)]
        print(f"first pixels        {statistics.median(begins):.3f} s   (best {min(begins):.3f}; goal 1)", flush=True)
        steps = [1000 * t for t in orbit_steps(file, folder)]
        steps.sort()
        print(f"orbit step          {statistics.median(steps):.0f} ms   (nine of ten below {steps[int(0.9 * len(steps))]:.0f}; goal 100)", flush=True)
        ratios = watched_loss(file, folder, options.seconds, options.turns)
        spread = statistics.stdev(ratios) if len(ratios) > 1 else 0
        print(f"slower when watched {100 * (1 - statistics.mean(ratios)):.1f} %   (+- {100 * spread / len(ratios) ** 0.5:.1f}; goal 5)")
    return 0


if __name__ == "__main__":
    sys.exit(main())
