#!/usr/bin/env python3
"""Makes random small scenes of Mitsuba 3, renders each with Mitsuba (of PyPI) and here from the same XML, and compares the pictures.

    tests/references/differential.py --program build/etendue --seed 1 --count 50 --keep /tmp/differences
    tests/references/differential.py --program build/etendue --scene /tmp/differences/17.xml

The scene of a seed (random_scenes.py) is always the same. Each program makes two pictures, whose difference tells the noise of both.
A scene differs when the mean of X, Y or Z does by more than 3.5 standard errors + 0.3 %, or a tile of 8 x 8 pixels by more than five +
2 % (of the tile, or of a tenth of the whole); and still does with four times the samples and other seeds, since the noise of a few
bright pixels does not know its own size. What differs is kept with the files it names, and shrunk: elements are left out, or give
way to what they hold, as long as the difference stays. `N.small.xml` then mostly shows the cause. A scene whose import tells that it
is not exact is marked so.
"""

import argparse
import copy
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as ET
from pathlib import Path

from random_scenes import SceneMaker

NOT_TRIED = 77  # the exit status that the test suite shows as skipped
try:
    import mitsuba
    import numpy as np
except ImportError:
    print("skipped: Mitsuba is not there (pip install mitsuba numpy)")
    sys.exit(NOT_TRIED)

TO_XYZ = np.array([[0.412453, 0.357580, 0.180423], [0.212671, 0.715160, 0.072169], [0.019334, 0.119193, 0.950227]])
TILE = 8
ALIKE = 4  # what a filter wider than a pixel makes of the variance of a mean: a Gaussian of 0.5 pixels, 4 pi / 4 = 3.1


class Untried(Exception):
    """A scene that one of the two does not render."""


def tiles(picture):
    h, w = picture.shape[0] // TILE, picture.shape[1] // TILE
    return picture[:h * TILE, :w * TILE].reshape(h, TILE, w, TILE, -1).mean((1, 3))


class Mean:
    """Of two pictures, with the variances of its mean and its tiles."""

    def __init__(self, halves, alike):
        self.picture = (halves[0] + halves[1]) / 2
        square = ((halves[0] - halves[1]) / 2) ** 2 * alike
        self.mean, self.tiles = self.picture.mean((0, 1)), tiles(self.picture)
        self.variance = square.mean((0, 1)) / (square.shape[0] * square.shape[1])
        # Of few pixels a variance is itself uncertain, and a dark tile may hold none of the rare bright paths.
        self.tile_variance = (tiles(square) + 0.05 * square.mean((0, 1))) / TILE**2


class Comparison:
    def __init__(self, here, there, notes):
        self.here, self.there, self.notes = here, there, notes
        scale = np.maximum(np.abs(there.mean), np.abs(here.mean))
        scale = np.maximum(scale, 1e-3 * scale.max() + 1e-9)
        self.error = np.sqrt(here.variance + there.variance) / scale
        self.difference = (here.mean - there.mean) / scale
        mean_over = np.abs(self.difference) / (3.5 * self.error + 0.003)
        tile_scale = np.maximum(np.abs(there.tiles), scale / 10)
        distance = np.abs(here.tiles - there.tiles)
        tile_over = distance / (5 * np.sqrt(here.tile_variance + there.tile_variance) + 0.02 * tile_scale)
        self.over, self.tile_over = mean_over.max(), tile_over.max()
        place = np.unravel_index(np.argmax(tile_over.max(-1)), tile_over.shape[:2])
        self.worst = tuple(int(i) for i in place)
        self.worst_difference = ((here.tiles - there.tiles) / tile_scale)[place]

    def differs(self):
        return bool(max(self.over, self.tile_over) > 1)

    def __str__(self):
        d, e = 100 * self.difference, 100 * self.error
        w = np.round(100 * self.worst_difference, 1)
        return (f"X {d[0]:+.2f} Y {d[1]:+.2f} Z {d[2]:+.2f} % (error {e[1]:.2f} %), {self.over:.2f} of the bound; "
                f"tile {self.worst}: {w[0]:+} {w[1]:+} {w[2]:+} %, {self.tile_over:.2f} of the bound")


class Programs:
    def __init__(self, options):
        self.program, self.samples = str(Path(options.program).resolve()), options.samples
        self.seed = 0

    def here(self, file, samples):
        self.seed += 1
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "picture.npy"
            command = [self.program, "render", file, "--quiet", "--samples", str(samples), "--seed", str(self.seed), "--set",
                       f'outputs=[NpyOutput {{ file: "{out}" }}]']
            result = subprocess.run(command, capture_output=True, text=True, timeout=600)
            if result.returncode != 0:
                raise Untried(f"here: {result.stderr.strip()}")
            return np.load(out).astype(float)[..., :3], result.stderr

    def there(self, scene, samples):
        self.seed += 1
        picture = np.array(mitsuba.render(scene, spp=samples, seed=self.seed), dtype=float)
        return picture[..., :3] @ TO_XYZ.T

    def compare(self, file, factor=1):
        samples = self.samples * factor
        try:
            scene = mitsuba.load_file(str(file))
            there = [self.there(scene, samples) for _ in range(2)]
            if not np.isfinite(there).all():
                raise Untried("Mitsuba: pixels that are not finite")
        except RuntimeError as error:
            raise Untried(f"Mitsuba: {str(error).strip().splitlines()[-1]}") from error
        pictures = [self.here(file, samples) for _ in range(2)]
        if pictures[0][0].shape != there[0].shape:
            raise Untried(f"pictures of {pictures[0][0].shape} here and {there[0].shape} there")
        alike = 1 if 'rfilter type="box"' in Path(file).read_text() else ALIKE
        return Comparison(Mean([p for p, _ in pictures], alike), Mean(there, alike), pictures[0][1])


def left_out(scene):
    """Ways to make the scene smaller, each with its way back: an element less, or in the place of the one that holds it. The view
    is kept: one from within a surface would differ for its own reasons."""
    parents = {inner: outer for outer in scene.iter() for inner in outer}
    view = {e for sensor in scene.iter("sensor") for e in sensor.iter()}
    for e in sorted(parents, key=lambda e: -len(list(e.iter()))):
        if e in view or e.tag == "integrator" or e.get("name") == "filename":
            continue
        yield parents[e], e, [None, *([i for i in e if i.tag == "bsdf"] if e.tag == "bsdf" else [])]


def shrink(programs, path, factor, seconds):
    """Writes the smallest scene that was found to differ still."""
    scene, end = ET.parse(path).getroot(), time.monotonic() + seconds
    small = path.with_suffix(".small.xml")

    def differs():
        ET.indent(scene)
        ET.ElementTree(scene).write(small)
        try:
            return programs.compare(small, factor).differs()
        except (Untried, subprocess.TimeoutExpired):
            return False

    for _ in range(2):  # what was needed at first may not be in a smaller scene
        gone = set()
        for outer, e, instead in left_out(scene):
            if outer in gone or e not in list(outer) or time.monotonic() > end:
                gone.add(e)
                continue
            index = list(outer).index(e)
            for inner in instead:
                outer.remove(e)
                if inner is not None:
                    outer.insert(index, inner)
                if differs():
                    gone.add(e)
                    break
                if inner is not None:
                    outer.remove(inner)
                outer.insert(index, e)
    differs()  # writes it
    return programs.compare(small, factor)


def try_scene(programs, path, options):
    """Whether it agrees, and words about it."""
    begin = time.monotonic()
    try:
        result = programs.compare(path)
        if result.differs():
            result = programs.compare(path, 4)
    except Untried as reason:
        return None, str(reason)
    # What a renderer cannot find, the other does not find either.
    notes = [note for note in result.notes.splitlines() if "warning" in note and " cannot find " not in note]
    told = " (told)" if notes else ""
    words = f"{'DIFFERS' + told if result.differs() else 'agrees'} {result} [{time.monotonic() - begin:.0f} s]"
    if result.differs():
        words += "".join("\n    " + note for note in notes)
        if options.shrink > 0:
            words += f"\n    of the small one: {shrink(programs, path, 4, options.shrink)}"
    return not result.differs(), words


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--seed", type=int, default=1, help="of the first scene; the following have the following")
    parser.add_argument("--count", type=int, default=50, help="of scenes")
    parser.add_argument("--scene", help="a file to compare instead")
    parser.add_argument("--samples", type=int, default=64, help="a pixel, of each of the four pictures")
    parser.add_argument("--variant", default="scalar_spectral", help="scalar_spectral: a small scene takes the others longer to compile")
    parser.add_argument("--threads", type=int, default=1, help="of Mitsuba")
    parser.add_argument("--keep", default="differences", help="a folder for the scenes that differ")
    parser.add_argument("--shrink", type=float, default=60, help="seconds to look for a smaller scene that differs")
    options = parser.parse_args()
    mitsuba.set_variant(options.variant)
    mitsuba.set_log_level(mitsuba.LogLevel.Error)
    import drjit
    drjit.set_thread_count(options.threads)
    programs = Programs(options)
    if options.scene:
        same, words = try_scene(programs, Path(options.scene), options)
        print(words)
        return int(not same)
    keep = Path(options.keep)
    keep.mkdir(parents=True, exist_ok=True)
    agree = differ = untried = 0
    for seed in range(options.seed, options.seed + options.count):
        maker = SceneMaker(seed)
        path = keep / f"{seed}" / f"{seed}.xml"
        path.parent.mkdir(exist_ok=True)
        ET.ElementTree(maker.scene()).write(path)
        for name, content in maker.files.items():
            (path.parent / name).write_bytes(content)
        same, words = try_scene(programs, path, options)
        print(f"{seed} {maker.sort} {maker.integrator}: {words}", flush=True)
        agree, differ, untried = agree + (same is True), differ + (same is False), untried + (same is None)
        if same:
            for file in path.parent.iterdir():
                file.unlink()
            path.parent.rmdir()
    print(f"{agree} agree, {differ} differ, {untried} are not rendered by one of the two")
    return 1 if differ or untried else 0


if __name__ == "__main__":
    sys.exit(main())
