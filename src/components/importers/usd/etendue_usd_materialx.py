"""Materials of USD that are MaterialX: networks of UsdShade whose shaders are nodes of MaterialX's library ("ND_standard_surface_surfaceshader"),
and references to .mtlx documents, for which usd-core alone has no reader."""
import importlib.util
import os
import xml.etree.ElementTree as xml

from pxr import Sdf, Usd, UsdShade

FILE, NAME = "etendue:materialx:file", "etendue:materialx:name"
CONTEXT = "mtlx"


def installed():
    return importlib.util.find_spec("MaterialX") is not None


def layer_of(path):
    """A layer that stands for a .mtlx document: below </MaterialX/Materials>, as UsdMtlx has them, its materials, which say where
    they come from."""
    names = [element.get("name", "") for element in xml.parse(path).getroot().iter("surfacematerial")]
    layer = Sdf.Layer.CreateAnonymous(os.path.basename(path) + ".usda")
    root = Sdf.CreatePrimInLayer(layer, "/MaterialX/Materials")
    layer.defaultPrim = "MaterialX"
    for prim in (root.nameParent, root):
        prim.specifier, prim.typeName = Sdf.SpecifierDef, "Scope"
    for name in dict.fromkeys(names):
        if not Sdf.Path.IsValidIdentifier(name):
            continue
        prim = Sdf.PrimSpec(root, name, Sdf.SpecifierDef, "Material")
        for key, value in ((FILE, path), (NAME, name)):
            Sdf.AttributeSpec(prim, key, Sdf.ValueTypeNames.String, Sdf.VariabilityUniform).default = value
    return layer


def surface_of(material):
    """The shader of MaterialX at the end of a material's network, or None."""
    shader = material.ComputeSurfaceSource(CONTEXT)[0]
    return shader if shader and str(shader.GetIdAttr().Get() or "").startswith("ND_") else None


def source_of(material, stage_path, note):
    """{"file", "name"}: the document that a material of MaterialX is in, which is the scene itself where its network is; or None."""
    prim = material.GetPrim()
    given = [prim.GetAttribute(key).Get() if prim.HasAttribute(key) else None for key in (FILE, NAME)]
    if not all(isinstance(text, str) and text for text in given):
        return {"file": stage_path, "name": name_of(prim)} if surface_of(material) else None
    if any(attribute.HasAuthoredValue() for attribute in prim.GetAttributes() if attribute.GetName().startswith("inputs:")):
        note("values that a scene gives to inputs of a material of a .mtlx document are left out")
    return {"file": given[0], "name": given[1]}


def name_of(prim):
    return "".join(c if c.isalnum() and c.isascii() else "_" for c in str(prim.GetPath())[1:])


def document_of(stage, time):
    """All networks of MaterialX in a stage, as a MaterialX document."""
    import MaterialX as mx
    library = mx.createDocument()
    mx.loadLibraries(mx.getDefaultDataLibraryFolders(), mx.getDefaultDataSearchPath(), library)
    document = mx.createDocument()
    for root in [stage.GetPseudoRoot(), *stage.GetPrototypes()]:
        for prim in Usd.PrimRange(root):
            material = UsdShade.Material(prim) if prim.IsA(UsdShade.Material) else None
            if material and not prim.HasAttribute(FILE) and surface_of(material):
                Network(mx, document, library, time).material(material)
    return mx.writeToXmlString(document)


class Network:
    def __init__(self, mx, document, library, time):
        self.mx, self.document, self.library, self.time = mx, document, library, time
        self.nodes = {}  # by the shader's path

    def material(self, material):
        try:
            surface = self.node(surface_of(material))
            made = self.document.addMaterialNode(self.document.createValidChildName(name_of(material.GetPrim())), surface)
            moved = material.ComputeDisplacementSource(CONTEXT)[0]
            if moved and str(moved.GetIdAttr().Get() or "").startswith("ND_"):
                given = made.addInput("displacementshader", "displacementshader")
                given.setNodeName(self.node(moved).getName())
        except (LookupError, RecursionError):
            return  # the material is not in the document: its reader says so where it is used

    def node(self, shader):
        path = shader.GetPath()
        if path in self.nodes:
            return self.nodes[path]
        kind = str(shader.GetIdAttr().Get() or "")
        definition = self.library.getNodeDef(kind)
        if definition is None:
            raise LookupError(kind)
        node = self.document.addNode(definition.getNodeString(), self.document.createValidChildName(name_of(shader.GetPrim())), definition.getType())
        node.setNodeDefString(kind)
        self.nodes[path] = node
        for given in shader.GetInputs():
            known = definition.getActiveInput(given.GetBaseName())
            if known is not None:
                self.input(node, given, known)
        return node

    def input(self, node, given, known):
        for attribute in given.GetValueProducingAttributes():
            if UsdShade.Utils.GetType(attribute.GetName()) == UsdShade.AttributeType.Output:
                other = self.node(UsdShade.Shader(attribute.GetPrim()))
                made = node.addInput(given.GetBaseName(), known.getType())
                made.setNodeName(other.getName())
                output = UsdShade.Output(attribute).GetBaseName()
                if len(self.library.getNodeDef(other.getNodeDefString()).getActiveOutputs()) > 1:
                    made.setOutputString(output)
                return
            value = attribute.Get(self.time)
            if value is None:
                continue
            made = node.addInput(given.GetBaseName(), known.getType())
            made.setValueString(text_of(value))
            space = str(attribute.GetColorSpace() or given.GetAttr().GetColorSpace() or "")
            if space:
                made.setColorSpace({"sRGB": "srgb_texture", "raw": "none"}.get(space, space))
            return


def text_of(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, Sdf.AssetPath):
        return value.resolvedPath or value.path
    if isinstance(value, (str, int, float)):
        return str(value)
    try:
        rows = [list(row) if hasattr(row, "__len__") else [row] for row in value]
        return ", ".join(f"{x:.9g}" for row in rows for x in row)
    except TypeError:
        return str(value)


def coordinates_of(material):
    """The names of surface coordinates that a network reads, in its order; "st" for the ones it does not name."""
    names = []
    for prim in Usd.PrimRange(material.GetPrim()):
        shader = UsdShade.Shader(prim) if prim.IsA(UsdShade.Shader) else None
        if shader and str(shader.GetIdAttr().Get() or "").startswith("ND_geompropvalue_vector2"):
            named = shader.GetInput("geomprop").Get() if shader.GetInput("geomprop") else None
            if isinstance(named, str) and named and named not in names:
                names.append(named)
    return names or ["st"]
