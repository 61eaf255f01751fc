#!/usr/bin/env python3
"""A ColorChecker under D65 and A, rendered, against colours computed from its published reflectances.

    python3 colorchecker.py --program build/etendue

Needs NumPy and colour-science, which has the reflectances (N. Ohta 1997, The basis of color reproduction engineering), the illuminants and the
CIE 1931 observer: none of the numbers here is ours. 24 patches and a perfect white lie in one plane below a uniform sky of the illuminant, so each
has the radiance reflectance x illuminant. Their colours, from the picture and from the bands of a SpectralFilm, must be within a CIEDE2000 difference
of 0.5 of the computed ones. `etendue image sensor` then exposes a camera with measured sensitivities (Nikon 5100, National Physical Laboratory): its
digital numbers must be within 0.5 % of white's.

The cameras that are known by name are exposed too, and developed with `--white` by the matrices that are derived from their curves. No camera sees as
the eye does, so its colours are never exact: the bound of what a matrix can do is the one fitted to these very patches, with white exact. The derived
matrix, which knows only smooth reflectances of other colours, may have a mean CIEDE2000 of 1 more, and EXPECTED says how much each has. In the light
of A, the colours are compared with those that the patches have by day: that the lamp shows too little blue cannot be undone.
"""
import argparse
import os
import subprocess
import sys
import tempfile
import warnings

try:
    warnings.simplefilter("ignore")
    import colour
    import numpy as np
except ImportError as error:
    print("skipped: %s" % error)
    sys.exit(77)

SIDE = 8  # pixels of a patch
WAVELENGTHS = np.arange(360, 831)


# The mean and the largest CIEDE2000 over the 24 patches that the colours of a camera may have, under D65 and A.
EXPECTED = {"Nikon D5100": {"D65": (1.4, 4.5), "A": (3.3, 10.5)}, "Sigma SD1 Merrill": {"D65": (2.7, 7.7), "A": (3.2, 11)},
            "Canon EOS 5D Mark II": {"D65": (1.1, 2.5), "A": (2.6, 9.2)}}


def table(distribution):
    """At whole nanometres, linear between the table's values and constant beyond, as our spectra are."""
    return np.interp(WAVELENGTHS, distribution.wavelengths, distribution.values)


def observer():
    cmfs = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    return np.stack([np.interp(WAVELENGTHS, cmfs.wavelengths, cmfs.values[:, c]) for c in range(3)], axis=1)


def scene(patches, illuminant):
    objects = ["Environment { emission: EnvironmentEmission { radiance: spectrum([%s], [%s]) } }" % (
        ", ".join("%g" % w for w in illuminant.wavelengths), ", ".join("%.8g" % (v / 100) for v in illuminant.values))]
    for i, patch in enumerate(patches):
        color = "spectrum([%s], [%s])" % (", ".join("%g" % w for w in patch.wavelengths), ", ".join("%.8g" % v for v in patch.values)) if patch else "1"
        objects.append("Rectangle { corner: [%d, %d, 0] m, edge_u: [1, 0, 0] m, edge_v: [0, 1, 0] m, shader: Lambertian { color: %s } }" % (
            i % 5, i // 5, color))
    return """Job {
    renderer: PathTracer { samples: 256 }
    camera: OrthographicCamera { from: [2.5, 2.5, 2] m, to: [2.5, 2.5, 0] m, width: 5 m }
    image: SpectralFilm { width: %d, height: %d, bands: 94, filter: BoxFilter {} }
    outputs: [ExrOutput { file: "checker.exr" }, NpyOutput { file: "colour.npy" }, NpyOutput { file: "bands.npy", spectrum: true }]
    scene: BruteForceScene { objects: [
%s
    ] }
}
""" % (5 * SIDE, 5 * SIDE, ",\n".join(objects))


def patches_of(image, count):
    """The mean of each patch; the camera looks along -z with +y upwards, so +x is to the right."""
    rows = image.reshape(5, SIDE, 5, SIDE, -1).mean(axis=(1, 3))[::-1]
    return rows.reshape(25, -1)[:count]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", required=True)
    program = os.path.abspath(parser.parse_args().program)
    patches = list(colour.SDS_COLOURCHECKERS["ColorChecker N Ohta"].values()) + [None]
    eye, failed = observer(), False
    camera = colour.MSDS_CAMERA_SENSITIVITIES["Nikon 5100 (NPL)"]
    # None beyond the table's ends.
    sensitivities = np.stack([np.interp(WAVELENGTHS, camera.wavelengths, camera.values[:, c], 0, 0) for c in range(3)], axis=1)
    for name in ("D65", "A"):
        illuminant = colour.SDS_ILLUMINANTS[name]
        light = table(illuminant)
        truth = np.array([(eye * (light * (table(p) if p else 1))[:, None]).sum(axis=0) for p in patches])
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "checker.etd"), "w") as f:
                f.write(scene(patches, illuminant))
            subprocess.run([program, "render", "checker.etd", "--quiet"], cwd=folder, check=True)
            np.savetxt(os.path.join(folder, "camera.csv"), np.column_stack([WAVELENGTHS, sensitivities]), delimiter=",",
                       header="wavelength,red,green,blue", comments="")
            subprocess.run([program, "image", "sensor", "checker.exr", "raw.npy", "--sensitivities", "camera.csv", "--columns", "red,green,blue",
                            "--shutter", "0.0003", "--bits", "16"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
            raw = patches_of(np.load(os.path.join(folder, "raw.npy")), 25)
            photos = {}
            for shipped in EXPECTED:
                subprocess.run([program, "image", "sensor", "checker.exr", "photo.npy", "--camera", shipped, "--white", name, "--shutter", "0.0003",
                                "--bits", "16"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
                subprocess.run([program, "image", "sensor", "checker.exr", "numbers.npy", "--camera", shipped, "--shutter", "0.0003", "--bits", "16"],
                               cwd=folder, check=True, stdout=subprocess.DEVNULL)
                photos[shipped] = [patches_of(np.load(os.path.join(folder, f)), 25) for f in ("photo.npy", "numbers.npy")]
            seen = patches_of(np.load(os.path.join(folder, "colour.npy")), 25)
            bands = patches_of(np.load(os.path.join(folder, "bands.npy")), 25)
        edges = np.linspace(360, 830, 95)
        weights = np.array([eye[(WAVELENGTHS >= a) & (WAVELENGTHS < b)].sum(axis=0) for a, b in zip(edges, edges[1:])])

        true_raw = np.array([(sensitivities * (light * (table(p) if p else 1))[:, None]).sum(axis=0) for p in patches])
        error = np.abs(raw / raw[-1] - true_raw / true_raw[-1]).max()
        balance = np.abs((raw[-1] / raw[-1, 1]) / (true_raw[-1] / true_raw[-1, 1]) - 1).max()
        print("%s, Nikon 5100: numbers differ by %.3f %% of white's at most, white's balance by %.3f %%" % (name, 100 * error, 100 * balance))
        failed |= bool(error > 0.005) or bool(balance > 0.005) or bool(raw.max() >= 65535)

        def lab(xyz, white):
            return colour.XYZ_to_Lab(xyz / white[1], colour.XYZ_to_xy(white))
        true_lab = lab(truth, truth[-1])
        # A camera's picture is balanced to D65.
        day = table(colour.SDS_ILLUMINANTS["D65"])
        by_day = np.array([(eye * (day * (table(p) if p else 1))[:, None]).sum(axis=0) for p in patches])
        for shipped, (photo, numbers) in photos.items():
            balanced = numbers / numbers[-1]
            weight = np.r_[np.ones(24), 1e3][:, None]
            best = balanced @ np.linalg.lstsq(weight * balanced, weight * by_day / by_day[-1, 1], rcond=None)[0]
            results = []
            for xyz in (photo, best):
                difference = colour.delta_E(lab(by_day, by_day[-1])[:24], lab(xyz, by_day[-1] / by_day[-1, 1] * xyz[-1, 1])[:24], method="CIE 2000")
                results.append((difference.mean(), difference.max()))
            print("%s, %s: CIEDE2000 mean %.2f, at most %.2f; of the matrix fitted to the patches %.2f, %.2f" % (name, shipped, *results[0], *results[1]))
            mean, most = EXPECTED[shipped][name]
            failed |= bool(results[0][0] > mean or results[0][1] > most or results[0][0] > results[1][0] + 1)
        for what, xyz in (("picture", seen), ("bands", bands @ weights)):
            difference = colour.delta_E(true_lab, lab(xyz, xyz[-1]), method="CIE 2000")
            print("%s, from the %s: CIEDE2000 at most %.3f, mean %.3f" % (name, what, difference.max(), difference.mean()))
            # Not only colours beside white, also white's own.
            chromaticity = np.abs(colour.XYZ_to_xy(xyz[-1]) - colour.XYZ_to_xy(truth[-1])).max()
            print("    white's chromaticity differs by %.5f" % chromaticity)
            failed |= bool(difference.max() > 0.5) or bool(chromaticity > 0.002)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
