#!/usr/bin/env python3
"""Illuminances of analytic cases, after CIE 171:2006, section 5: writes docs/results/cie-171.md.

    python3 benchmarks/cie171.py --program build/etendue [--write docs/results/cie-171.md] [--quick]

Needs NumPy. CIE 171:2006 (Test cases to assess the accuracy of lighting computer programs) describes situations whose illuminances
follow from formulas. The situations here have the numbers of its sections and follow the same laws; the dimensions are our own. Each true
value is computed here, from its law alone: contour integrals of polygons, geometric series, Gauss-Legendre integrals of the CIE general
sky over openings. `etendue measure` then measures the same with an IrradianceMeter, by several algorithms, until its standard error is small enough.
The exit status is 1 if a difference exceeds 0.5 %. --quick: a few cases, for the tests.
"""
import argparse
import json
import math
import os
import subprocess
import sys
import tempfile

try:
    import numpy as np
except ImportError:
    print("needs NumPy")
    sys.exit(77)  # skipped

# Light subpaths are not connected to what is seen directly at infinity, so LightTracer has nothing to show of a sky through an opening. Photons
# of VertexConnectionMerging are merged within a small radius: in the wide pixels of a hemisphere, the default would blur whole objects.
# Paths of 64 segments, the default, would leave out 4 % of the light in a sphere of the reflectance 0.95, and 0.13 % at 0.9.
RENDERERS = {"PathTracer": "PathTracer { max_depth: 512 }", "BidirectionalPathTracer": "BidirectionalPathTracer { max_depth: 512 }",
             "VertexConnectionMerging": "VertexConnectionMerging { radius: 0.1, max_depth: 512 }", "LightTracer": "LightTracer { max_depth: 512 }"}
WITHOUT_MERGING = ["PathTracer", "BidirectionalPathTracer", "LightTracer"]
WITHOUT_LIGHT_TRACER = ["PathTracer", "BidirectionalPathTracer", "VertexConnectionMerging"]
NANOMETRES = 470  # meters integrate 360 to 830 nm
LIMIT = 0.005

# ---- laws


def lambert(polygon, luminance, point, normal):
    """E of a polygon of uniform luminance, in front of the plane: L / 2 times the sum over edges of the angle that each subtends times the
    cosine between its plane's normal and the receiver's (Lambert 1760). The part behind the receiver's plane is cut off first."""
    r, n = np.array(polygon, float) - point, np.array(normal, float)
    kept = []
    for a, b in zip(r, np.roll(r, -1, axis=0)):
        da, db = a @ n, b @ n
        if da >= 0:
            kept.append(a)
        if da * db < 0:
            kept.append(a + (b - a) * da / (da - db))
    total = 0
    for a, b in zip(kept, kept[1:] + kept[:1]):
        across = np.cross(a, b)
        if (sine := np.linalg.norm(across)) > 1e-14:
            total += math.atan2(sine, a @ b) * (across @ n) / sine
    return abs(luminance / 2 * total)


def by_sum(polygon, luminance, point, normal, parts=400):
    """The same for a parallelogram by a sum of L cos cos' dA / d^2 over parts x parts middles: another derivation, to check the first."""
    p = np.array(polygon, float)
    u, v = p[1] - p[0], p[3] - p[0]
    s = (np.arange(parts) + 0.5) / parts
    d = p[0] + s[:, None, None] * u + s[None, :, None] * v - point
    r2 = (d ** 2).sum(axis=-1)
    area = np.cross(u, v)
    return luminance * (np.maximum(d @ np.array(normal, float), 0) * np.abs(d @ area) / r2 ** 2).sum() / parts ** 2


def rectangle(x0, x1, z0, z1, y):
    return [(x0, y, z0), (x1, y, z0), (x1, y, z1), (x0, y, z1)]


# CIE general sky (ISO 15469:2004 / CIE S 011; Kittler, Perez & Darula 1997): a, b, c, d, e of the types 1 to 15.
SKIES = [(4, -0.7, 0, -1, 0), (4, -0.7, 2, -1.5, 0.15), (1.1, -0.8, 0, -1, 0), (1.1, -0.8, 2, -1.5, 0.15), (0, -1, 0, -1, 0),
         (0, -1, 2, -1.5, 0.15), (0, -1, 5, -2.5, 0.3), (0, -1, 10, -3, 0.45), (-1, -0.55, 2, -1.5, 0.15), (-1, -0.55, 5, -2.5, 0.3),
         (-1, -0.55, 10, -3, 0.45), (-1, -0.32, 10, -3, 0.45), (-1, -0.32, 16, -3, 0.3), (-1, -0.15, 16, -3, 0.3), (-1, -0.15, 24, -2.8, 0.15)]
SUN_ZENITH, SUN_AZIMUTH = math.radians(40), math.radians(30)  # azimuth from +z towards +x


def sky_luminance(kind, direction):
    """Relative to the zenith's: f(chi) phi(Z) / (f(Z_sun) phi(0)), phi(Z) = 1 + a exp(b / cos Z), f(chi) = 1 + c (exp(d chi) - exp(d pi/2))
    + e cos^2 chi, with the angles Z from the zenith and chi from the sun. Type 16: the overcast sky of Moon & Spencer, (1 + 2 cos Z) / 3."""
    y = direction[..., 1]
    if kind == 16:
        return (1 + 2 * y) / 3
    a, b, c, d, e = SKIES[kind - 1]
    sun = np.array([math.sin(SUN_ZENITH) * math.sin(SUN_AZIMUTH), math.cos(SUN_ZENITH), math.sin(SUN_ZENITH) * math.cos(SUN_AZIMUTH)])
    chi = np.arccos(np.clip(direction @ sun, -1, 1))
    f = lambda x: 1 + c * (np.exp(d * x) - math.exp(d * math.pi / 2)) + e * np.cos(x) ** 2
    return f(chi) * (1 + a * np.exp(b / np.maximum(y, 1e-9))) / (f(SUN_ZENITH) * (1 + a * math.exp(b)))


def pane(cosine, index=1.5):
    """Transmittance of a clear pane: each polarization by itself, all reflections inside: (1 - R) / (1 + R) (Stokes 1862), R by Fresnel."""
    inside = np.sqrt(1 - (1 - cosine ** 2) / index ** 2)
    rs = ((cosine - index * inside) / (cosine + index * inside)) ** 2
    rp = ((index * cosine - inside) / (index * cosine + inside)) ** 2
    return ((1 - rs) / (1 + rs) + (1 - rp) / (1 + rp)) / 2


def through(opening, point, normal, luminance, glass=False, nodes=64):
    """E through an opening, a parallelogram: the Gauss-Legendre integral of L(direction) cos cos' / d^2 over it."""
    p = np.array(opening, float)
    u, v = p[1] - p[0], p[3] - p[0]
    s, w = np.polynomial.legendre.leggauss(nodes)
    s, w = (s + 1) / 2, w / 2
    d = p[0] + s[:, None, None] * u + s[None, :, None] * v - point
    r = np.sqrt((d ** 2).sum(axis=-1))
    d /= r[..., None]
    area = np.cross(u, v)
    facing = np.abs(d @ area)
    value = luminance(d) * np.maximum(d @ np.array(normal, float), 0) * facing / r ** 2
    if glass:
        value = value * pane(facing / np.linalg.norm(area))
    return float((w[:, None] * w[None, :] * value).sum())


# ---- descriptions


def numbers(v):
    return "[%s]" % ", ".join("%.10g" % x for x in v)


def surface(corners, members=""):
    c = np.array(corners, float)
    return "Rectangle { corner: %s m, edge_u: %s m, edge_v: %s m%s }" % (numbers(c[0]), numbers(c[1] - c[0]), numbers(c[3] - c[0]), members)


def emitting(value, sides="both"):
    return ", emission: DiffuseEmission { radiance: %.12g, sides: %s }" % (value, sides)


def sky(kind, ground=0.0):
    """The same formula, in v, upwards from 0 to 1, and u, whose middle is +z and whose quarter is +x."""
    sine, cosine = "sin(pi * v)", "(0 - cos(pi * v))"
    if kind == 16:
        above = "(1 + 2 * %s) / 3" % cosine
    else:
        a, b, c, d, e = SKIES[kind - 1]
        toward = "(%.15g * %s + %.15g * %s * cos(2 * pi * (0.5 - u) - %.15g))" % (math.cos(SUN_ZENITH), cosine, math.sin(SUN_ZENITH), sine, SUN_AZIMUTH)
        zenith = (1 + c * (math.exp(d * SUN_ZENITH) - math.exp(d * math.pi / 2)) + e * math.cos(SUN_ZENITH) ** 2) * (1 + a * math.exp(b))
        chi = "atan2(sqrt(max(0, 1 - %s * %s)), %s)" % (toward, toward, toward)
        above = "(1 + (%g) * (exp((%g) * %s) - %.15g) + %g * %s * %s) * (1 + (%g) * exp((%g) / max(0.000000001, %s))) / %.15g" % (
            c, d, chi, math.exp(d * math.pi / 2), e, toward, toward, a, b, cosine, zenith)
    formula = "mix(%.12g, %s, step(0.5, v))" % (ground, above)
    return 'Environment { emission: EnvironmentEmission { radiance: FormulaMap { formula: "%s" } } }' % formula


def frame(outer, inner, make):
    """A wall (x0, x1, y0, y1) with an opening, as four rectangles; `make` places its coordinates in space."""
    (a0, a1, b0, b1), (p0, p1, q0, q1) = outer, inner
    parts = [(a0, a1, b0, q0), (a0, a1, q1, b1), (a0, p0, q0, q1), (p1, a1, q0, q1)]
    return [surface([make(x0, y0), make(x1, y0), make(x1, y1), make(x0, y1)]) for x0, x1, y0, y1 in parts if x1 > x0 and y1 > y0]


ROOM = [surface([(0, 0, 0), (0, 3, 0), (0, 3, 4), (0, 0, 4)]), surface([(4, 0, 0), (4, 3, 0), (4, 3, 4), (4, 0, 4)]),
        surface([(0, 0, 0), (4, 0, 0), (4, 3, 0), (0, 3, 0)])]  # black walls at x = 0, x = 4 and z = 0
FRONT = [surface([(0, 0, 4), (4, 0, 4), (4, 3, 4), (0, 3, 4)])]
FLOOR = [surface(rectangle(0, 4, 0, 4, 0))]
ABOVE = 1e-4  # of a meter over a surface [m]


class Case:
    def __init__(self, section, what, objects, point, normal, truth, quick=False, renderers=None):
        self.section, self.what, self.objects, self.quick = section, what, objects, quick
        self.point, self.normal, self.truth, self.renderers = point, normal, truth, renderers or list(RENDERERS)

    def text(self, renderer):
        return "Job {\n renderer: %s\n camera: IrradianceMeter { from: %s m, normal: %s }\n scene: BruteForceScene { objects: [\n%s\n] }\n}\n" % (
            RENDERERS[renderer], numbers(self.point), numbers(self.normal), ",\n".join(self.objects))


UP, DOWN, EAST = (0, 1, 0), (0, -1, 0), (1, 0, 0)


def point_cases():
    lamp = np.array([2, 3 - 1e-3, 2])
    objects = ROOM + FRONT + FLOOR + ["Point { position: %s m, emission: DiffuseEmission { radiance: 1 } }" % numbers(lamp)]
    for what, point, normal in [("floor, below the lamp", (2, ABOVE, 2), UP), ("floor, corner", (0.5, ABOVE, 0.5), UP),
                                ("wall", (ABOVE, 1.5, 2.5), EAST), ("wall, near the ceiling", (ABOVE, 2.75, 3.5), EAST)]:
        d = lamp - point
        yield Case("5.2", "point source: " + what, objects, point, normal, d @ np.array(normal, float) / np.linalg.norm(d) ** 3,
                   quick=what == "wall")


def area_cases():
    lamp = rectangle(1.5, 2.5, 1.5, 2.5, 2.9)
    objects = ROOM + FRONT + FLOOR + [surface(lamp, emitting(1))]
    for what, point, normal in [("floor, below", (2, ABOVE, 2), UP), ("floor, corner", (0.5, ABOVE, 0.5), UP), ("wall", (ABOVE, 1.5, 2.5), EAST),
                                ("wall, near the ceiling", (ABOVE, 2.5, 1), EAST), ("tilted, cut by its horizon", (2, 2.2, 2.2), (0.8, 0.6, 0))]:
        truth = lambert(lamp, 1, np.array(point), normal)
        assert abs(by_sum(lamp, 1, np.array(point), normal) / truth - 1) < 2e-3, what
        yield Case("5.3", "area source: " + what, objects, point, normal, truth, quick=what == "floor, corner")


def reflection_cases():
    # A floor of the reflectance 0.8 in the light of a distant luminaire: its luminance is 0.8 E / pi.
    direction = np.array([0.3, -0.9, -0.2])
    onto = -direction[1] / np.linalg.norm(direction)
    lit = 0.8 * onto / math.pi
    patch = rectangle(1, 3, 1, 3, 0)
    light = "Distant { direction: %s, emission: DiffuseEmission { radiance: 1 } }" % numbers(direction)
    objects = [surface(patch, ", shader: Lambertian { color: 0.8 }"), light]
    for what, point, normal in [("ceiling", (1.2, 3, 2.4), DOWN), ("wall", (0.2, 0.8, 2.2), EAST), ("wall, further up", (0, 2.5, 0.5), EAST)]:
        # The meter on the wall faces away from the luminaire.
        assert np.array(normal) @ -direction <= 0
        yield Case("5.6", "reflection: " + what, objects, point, normal, lambert(patch, lit, np.array(point), normal), quick=False)
    # A black screen between floor and ceiling. Seen from the meter it hides the rectangle that it projects to on the floor; its
    # shadow falls beside the floor's patch.
    height, screen = 1.5, rectangle(2.2, 4, 0.8, 3.2, 1.5)
    light = "Distant { direction: [0.99, -0.5, 0], emission: DiffuseEmission { radiance: 1 } }"
    lit = 0.8 * 0.5 / math.hypot(0.99, 0.5) / math.pi
    shadow = np.array(screen) + np.array([0.99, -0.5, 0]) * height / 0.5
    assert shadow[:, 0].min() > 3
    for what, point in [("half hidden", (2.2, 3, 2)), ("a strip hidden", (2.6, 3, 2.5)), ("nothing hidden", (-0.5, 3, 1.5))]:
        eye = np.array(point)
        hidden = eye + (np.array(screen) - eye) * eye[1] / (eye[1] - height)
        x0, x1 = np.clip([hidden[:, 0].min(), hidden[:, 0].max()], 1, 3)
        z0, z1 = np.clip([hidden[:, 2].min(), hidden[:, 2].max()], 1, 3)
        truth = lambert(patch, lit, eye, DOWN)
        if x1 > x0 and z1 > z0:
            truth -= lambert(rectangle(x0, x1, z0, z1, 0), lit, eye, DOWN)
        yield Case("5.7", "screened reflection: " + what, [surface(patch, ", shader: Lambertian { color: 0.8 }"),
                                                            surface(screen), light], point, DOWN, truth, quick=what == "half hidden")


def sphere_cases():
    # In a sphere the irradiance that any part gives the others is the same everywhere: E = E_direct + flux / area * rho / (1 - rho),
    # wherever the source is (integrating sphere; CIE 171 approximates a cube by it).
    radius = 2.0
    for rho in (0.2, 0.5, 0.8, 0.9):
        for what, lamp in [("source in the middle", (0, 0, 0)), ("source off the middle", (0.6, -0.5, 0.3))]:
            if what != "source in the middle" and rho not in (0.5, 0.9):
                continue
            normal = np.array([0.48, 0.64, 0.6])
            point = -normal * (radius - ABOVE)
            d = np.array(lamp) - point
            truth = d @ normal / np.linalg.norm(d) ** 3 + 4 * math.pi / (4 * math.pi * radius ** 2) * rho / (1 - rho)
            objects = ["Sphere { radius: %g m, shader: Lambertian { color: %g } }" % (radius, rho),
                       "Point { position: %s m, emission: DiffuseEmission { radiance: 1 } }" % numbers(lamp)]
            yield Case("5.8", "interreflection, reflectance %g, %s" % (rho, what), objects, point, normal, truth, quick=rho == 0.5 and "off" in what,
                       renderers=WITHOUT_MERGING if rho > 0.8 else None)


def roof_cases():
    floor, wall = (1.2, ABOVE, 2.6), (ABOVE, 1.2, 2.3)
    for size in (1, 4):
        inner = (2 - size / 2, 2 + size / 2) * 2
        roof = frame((0, 4, 0, 4), inner, lambda x, y: (x, 3, y))
        hole = rectangle(inner[0], inner[1], inner[2], inner[3], 3)
        for glazed in (False, True):
            for kind in (range(1, 17) if size == 1 and not glazed else (1, 12, 16) if size == 1 or not glazed else ()):
                for what, point, normal in (("floor", floor, UP), ("wall", wall, EAST)):
                    if what == "wall" and kind not in (12, 16):
                        continue
                    light = lambda d, kind=kind: sky_luminance(kind, d)
                    glass = [surface(hole, ", shader: ThinDielectric {}")] if glazed else []
                    yield Case("5.10" if glazed else "5.9", "roof %s %g x %g m, CIE sky %d: %s" % ("glazed" if glazed else "open", size, size, kind, what),
                               ROOM + FRONT + roof + glass + [sky(kind)], point, normal, through(hole, np.array(point), normal, light, glazed),
                               quick=size == 1 and kind == 12 and what == "floor" and not glazed, renderers=WITHOUT_LIGHT_TRACER)


def strips(point, lines, y0, y1):
    """The heights at which the opening in z = 4 is cut, so that integrands are smooth between."""
    return sorted({y0, y1} | {y for y in lines if y0 < y < y1})


def facade_cases():
    x0, x1, y0, y1 = 1.0, 3.0, 1.0, 2.5
    wall = frame((0, 4, 0, 3), (x0, x1, y0, y1), lambda x, y: (x, y, 4))
    ceiling = [surface(rectangle(0, 4, 0, 4, 3))]
    hole = [(x0, y0, 4), (x1, y0, 4), (x1, y1, 4), (x0, y1, 4)]
    ground = 0.12
    # An overhang above the opening and an obstruction in front, both so long that their ends do not matter, of given luminances.
    overhang = surface([(-500, y1, 4), (500, y1, 4), (500, y1, 5), (-500, y1, 5)])
    obstruction = surface([(-2000, -50, 10), (2000, -50, 10), (2000, 5, 10), (-2000, 5, 10)], emitting(0.3))

    def case(section, kind, masked, glazed, what, point, normal):
        eye = np.array(point, float)
        depth = 4 - eye[2]
        over = eye[1] + (y1 - eye[1]) * depth / (5 - eye[2])   # above: the overhang
        top = eye[1] + (5 - eye[1]) * depth / (10 - eye[2])    # below: the obstruction
        cuts = strips(eye, [eye[1]] + ([over] if masked == "overhang" else [top] if masked else []), y0, y1)

        def light(d):
            height = eye[1] + d[..., 1] / d[..., 2] * depth
            value = np.where(d[..., 1] > 0, sky_luminance(kind, np.where(d[..., 1:2] > 0, d, -d)), ground)
            if masked == "overhang":
                return np.where(height > over, 0, value)
            return np.where(height < top, 0.3, value) if masked else value
        truth = sum(through([(x0, a, 4), (x1, a, 4), (x1, b, 4), (x0, b, 4)], eye, normal, light, glazed) for a, b in zip(cuts, cuts[1:]))
        outside = {"overhang": [overhang], "obstruction": [obstruction], "": []}[masked]
        glass = [surface(hole, ", shader: ThinDielectric {}")] if glazed else []
        return Case(section, "facade %s%s, CIE sky %d: %s" % ("glazed" if glazed else "open", ", " + masked if masked else "", kind, what),
                    ROOM + FLOOR + ceiling + wall + glass + outside + [sky(kind, ground)], point, normal, truth,
                    quick=section == "5.12" and kind == 12 and what == "wall", renderers=WITHOUT_LIGHT_TRACER)
    places = [("floor", (2.4, ABOVE, 2.8), UP), ("wall", (ABOVE, 1.4, 2.5), EAST), ("ceiling", (2, 3 - ABOVE, 2.5), DOWN)]
    for kind in (1, 12, 16):
        for place in places:
            if place[0] == "ceiling" and kind != 16:
                continue
            yield case("5.11", kind, "", False, *place)
            yield case("5.12", kind, "", True, *place)
            if kind in (12, 16):
                if place[0] != "ceiling":
                    yield case("5.13", kind, "overhang", False, *place)
                yield case("5.14", kind, "obstruction", False, *place)


def flux_cases():
    """5.4: the flux of an area source, pi L A, arrives at the floor and the walls: Gauss-Legendre integral of meters over a half of each
    of four quarters. Yields the meters with their weights."""
    lamp = rectangle(1.5, 2.5, 1.5, 2.5, 2)
    objects = [surface(lamp, ", emission: DiffuseEmission { radiance: 1, sides: both }")]
    s, w = np.polynomial.legendre.leggauss(4)
    s, w = (s + 1) / 2, w / 2
    meters = []
    for i in range(4):
        for j in range(i + 1):  # floor, a quarter of 2 x 2 m, symmetric about its diagonal; the ceiling receives as much from the back
            meters.append(((2 * s[i], ABOVE, 2 * s[j]), UP, 4 * 4 * w[i] * w[j] * (1 if i == j else 2)))
        for j in range(4):      # a half of a wall below the lamp's height, 2 x 2 m; eight halves
            meters.append(((ABOVE, 2 * s[j], 2 * s[i]), EAST, 8 * 4 * w[i] * w[j]))
    return lamp, objects, meters


# ---- measuring


def measure(program, text, samples, folder):
    path = os.path.join(folder, "case.etd")
    with open(path, "w") as f:
        f.write(text)
    run = subprocess.run([program, "measure", path, "--samples", "%g" % samples, "--bands", "1", "--json"], capture_output=True, text=True)
    if run.returncode != 0:
        sys.exit("%s\n%s" % (run.stderr, text))
    reading = json.loads(run.stdout)
    total = reading["total"]
    return total["value"] / NANOMETRES, total["error"] / NANOMETRES


def measured(program, case, renderer, samples, most, target, folder):
    """Four times as many samples until the standard error is below the target."""
    while True:
        value, error = measure(program, case.text(renderer), samples, folder)
        if error <= target * case.truth or samples >= most:
            return value, error
        samples *= 4


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", default="build/etendue")
    parser.add_argument("--write")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", help="a section, such as 5.9")
    options = parser.parse_args()
    cases = [c for make in (point_cases, area_cases, reflection_cases, sphere_cases, roof_cases, facade_cases) for c in make()]
    if options.quick:
        cases = [c for c in cases if c.quick]
    if options.only:
        cases = [c for c in cases if c.section == options.only]
    start, most, target = (1 << 17, 1 << 19, 4e-3) if options.quick else (1 << 18, 1 << 20, 1.2e-3)
    rows, worst, failed, deviations = [], 0, [], []
    with tempfile.TemporaryDirectory() as folder:
        for case in cases:
            row = {}
            for renderer in case.renderers:
                if options.quick and renderer == "VertexConnectionMerging":
                    continue
                value, error = measured(options.program, case, renderer, start, most, target, folder)
                difference, error = value / case.truth - 1, error / case.truth
                row[renderer] = difference, error
                # A difference must be below the limit; while a test is quick, within what its noise allows, too.
                if abs(difference) > (LIMIT if not options.quick else LIMIT + 4 * error):
                    failed.append("%s %s, %s: %+.3f %%" % (case.section, case.what, renderer, 100 * difference))
                deviations.append(difference / max(error, 1e-5))
                worst = max(worst, abs(difference))
            print("%-5s %-60s %.6f  %s" % (case.section, case.what, case.truth, "  ".join("%+.3f±%.3f %%" % (100 * d, 100 * e) for d, e in row.values())), flush=True)
            rows.append((case, row))
        if not options.quick and options.only in (None, "5.4"):
            rows.append(flux_row(options, folder, start, most, failed))
    print("largest difference %.3f %%; root mean square of differences over standard errors %.2f" % (
        100 * worst, math.sqrt(np.mean(np.square(deviations))) if deviations else 0))
    if options.write:
        write(options.write, rows, worst, deviations)
    for line in failed:
        print("too far: " + line)
    return 1 if failed else 0


def flux_row(options, folder, start, most, failed):
    lamp, objects, meters = flux_cases()
    case = Case("5.4", "flux at floor, ceiling and walls", objects, (0, 0, 0), UP, 2 * math.pi)
    # What the quadrature gives with exact values. The lamp's two sides are alike.
    exact = 2 * sum(w * lambert(lamp, 1, np.array(p), n) for p, n, w in meters)
    assert abs(exact / case.truth - 1) < 1e-3, exact / case.truth
    row = {}
    for renderer in case.renderers:
        sums = [0.0, 0.0]
        for point, normal, weight in meters:
            one = Case("5.4", "", objects, point, normal, lambert(lamp, 1, np.array(point), normal))
            value, error = measured(options.program, one, renderer, start, most, 4e-3, folder)
            sums[0] += 2 * weight * value
            sums[1] += (2 * weight * error) ** 2
        row[renderer] = sums[0] / case.truth - 1, math.sqrt(sums[1]) / case.truth
        if abs(row[renderer][0]) > LIMIT:
            failed.append("5.4, %s: %+.3f %%" % (renderer, 100 * row[renderer][0]))
    print("5.4   flux %s" % "  ".join("%+.3f±%.3f %%" % (100 * d, 100 * e) for d, e in row.values()), flush=True)
    return case, row


def write(path, rows, worst, deviations):
    text = ["# Illuminances after CIE 171:2006", "",
            "Made by `benchmarks/cie171.py`, which says how. The sections are those of CIE 171:2006; the dimensions are our own, and the true values "
            "are computed from each section's law, independently of the renderers. The table has the differences of `etendue measure` from the true value "
            "with their standard errors, in %.", "",
            "Largest difference: **%.2f %%** (allowed: 0.5 %%). The differences are %.2f standard errors, root mean square; pure noise gives 1.07, as the "
            "errors are themselves estimated from 16 renders. Rows of one geometry use the same random numbers, so their differences are alike; light that the "
            "meter sees directly is found in the same way by PathTracer and BidirectionalPathTracer, to the same numbers. LightTracer finds no sky that is "
            "seen directly." % (100 * worst, math.sqrt(np.mean(np.square(deviations)))), "",
            "| | case | true value | " + " | ".join(RENDERERS) + " |", "|---|---|---:|" + "---:|" * len(RENDERERS)]
    for case, row in sorted(rows, key=lambda r: [int(x) for x in r[0].section.split(".")]):
        text.append("| %s | %s | %.6g | %s |" % (case.section, case.what, case.truth, " | ".join(
            "%+.2f ± %.2f" % tuple(100 * x for x in row[name]) if name in row else "—" for name in RENDERERS)))
    text += ["", "Units: the sources have the radiance or intensity 1, the skies the zenith's radiance 1; the true values are irradiances in the same "
             "unit, the flux of 5.4 likewise. The sun of the skies stands 50° high. 5.13: a black overhang of 1 m; 5.14: an obstruction of the luminance 0.3 "
             "in front; the ground has the luminance 0.12.", ""]
    with open(path, "w") as f:
        f.write("\n".join(text))


if __name__ == "__main__":
    sys.exit(main())
