#!/usr/bin/env python3
"""Exports scenes to Mitsuba 3, renders them there (PyPI's mitsuba, spectrally) and here, and compares the means of X, Y and Z.

    tests/references/exports.py --program build/etendue --data ../shared/validation
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

MITSUBA = "mitsuba/tests/scenes/"
# Scene, below the repository or the validation data, and samples a pixel there and here.
HERE = "tests/references/exports/"
SCENES = [
    (HERE + "shapes.etd", 256),
    (HERE + "metals.etd", 256),
    (HERE + "glass.etd", 512),
    (HERE + "media.etd", 256),
    (HERE + "emitters.etd", 256),
    (HERE + "textures.etd", 256),
    ("scenes/cornell_box.etd", 128),
    (MITSUBA + "bsdf_spheres/test_constant_path.xml", 512),
    (MITSUBA + "bsdf_spheres/test_textured_diffuse_path.xml", 1024),
    (MITSUBA + "bsdf_spheres/test_roughplastic_linear_path.xml", 2048),
    (MITSUBA + "floating_sphere/test_directional_direct.xml", 256),
    (MITSUBA + "instancing/test_instancing_path.xml", 128),
    (MITSUBA + "orthographic_sensor/test_orthographic_path.xml", 64),
    (MITSUBA + "participating_media/test_homo_null_envmap_volpath.xml", 1024),
    (MITSUBA + "participating_media/test_surf_area_light_volpath.xml", 2048),
    (MITSUBA + "infinite_mirrors/scene_path.xml", 1024),
    ("bitterli/cornell-box/scene.xml", 128),
    ("bitterli/veach-mis/scene.xml", 128),
]
TO_XYZ = np.array([[0.412453, 0.357580, 0.180423], [0.212671, 0.715160, 0.072169], [0.019334, 0.119193, 0.950227]])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--data", required=True)
    parser.add_argument("--only", default="")
    parser.add_argument("--tolerance", type=float, default=0.005)
    parser.add_argument("--variant", default="llvm_ad_spectral")
    options = parser.parse_args()
    import mitsuba
    mitsuba.set_variant(options.variant)
    bad = 0
    for scene, samples in SCENES:
        if options.only not in scene:
            continue
        with tempfile.TemporaryDirectory() as folder:
            path = scene if scene.endswith(".etd") else str(Path(options.data) / scene)
            size = ["--size", "128x128"] if scene.startswith(("scenes/", "bitterli/")) else []
            exported, picture = f"{folder}/scene.xml", f"{folder}/picture.npy"
            sets = ["--set", "image.width=128", "--set", "image.height=128"] if size else []
            notes = subprocess.run([options.program, "export", path, "--allow-path", options.data, "-o", exported, *sets],
                                   capture_output=True, text=True, check=True).stderr
            subprocess.run([options.program, "render", path, "--allow-path", options.data, "--quiet", "--samples", str(samples),
                            "-o", picture, *sets], check=True, capture_output=True)
            here = np.load(picture)[..., :3]
            there = np.array(mitsuba.render(mitsuba.load_file(exported), spp=samples))[..., :3] @ TO_XYZ.T
        difference = there.mean((0, 1)) / here.mean((0, 1)) - 1
        pixels = here.shape[0] * here.shape[1]
        # Between two pictures of the same expectation neighbours differ by noise alone: its size in the mean.
        error = np.std((there - here)[..., 1]) / np.sqrt(pixels) / here[..., 1].mean()
        good = bool((np.abs(difference) < options.tolerance + 3 * error).all())
        bad += not good
        print(f"{scene:66} {'agrees' if good else 'DIFFERS'} " + " ".join(f"{100 * d:+.2f}" for d in difference) +
              f" % (error {100 * error:.2f} %)", flush=True)
        for note in notes.splitlines():
            print("    " + note)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
