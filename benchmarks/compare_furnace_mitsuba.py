#!/usr/bin/env python3
"""Shading normals in a furnace, here and in Mitsuba 3: what scatters all light must not be seen in it.

Needs `pip install mitsuba numpy`.

    python3 benchmarks/compare_furnace_mitsuba.py [--samples 256] [--program build/etendue] [--table docs/results/furnace.md]

A ball whose normals are interpolated (meshes of 32, 128, 512 triangles), bumped, or read from an image, in an environment of
radiance 1. Every pixel ought to be 1. Told are the mean of the pixels that show the ball, and the darkest of them, of renders
with paths of up to 200 segments; both contain noise where the material is rough. Mitsuba's materials are those that come nearest.
"""
import argparse
import math
import os
import subprocess
import tempfile

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
SIZE = 48

ETENDUE = """Job {{
    renderer: PathTracer {{ max_depth: 200 }}
    camera:   PerspectiveCamera {{ from: [3, 2, 4], to: [0, 0, 0], fov: 24 deg }}
    image:    ImageBuffer {{ width: {size}, height: {size}, filter: BoxFilter {{}} }}
    scene: EmbreeScene {{ objects: [ {object}
        Environment {{ emission: EnvironmentEmission {{ radiance: 1 }} }} ] }}
    outputs: [ NpyOutput {{}} ]
}}
"""

# name, here, in Mitsuba
SHADERS = [
    ("matt, white", "Lambertian { color: 1 }", {"type": "diffuse", "reflectance": 1.0}),
    ("rough matt, white", "OrenNayar { color: 1, roughness: 0.6 }", None),
    ("glass", "Dielectric { ior: 1.5 }", {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}),
    ("frosted glass", "Dielectric { ior: 1.5, roughness: 0.4 }",
     {"type": "roughdielectric", "int_ior": 1.5, "ext_ior": 1.0, "alpha": 0.4, "distribution": "ggx"}),
    ("thin pane", "ThinDielectric { ior: 1.5 }", {"type": "thindielectric", "int_ior": 1.5, "ext_ior": 1.0}),
    ("mirror", "Conductor { ior: complex(0.01, 99), roughness: 0 }", {"type": "conductor", "material": "none"}),
    ("rough metal", "Conductor { ior: complex(0.01, 99), roughness: 0.5 }",
     {"type": "roughconductor", "material": "none", "alpha": 0.5, "distribution": "ggx"}),
    ("plastic, white", "LayeredShader { top: Dielectric { ior: 1.5 }, bottom: Lambertian { color: 1 } }",
     {"type": "plastic", "int_ior": 1.5, "ext_ior": 1.0, "diffuse_reflectance": 1.0}),
]


def ball(rows):
    """Vertices of a ball of 4 rows (rows - 1) triangles; they are its normals as well."""
    columns = 2 * rows
    vertices = [(0, 1, 0)]
    for i in range(1, rows):
        theta = math.pi * i / rows
        for k in range(columns):
            phi = 2 * math.pi * k / columns
            vertices.append((math.sin(theta) * math.cos(phi), math.cos(theta), -math.sin(theta) * math.sin(phi)))
    vertices.append((0, -1, 0))

    def at(i, k):
        return 0 if i == 0 else (1 + (rows - 1) * columns if i == rows else 1 + (i - 1) * columns + k % columns)

    triangles = []
    for i in range(rows):
        for k in range(columns):
            a, b, c, d = at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)
            if i > 0:
                triangles.append((a, b, d))
            if i + 1 < rows:
                triangles.append((b, c, d))
    return vertices, triangles


def write_ply(path, vertices, triangles):
    with open(path, "w", encoding="ascii") as file:
        file.write("ply\nformat ascii 1.0\n")
        file.write(f"element vertex {len(vertices)}\n" + "".join(f"property float {n}\n" for n in ("x", "y", "z", "nx", "ny", "nz")))
        file.write(f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n")
        for v in vertices:
            file.write(" ".join(f"{x:.9g}" for x in v + v) + "\n")
        for t in triangles:
            file.write("3 %d %d %d\n" % t)


def maps():
    """Heights in [0, 1] and the normals, tilted up to 52 degrees, of 64 x 64 texels."""
    y, x = np.mgrid[0:64, 0:64]
    heights = 0.5 + 0.25 * np.sin(2 * np.pi * x / 16) + 0.25 * np.sin(2 * np.pi * y / 16)
    turn, slope = 2.4 * (8 * (y // 8) + x // 8), 0.2 * ((x // 8 + 3 * (y // 8)) % 5)
    normals = np.stack([slope * np.cos(turn), slope * np.sin(turn), np.sqrt(1 - slope**2)], axis=-1)
    return heights.astype(np.float32), (0.5 + 0.5 * normals).astype(np.float32)


def ours(folder, program, name, surface, shader, samples):
    objects = {
        "bumps": f'Sphere {{ shader: BumpShader {{ shader: {shader}, height: ImageMap {{ file: "heights.exr" }}, scale: 0.4 }} }}',
        "image": f'Sphere {{ shader: NormalMapShader {{ shader: {shader}, file: "normals.exr" }} }}',
    }
    text = objects.get(surface, f'TriangleMesh {{ file: "{surface}.ply", shader: {shader} }}')
    scene, picture = os.path.join(folder, f"{name}.etd"), os.path.join(folder, f"{name}.npy")
    with open(scene, "w", encoding="utf-8") as file:
        file.write(ETENDUE.format(size=SIZE, object=text))
    subprocess.run([program, "render", scene, "--samples", str(samples), "-o", picture, "--quiet"], check=True)
    return np.load(picture)[:, :, 1]


def theirs(folder, surface, bsdf, samples):
    import mitsuba as mi
    if bsdf is None:
        return None
    if surface == "bumps":
        heights = {"type": "bitmap", "filename": os.path.join(folder, "heights.exr"), "raw": True}
        bsdf = {"type": "bumpmap", "arbitrary": heights, "scale": 0.4, "bsdf": bsdf}
    elif surface == "image":
        normals = {"type": "bitmap", "filename": os.path.join(folder, "normals.exr"), "raw": True}
        bsdf = {"type": "normalmap", "normalmap": normals, "bsdf": bsdf}
    if bsdf["type"] in ("diffuse", "conductor", "roughconductor", "plastic", "bumpmap", "normalmap"):
        bsdf = {"type": "twosided", "bsdf": bsdf} if not str(bsdf).count("dielectric") else bsdf
    shape = ({"type": "sphere", "bsdf": bsdf} if surface in ("bumps", "image") else
             {"type": "ply", "filename": os.path.join(folder, f"{surface}.ply"), "bsdf": bsdf})
    scene = mi.load_dict({
        "type": "scene",
        "integrator": {"type": "path", "max_depth": 200},
        "sensor": {"type": "perspective", "fov": 24, "to_world": mi.ScalarTransform4f().look_at([3, 2, 4], [0, 0, 0], [0, 1, 0]),
                   "film": {"type": "hdrfilm", "width": SIZE, "height": SIZE, "rfilter": {"type": "box"}, "pixel_format": "rgb"},
                   "sampler": {"type": "independent", "sample_count": samples}},
        "light": {"type": "constant", "radiance": {"type": "uniform", "value": 1.0}},
        "shape": shape,
    })
    return np.array(mi.render(scene, spp=samples))[:, :, 1]


def told(picture, mask):
    if picture is None:
        return "-"
    seen = picture[mask]
    return f"{seen.mean():.4f} ({seen.min():.2f})"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--samples", type=int, default=256)
    parser.add_argument("--program", default=os.path.join(HERE, "..", "build", "etendue"))
    parser.add_argument("--table")
    arguments = parser.parse_args()
    import mitsuba as mi
    mi.set_variant("scalar_rgb")
    surfaces = {"32 triangles": 3.37, "128 triangles": 6.2, "512 triangles": 12, "bumps": 0, "image": 0}
    counts = {}
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name, wanted in surfaces.items():
            if wanted:
                vertices, triangles = ball(round(wanted))
                counts[name] = len(triangles)
                write_ply(os.path.join(folder, f"{name}.ply"), vertices, triangles)
        heights, normals = maps()
        mi.Bitmap(heights[:, :, None]).write(os.path.join(folder, "heights.exr"))
        mi.Bitmap(normals).write(os.path.join(folder, "normals.exr"))
        # Pixels that are the ball's alone: black on white.
        mask = ours(folder, arguments.program, "mask", "32 triangles", "Lambertian { color: 0 }", 16) == 0
        for shader, here, there in SHADERS:
            for surface in surfaces:
                mine = ours(folder, arguments.program, "picture", surface, here, arguments.samples)
                other = theirs(folder, surface, there, arguments.samples)
                rows.append((shader, f"{counts[surface]} triangles" if surface in counts else surface, told(mine, mask), told(other, mask)))
                print(*rows[-1], sep="\t", flush=True)
    if arguments.table:
        with open(arguments.table, "w", encoding="utf-8") as file:
            file.write("# Shading normals in a furnace\n\n")
            file.write(f"Made by `python3 benchmarks/compare_furnace_mitsuba.py --samples {arguments.samples} --table ...`, beside "
                       f"Mitsuba {mi.__version__}. The mean over the pixels that show nothing but the ball, and the darkest of them; all "
                       "ought to be 1. Single pixels contain noise where the material is rough.\n\n")
            file.write("| material | normals | Étendue | Mitsuba |\n|---|---|---|---|\n")
            for row in rows:
                file.write("| " + " | ".join(row) + " |\n")


if __name__ == "__main__":
    main()
