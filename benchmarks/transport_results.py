#!/usr/bin/env python3
"""Measures what docs/results/algorithms.md tells: the plates of multiple importance sampling, and the door ajar.

    python3 benchmarks/transport_results.py [--program build/etendue] [--pictures FOLDER]

Needs NumPy. Variances are over renders with different seeds; times are processor seconds of the whole process.
"""
import argparse
import os
import resource
import subprocess
import sys
import tempfile

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
SCENES = os.path.join(HERE, "..", "scenes", "verify")


def render(program, scene, renderer, size, samples, seed, folder, outputs=("out.npy",), more=()):
    """Renders and returns the array (height, width, channels) and the processor seconds it took."""
    paths = [os.path.join(folder, o) for o in outputs]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([program, "render", os.path.join(SCENES, scene + ".etd"), "--quiet", "--size", size, "--samples", str(samples),
                    "--seed", str(seed), "--set", "renderer=" + renderer, *more,
                    *[x for p in paths for x in ("-o", p)]], check=True, stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return np.load(paths[0]), after.ru_utime - before.ru_utime


def picture(program, scene, renderer, samples, path):
    subprocess.run([program, "render", os.path.join(SCENES, scene + ".etd"), "--quiet", "--size", "384x288", "--samples",
                    str(samples), "--set", "renderer=" + renderer, "-o", path], check=True, stderr=subprocess.DEVNULL)


def plates(program, folder, pictures):
    size, samples, runs = "256x192", 16, 24
    objects, _ = render(program, "mis_plates", "FeatureRenderer{feature: \"object\"}", size, 1, 1, folder)
    flat = objects[..., 1].round(5)
    # The plates are the objects of the lower picture's middle column, from the sharpest (far) to the dullest (near).
    names = ["12000", "1500", "200", "25"]
    column = [(0, -0.35, 0.95), (0, -0.9, 0.62), (0, -1.5, 0.36), (0, -2.2, 0.16)]
    masks = []
    for point in column:
        x, y = project(point, 256, 192)
        masks.append(flat == flat[int(y), int(x)])
    print("mean variance of Y over each plate, %d samples a pixel, %d renders" % (samples, runs))
    table = {}
    for name, renderer in {"luminaires": "DirectRenderer{strategy: \"light\"}", "shader": "DirectRenderer{strategy: \"shader\"}",
                           "both": "DirectRenderer{strategy: \"both\", heuristic: \"power\"}"}.items():
        images = [render(program, "mis_plates", renderer, size, samples, 100 + i, folder)[0][..., 1] for i in range(runs)]
        variance = np.var(images, axis=0, ddof=1)
        table[name] = [variance[m].mean() for m in masks]
        print("  %-11s" % name, " ".join("%s: %.3e" % (n, v) for n, v in zip(names, table[name])),
              " mean %.3e" % np.mean(table[name]))
        if pictures:
            picture(program, "mis_plates", renderer, samples, os.path.join(pictures, "mis_plates_%s.png" % name))
    for other in ("luminaires", "shader"):
        print("  variance with %s alone / with both: %.1f" % (other, np.mean(table[other]) / np.mean(table["both"])))


def project(point, width, height):
    """Film point of a point of mis_plates.etd, whose camera is from (0, -6, 1.7) to (0, -1.2, 0.85), 29 degrees high."""
    eye, to = np.array([0, -6, 1.7]), np.array([0, -1.2, 0.85])
    z = (to - eye) / np.linalg.norm(to - eye)
    x = np.cross(z, [0, 0, 1])
    x /= np.linalg.norm(x)
    y = np.cross(x, z)
    d = np.array(point) - eye
    scale = height / 2 / np.tan(np.radians(29) / 2)
    return width / 2 + scale * d @ x / (d @ z), height / 2 - scale * d @ y / (d @ z)


def door(program, folder, pictures):
    size = "128x96"
    reference, _ = render(program, "door_ajar", "BidirectionalPathTracer{max_depth: 16}", size, 8192, 7, folder)
    reference = reference[..., 1]
    floor = 1e-2 * reference.mean()
    error = lambda image: np.mean((image - reference) ** 2 / (reference ** 2 + floor ** 2))
    print("door ajar, relative mean squared error of Y against 8192 bidirectional samples")
    products = {}
    for name, samples in {"PathTracer": 512, "BidirectionalPathTracer": 128}.items():
        errors, seconds = [], []
        for seed in range(4):
            image, used = render(program, "door_ajar", name + "{max_depth: 16}", size, samples, 1000 + seed, folder)
            errors.append(error(image[..., 1]))
            seconds.append(used)
        products[name] = np.mean(errors) * np.mean(seconds)
        print("  %-24s %4d samples, %.1f s of processor time: %.4f; error times time %.4f" %
              (name, samples, np.mean(seconds), np.mean(errors), products[name]))
        if pictures:
            picture(program, "door_ajar", name + "{max_depth: 16}", samples // 2,
                    os.path.join(pictures, "door_ajar_%s.png" % name))
    print("  path tracing / bidirectional at equal time: %.1f" % (products["PathTracer"] / products["BidirectionalPathTracer"]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=os.path.join(HERE, "..", "build", "etendue"))
    parser.add_argument("--pictures", help="folder for the pictures")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        plates(options.program, folder, options.pictures)
        door(options.program, folder, options.pictures)
    return 0


if __name__ == "__main__":
    sys.exit(main())
