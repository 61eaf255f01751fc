#!/usr/bin/env python3
"""What shaders in the Open Shading Language cost, against parts in C++ that do the same: eight materials, each written both ways.

    python3 benchmarks/osl_shaders.py [--program build/etendue] [--samples 64] [--pairs 3] [--only NAME...]
    python3 benchmarks/osl_shaders.py --start
    python3 benchmarks/osl_shaders.py --lengths 10 100 500

Each material covers the ball, the block and the floor of a scene like scenes/osl/stage.etd. It is rendered on one thread in three
ways, one after the other: the C++ part, the shader as machine code, the shader by the interpreter. What counts is the processor's
time (user and system) of the process less that of the same scene with one sample, so that start-up and compilation are not in it.
Printed are the ratios shader / C++ of the medians, and the mean of the pictures' difference: both must be of the same material. With
--start, the processor's time of one sample is printed instead: what start-up and compilation cost. With --lengths, what the
compilation of a shader of so many lines costs.

Needs numpy. The pictures of machine code and interpreter must be the same bytes, or the exit status is 1.
"""
import argparse
import os
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile

import numpy

# name: (shader, C++ part). A shader's class has its name with capitals.
MATERIALS = {
    "matt": ("surface matt(color paint = color(0.5, 0.3, 0.2)) { Ci = paint * diffuse(N); }", "Lambertian { color: rgb(0.5, 0.3, 0.2) }"),
    "checker": (
        """surface checker(float first = 0.2, float second = 0.8, float size = 8) {
             int odd = (int(floor(u * size)) + int(floor(v * size))) & 1;
             Ci = color(odd ? second : first) * diffuse(N); }""",
        "Lambertian { color: CheckerMap { first: 0.2, second: 0.8, repeat: [8, 8, 1] } }",
    ),
    "bumps": (
        """surface bumps(float low = 0.1, float high = 0.8) {
             float t = noise("uperlin", 4 * transform("object", P));
             Ci = color(mix(low, high, t)) * diffuse(N); }""",
        "Lambertian { color: NoiseMap { first: 0.1, second: 0.8, size: 0.25 m } }",
    ),
    "clouds": (
        """surface clouds(float low = 0.1, float high = 0.8) {
             point p = 2 * transform("object", P);
             float sum = 0, weight = 1, all = 0;
             for (int i = 0; i < 8; i++) { sum += weight * noise("uperlin", p); all += weight; weight *= 0.5; p *= 2; }
             Ci = color(mix(low, high, sum / all)) * diffuse(N); }""",
        "Lambertian { color: FbmMap { first: 0.1, second: 0.8, size: 0.5 m, octaves: 8 } }",
    ),
    "stripes": (
        """surface stripes() { float t = 0.5 + 0.4 * sin(40 * u) * cos(30 * v);
             Ci = color(clamp(t * t + 0.1 * smoothstep(0.4, 0.6, u), 0, 1)) * diffuse(N); }""",
        """Lambertian { color: FormulaMap { formula: "clamp((0.5 + 0.4 * sin(40 * u) * cos(30 * v)) * (0.5 + 0.4 * sin(40 * u) * cos(30 * v)) + 0.1 * smoothstep(0.4, 0.6, u), 0, 1)" } }""",
    ),
    "metal": (
        'surface metal(float rough = 0.2) { Ci = conductor_bsdf(N, dPdu, rough, rough, color(0.2, 0.9, 1.1), color(3.9, 2.4, 2.2), "ggx"); }',
        "Conductor { index: rgb, rgb_n: [0.2, 0.9, 1.1], rgb_k: [3.9, 2.4, 2.2], roughness: 0.2 }",
    ),
    "chalk": (
        "surface chalk(color paint = 0.5, float rough = 0.4) { Ci = oren_nayar_diffuse_bsdf(N, paint, rough); }",
        "OrenNayar { color: 0.5, roughness: 0.4 }",
    ),
    "coated": (
        """surface coated(color paint = color(0.5, 0.1, 0.1)) {
             Ci = layer(dielectric_bsdf(N, dPdu, color(1), color(0), 0.1, 0.1, 1.5, "ggx"), paint * diffuse(N)); }""",
        # The same two lobes by albedo scaling, here with the transmittance of the coat in both directions; its square is alpha.
        "Principled { base_color: rgb(0.5, 0.1, 0.1), specular_roughness: 0.31622776 }",
    ),
}

SCENE = """
{plugin}
Job {{
    renderer: PathTracer {{ max_depth: 6, samples: {samples} }}
    camera: PerspectiveCamera {{ from: [0.6, -6.2, 2.6] m, to: [0, 0, 0.95] m, up: [0, 0, 1], fov: 28 deg }}
    image: ImageBuffer {{ width: 160, height: 120 }}
    outputs: [NpyOutput {{}}]
    scene: BvhScene {{ objects: [
        Sphere {{ transform: translate(0.75 m, 0, 1 m), radius: 1 m, shader: {subject} }}
        Box {{ transform: translate(-1.05 m, 0.1 m, 0.76 m) * rotate(25 deg, "z"), size: [1.2, 1.2, 1.5], shader: {subject} }}
        Rectangle {{ corner: [-20, -20, 0] m, edge_u: [40, 0, 0] m, edge_v: [0, 40, 0] m, shader: {subject} }}
        Rectangle {{ corner: [-4.5, -2.5, 3.5] m, edge_u: [1, -1.6, 0.4] m, edge_v: [0.6, 0.6, 1.8] m, emission: DiffuseEmission {{ radiance: 9, sides: both }} }}
        Environment {{ emission: DiffuseEmission {{ radiance: 0.3 }} }}
    ] }}
}}
"""


def run(program, scene, output, way):
    """The processor's time of a render [s]."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([program, "render", scene, "-o", output, "--threads", "1"], check=True, stdout=subprocess.DEVNULL,
                   env={**os.environ, "ETENDUE_OSL": way})
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def shader_of(lines):
    """A shader of so many lines of arithmetic, functions and noise, with a branch and a loop now and then."""
    rows = ["surface long_one(float knob = 0.3, output float f = 0.5, output color c = 0.2) {", "  float x = u, y = v;"]
    kinds = ("x = sin(x * {k}) + y * knob;", "y = mix(x, y, 0.{k}) + noise(\"perlin\", P * {k});", "c = c * color(x, y, {k}) + 0.1 * tint;",
             "color tint = clamp(c * x, 0, {k});", "if (x > y) {{ x -= 0.{k}; }} else {{ y = sqrt(abs(x)); }}",
             "for (int i = 0; i < {k}; ++i) y += pow(x, i) * 0.1;", "f += smoothstep(0.1, 0.9, x) * dot(N, vector(x, y, {k}));")
    for i in range(lines - 4):
        rows.append("  " + kinds[(3, 0, 1, 2, 4, 5, 6)[i % 7]].format(k=1 + i % 7).replace("tint", f"tint{i // 7}"))
    return "\n".join(rows + ["  Ci = c * f * diffuse(N);", "}"])


def compile_times(options):
    print(f"{'lines':>6} {'compilation [s]':>16}")
    with tempfile.TemporaryDirectory() as folder:
        for lines in options.lengths:
            path = pathlib.Path(folder) / "long_one.osl"
            path.write_text(shader_of(lines))
            found = []
            for _ in range(options.pairs):
                used = []
                for way in ("--interpreter", "--compiler"):
                    before = resource.getrusage(resource.RUSAGE_CHILDREN)
                    subprocess.run([options.program, "shade", way, "-g", "1", "1", path], check=True, stdout=subprocess.DEVNULL)
                    after = resource.getrusage(resource.RUSAGE_CHILDREN)
                    used.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
                found.append(used[1] - used[0])
            print(f"{lines:6} {statistics.median(found):16.3f}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(pathlib.Path(__file__).resolve().parent.parent / "build/etendue"))
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--pairs", type=int, default=3)
    parser.add_argument("--only", nargs="*", default=list(MATERIALS))
    parser.add_argument("--start", action="store_true", help="prints what start-up costs")
    parser.add_argument("--lengths", type=int, nargs="+", help="lines of shaders that are compiled")
    options = parser.parse_args()
    if options.lengths:
        return compile_times(options)
    different = False
    print(f"{'material':10} {'C++ [s]':>9} {'machine code':>13} {'interpreter':>12}   picture")
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for name in options.only:
            shader, part = MATERIALS[name]
            (folder / f"{name}.osl").write_text(shader)
            ways = {"C++": ("", part, "automatic"), "compiler": (f'plugin "{name}.osl"', f"{name.capitalize()} {{}}", "compiler"),
                    "interpreter": (f'plugin "{name}.osl"', f"{name.capitalize()} {{}}", "interpreter")}
            times = {way: [] for way in ways}
            for pair in range(options.pairs):
                for way, (plugin, subject, mode) in ways.items():
                    used = {}
                    for samples in (1, options.samples):
                        scene = folder / f"{name}_{way.replace('+', 'p')}_{samples}.etd"
                        scene.write_text(SCENE.format(plugin=plugin, subject=subject, samples=samples))
                        used[samples] = run(options.program, scene, scene.with_suffix(".npy"), mode)
                    times[way].append(used[1] if options.start else used[options.samples] - used[1])
            images = {way: numpy.load(folder / f"{name}_{way.replace('+', 'p')}_{options.samples}.npy") for way in ways}
            if images["compiler"].tobytes() != images["interpreter"].tobytes():
                different = True
                print(f"{name}: machine code and interpreter made different pictures")
            middle = {way: statistics.median(t) for way, t in times.items()}
            mean = images["C++"].mean()
            print(f"{name:10} {middle['C++']:9.2f} {middle['compiler'] / middle['C++']:13.2f} {middle['interpreter'] / middle['C++']:12.2f}"
                  f"   {(images['compiler'].mean() - mean) / mean:+.2%}", flush=True)
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
