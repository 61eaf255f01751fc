"""Meshes as glTF's triangles, and as cages of SubdivisionSurface."""
import numpy
from pxr import UsdGeom, UsdShade

from etendue_usd_normals import stated
from etendue_usd_polygons import triangulated
from etendue_usd_values import array


class Meshes:
    def __init__(self, glb, materials, time):
        self.glb, self.materials, self.time, self.known = glb, materials, time, {}

    def get(self, prim):
        """{"mesh": place} or {"part": …, "material": …} of a mesh, or None."""
        original = prim.GetPrimInPrototype() if prim.IsInstanceProxy() else prim
        key = original.GetPath(), self.materials.bound(prim)
        if key not in self.known:
            self.known[key] = self.make(prim)
        return self.known[key]

    def make(self, prim):
        mesh = UsdGeom.Mesh(prim)
        points = array(mesh.GetPointsAttr().Get(self.time), "f4", 3)
        counts = array(mesh.GetFaceVertexCountsAttr().Get(self.time), "i8")
        corners = array(mesh.GetFaceVertexIndicesAttr().Get(self.time), "i8")
        if len(points) == 0 or len(corners) == 0:
            return None
        if counts.min() < 0 or counts.sum() != len(corners):
            raise ValueError(f"{prim.GetPath()}: its faces have {counts.sum()} corners, but it names {len(corners)}")
        if corners.min() < 0 or corners.max() >= len(points):
            raise ValueError(f"{prim.GetPath()}: its faces refer to points that are not there")
        if not numpy.isfinite(points).all():
            raise ValueError(f"{prim.GetPath()}: its points are no finite numbers")
        subsets = [s for s in UsdShade.MaterialBindingAPI(prim).GetMaterialBindSubsets() if s.GetElementTypeAttr().Get() == "face"]
        mesh_normals = stated(mesh, self.time)
        if self.is_smooth(mesh, mesh_normals):
            if not subsets:
                return self.cage(prim, mesh, points, counts, corners)
            self.glb.note("subdivision surfaces of several materials are shown as their cages")
        elif mesh.GetSubdivisionSchemeAttr().Get() != "none" and mesh_normals is not None:
            self.glb.note("meshes that state normals and no scheme of subdivision are shown as polygons")
        whole = self.materials.bound(prim)
        names, by_vertex = self.materials.uses.get(whole, ({"st"}, whole is None))
        for subset in subsets:
            more = self.materials.uses.get(self.materials.bound(subset.GetPrim()), (set(), False))
            names, by_vertex = names | more[0], by_vertex or more[1]
        colors, opaque = self.colors(mesh) if by_vertex else (None, True)
        each = {"NORMAL": mesh_normals, "COLOR_0": colors}
        for name in sorted(names, key=lambda n: self.materials.uv_sets[n]):
            each[f"TEXCOORD_{self.materials.uv_sets[name]}"] = self.uvs(prim, name)
        attributes, by_corner = self.attributes(each, points, counts, corners)
        faces, triangles = triangulated(points[corners].astype("f8"), counts)
        kept = numpy.ones(len(counts), bool)
        holes = array(mesh.GetHoleIndicesAttr().Get(self.time), "i8")
        kept[holes[(holes >= 0) & (holes < len(counts))]] = False
        if mesh.GetOrientationAttr().Get() == "leftHanded":
            triangles = triangles[:, ::-1]
        where = triangles if by_corner else corners[triangles]
        made, left = [], kept.copy()

        def add(chosen, material):
            some = where[chosen[faces]]
            if len(some):
                made.append({"attributes": attributes, "indices": self.glb.indices(some),
                             "material": material if material is not None else self.materials.plain(opaque)})

        for subset in subsets:
            named = array(subset.GetIndicesAttr().Get(self.time), "i8")
            chosen = numpy.zeros(len(counts), bool)
            chosen[named[(named >= 0) & (named < len(counts))]] = True
            chosen &= left  # a face of two subsets is the first one's
            material = self.materials.bound(subset.GetPrim())
            add(chosen, material if material is not None else whole)
            left &= ~chosen
        add(left, whole)
        return {"mesh": self.glb.add("meshes", {"name": prim.GetName(), "primitives": made})} if made else None

    @staticmethod
    def is_smooth(mesh, normals):
        scheme = mesh.GetSubdivisionSchemeAttr()
        return scheme.Get() in ("catmullClark", "loop", "bilinear") and (scheme.HasAuthoredValue() or normals is None)

    def attributes(self, each, points, counts, corners):
        """Accessors, and whether they count corners of faces instead of points."""
        by_corner = any(v is not None and v[1] in ("faceVarying", "uniform") for v in each.values())
        face_of_corner = numpy.repeat(numpy.arange(len(counts)), counts)
        attributes = {"POSITION": self.glb.vectors(points[corners] if by_corner else points)}
        for name, given in each.items():
            if given is None:
                continue
            values, how = given
            if how == "constant":
                spread = numpy.repeat(values[:1], len(corners) if by_corner else len(points), axis=0)
            elif how == "uniform":
                spread = values[face_of_corner] if len(values) == len(counts) else None
            elif how == "faceVarying":
                spread = values if len(values) == len(corners) else None
            else:
                spread = (values[corners] if by_corner else values) if len(values) == len(points) else None
            if spread is None:
                self.glb.note(f"{name.split('_')[0].lower()} that does not fit its mesh is left out")
            else:
                attributes[name] = self.glb.vectors(numpy.nan_to_num(spread, posinf=0, neginf=0))
        return attributes, by_corner

    def cage(self, prim, mesh, points, counts, corners):
        material = self.materials.bound(prim)
        names, by_vertex = self.materials.uses.get(material, ({"st"}, False))
        scheme = {"catmullClark": "catmull_clark", "loop": "loop", "bilinear": "bilinear"}[mesh.GetSubdivisionSchemeAttr().Get()]
        if scheme == "loop" and (counts != 3).any():
            raise ValueError(f"{prim.GetPath()}: Loop's scheme is for triangles")
        holes = array(mesh.GetHoleIndicesAttr().Get(self.time), "i8")
        if len(holes):
            self.glb.note("holes of subdivision surfaces are closed")
        if mesh.GetOrientationAttr().Get() == "leftHanded":
            backwards = numpy.concatenate([numpy.arange(n)[::-1] + s for n, s in zip(counts, numpy.cumsum(counts) - counts)])
        else:
            backwards = numpy.arange(len(corners))
        boundary = {"none": "none", "edgeOnly": "edges"}.get(mesh.GetInterpolateBoundaryAttr().Get(), "edges_and_corners")
        linear = {"none": "smooth", "cornersOnly": "corners", "cornersPlus1": "corners_and_junctions", "cornersPlus2": "corners_and_darts",
                  "boundaries": "boundaries", "all": "linear"}
        members = {"positions": {"accessor": self.glb.vectors(points)}, "face_sizes": {"accessor": self.glb.indices(counts)},
                   "indices": {"accessor": self.glb.indices(corners[backwards])}, "scheme": scheme, "boundary": boundary, "weld": False,
                   "uv_boundary": linear.get(mesh.GetFaceVaryingLinearInterpolationAttr().Get(), "corners_and_junctions"), "levels": 3}
        names = sorted(names, key=lambda n: self.materials.uv_sets[n])
        uv = self.uvs(prim, names[-1])  # the only one but "st", when there is such
        if uv is not None and uv[1] in ("vertex", "varying", "faceVarying"):
            values = uv[0] * (1, -1) + (0, 1)
            if len(values) == len(points if uv[1] != "faceVarying" else corners):
                if uv[1] == "faceVarying":
                    values, which = numpy.unique(values, axis=0, return_inverse=True)
                    members["uv_indices"] = {"accessor": self.glb.indices(which.reshape(-1)[backwards])}
                members["uvs"] = {"accessor": self.glb.vectors(values)}
        self.creases(mesh, members, len(points))
        part = {"class": "SubdivisionSurface", "members": members}
        if material is None:
            colors, opaque = self.colors(mesh)
            color = numpy.mean(colors[0][:, :3], axis=0) if colors is not None else (0.5, 0.5, 0.5)
            if colors is not None and colors[1] != "constant":
                self.glb.note("subdivision surfaces have the mean of their displayColor")
            material = self.glb.same("materials", {"pbrMetallicRoughness": {
                "baseColorFactor": [*(float(max(0, x)) for x in color), 1], "metallicFactor": 0, "roughnessFactor": 0.5}})
        elif by_vertex:
            self.glb.note("colours of points of subdivision surfaces are left out")
        return {"part": part, "material": material}

    def creases(self, mesh, members, points):
        """Runs of edges, each as sharp as one number says or with one for each edge; sharp points."""
        lengths = array(mesh.GetCreaseLengthsAttr().Get(self.time), "i8")
        along = array(mesh.GetCreaseIndicesAttr().Get(self.time), "i8")
        sharp = array(mesh.GetCreaseSharpnessesAttr().Get(self.time), "f8")
        if len(lengths) and lengths.min() >= 2 and lengths.sum() == len(along) and len(along) and along.min() >= 0 and along.max() < points:
            ends = numpy.cumsum(lengths)
            inner = numpy.ones(len(along), bool)
            inner[ends - 1] = False
            first = numpy.nonzero(inner)[0]
            if len(sharp) == len(lengths):
                sharp = numpy.repeat(sharp, lengths - 1)
            if len(sharp) == len(first):
                members["creases"] = {"accessor": self.glb.indices(numpy.stack((along[first], along[first + 1]), axis=1))}
                members["crease_sharpness"] = {"accessor": self.glb.vectors(numpy.clip(sharp, 0, 10))}
        corners = array(mesh.GetCornerIndicesAttr().Get(self.time), "i8")
        sharp = array(mesh.GetCornerSharpnessesAttr().Get(self.time), "f8")
        if len(corners) and len(corners) == len(sharp) and corners.min() >= 0 and corners.max() < points:
            members["corners"] = {"accessor": self.glb.indices(corners)}
            members["corner_sharpness"] = {"accessor": self.glb.vectors(numpy.clip(sharp, 0, 10))}

    # ---- what points, corners or faces have ----------------------------------------------------------------------------------

    def uvs(self, prim, name):
        """Downwards, as in glTF; of what materials call 'st' also those of another name, when a mesh has no 'st'."""
        primvars = UsdGeom.PrimvarsAPI(prim)
        primvar = primvars.FindPrimvarWithInheritance(name)
        if not primvar.HasValue() and name == "st":
            others = [p for p in primvars.FindPrimvarsWithInheritance()
                      if p.GetTypeName().role == "TextureCoordinate" or p.GetPrimvarName() in ("uv", "UVMap", "map1")]
            primvar = others[0] if others else primvar
        values = primvar.ComputeFlattened(self.time) if primvar and primvar.HasValue() else None
        if values is None or len(values) == 0 or len(values[0]) < 2:
            return None
        uv = numpy.array(values, dtype="f4")[:, :2].copy()
        uv[:, 1] = 1 - uv[:, 1]
        return uv, primvar.GetInterpolation()

    def colors(self, mesh):
        """displayColor with displayOpacity, or None; and whether it is opaque."""
        primvar, faded = mesh.GetDisplayColorPrimvar(), mesh.GetDisplayOpacityPrimvar()
        values = primvar.ComputeFlattened(self.time) if primvar and primvar.HasValue() else None
        opacity = faded.ComputeFlattened(self.time) if faded and faded.HasValue() else None
        if values is None or not len(values):
            values = [(0.5, 0.5, 0.5)]
            how = "constant"
        else:
            how = primvar.GetInterpolation()
        colors = numpy.array(values, dtype="f4").reshape(-1, 3)
        if opacity is None or not len(opacity) or min(opacity) >= 1:
            return (colors, how), True
        alpha = numpy.array(opacity, dtype="f4").reshape(-1, 1)
        if len(alpha) == 1:
            alpha = numpy.repeat(alpha, len(colors), axis=0)
        elif len(colors) == 1:
            colors, how = numpy.repeat(colors, len(alpha), axis=0), faded.GetInterpolation()
        if len(alpha) != len(colors):
            self.glb.note("displayOpacity that does not fit displayColor is left out")
            return (colors, how), True
        return (numpy.concatenate((colors, alpha), axis=1), how), False
