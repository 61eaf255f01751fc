"""Meshes as blend shapes move and skeletons bend them at a time, written over them in memory: no file is saved."""
import numpy
from pxr import Usd, UsdGeom, UsdSkel, Vt

from etendue_usd_files import words_of
from etendue_usd_normals import Normals, turned, smooth_normals
from etendue_usd_values import array

MOST_OPENED = 4096  # instances with skins of their own


def bend(stage, time, note, unusable):
    stage.SetEditTarget(stage.GetSessionLayer())  # which is stronger than all others
    open_instances(stage, note)
    cache, places = UsdSkel.Cache(), UsdGeom.XformCache(time)
    roots = [prim for prim in Usd.PrimRange(stage.GetPseudoRoot(), Usd.TraverseInstanceProxies(Usd.PrimIsActive & Usd.PrimIsLoaded))
             if prim.IsA(UsdSkel.Root) and not prim.IsInstanceProxy()]
    for root in map(UsdSkel.Root, roots):
        if not cache.Populate(root, Usd.PrimDefaultPredicate):
            continue
        for binding in cache.ComputeSkelBindings(root, Usd.PrimDefaultPredicate):
            skeleton = binding.GetSkeleton()
            query = cache.GetSkelQuery(skeleton)
            joints = query.ComputeSkinningTransforms(time) if query else None
            animation = query.GetAnimQuery() if query else None
            weights = animation.ComputeBlendShapeWeights(time) if animation else None
            if query and joints is None:
                note("a skeleton whose lists of joints are not of the same length leaves its skins as they are modelled")
            place = places.GetLocalToWorldTransform(skeleton.GetPrim())
            for skin in binding.GetSkinningTargets():
                if skin.GetPrim().IsInstanceProxy():
                    note("skins within instances are shown as they are modelled, without their skeletons' pose")
                    continue
                try:
                    Skin(skin, time, note).pose(joints, weights, place * places.GetLocalToWorldTransform(skin.GetPrim()).GetInverse())
                except unusable as error:
                    note(f"{skin.GetPrim().GetPath()} is shown as it is modelled: {words_of(error)[:200]}")


def open_instances(stage, note):
    """What stands in an instance cannot be written over: those with skeletons become places of their own."""
    opened = 0
    while True:
        closed = [prim for prim in stage.Traverse() if prim.IsInstance() and
                  any(inner.IsA(UsdSkel.Root) for inner in Usd.PrimRange(prim, Usd.TraverseInstanceProxies()))]
        if not closed or opened + len(closed) > MOST_OPENED:
            return
        opened += len(closed)
        for prim in closed:
            prim.SetInstanceable(False)


class Skin:
    """One mesh, or other thing made of points."""

    def __init__(self, query, time, note):
        self.query, self.time, self.note = query, time, note
        self.prim = query.GetPrim()
        self.points_attribute = UsdGeom.PointBased(self.prim).GetPointsAttr()

    def pose(self, joints, weights, back):
        """`joints` are in the skeleton's space, from which `back` leads to the mesh's; None and no weights: there are none."""
        rest = array(self.points_attribute.Get(self.time) if self.points_attribute else None, "f4", 3)
        if len(rest) == 0 or not numpy.isfinite(rest).all():
            return
        mesh = UsdGeom.Mesh(self.prim) if self.prim.IsA(UsdGeom.Mesh) else None
        normals = Normals.of(mesh, len(rest), self.time) if mesh else None
        moved = self.blend(rest, normals, mesh, weights) if self.query.HasBlendShapes() and weights else None
        if joints is not None and self.query.HasJointInfluences():
            bent = self.bend(rest if moved is None else moved, normals, joints, back)
            moved = bent if bent is not None else moved
        if moved is None:
            return
        self.points_attribute.Set(Vt.Vec3fArray.FromNumpy(numpy.ascontiguousarray(moved, dtype="f4")), self.time)
        if normals:
            normals.write(mesh, self.time)

    # ---- blend shapes --------------------------------------------------------------------------------------------------------

    def blend(self, rest, normals, mesh, weights):
        """The points with what blend shapes, and those in between, move them by, each times its weight. None: nothing moves."""
        shapes = UsdSkel.BlendShapeQuery(UsdSkel.BindingAPI(self.prim))
        # Those of the animation's shapes that the mesh has, in its own order.
        mapper = self.query.GetBlendShapeMapper()
        own = mapper.Remap(weights) if mapper else weights
        points = Vt.Vec3fArray.FromNumpy(rest)
        indices = shapes.ComputeBlendShapePointIndices()
        parts = shapes.ComputeSubShapeWeights(own) if own else None
        if not parts or not shapes.ComputeDeformedPoints(*parts, indices, shapes.ComputeSubShapePointOffsets(), points):
            self.note("blend shapes that do not fit their mesh are left out")
            return None
        moved = numpy.array(points, dtype="f4").reshape(-1, 3)
        if normals:
            self.blend_normals(normals, mesh, shapes, parts, indices, rest)
        return moved

    def blend_normals(self, normals, mesh, shapes, parts, indices, rest):
        """By the offsets of normals that shapes state; of those that state none, or none that fit, with the surface."""
        offsets, weights = numpy.zeros((len(rest), 3)), list(parts[0])
        for i, (weight, shape, part) in enumerate(zip(*parts)):
            between = shapes.GetInbetween(part)
            own = between.GetNormalOffsets() if between else shapes.GetBlendShape(shape).GetNormalOffsetsAttr().Get()
            own, where = array(own, "f8", 3), array(indices[shape], "i8")
            if len(where) == 0:
                where = numpy.arange(len(rest))
            if len(own) == len(where) and where.min() >= 0 and where.max() < len(rest):
                numpy.add.at(offsets, where, weight * own)
                weights[i] = 0
        if any(weights):
            points = Vt.Vec3fArray.FromNumpy(rest)
            shapes.ComputeDeformedPoints(Vt.FloatArray(weights), *parts[1:], indices, shapes.ComputeSubShapePointOffsets(), points)
            here, there = (smooth_normals(mesh, p, self.time)[normals.points] for p in (rest, numpy.array(points, dtype="f4").reshape(-1, 3)))
            normals.values = turned(normals.values, here, there)
        normals.set(normals.values + offsets[normals.points])

    # ---- joints --------------------------------------------------------------------------------------------------------------

    def bend(self, points, normals, joints, back):
        """The bent points, with the normals bent in place; None: it stays as it is. `joints` are in the skeleton's order, from
        which the query maps them to the mesh's own."""
        if self.query.IsRigidlyDeformed():
            matrix = self.query.ComputeSkinnedTransform(joints, self.time) * back
            deform = lambda p: moved_by(p, matrix)
        else:
            def deform(p):
                p = Vt.Vec3fArray.FromNumpy(numpy.ascontiguousarray(p, dtype="f4"))
                return moved_by(p, back) if self.query.ComputeSkinnedPoints(joints, p, self.time) else None
        bent = deform(points)
        if bent is None:
            self.note("a skin whose joints do not fit its points is shown as it is modelled")
            return None
        if normals:
            # By its own weights a point is moved by an affine map, whichever method of skinning mixes it: three steps away from
            # the point, as long as the mesh is large, tell it without an error but rounding. A normal is the cross product of
            # two tangents and goes by the cofactors of that map.
            step = float(numpy.ptp(points, axis=0).max()) or 1.0
            x, y, z = ((deform(points + step * axis) - bent)[normals.points] for axis in numpy.eye(3, dtype="f4"))
            n = normals.values
            normals.set(n[:, :1] * numpy.cross(y, z) + n[:, 1:2] * numpy.cross(z, x) + n[:, 2:] * numpy.cross(x, y))
        return bent


def moved_by(points, matrix):
    numbers, m = numpy.array(points, dtype="f8").reshape(-1, 3), numpy.array(matrix)
    return numbers @ m[:3, :3] + m[3, :3]
