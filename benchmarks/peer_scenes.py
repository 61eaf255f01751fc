"""The scenes of peers.py, each as one file of Mitsuba's XML that both programs read.

Four are Bitterli's (given by --scenes; they are no part of this project), in the old form that Mitsuba 3 does not read any more: what
it lacks is changed here. Four are made here, of shapes and materials that mean the same to both.
"""
import math
import pathlib
import random
import struct
import xml.etree.ElementTree as tree
from dataclasses import dataclass


@dataclass
class Scene:
    name: str
    file: pathlib.Path
    depth: int          # segments of a path at most
    size: tuple         # pixels
    integrator: str     # Mitsuba's: path or volpath
    folder: pathlib.Path  # that both may read
    gltf: bool = False  # whether glTF can say what matters of it


def upgraded(source, target, size, depth, integrator):
    """Bitterli's files without what Mitsuba 3 refuses: settings that change no picture, and plugins of other names. A coat, which it
    lacks, is left out; a medium's two coefficients become extinction and albedo."""
    root = tree.parse(source).getroot()
    for part in root.iter("integrator"):
        part.set("type", integrator)
        for child in part:
            if child.get("name") == "maxDepth":
                child.set("value", str(depth))
    for parent in list(root.iter()):
        for i, child in enumerate(list(parent)):
            if child.tag == "bsdf" and child.get("type") == "coating":
                name = next(c.get("id") for c in child if c.tag == "ref")
                parent[i] = next(b for b in root.iter("bsdf") if b.get("id") == name).find("bsdf")
    for medium in root.iter("medium"):
        values = {c.get("name"): [float(x) for x in c.get("value").replace(",", " ").split()] for c in medium if c.tag == "rgb"}
        if "sigmaA" in values:
            absorbed, scattered = values["sigmaA"], values.get("sigmaS", [0, 0, 0])
            for child in [c for c in medium if c.get("name") in ("sigmaA", "sigmaS")]:
                medium.remove(child)
            for name, three in (("sigma_t", [a + b for a, b in zip(absorbed, scattered)]),
                                ("albedo", [b / (a + b) if a + b else 0 for a, b in zip(absorbed, scattered)])):
                tree.SubElement(medium, "rgb", name=name, value=", ".join(map(str, three)))
    for parent in list(root.iter()):
        for child in list(parent):
            if child.get("name") in ("strictNormals", "banner", "pixelFormat", "gamma", "fileFormat", "extEta", "filterType"):
                parent.remove(child)
    for film in root.iter("film"):
        film.set("type", "hdrfilm")
        for child in film:
            if child.get("name") in ("width", "height"):
                child.set("value", str(size[0] if child.get("name") == "width" else size[1]))
        for filter_ in film.iter("rfilter"):
            filter_.set("type", "box")
    for sampler in root.iter("sampler"):
        sampler.set("type", "independent")
    for string in root.iter("string"):  # files beside the source
        if string.get("name") == "filename":
            string.set("value", str((source.parent / string.get("value")).resolve()))
    tree.ElementTree(root).write(target)
    return target


def ply(path, positions, faces, normals=None):
    with open(path, "wb") as out:
        names = ["x", "y", "z"] + (["nx", "ny", "nz"] if normals else [])
        properties = "".join(f"property float {n}\n" for n in names)
        out.write((f"ply\nformat binary_little_endian 1.0\nelement vertex {len(positions)}\n{properties}"
                   f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n").encode())
        for i, p in enumerate(positions):
            out.write(struct.pack("<3f", *p))
            if normals:
                out.write(struct.pack("<3f", *normals[i]))
        for f in faces:
            out.write(struct.pack("<B3i", 3, *f))


HEAD = """<scene version="3.0.0">
<integrator type="{integrator}"><integer name="max_depth" value="{depth}"/></integrator>
<sensor type="perspective"><float name="fov" value="{fov}"/>
<transform name="to_world"><lookat origin="{origin}" target="{target}" up="0,1,0"/></transform>
<sampler type="independent"><integer name="sample_count" value="16"/></sampler>
<film type="hdrfilm"><integer name="width" value="{width}"/><integer name="height" value="{height}"/><rfilter type="box"/></film></sensor>
"""


def write(path, integrator, depth, size, fov, origin, target, body):
    path.write_text(HEAD.format(integrator=integrator, depth=depth, width=size[0], height=size[1], fov=fov, origin=origin,
                                target=target) + body + "</scene>\n")
    return path


def rgb(name, *values):
    return f'<rgb name="{name}" value="{", ".join(str(v) for v in (values if len(values) == 3 else values * 3))}"/>'


def rectangle(transform, inside):
    return f'<shape type="rectangle"><transform name="to_world">{transform}</transform>{inside}</shape>\n'


def diffuse(*color):
    return f'<bsdf type="twosided"><bsdf type="diffuse">{rgb("reflectance", *color)}</bsdf></bsdf>'


def lamp(*radiance):
    return f'<emitter type="area">{rgb("radiance", *radiance)}</emitter>'


FLOOR = '<rotate x="1" angle="-90"/><scale value="{}"/>'


def glass_caustic(folder, size):
    """A ball and a block of glass under a small lamp: light that comes through them."""
    body = rectangle(FLOOR.format(8), diffuse(0.6))
    body += '<shape type="sphere"><point name="center" x="-0.9" y="1.02" z="0"/><float name="radius" value="1"/>' \
            '<bsdf type="dielectric"><float name="int_ior" value="1.5"/></bsdf></shape>\n'
    body += '<shape type="cube"><transform name="to_world"><scale value="0.7"/><rotate y="1" angle="30"/>' \
            '<translate x="1.3" y="0.72" z="0.3"/></transform><bsdf type="dielectric"><float name="int_ior" value="1.5"/></bsdf></shape>\n'
    body += '<shape type="sphere"><point name="center" x="-2.5" y="6" z="1"/><float name="radius" value="0.5"/>' + lamp(60) + \
            '</shape>\n'
    return write(folder / "glass_caustic.xml", "path", 12, size, 40, "0,3.2,7", "0,0.8,0", body)


def fog(folder, size):
    """A room full of a homogeneous medium, a lamp and two balls.

    The medium reaches a little below the floor. Where its side lay in the floor Mitsuba's pictures were 7 % darker: rays that
    meet both at once have left the medium there."""
    body = '<medium type="homogeneous" id="fog">' + rgb("albedo", 0.9, 0.85, 0.8) + rgb("sigma_t", 0.35) + \
           '<phase type="hg"><float name="g" value="0.3"/></phase></medium>\n'
    body += '<shape type="cube"><transform name="to_world"><scale value="3"/><translate y="2.98"/></transform>' \
            '<bsdf type="null"/><ref name="interior" id="fog"/></shape>\n'
    body += rectangle(FLOOR.format(12), diffuse(0.5))
    for x, color in ((-1.2, (0.7, 0.3, 0.2)), (1.2, (0.2, 0.4, 0.7))):
        body += f'<shape type="sphere"><point name="center" x="{x}" y="1" z="0"/><float name="radius" value="0.8"/>' + \
                diffuse(*color) + '</shape>\n'
    body += rectangle('<scale value="0.8"/><rotate x="1" angle="90"/><translate y="8"/>', lamp(25))
    return write(folder / "fog.xml", "volpath", 16, size, 45, "0,2.5,10", "0,2,0", body)


def thousand_lamps(folder, size):
    """A thousand small lamps above a million triangles of hills."""
    randoms = random.Random(3)
    side = 708
    positions, faces = [], []
    for j in range(side):
        for i in range(side):
            x, z = 20 * (i / (side - 1) - 0.5), 20 * (j / (side - 1) - 0.5)
            y = 0.35 * math.sin(1.3 * x) * math.cos(1.1 * z) + 0.02 * math.sin(23 * x + 3) * math.sin(29 * z)
            positions.append((x, y, z))
    for j in range(side - 1):
        for i in range(side - 1):
            a = j * side + i
            faces += [(a, a + side, a + 1), (a + 1, a + side, a + side + 1)]
    ply(folder / "hills.ply", positions, faces)
    body = '<shape type="ply"><string name="filename" value="hills.ply"/>' + diffuse(0.55, 0.5, 0.42) + '</shape>\n'
    for _ in range(1000):
        x, z, y = randoms.uniform(-9, 9), randoms.uniform(-9, 9), randoms.uniform(0.7, 1.6)
        color = [8 * c for c in randoms.choice([(1, 0.6, 0.3), (0.9, 0.95, 1), (1, 0.85, 0.6)])]
        body += f'<shape type="sphere"><point name="center" x="{x:.4f}" y="{y:.4f}" z="{z:.4f}"/>' \
                '<float name="radius" value="0.03"/>' + lamp(*color) + '</shape>\n'
    return write(folder / "thousand_lamps.xml", "path", 6, size, 45, "0,5,13", "0,0,0", body)


def foliage(folder, size):
    """Twenty thousand square leaves whose shapes are cut out by a mask, under a sky and a lamp."""
    randoms = random.Random(5)
    import numpy as np
    from PIL import Image
    y, x = np.mgrid[-1:1:128j, -1:1:128j]
    Image.fromarray(((np.abs(x) < 0.55 * (1 - y * y)) * 255).astype("uint8")).save(folder / "leaf.png")
    positions, faces, uvs = [], [], []
    for _ in range(20000):
        r = 2.2 * randoms.random() ** (1 / 3)
        d = [randoms.gauss(0, 1) for _ in range(3)]
        n = math.sqrt(sum(c * c for c in d))
        centre = [r * c / n for c in d]
        centre[1] += 3
        a = [randoms.gauss(0, 1) for _ in range(3)]
        b = [randoms.gauss(0, 1) for _ in range(3)]
        la = math.sqrt(sum(c * c for c in a))
        a = [0.12 * c / la for c in a]
        k = sum(p * q for p, q in zip(a, b)) / sum(p * p for p in a)
        b = [q - k * p for p, q in zip(a, b)]
        lb = math.sqrt(sum(c * c for c in b))
        b = [0.12 * c / lb for c in b]
        base = len(positions)
        for su, sv in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
            positions.append([centre[i] + su * a[i] + sv * b[i] for i in range(3)])
            uvs.append(((su + 1) / 2, (sv + 1) / 2))
        faces += [(base, base + 1, base + 2), (base, base + 2, base + 3)]
    with open(folder / "leaves.obj", "w") as out:
        for p in positions:
            out.write("v %.5f %.5f %.5f\n" % tuple(p))
        for u in uvs:
            out.write("vt %.3f %.3f\n" % u)
        for f in faces:
            out.write("f " + " ".join(f"{i + 1}/{i + 1}" for i in f) + "\n")
    body = rectangle(FLOOR.format(12), diffuse(0.4))
    body += '<shape type="obj"><string name="filename" value="leaves.obj"/><bsdf type="mask"><texture name="opacity" type="bitmap">' \
            '<string name="filename" value="leaf.png"/><boolean name="raw" value="true"/></texture>' + \
            diffuse(0.2, 0.45, 0.1) + '</bsdf></shape>\n'
    body += '<shape type="cylinder"><point name="p0" x="0" y="0" z="0"/><point name="p1" x="0" y="2" z="0"/>' \
            '<float name="radius" value="0.15"/>' + diffuse(0.3, 0.2, 0.1) + '</shape>\n'
    body += '<emitter type="constant">' + rgb("radiance", 0.6, 0.7, 0.9) + '</emitter>\n'
    body += rectangle('<scale value="1"/><rotate x="1" angle="90"/><translate x="4" y="9" z="3"/>', lamp(60, 55, 45))
    return write(folder / "foliage.xml", "path", 12, size, 40, "0,3.5,9", "0,2.6,0", body)


def scenes(folder, bitterli, size=(320, 240)):
    """All that can be had; `bitterli` may be None."""
    found = []
    if bitterli:
        for name, depth, scene_size, integrator in (
                ("cornell-box", 64, (256, 256), "path"), ("veach-mis", 2, (320, 180), "path"),
                ("material-testball", 64, (320, 180), "path"), ("staircase2", 64, (256, 256), "volpath")):
            source = bitterli / name / "scene.xml"
            if source.exists():
                file = upgraded(source, folder / f"{name}.xml", scene_size, depth, integrator)
                found.append(Scene(name, file, depth, scene_size, integrator, source.parent.resolve(), name == "cornell-box"))
    for make, depth, integrator in ((glass_caustic, 12, "path"), (fog, 16, "volpath"), (thousand_lamps, 6, "path"),
                                    (foliage, 12, "path")):
        found.append(Scene(make.__name__, make(folder, size), depth, size, integrator, folder, make is glass_caustic))
    return found
