#!/usr/bin/env python3
"""etendue_usd.py [--materialx] FILE [SECONDS [FOLDER ...]]: a USD stage as .glb on standard output, or its materials that are
MaterialX as one such document; what is wrong goes to standard error.

It is started by UsdImporter, in a process of its own. Meshes, shapes, curves, subdivision surfaces, instances, UsdPreviewSurface
materials, lights and cameras are converted (docs/materials-of-models.md); what is not is told in asset.extras.notes, which the
importer shows. Files outside of FILE's folder and of the FOLDERs are not opened.
"""
import math
import os
import resource
import sys

sys.dont_write_bytecode = True
# Each thread takes address space of its own, which is limited here: on a machine of many cores they would take all of it.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("PXR_WORK_THREAD_LIMIT", "4")
os.environ.setdefault("PXR_USDC_EMIT_DEPRECATION_WARNINGS", "0")  # of files that are read all the same
os.environ.setdefault("TF_ENV_SETTING_ALERTS_ENABLED", "0")  # or it says so among the errors

try:
    import numpy
    from pxr import Gf, Tf, Usd, UsdGeom, UsdLux
except ImportError as missing:
    sys.exit(f"USD files are read by Python packages of which one is not installed ({missing.name or missing}): pip install usd-core numpy; "
             "the environment variable ETENDUE_PYTHON names the Python that has them")

from etendue_usd_files import Files, words_of
from etendue_usd_glb import Glb
from etendue_usd_instances import WITHOUT, lists_of_instances, places_of_instances
from etendue_usd_lights import Lights
from etendue_usd_materialx import document_of
from etendue_usd_materials import Materials
from etendue_usd_meshes import Meshes
from etendue_usd_shapes import Shapes, camera_of
from etendue_usd_skins import bend
from etendue_usd_values import array, metres_per_unit

MOST_INSTANCES = 1 << 22
# What a value of an unexpected type ends in: without the thing that has it a scene is still one.
UNUSABLE = (TypeError, AttributeError, LookupError, OverflowError, Tf.ErrorException)


class Converter:
    def __init__(self, stage, files, glb, seconds):
        self.stage, self.glb = stage, glb
        moves = stage.HasAuthoredTimeCodeRange()
        self.time = Usd.TimeCode(stage.GetStartTimeCode() + seconds * stage.GetTimeCodesPerSecond()) if moves else Usd.TimeCode.Default()
        self.metres = metres_per_unit(stage)
        if not (0 < self.metres < float("inf")):
            raise ValueError(f"its metersPerUnit is {self.metres}")
        bend(stage, self.time, glb.note, UNUSABLE)
        self.places = UsdGeom.XformCache(self.time)
        self.materials = Materials(glb, files, self.time)
        self.materials.gather(stage)
        self.meshes = Meshes(glb, self.materials, self.time)
        self.shapes = Shapes(glb, self.time)
        self.lights = Lights(glb, self.materials, self.time, stage)
        self.nodes, self.instanced = [], 0

    def run(self):
        self.walk(self.stage.GetPseudoRoot(), self.convert)
        root = {"children": self.nodes, "scale": [self.metres] * 3}
        if UsdGeom.GetStageUpAxis(self.stage) == "Z":
            root["rotation"] = [-math.sqrt(0.5), 0, 0, math.sqrt(0.5)]
        self.glb.json["scenes"] = [{"nodes": [self.glb.add("nodes", root)] if self.nodes else []}]
        return self.glb

    def walk(self, root, convert, predicate=Usd.PrimDefaultPredicate):
        """All that is shown below a prim, but for what stands below an instancer, which shows it itself."""
        prims = iter(Usd.PrimRange(root, Usd.TraverseInstanceProxies(predicate)))
        for prim in prims:
            imageable = UsdGeom.Imageable(prim)
            if imageable:
                # Visibility and purpose are inherited: nothing below can be shown again.
                if imageable.GetVisibilityAttr().Get(self.time) == "invisible" or imageable.ComputePurpose() in ("guide", "proxy"):
                    prims.PruneChildren()
                    continue
            elif prim.GetTypeName() in ("RenderSettings",):
                self.glb.note("render settings are left out")
            try:
                convert(prim)
            except UNUSABLE as error:
                self.glb.note(f"{prim.GetPath()} is left out: {words_of(error)[:200]}")
            if prim.IsA(UsdGeom.PointInstancer):
                prims.PruneChildren()

    def convert(self, prim):
        place = self.places.GetLocalToWorldTransform(prim)
        kind = prim.GetTypeName()
        if prim.IsA(UsdGeom.PointInstancer):
            self.instances(prim, place)
        elif kind == "Camera":
            self.node(prim, place, camera=self.glb.add("cameras", camera_of(self.glb, prim, self.time, self.metres)))
        elif kind.endswith("Light") or kind == "DomeLight_1":
            made = self.lights.get(prim, place)
            if made:
                self.node(prim, made[1], extensions={"ETENDUE_part": made[0]})
        else:
            for what, inner in self.shown(prim):
                self.node(prim, inner * place, **what)

    def shown(self, prim):
        """[(what a node has, place within the prim)] of what has a surface."""
        kind = prim.GetTypeName()
        if prim.HasAPI(UsdLux.LightAPI) and kind in ("Mesh", "Volume"):
            self.glb.note("meshes and volumes that are lights (MeshLightAPI, VolumeLightAPI) give no light")
        if kind == "Mesh":
            made = self.meshes.get(prim)
            if made is None:
                return []
            return [(made if "mesh" in made else {"extensions": {"ETENDUE_part": dict(made["part"], material=made["material"])}}, Gf.Matrix4d(1))]
        if kind in Shapes.KINDS:
            return [({"extensions": {"ETENDUE_part": {"class": name, "members": members, "material": self.surface(prim)}}}, inner)
                    for name, members, inner in self.shapes.get(prim)]
        if prim.IsA(UsdGeom.Gprim) or (kind and "Volume" in kind):
            self.glb.note(f"objects of the type {kind} are left out")
        return []

    def surface(self, prim):
        """The material of a shape: its own, or one of its displayColor."""
        bound = self.materials.bound(prim)
        if bound is not None:
            return bound
        values = UsdGeom.Gprim(prim).GetDisplayColorAttr().Get(self.time)
        color = [max(0.0, min(1.0, float(x))) for x in (values[0] if values else (0.5, 0.5, 0.5))]
        return self.glb.same("materials", {"pbrMetallicRoughness": {"baseColorFactor": [*color, 1], "metallicFactor": 0, "roughnessFactor": 0.5}})

    def node(self, prim, place, **what):
        matrix = [place[r][c] for r in range(4) for c in range(4)]  # USD's rows are glTF's columns
        if not all(abs(x) < 1e30 for x in matrix):
            raise ValueError(f"{prim.GetPath()}: its transform is no finite one")
        self.nodes.append(self.glb.add("nodes", dict(what, name=prim.GetName(), matrix=matrix)))

    def instances(self, prim, place):
        instancer = UsdGeom.PointInstancer(prim)
        which = array(instancer.GetProtoIndicesAttr().Get(self.time), "i8")
        self.instanced += len(which)
        if self.instanced > MOST_INSTANCES:
            raise ValueError(f"{prim.GetPath()}: there are more than {MOST_INSTANCES} instances")
        targets = instancer.GetPrototypesRel().GetForwardedTargets()
        lists = lists_of_instances(instancer, self.time)
        uneven = [name for name, entries in lists.items() if len(entries) != len(which) and (len(entries) or name == "positions")]
        for name in uneven:
            self.glb.note(f"an instancer has another number of {name} than of protoIndices: {WITHOUT[name]}")
        if uneven:
            which = which[:len(lists["positions"])]
            moved = places_of_instances(self.stage, self.time, lists, which, targets)
        else:
            moved = instancer.ComputeInstanceTransformsAtTime(self.time, self.time, UsdGeom.PointInstancer.IncludeProtoXform,
                                                              UsdGeom.PointInstancer.IgnoreMask) or []
            if len(moved) != len(which):
                raise ValueError(f"{prim.GetPath()}: the places of its instances cannot be computed")
        shown = array(instancer.ComputeMaskAtTime(self.time), bool)[:len(which)]
        if len(shown):
            shown = numpy.append(shown, numpy.ones(len(which) - len(shown), bool))
        parts = [self.prototype(path) for path in targets]
        moved = numpy.array(moved, dtype="f8").reshape(-1, 4, 4)
        for i, inner in ((i, p) for i, p in enumerate(parts) if p):
            chosen = numpy.nonzero((which == i) & shown if len(shown) == len(which) else which == i)[0]
            for name, what, own in inner if len(chosen) else []:
                matrices = numpy.array(own) @ moved[chosen] @ numpy.array(place)
                if "mesh" in what and len(chosen) > 8 and self.together(name, what, matrices, place):
                    continue
                for matrix in matrices:
                    self.node(prim, Gf.Matrix4d(matrix.tolist()), **what)
        if ((which < 0) | (which >= len(targets))).any():
            self.glb.note("instances of prototypes that are not there are left out")

    def prototype(self, path):
        """[(name, what a node has, place below the prototype)] of all that it shows."""
        root = self.stage.GetPrimAtPath(path)
        if not root:
            self.glb.note("instances of prototypes that are not there are left out")
            return []
        found = []
        back = self.places.GetLocalToWorldTransform(root).GetInverse()

        def take(prim):
            if prim.IsA(UsdGeom.PointInstancer):
                self.glb.note("instancers within the prototypes of others are left out")
                return
            if prim.GetTypeName().endswith("Light"):
                self.glb.note("lights within the prototypes of instancers are left out")
            for what, inner in self.shown(prim):
                found.append((prim.GetName(), what, inner * self.places.GetLocalToWorldTransform(prim) * back))

        # As Hydra has it: a prototype may stand below an 'over', which by itself defines nothing.
        self.walk(root, take, Usd.PrimIsActive & Usd.PrimIsLoaded & Usd.PrimHasDefiningSpecifier & ~Usd.PrimIsAbstract)
        if root.IsAbstract():
            self.glb.note("prototypes of instancers that are classes, or below one, are left out")
        return found

    def together(self, name, what, matrices, place):
        """Many places as one node (EXT_mesh_gpu_instancing): only those that move, turn and scale along the mesh's axes."""
        linear = numpy.swapaxes(matrices[:, :3, :3], 1, 2)  # columns are where x, y and z go
        scales = numpy.linalg.norm(linear, axis=1)
        if not (scales > 0).all():
            return False
        turned = linear / scales[:, None, :]
        flipped = numpy.linalg.det(turned) < 0
        scales[flipped, 0] *= -1
        turned[flipped, :, 0] *= -1
        if numpy.abs(numpy.swapaxes(turned, 1, 2) @ turned - numpy.eye(3)).max() > 1e-5:
            return False
        quaternions = []
        for t in turned:
            q = Gf.Matrix3d(t.T.tolist()).ExtractRotation().GetQuat()
            quaternions.append((*q.GetImaginary(), q.GetReal()))
        attributes = {"TRANSLATION": self.glb.vectors(matrices[:, 3, :3]), "ROTATION": self.glb.vectors(numpy.array(quaternions)),
                      "SCALE": self.glb.vectors(scales)}
        self.nodes.append(self.glb.add("nodes", dict(what, name=name, extensions={"EXT_mesh_gpu_instancing": {"attributes": attributes}})))
        return True


def limit(what, wanted):
    """Lower limits that the process was started with stay."""
    soft, hard = resource.getrlimit(what)
    lowest = min([wanted] + [x for x in (soft, hard) if x != resource.RLIM_INFINITY])
    resource.setrlimit(what, (lowest, hard))


def main():
    only_materials = sys.argv[1] == "--materialx"
    if only_materials:
        del sys.argv[1]
    path = os.path.abspath(sys.argv[1])
    size = os.path.getsize(path)
    limit(resource.RLIMIT_CORE, 0)
    limit(resource.RLIMIT_AS, (4 << 30) + 64 * size)
    limit(resource.RLIMIT_CPU, 120 + (size >> 20))
    glb = Glb()
    files = Files(path, sys.argv[3:], glb.note)
    files.check_layers()
    stage = Usd.Stage.Open(path)
    if only_materials:
        sys.stdout.write(document_of(stage, Usd.TimeCode.Default()))
        return
    if hasattr(stage, "GetCompositionErrors"):
        for error in stage.GetCompositionErrors()[:20]:
            glb.note("a part cannot be put together: " + " ".join(str(error).split())[:200])
    Converter(stage, files, glb, float(sys.argv[2]) if len(sys.argv) > 2 else 0).run().write(sys.stdout.buffer)


if __name__ == "__main__":
    try:
        main()
    except MemoryError:
        sys.exit(f"it needs more memory than its reader may have ({resource.getrlimit(resource.RLIMIT_AS)[0] >> 20} MB, see 'ulimit -v')")
    except Exception as error:
        sys.exit(words_of(error)[:400] or type(error).__name__)
