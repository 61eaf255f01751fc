#!/usr/bin/env python3
"""Do the renderers agree about light path expressions? Writes docs/results/path-layers.md.

    python3 benchmarks/path_layers.py --program build/etendue [--write docs/results/path-layers.md] [--quick] [--scene NAME]

Needs NumPy and SciPy. Five scenes are rendered by seven renderers with twenty layers each, 16 times with different seeds.

1. Partitions: some of the expressions divide all paths in four ways. In each render of each renderer these layers must add up to the picture, in
   every pixel, to the rounding of floats.
2. Agreement: each layer's mean over the picture is compared with that of the path tracer, whose render has more samples, by Welch's t test: the
   means of 16 independent renders are nearly normal, and their variance is estimated from their spread. All comparisons together have the
   significance 0.01 (Bonferroni).

Where a renderer does not find a class of paths, as it says itself, the layers that such paths belong to are left out (`MISSING`). The exit status is 1 if
something disagrees. --quick: fewer renders and samples, for the tests.
"""
import argparse
import os
import subprocess
import sys
import tempfile

try:
    import numpy as np
    from scipy import stats
except ImportError as error:
    print("skipped: %s" % error)
    sys.exit(77)

WIDTH, HEIGHT, SEGMENTS = 10, 8, 6

LAYERS = {
    # by the first event
    "emitted": "C[LBO]", "diffuse": "C<.D>[LBO]", "glossy": "C<.G>[LBO]", "specular": "C<.S>[LBO]", "volume": "CV[LBO]",
    "to_diffuse": "C<.D>[RTV].*", "to_glossy": "C<.G>[RTV].*", "to_specular": "C<.S>[RTV].*", "to_volume": "CV[RTV].*",
    # by length
    "two": "C.[LBO]", "three": "C..[LBO]", "longer": "C.{3,}[LBO]",
    # by what is on the way
    "surfaces": "C[RT]*[LBO]", "in_media": "C.*V.*",
    # by the luminaire
    "key": "C.*<L.'key'>", "others": "C.*[^'key']",
    # what belongs to no division
    "caustics": "C.*<RD>S+[LB]", "mirrored": "CS+<RD>.*", "ball": "C.*'ball'.*", "transmitted": "C.*T.*",
}
DIVISIONS = {
    "first event": ["emitted", "diffuse", "glossy", "specular", "volume", "to_diffuse", "to_glossy", "to_specular", "to_volume"],
    "length": ["emitted", "two", "three", "longer"],
    "media": ["surfaces", "in_media"],
    "luminaire": ["key", "others"],
}
# All expressions of a picture become one automaton, whose size is limited: two pictures have what one cannot.
PICTURES = [["emitted", "diffuse", "glossy", "specular", "volume", "to_diffuse", "to_glossy", "to_specular", "to_volume", "two", "three", "longer"],
            ["surfaces", "in_media", "key", "others", "caustics", "mirrored", "ball", "transmitted"]]

LAMP = "key = DiffuseEmission { radiance: 5 }\n"
FOGGY_BALL = """plastic = Plastic { color: rgb(0.7, 0.3, 0.2), roughness: 0.3 }
ball = Sphere { centre: [0.2, 0, 0], radius: 0.5, shader: plastic }"""
FOG = """
    ball
    Sphere { centre: [0, 2, 0.5], radius: 0.5, emission: key }
    Rectangle { corner: [-2, -0.8, -2], edge_u: [0, 0, 4], edge_v: [4, 0, 0], shader: Lambertian { color: 0.5 } }
    Sphere { radius: 4, shader: PassThrough {}, interior: HomogeneousVolume { scattering: 0.2, absorption: 0.05, emission: %g,
        phase: HenyeyGreensteinPhase { anisotropy: 0.4 } } }"""
SCENES = {
    # Surfaces that are diffuse and glossy at once.
    "plastics": (LAMP + """plastic = Plastic { color: rgb(0.7, 0.3, 0.2), roughness: 0.3 }
ball = Sphere { centre: [-0.5, -0.5, 0.4], radius: 0.5, shader: MixShader { first: Lambertian { color: rgb(0.2, 0.5, 0.3) },
    second: Conductor { roughness: 0.4 }, amount: 0.5 } }""", """
    ball
    Sphere { centre: [0.6, -0.5, 0.3], radius: 0.5, shader: plastic }
    Rectangle { corner: [-4, -1, -4], edge_u: [0, 0, 8], edge_v: [8, 0, 0], shader: plastic }
    Rectangle { corner: [-4, -1, -2], edge_u: [8, 0, 0], edge_v: [0, 4, 0], shader: Lambertian { color: 0.6 } }
    Sphere { centre: [0, 2, 0.5], radius: 0.5, shader: Lambertian { color: 0.2 }, emission: key }
    Sphere { centre: [1.5, 1.2, 0.8], radius: 0.3, emission: DiffuseEmission { radiance: rgb(1, 2, 6) } }"""),
    # Glass, a mirror and a sky: caustics, and reflections of caustics.
    "glass": (LAMP + """plastic = Plastic { color: rgb(0.7, 0.3, 0.2), roughness: 0.3 }
ball = Sphere { centre: [-0.5, -0.5, 0.4], radius: 0.5, shader: Dielectric {} }""", """
    ball
    Sphere { centre: [0.6, -0.5, 0.3], radius: 0.5, shader: plastic }
    Rectangle { corner: [1.6, -1, -2], edge_u: [0, 0, 4], edge_v: [0, 3, 0], shader: Conductor {} }
    Rectangle { corner: [-4, -1, -4], edge_u: [0, 0, 8], edge_v: [8, 0, 0], shader: Lambertian { color: 0.6 } }
    Rectangle { corner: [-4, -1, -2], edge_u: [8, 0, 0], edge_v: [0, 4, 0], shader: Lambertian { color: 0.6 } }
    Sphere { centre: [0, 2, 0.5], radius: 0.5, shader: Lambertian { color: 0.2 }, emission: key }
    Environment { emission: EnvironmentEmission { radiance: 0.3 } }"""),
    # A medium that scatters, and one that emits as well.
    "fog": (LAMP + FOGGY_BALL, FOG % 0),
    "glowing fog": (LAMP + FOGGY_BALL, FOG % 0.02),
    # Leaves that light passes diffusely, rough glass, an instance, a mask and lights without extent.
    "leaves": ("""key = DiffuseEmission { radiance: 8 }
ball = Sphere { radius: 0.5, shader: Dielectric { roughness: 0.4 } }""", """
    Instance { scene: BvhScene { objects: [ ball ] }, transform: translate(-0.6, -0.4, 0.3) }
    Rectangle { corner: [-0.2, -0.6, 0.4], edge_u: [1.2, 0, -0.3], edge_v: [0, 1.2, -0.4], shader: DiffuseTransmitter {
        reflectance: rgb(0.2, 0.4, 0.1), transmittance: rgb(0.2, 0.4, 0.1) } }
    Rectangle { corner: [-4, -1, -4], edge_u: [0, 0, 8], edge_v: [8, 0, 0], shader: Lambertian { color: 0.6 } }
    Rectangle { corner: [-4, -1, -2], edge_u: [8, 0, 0], edge_v: [0, 4, 0], shader: Plastic { color: rgb(0.3, 0.4, 0.6), roughness: 0.2 } }
    Point { transform: translate(0.5, 1.5, -0.8), emission: key }
    Sphere { centre: [-0.5, 1.6, 0.8], radius: 0.4, emission: DiffuseEmission { radiance: rgb(5, 3, 1) } }"""),
}
REFERENCE = "PathTracer"
REFERENCE_SAMPLES = 4  # times as many
# The renderer, its samples per pixel in each render, and the relative bias that it may have: photons are merged within a radius.
RENDERERS = {
    "PathTracer": ("PathTracer { max_depth: 6 }", 256, 0),
    "BidirectionalPathTracer": ("BidirectionalPathTracer { max_depth: 6 }", 256, 0),
    "GuidedPathTracer": ("GuidedPathTracer { max_depth: 6 }", 256, 0),
    "LightTracer": ("LightTracer { max_depth: 6 }", 1024, 0),
    "InstantRadiosity": ("InstantRadiosity { max_depth: 6, nearest: 1 }", 64, 0),
    "MultiplexedMetropolis": ("MultiplexedMetropolis { max_depth: 6 }", 128, 0),
    "VertexConnectionMerging": ("VertexConnectionMerging { max_depth: 6, photon_walks: 2000, radius: 0.2 }", 64, 0.01),
}
# Light subpaths are not connected to a camera through a mirror or smooth glass, nor to a sky that it sees, and do not begin in media that emit. Virtual
# lights do not either. So layers with such paths are left out.
MISSING = {
    ("glass", "LightTracer"): ["emitted", "specular", "to_specular", "two", "three", "longer", "surfaces", "key", "others", "caustics", "mirrored", "ball",
                               "transmitted", ""],
    ("glowing fog", "LightTracer"): [name for name in ["", *LAYERS] if name != "key"],
    ("glowing fog", "InstantRadiosity"): ["to_diffuse", "to_glossy", "to_volume", "three", "longer", "surfaces", "in_media", "others", "ball", ""],
}
SIGNIFICANCE = 0.01
ROUNDING = 1e-5  # of the layers of a division, relative to the picture and a thousandth of its brightest value


def picture(program, folder, scene, renderer, samples, seed):
    """X, Y, Z of the picture and of each layer: {name: (height, width, 3)}; "" is the whole picture. And by how much the layers of each
    division miss the picture, relative to it."""
    head, objects = SCENES[scene]
    path, found, missed = os.path.join(folder, "scene.etd"), {}, {}
    for names in PICTURES:
        with open(path, "w") as f:
            f.write(head + """
Job { renderer: PathTracer {}
    camera: PerspectiveCamera { from: [0, 0.3, 2.6], to: [0, 0, 0], fov: 60 }
    image: ImageBuffer { width: %d, height: %d, layers: [%s] }
    outputs: [NpyOutput { file: "out.npy", layers: true }]
    scene: BvhScene { objects: [%s
    ] } }
""" % (WIDTH, HEIGHT, ", ".join('"path.%s = %s"' % (name, LAYERS[name]) for name in names), objects))
        subprocess.run([program, "render", path, "--quiet", "--threads", "1", "--renderer", renderer, "--samples", str(samples),
                        "--seed", str(seed)], cwd=folder, check=True, stderr=subprocess.DEVNULL)  # it warns of light that it misses
        values = np.load(os.path.join(folder, "out.npy")).reshape(HEIGHT, WIDTH, -1, 3)
        layers = dict(zip(names, np.moveaxis(values[:, :, 1:], 2, 0)))
        whole = values[:, :, 0]
        for division, parts in DIVISIONS.items():
            if all(part in layers for part in parts):
                missed[division] = (np.abs(sum(layers[part] for part in parts) - whole) / (whole.max() * 1e-3 + np.abs(whole))).max()
        found.update(layers)
        found[""] = whole
    return found, missed


class Estimate:
    """The mean of a layer over the picture, from renders with different seeds; None where no render has any light."""

    def __init__(self, means):
        self.count, self.mean, self.variance = len(means), np.mean(means), np.var(means, ddof=1) / len(means)


def welch(a, b):
    """The difference relative to b, its standard error, and the probability of such a difference by chance."""
    error = np.sqrt(a.variance + b.variance)
    freedom = (a.variance + b.variance) ** 2 / (a.variance ** 2 / (a.count - 1) + b.variance ** 2 / (b.count - 1))
    return (a.mean - b.mean) / b.mean, error / b.mean, freedom


def measured(program, scene, seeds, divisor):
    """{renderer: {layer: Estimate}}, and the largest miss of each division."""
    found, missed = {}, {}
    with tempfile.TemporaryDirectory() as folder:
        for index, (renderer, (text, samples, _)) in enumerate(RENDERERS.items()):
            samples = samples // divisor * (REFERENCE_SAMPLES if renderer == REFERENCE else 1)
            means = {}
            for i in range(seeds):
                layers, misses = picture(program, folder, scene, text, samples, 1000 * index + i + 1)
                for name, values in layers.items():
                    means.setdefault(name, []).append(values[..., 1].mean())
                for division, miss in misses.items():
                    missed[renderer, division] = max(missed.get((renderer, division), 0), miss)
            found[renderer] = {name: Estimate(values) for name, values in means.items()}
    return found, missed


def judged(results):
    """The comparisons (scene, renderer, layer, difference, standard error, probability), the level at which each is significant, and what is wrong."""
    failures, comparisons = [], []
    for scene, (found, missed) in results.items():
        for (renderer, division), miss in missed.items():
            if miss > ROUNDING:
                failures.append("%s, %s: the division by %s misses the picture by %.2g" % (scene, renderer, division, miss))
        truth = found[REFERENCE]
        for renderer, layers in found.items():
            for name, layer in layers.items():
                if renderer == REFERENCE or name in MISSING.get((scene, renderer), []):
                    continue
                if truth[name].mean == 0 or layer.mean == 0:
                    # Both are without light, or one finds light that the other does not know.
                    if truth[name].mean != layer.mean:
                        failures.append("%s, %s, %s: %g, not %g" % (scene, renderer, name, layer.mean, truth[name].mean))
                    continue
                difference, error, freedom = welch(layer, truth[name])
                beyond = max(0, abs(difference) - RENDERERS[renderer][2])
                comparisons.append((scene, renderer, name, difference, error, 2 * stats.t.sf(beyond / error, freedom)))
    level = SIGNIFICANCE / max(1, len(comparisons))
    for scene, renderer, name, difference, error, probability in comparisons:
        if probability < level:
            failures.append("%s, %s, %s: differs by %+.2f %% (standard error %.2f %%, probability %.1g)" % (
                scene, renderer, name or "picture", 100 * difference, 100 * error, probability))
    return comparisons, level, failures


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", required=True)
    parser.add_argument("--write", help="the page to write")
    parser.add_argument("--scene", choices=list(SCENES), action="append", help="only this scene; may be repeated")
    parser.add_argument("--seeds", type=int, default=16)
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    program = os.path.abspath(options.program)
    seeds, divisor = (6, 8) if options.quick else (options.seeds, 1)
    results = {scene: measured(program, scene, seeds, divisor) for scene in options.scene or list(SCENES)}
    comparisons, level, failures = judged(results)
    for failure in failures:
        print("DISAGREES:", failure)
    print("%d comparisons, the smallest probability %.2g, the level %.2g; divisions miss by %.1g at most" % (
        len(comparisons), min(c[5] for c in comparisons), level, max(m for _, missed in results.values() for m in missed.values())))
    if options.write:
        with open(options.write, "w") as f:
            f.write(page(results, seeds))
    return 1 if failures else 0


def page(results, seeds):
    comparisons, level, failures = judged(results)
    text = """# Do the renderers agree about light path expressions?

Written by `benchmarks/path_layers.py`: %d expressions, %d scenes, %d renderers, %d independent renders of each by each. %d × %d pixels, paths of up to %d
segments.

**Divisions.** Four groups of the expressions divide all paths: by the first event, by length, by whether a medium was met, and by the luminaire.
In every render the layers of a group add up to the picture: in the worst pixel of all they miss it by %.1g of its value.

**Agreement.** The mean of each layer over the picture is compared with the path tracer's, by Welch's t test. All %d comparisons together have a
significance of %g, each one of %.2g (Bonferroni). %s The smallest probability is %.2g.

""" % (len(LAYERS), len(results), len(RENDERERS), seeds, WIDTH, HEIGHT, SEGMENTS, max(m for _, missed in results.values() for m in missed.values()),
       len(comparisons), SIGNIFICANCE, level, "**All agree.**" if not failures else "**Disagreements:** " + "; ".join(failures) + ".",
       min(c[5] for c in comparisons))
    text += """Cells are the difference in per cent and its standard error; a test finds a difference above about 6 standard errors with a probability of 95 %.
`VertexConnectionMerging`, which blurs within a small radius, may differ by 1 % besides. `-`: no path of the scene belongs to the layer. Where a
cell is empty, the renderer says itself what it cannot find.

"""
    others = [r for r in RENDERERS if r != REFERENCE]
    cells = {(scene, renderer, name): "%+.2f ± %.2f" % (100 * d, 100 * e) for scene, renderer, name, d, e, _ in comparisons}
    for scene, (found, _) in results.items():
        truth = found[REFERENCE]
        text += "## %s\n\n| layer | share of the light | %s |\n|---|---|%s\n" % (scene, " | ".join(others), "---|" * len(others))
        for name in [""] + list(LAYERS):
            share, title = truth[name].mean / truth[""].mean, "`%s`" % LAYERS[name] if name else "the picture"
            if share == 0:
                text += "| %s | - |%s\n" % (title, " - |" * len(others))
                continue
            text += "| %s | %.1f %% | %s |\n" % (title, 100 * share, " | ".join(cells.get((scene, r, name), "") for r in others))
        text += "\n"
    return text.rstrip("\n") + "\n"


if __name__ == "__main__":
    sys.exit(main())
