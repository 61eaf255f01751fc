#!/usr/bin/env python3
"""Polarized light here and in Mitsuba 3: Stokes vectors of tiles of pictures, rendered by both.

Needs `pip install mitsuba numpy`.

    python3 benchmarks/compare_polarization_mitsuba.py [--samples 4096] [--program build/etendue] [--only glass] [--table FILE.md]

Both have S0 to S3 relative to the camera: for a ray of direction d, x = d x up. All spectra are flat, so that colours do not
matter; Mitsuba's variant is scalar_spectral_polarized. A tile agrees when S0 does within 0.3 %, and S1, S2, S3 within 0.3 % of S0,
or within four standard errors where noise is larger than that.
"""
import argparse
import os
import subprocess
import sys
import tempfile

import numpy as np

WIDTH, HEIGHT, TILE = 48, 36, 12
PASSES = 8
CAMERA = {"origin": [1.2, -4, 1.6], "target": [0, 0, 0.1], "up": [0, 0, 1], "fov": 40}
BOUND = 0.003


def sphere(centre, radius, ours, theirs):
    return (f"Sphere {{ centre: {centre}, radius: {radius}, shader: {ours} }}",
            {"type": "sphere", "center": centre, "radius": radius, "bsdf": theirs})


def rectangle(corner, u, v, ours, theirs=None, radiance=None):
    """Mitsuba's rectangle spans [-1, 1]^2 with its normal along z."""
    c, u, v = (np.array(x, float) for x in (corner, u, v))
    middle, normal = c + (u + v) / 2, np.cross(u, v) / np.linalg.norm(np.cross(u, v))
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2], matrix[:3, 3] = u / 2, v / 2, normal, middle
    text = f"Rectangle {{ corner: {c.tolist()}, edge_u: {u.tolist()}, edge_v: {v.tolist()}"
    text += f", shader: {ours}" if ours else ""
    text += f", emission: DiffuseEmission {{ radiance: {radiance} }}" if radiance else ""
    other = {"type": "rectangle", "to_world": matrix, "bsdf": theirs or {"type": "diffuse", "reflectance": 0.0}}
    if radiance:
        other["emitter"] = {"type": "area", "radiance": {"type": "uniform", "value": radiance}}
    return text + " }", other


def cube(ours, theirs, size=1.0, centre=(0, 0, 0), turn=30):
    import math
    c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
    matrix = np.eye(4)
    matrix[:3, :3] = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) * size / 2
    matrix[:3, 3] = centre
    return (f"Box {{ size: [{size}, {size}, {size}], transform: translate({centre[0]}, {centre[1]}, {centre[2]}) * "
            f"rotate({turn} deg, \"z\"), shader: {ours} }}", {"type": "cube", "to_world": matrix, "bsdf": theirs})


def grey(x):
    return f"Lambertian {{ color: {x} }}", {"type": "diffuse", "reflectance": {"type": "uniform", "value": x}}


def glass(index):
    return f"Dielectric {{ ior: {index} }}", {"type": "dielectric", "int_ior": index, "ext_ior": 1.0}


def metal(n, k):
    flat = lambda x: {"type": "uniform", "value": x}
    return f"Conductor {{ ior: complex({n}, {k}), roughness: 0 }}", {"type": "conductor", "eta": flat(n), "k": flat(k)}


def rough_metal(n, k, alpha):
    ours, theirs = metal(n, k)
    ours = ours.replace("roughness: 0", f"roughness: {alpha}, multiple_scattering: false, heights: independent")
    return ours, {**theirs, "type": "roughconductor", "alpha": alpha, "distribution": "ggx"}


def polarizer(angle):
    """Mitsuba's theta turns a polarizer clockwise seen from the front, and a retarder counter-clockwise (3.9.1)."""
    return f"LinearPolarizer {{ angle: {angle} }}", {"type": "polarizer", "theta": {"type": "uniform", "value": -angle}}


def retarder(angle, waves):
    return (f"Retarder {{ angle: {angle}, retardance: {waves} }}",
            {"type": "retarder", "theta": {"type": "uniform", "value": angle}, "delta": {"type": "uniform", "value": 360 * waves}})


FLOOR = rectangle([-3, -3, -1], [6, 0, 0], [0, 6, 0], *grey(0.4))
LAMP = rectangle([-2.2, -1, 2.5], [0, 1.5, 0], [1.5, 0, 0], None, radiance=12)


def before_camera(distance, shader, tilt=0.0):
    """A plate before the camera with its front to it."""
    o, t = np.array(CAMERA["origin"], float), np.array(CAMERA["target"], float)
    d = (t - o) / np.linalg.norm(t - o)
    x = np.cross(d, CAMERA["up"])
    x /= np.linalg.norm(x)
    y = np.cross(x, d) + tilt * d
    y /= np.linalg.norm(y)
    middle = o + distance * d
    return rectangle(list(middle - 2 * x - 2 * y), list(4 * x), list(4 * y), *shader)


SCENES = {
    "glass": (8, [sphere([-0.4, 0, 0], 0.8, *glass(1.5)), sphere([1.1, 0.5, -0.4], 0.6, *glass(2.0)), FLOOR, LAMP]),
    "metals": (6, [sphere([-0.6, 0, 0], 0.8, *metal(0.2, 3.5)), rectangle([-3, -3, -1], [6, 0, 0], [0, 6, 0], *metal(1.5, 7)),
                   sphere([1.1, 0.3, -0.3], 0.7, *metal(2.5, 2.5)), LAMP]),
    "rough metal": (5, [sphere([-0.6, 0, 0], 0.8, *rough_metal(0.2, 3.5, 0.25)), FLOOR,
                        sphere([1.1, 0.3, -0.3], 0.7, *rough_metal(2.5, 2.5, 0.4)), LAMP]),
    # Mitsuba's retardance falls as the cosine of the angle, ours does not, and at a slant its axis is turned by the angle between
    # directions that are not perpendicular to the ray. So it is seen along its normal, by parallel rays.
    "plates": (40, [before_camera(0.6, retarder(20, 0.3)), before_camera(0.9, polarizer(65), 0.5), sphere([-0.3, 0, 0], 0.9, *glass(1.5)),
                   rectangle([-3, -3, -1], [6, 0, 0], [0, 6, 0], *metal(1.5, 4)),
                   rectangle([-2.4, -1.2, 2.2], [0, 2, 0], [2, 0, 0], *polarizer(30)), LAMP], 3.0),
    "glass cube": (12, [cube(*glass(1.6), size=1.3), rectangle([-3, -3, -1], [6, 0, 0], [0, 6, 0], *metal(0.5, 2)),
                        rectangle([-3, 1.5, -1], [6, 0, 0], [0, 0, 3], *grey(0.6)), LAMP]),
}


def ours(program, name, samples, folder):
    depth, objects, *parallel = SCENES[name]
    camera = f"from: {CAMERA['origin']}, to: {CAMERA['target']}, up: {CAMERA['up']}"
    camera = (f"OrthographicCamera {{ {camera}, width: {parallel[0]} }}" if parallel else
              f"PerspectiveCamera {{ {camera}, fov: {CAMERA['fov']} deg, fov_axis: width }}")
    scene, out = folder + "/scene.etd", folder + "/ours.npy"
    with open(scene, "w") as file:
        file.write(f"""Job {{
    renderer: PolarizedPathTracer {{ max_depth: {depth}, roulette_depth: 64 }}
    camera: {camera}
    image: ImageBuffer {{ width: {WIDTH}, height: {HEIGHT}, filter: BoxFilter {{}}, layers: ["stokes"] }}
    scene: BvhScene {{ objects: [
        {chr(10).join(o[0] for o in objects)}
        Environment {{ emission: EnvironmentEmission {{ radiance: 0.5 }} }} ] }} }}
""")
    pictures = []
    for seed in range(PASSES):
        result = subprocess.run([program, "render", scene, "--samples", str(samples // PASSES), "--seed", str(seed), "--quiet", "--threads", "1",
                                 "--set", f'outputs=[NpyOutput {{ file: "{out}", layers: true }}]'], capture_output=True, text=True)
        if result.returncode:
            sys.exit(f"{program} failed:\n{result.stdout}{result.stderr}")
        pictures.append(np.load(out)[..., [1, 4, 7, 10]].astype(float))  # the Y of X Y Z, S1.X …
    return np.array(pictures)


def theirs(name, samples):
    import mitsuba as mi
    mi.set_variant("scalar_spectral_polarized")
    depth, objects, *parallel = SCENES[name]
    T = mi.ScalarTransform4f
    flat = {"type": "uniform", "value": 0.5}
    pose = T().look_at(origin=CAMERA["origin"], target=CAMERA["target"], up=CAMERA["up"])
    if parallel:
        pose = pose @ T().scale([parallel[0] / 2, parallel[0] / 2, 1])
    view = {"type": "orthographic"} if parallel else {"type": "perspective", "fov": CAMERA["fov"], "fov_axis": "x"}
    scene = {"type": "scene", "integrator": {"type": "stokes", "nested": {"type": "path", "max_depth": depth, "rr_depth": 64}},
             "sensor": {**view, "to_world": pose,
                        "film": {"type": "hdrfilm", "width": WIDTH, "height": HEIGHT, "pixel_format": "rgb", "component_format": "float32",
                                 "rfilter": {"type": "box"}},
                        "sampler": {"type": "independent"}},
             "environment": {"type": "constant", "radiance": flat}}
    for i, (_, other) in enumerate(objects):
        other = dict(other)
        if "to_world" in other:
            other["to_world"] = T(other["to_world"])
        scene[f"object{i}"] = other
    scene = mi.load_dict(scene)
    pictures = []
    for seed in range(PASSES):
        values = np.array(mi.render(scene, spp=samples // PASSES, seed=seed))
        # The first channels are R G B; then S0 to S3 in R G B. Linear sRGB to Y.
        stokes = values[..., -12:].reshape(HEIGHT, WIDTH, 4, 3)
        pictures.append(stokes @ np.array([0.2126390059, 0.7151686788, 0.0721923154]))
    return np.array(pictures)


def tiles(pictures):
    p, h, w, n = pictures.shape
    return pictures.reshape(p, h // TILE, TILE, w // TILE, TILE, n).mean((2, 4)).reshape(p, -1, n)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--samples", type=int, default=4096)
    parser.add_argument("--program", default="build/etendue")
    parser.add_argument("--only")
    parser.add_argument("--table")
    arguments = parser.parse_args()
    lines, good = [], True
    for name in SCENES:
        if arguments.only and arguments.only != name:
            continue
        with tempfile.TemporaryDirectory() as folder:
            a = tiles(ours(os.path.abspath(arguments.program), name, arguments.samples, folder))
        b = tiles(theirs(name, arguments.samples))
        mean_a, mean_b = a.mean(0), b.mean(0)
        light = mean_b[:, :1]
        error = np.sqrt((a.var(0, ddof=1) + b.var(0, ddof=1)) / PASSES) / light
        off = (mean_a - mean_b) / light
        whole = (mean_a.mean(0) - mean_b.mean(0)) / mean_b.mean(0)[0]
        degree = np.hypot(mean_b[:, 1], mean_b[:, 2]) / mean_b[:, 0]
        agrees = bool((np.abs(off) <= np.maximum(BOUND, 4 * error)).all() and (np.abs(whole) <= BOUND).all())
        good &= agrees
        lines.append(f"| {name} | " + " | ".join(f"{100 * x:+.3f} %" for x in whole) + f" | {100 * np.abs(off).max():.2f} % | "
                     f"{100 * error.max():.2f} % | {100 * degree.max():.0f} % | {100 * np.abs(mean_b[:, 3] / mean_b[:, 0]).max():.1f} % | "
                     f"{'yes' if agrees else 'NO'} |")
        print(lines[-1], flush=True)
    head = ["| scene | S0 | S1 | S2 | S3 | most of a tile | its standard error | most linear | most circular | agrees |",
            "|---|---|---|---|---|---|---|---|---|---|"]
    if arguments.table:
        with open(arguments.table, "w") as file:
            file.write("\n".join(head + lines) + "\n")
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
