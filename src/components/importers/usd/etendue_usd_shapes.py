"""UsdGeom's other shapes, and cameras."""
import math

import numpy
from pxr import Gf, UsdGeom

from etendue_usd_values import array, of_kind

# Places of what stands along z here, for an axis of USD's: rows are where x, y and z go.
ALONG = {"Z": Gf.Matrix4d(1), "X": Gf.Matrix4d(0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0, 1),
         "Y": Gf.Matrix4d(0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1)}


class Shapes:
    KINDS = ("Sphere", "Cube", "Cylinder", "Cylinder_1", "Cone", "Capsule", "Capsule_1", "Plane", "BasisCurves")

    def __init__(self, glb, time):
        self.glb, self.time = glb, time

    def get(self, prim):
        """[(class, members, place within the prim)], of which there may be none."""
        kind = prim.GetTypeName()
        value = lambda name, otherwise: self.value(prim, name, otherwise)
        axis = ALONG.get(str(value("axis", "Z")), ALONG["Z"])
        lifted = lambda by: Gf.Matrix4d().SetTranslate(Gf.Vec3d(0, 0, by)) * axis
        if kind == "Sphere":
            return [("Sphere", {"radius": value("radius", 1)}, Gf.Matrix4d(1))]
        if kind == "Cube":
            return [("Box", {"size": [value("size", 2)] * 3}, Gf.Matrix4d(1))]
        if kind == "Cylinder":
            return [("Cylinder", {"radius": value("radius", 1), "height": value("height", 2)}, axis)]
        if kind in ("Cone", "Cylinder_1"):
            h = value("height", 2)
            low, top = (value("radius", 1), 0) if kind == "Cone" else (value("radiusBottom", 1), value("radiusTop", 1))
            return [("Cone", {"radius": low, "top_radius": top, "height": h}, lifted(-h / 2))]
        if kind == "Plane":
            w, h = value("width", 2), value("length", 2)
            members = {"corner": [-w / 2, -h / 2, 0], "edge_u": [w, 0, 0], "edge_v": [0, h, 0]}
            return [("Rectangle", members, axis)]
        if kind in ("Capsule", "Capsule_1"):
            r = value("radius", 0.5)
            low, top, h = value("radiusBottom", r), value("radiusTop", r), value("height", 1)
            if low != top:
                self.glb.note("capsules have the radius of their lower end")
            return [("Cylinder", {"radius": low, "height": h, "caps": False}, axis), ("Sphere", {"radius": low}, lifted(-h / 2)),
                    ("Sphere", {"radius": low}, lifted(h / 2))]
        return self.curves(prim)

    def value(self, prim, name, otherwise):
        attribute = prim.GetAttribute(name)
        found = attribute.Get(self.time) if attribute else None
        return of_kind(found, otherwise, f"'{name}' of {prim.GetPath()}", self.glb.note)

    def curves(self, prim):
        curves = UsdGeom.BasisCurves(prim)
        points = array(curves.GetPointsAttr().Get(self.time), "f8", 3)
        counts = array(curves.GetCurveVertexCountsAttr().Get(self.time), "i8")
        if len(points) == 0 or len(counts) == 0:
            return []
        if counts.min() < 2 or counts.sum() != len(points) or not numpy.isfinite(points).all():
            raise ValueError(f"{prim.GetPath()}: its curves have {counts.sum()} points, but it has {len(points)}")
        wrap, linear = str(curves.GetWrapAttr().Get() or "nonperiodic"), curves.GetTypeAttr().Get() == "linear"
        basis = "linear" if linear else {"bezier": "bezier", "bspline": "b_spline", "catmullRom": "catmull_rom"}.get(
            str(curves.GetBasisAttr().Get()), "linear")
        if wrap == "periodic":
            self.glb.note("curves that are closed are left out")
            return []
        if wrap == "pinned" and basis == "b_spline":
            self.glb.note("splines that are pinned to their ends are left out")
            return []
        if UsdGeom.BasisCurves(prim).GetNormalsAttr().HasAuthoredValue():
            self.glb.note("ribbons are round tubes")
        points = numpy.concatenate((points, self.widths(curves, points, counts)[:, None] / 2), axis=1)
        if basis == "catmull_rom" and wrap == "nonperiodic":
            # Its first and last points only steer: as Bezier curves, with handles a sixth of the way between the neighbours.
            made, lengths = [], []
            for start, n in zip(numpy.cumsum(counts) - counts, counts):
                p = points[start:start + n]
                if n < 4:
                    continue
                a, b = p[1:-2], p[2:-1]
                piece = numpy.stack((a, a + (b - p[:-3]) / 6, b - (p[3:] - a) / 6), axis=1).reshape(-1, 4)
                made.append(numpy.concatenate((piece, b[-1:])))
                lengths.append(len(made[-1]))
            if not made:
                return []
            points, counts, basis = numpy.concatenate(made), numpy.array(lengths), "bezier"
        members = {"points": {"accessor": self.glb.vectors(points[:, :3])}, "counts": {"accessor": self.glb.indices(counts)},
                   "radius": {"accessor": self.glb.vectors(numpy.maximum(points[:, 3], 0))}, "basis": basis}
        return [("Curve", members, Gf.Matrix4d(1))]

    def widths(self, curves, points, counts):
        """One for each point."""
        values = array(curves.GetWidthsAttr().Get(self.time), "f8")
        if len(values) == len(points):
            return values
        if len(values) == len(counts):
            return numpy.repeat(values, counts)
        if len(values) > 1:
            self.glb.note("widths of curves that are not of their points are the mean of all")
        return numpy.full(len(points), values.mean() if len(values) else 1.0)


def camera_of(glb, prim, time, metres):
    """An element of glTF's cameras."""
    own = UsdGeom.Camera(prim)
    camera = own.GetCamera(time)
    aspect = camera.aspectRatio or 1
    members = {}
    if camera.projection == Gf.Camera.Perspective:
        fov = math.radians(camera.GetFieldOfView(Gf.Camera.FOVVertical))
        made = {"type": "perspective", "perspective": {"yfov": fov, "aspectRatio": aspect}}
        shift = [-camera.horizontalApertureOffset / (camera.horizontalAperture or 1), camera.verticalApertureOffset / (camera.verticalAperture or 1)]
        if shift != [0, 0]:
            members["principal_point"] = shift
        if camera.fStop > 0 and camera.focusDistance > 0:
            members["lens_radius"] = camera.focalLength * Gf.Camera.FOCAL_LENGTH_UNIT / (2 * camera.fStop) * metres
            members["focus_distance"] = camera.focusDistance * metres
    else:
        half = camera.horizontalAperture * Gf.Camera.APERTURE_UNIT / 2 * metres
        made = {"type": "orthographic", "orthographic": {"xmag": half, "ymag": half / aspect}}
        if camera.horizontalApertureOffset or camera.verticalApertureOffset:
            glb.note("orthographic cameras are not shifted")
    if hasattr(own, "ComputeLinearExposureScale") and abs(own.ComputeLinearExposureScale(time) - 1) > 1e-6:
        glb.note("the exposure of cameras is left out")
    for what, there in (("'clippingPlanes'", len(camera.clippingPlanes) > 0), ("stereo", str(own.GetStereoRoleAttr().Get()) in ("left", "right"))):
        if there:
            glb.note(f"{what} of cameras is left out")
    # What the file leaves at its defaults (1 and 1000000 units) is no choice of its makers: nothing is clipped then. glTF's
    # planes are not stretched with the camera, so they are in metres.
    if own.GetClippingRangeAttr().HasAuthoredValue():
        made[made["type"]].update(znear=max(camera.clippingRange.min, 0) * metres, zfar=camera.clippingRange.max * metres)
    if members:
        made["extensions"] = {"ETENDUE_part": {"members": members}}
    return dict(made, name=prim.GetName())
