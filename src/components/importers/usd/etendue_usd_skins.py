"""Meshes as blend shapes move and skeletons bend them at a time, written over them in memory: no file is saved."""
import numpy
from pxr import Usd, UsdGeom, UsdSkel, Vt

from etendue_usd_meshes import Meshes


def bend(stage, time, note):
    roots = [prim for prim in Usd.PrimRange(stage.GetPseudoRoot(), Usd.TraverseInstanceProxies()) if prim.IsA(UsdSkel.Root)]
    if any(root.IsInstanceProxy() or root.IsInstance() for root in roots):
        note("skins within instances are shown as they are modelled, without their skeletons' pose")
    roots = [root for root in roots if not root.IsInstanceProxy() and not root.IsInstance()]
    cache, places = UsdSkel.Cache(), UsdGeom.XformCache(time)
    for root in map(UsdSkel.Root, roots):
        if not cache.Populate(root, Usd.PrimDefaultPredicate):
            continue
        bindings = cache.ComputeSkelBindings(root, Usd.PrimDefaultPredicate)
        for binding in bindings:
            skeleton = binding.GetSkeleton()
            query = cache.GetSkelQuery(skeleton)
            joints = query.ComputeSkinningTransforms(time) if query else None
            animation = query.GetAnimQuery() if query else None
            weights = animation.ComputeBlendShapeWeights(time) if animation else None
            for skin in binding.GetSkinningTargets():
                moved = blend(skin, weights, time, note) if skin.HasBlendShapes() and weights else False
                if joints is not None and skin.HasJointInfluences():
                    moved = bend_one(skin, joints, places.GetLocalToWorldTransform(skeleton.GetPrim()), places, time, note) or moved
                if moved:
                    face_anew(UsdGeom.Mesh(skin.GetPrim()), time, note)


def blend(skin, weights, time, note):
    """Adds to the points what blend shapes, and those in between, move them by, each times its weight. False: nothing moves."""
    mesh, shapes = UsdGeom.PointBased(skin.GetPrim()), UsdSkel.BlendShapeQuery(UsdSkel.BindingAPI(skin.GetPrim()))
    points = mesh.GetPointsAttr().Get(time) if mesh else None
    if points is None or len(points) == 0:
        return False
    # Those of the animation's shapes that the mesh has, in its own order.
    mapper = skin.GetBlendShapeMapper()
    own = mapper.Remap(weights) if mapper else weights
    points = Vt.Vec3fArray(points)
    parts = shapes.ComputeSubShapeWeights(own) if own else None
    if not parts or not shapes.ComputeDeformedPoints(*parts, shapes.ComputeBlendShapePointIndices(),
                                                     shapes.ComputeSubShapePointOffsets(), points):
        note("blend shapes that do not fit their mesh are left out")
        return False
    mesh.GetPointsAttr().Set(points, time)
    return True


def bend_one(skin, joints, skeleton, places, time, note):
    """False: it stays as it is."""
    mesh = UsdGeom.PointBased(skin.GetPrim())
    points = mesh.GetPointsAttr().Get(time) if mesh else None
    if points is None or len(points) == 0:
        return False
    mapper = skin.GetJointMapper()
    if mapper and not mapper.IsIdentity():
        joints = mapper.RemapTransforms(joints)
    back = skeleton * places.GetLocalToWorldTransform(skin.GetPrim()).GetInverse()
    if skin.IsRigidlyDeformed():
        moved = skin.ComputeSkinnedTransform(joints, time)
        matrix = moved * back
        mesh.GetPointsAttr().Set(moved_by(points, matrix), time)
    else:
        points = Vt.Vec3fArray(points)
        if not skin.ComputeSkinnedPoints(joints, points, time):
            note("a skin whose joints do not fit its points is shown as it is modelled")
            return False
        mesh.GetPointsAttr().Set(moved_by(points, back), time)
    return True


def face_anew(mesh, time, note):
    """Its normals are of the mesh at rest; the moved faces say better where they face."""
    normals = UsdGeom.PrimvarsAPI(mesh).GetPrimvar("normals")
    if mesh.GetNormalsAttr().HasAuthoredValue() or (normals and normals.HasAuthoredValue()):
        note("the normals of skins are those of their bent faces, smoothed")
        if normals:
            normals.GetAttr().Block()
        mesh.GetNormalsAttr().Set(smooth_normals(mesh, time), time)
        mesh.SetNormalsInterpolation("vertex")


def smooth_normals(mesh, time):
    """The means of the normals of the triangles around each point, by area."""
    points = numpy.array(mesh.GetPointsAttr().Get(time), dtype="f8").reshape(-1, 3)
    counts = numpy.array(mesh.GetFaceVertexCountsAttr().Get(time), dtype="i8")
    corners = numpy.array(mesh.GetFaceVertexIndicesAttr().Get(time), dtype="i8")
    sums = numpy.zeros_like(points)
    if len(counts) and counts.min() >= 0 and counts.sum() == len(corners) and len(corners) and 0 <= corners.min() <= corners.max() < len(points):
        where = corners[Meshes.fans(counts)[1]]
        if mesh.GetOrientationAttr().Get() == "leftHanded":
            where = where[:, ::-1]
        a, b, c = (points[where[:, k]] for k in range(3))
        across = numpy.cross(b - a, c - a)
        for k in range(3):
            numpy.add.at(sums, where[:, k], across)
    lengths = numpy.linalg.norm(sums, axis=1, keepdims=True)
    return Vt.Vec3fArray.FromNumpy((sums / numpy.where(lengths > 0, lengths, 1)).astype("f4"))


def moved_by(points, matrix):
    numbers, m = numpy.array(points, dtype="f8").reshape(-1, 3), numpy.array(matrix)
    return Vt.Vec3fArray.FromNumpy((numbers @ m[:3, :3] + m[3, :3]).astype("f4"))
