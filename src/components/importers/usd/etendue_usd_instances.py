"""The places of an instancer's instances where its lists are not of the same length, for which UsdGeom gives none."""
from pxr import Gf, UsdGeom

# What becomes of instances for which a list has no entry. Entries for which there is no instance are left out.
WITHOUT = {"positions": "instances without one are left out", "orientations": "instances without one are not turned",
           "scales": "instances without one keep their size", "ids": "instances without one are shown"}


def lists_of_instances(instancer, time):
    """{name: entries} of all lists that have one entry for each instance, or none."""
    turns = instancer.GetOrientationsfAttr().Get(time) if hasattr(instancer, "GetOrientationsfAttr") else None
    found = {"positions": instancer.GetPositionsAttr().Get(time), "orientations": turns or instancer.GetOrientationsAttr().Get(time),
             "scales": instancer.GetScalesAttr().Get(time), "ids": instancer.GetIdsAttr().Get(time)}
    return {name: entries or [] for name, entries in found.items()}


def places_of_instances(stage, time, lists, which, targets):
    """What ComputeInstanceTransformsAtTime gives where the lists are as long as `which`, the prototype of each instance. An
    instance without an orientation or a scale has the neutral one, as in Hydra."""
    own = []
    for path in targets:
        root = stage.GetPrimAtPath(path)
        own.append(UsdGeom.Xformable(root).GetLocalTransformation(time) if root and root.IsA(UsdGeom.Xformable) else Gf.Matrix4d(1))
    moved = []
    for k, prototype in enumerate(which):
        place = own[prototype] if 0 <= prototype < len(own) else Gf.Matrix4d(1)
        if k < len(lists["scales"]):
            place = place * Gf.Matrix4d().SetScale(Gf.Vec3d(lists["scales"][k]))
        if k < len(lists["orientations"]):
            place = place * Gf.Matrix4d().SetRotate(Gf.Quatd(lists["orientations"][k]))
        moved.append(place * Gf.Matrix4d().SetTranslate(Gf.Vec3d(lists["positions"][k])))
    return moved
