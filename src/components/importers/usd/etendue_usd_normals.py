"""Normals of meshes: as they are stated, and as they turn when the mesh is moved."""
import numpy
from pxr import UsdGeom, Vt

from etendue_usd_polygons import triangulated
from etendue_usd_values import array


def stated(mesh, time):
    """(normals, interpolation) of a mesh, or None; 'primvars:normals' goes before 'normals'."""
    primvar = UsdGeom.PrimvarsAPI(mesh).GetPrimvar("normals")
    own = primvar and primvar.HasValue()
    values = primvar.ComputeFlattened(time) if own else mesh.GetNormalsAttr().Get(time)
    how = primvar.GetInterpolation() if own else mesh.GetNormalsInterpolation()
    return (array(values, "f4", 3), how) if values is not None and len(values) else None


class Normals:
    """A mesh's normals with the point that each belongs to."""

    def __init__(self, values, points, how):
        self.values, self.points, self.how = values.astype("f8"), points, how

    @classmethod
    def of(cls, mesh, count, time):
        """None: it has none, or none that fit, which is told when it is made."""
        given = stated(mesh, time)
        if given is None:
            return None
        values, how = given
        counts = array(mesh.GetFaceVertexCountsAttr().Get(time), "i8")
        corners = array(mesh.GetFaceVertexIndicesAttr().Get(time), "i8")
        if len(corners) == 0 or counts.min() < 0 or counts.sum() != len(corners) or corners.min() < 0 or corners.max() >= count:
            return None
        if how == "constant":
            return cls(numpy.repeat(values[:1], count, axis=0), numpy.arange(count), "vertex")
        if how == "uniform" and len(values) == len(counts):
            return cls(numpy.repeat(values, counts, axis=0), corners, "faceVarying")
        if how == "faceVarying" and len(values) == len(corners):
            return cls(values, corners, "faceVarying")
        if how in ("vertex", "varying") and len(values) == count:
            return cls(values, numpy.arange(count), "vertex")
        return None

    def set(self, values):
        """Those that vanish stay as they were."""
        lengths = numpy.linalg.norm(values, axis=1, keepdims=True)
        self.values = numpy.where(lengths > 0, values / numpy.where(lengths > 0, lengths, 1), self.values)

    def write(self, mesh, time):
        primvar = UsdGeom.PrimvarsAPI(mesh).GetPrimvar("normals")
        if primvar:
            primvar.GetAttr().Block()
        mesh.GetNormalsAttr().Set(Vt.Vec3fArray.FromNumpy(numpy.nan_to_num(self.values).astype("f4")), time)
        mesh.SetNormalsInterpolation(self.how)


def smooth_normals(mesh, points, time):
    """The means of the normals of the triangles around each point, by area; 0 where there are none."""
    counts = array(mesh.GetFaceVertexCountsAttr().Get(time), "i8")
    corners = array(mesh.GetFaceVertexIndicesAttr().Get(time), "i8")
    points = points.astype("f8")
    where = corners[triangulated(points[corners], counts)[1]]
    a, b, c = (points[where[:, k]] for k in range(3))
    across = numpy.cross(b - a, c - a)
    sums = numpy.zeros_like(points)
    for k in range(3):
        numpy.add.at(sums, where[:, k], across)
    lengths = numpy.linalg.norm(sums, axis=1, keepdims=True)
    return sums / numpy.where(lengths > 0, lengths, 1)


def turned(vectors, from_here, to_there):
    """Vectors by the smallest rotation that takes one unit vector to another (Rodrigues' formula)."""
    axis = numpy.cross(from_here, to_there)
    cosine = (from_here * to_there).sum(axis=1, keepdims=True)
    once = numpy.cross(axis, vectors)
    made = vectors + once + numpy.cross(axis, once) / numpy.maximum(1 + cosine, 1e-6)
    known = (from_here ** 2).sum(axis=1, keepdims=True) * (to_there ** 2).sum(axis=1, keepdims=True) > 0.5
    return numpy.where(known, made, vectors)
