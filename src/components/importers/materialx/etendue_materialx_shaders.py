"""Materials of a MaterialX document as shaders in the Open Shading Language that our compiler takes.

The text is that of MaterialX's own generator, changed in its frame: a shader that others can be connected to becomes a surface
that sets Ci; its parameters get the names of the inputs of the material's surface node, with their texts and ranges; those that
nobody would set, and those of types without members, become variables.
"""
import os
import re

import MaterialX as mx
import MaterialX.PyMaterialXGenOsl as mx_osl
import MaterialX.PyMaterialXGenShader as mx_shader

MOST_TEXT = 4 << 20  # bytes of a shader
MOST_MATERIALS = 20_000
# What may hold text for readers, which does not enter the shader.
PROSE = {"doc", "uiname", "uifolder", "uiadvanced", "enum", "enumvalues", "xpos", "ypos", "version", "colorspace", "contains"}
# Of a surface node: the inputs that let light through it, unless they have these values; the inputs of which one that is 0 makes
# it dark.
LIGHT_THROUGH = {"standard_surface": {"transmission": 0, "opacity": 1}, "open_pbr_surface": {"transmission_weight": 0, "geometry_opacity": 1},
                 "gltf_pbr": {"transmission": 0, "alpha": 1}, "UsdPreviewSurface": {"opacity": 1}}
LIGHT_FROM = {"standard_surface": ("emission", "emission_color"), "open_pbr_surface": ("emission_luminance", "emission_color"),
              "gltf_pbr": ("emissive", "emissive_strength"), "UsdPreviewSurface": ("emissiveColor",), "surface_unlit": ("emission", "emission_color")}
# Words of the language, of descriptions and of the frame: no parameter is named so.
TAKEN = {"Ci", "N", "P", "I", "Ng", "u", "v", "dPdu", "dPdv", "time", "Ps", "normal", "vector", "color", "point", "matrix", "float", "int", "string",
         "out", "output", "if", "else", "for", "while", "do", "return", "break", "continue", "struct", "closure", "void", "shader", "surface",
         "displacement", "volume", "true", "false", "not", "and", "or"}


class Refused(Exception):
    """What is wrong with a document, or with one material of it."""


class Generator:
    def __init__(self, document, folder, files):
        """`files.require(path, named)` throws unless the file may be read; `files.allowed(path)` says whether it may."""
        self.document, self.folder, self.require, self.allowed = document, folder, files.require, files.allowed
        self.notes = []
        self.texts = {}  # of shaders: what stands before them and their bodies, and their numbers
        self.check()  # of the document alone, before the library is there
        path = mx.getDefaultDataSearchPath()
        library = mx.createDocument()
        mx.loadLibraries(mx.getDefaultDataLibraryFolders(), path, library)
        document.setDataLibrary(library)
        self.shaders = mx_osl.OslShaderGenerator.create()
        self.context = mx_shader.GenContext(self.shaders)
        self.context.registerSourceCodeSearchPath(path)
        colors = mx_shader.DefaultColorManagementSystem.create(self.shaders.getTarget())
        colors.loadLibrary(library)
        self.shaders.setColorManagementSystem(colors)
        self.colors = colors
        units = mx_shader.UnitSystem.create(self.shaders.getTarget())
        units.loadLibrary(library)
        converters = mx.UnitConverterRegistry.create()
        for kind in ("distance", "angle"):
            definition = library.getUnitTypeDef(kind)
            converters.addUnitConverter(definition, mx.LinearUnitConverter.create(definition))
        units.setUnitConverterRegistry(converters)
        self.shaders.setUnitSystem(units)
        if hasattr(self.shaders, "registerTypeDefs"):
            self.shaders.registerTypeDefs(document)
        options = self.context.getOptions()
        options.targetDistanceUnit = "meter"
        options.targetColorSpaceOverride = "lin_rec709"
        # Textures of the language begin at the top of an image, surface coordinates of MaterialX at its bottom.
        options.fileTextureVerticalFlip = True
        self.include = [folder for root in path.asString().split(mx.PATH_LIST_SEPARATOR) for folder in
                        [os.path.join(root, "libraries", "stdlib", "genosl", "include")] if os.path.isdir(folder)]

    def note(self, text):
        if text not in self.notes and len(self.notes) < 100:
            self.notes.append(text)

    def run(self, stem):
        self.find_images()
        elements = self.elements()
        if not elements:
            raise Refused("it has no materials: neither surfacematerial nor shader nor output nodes")
        names, made = set(), []
        for element in elements[:MOST_MATERIALS]:
            path = element.getNamePath() if element.getCategory() == "output" else element.getName()
            name = class_name(stem, re.sub("/out$", "", path) if len(elements) > 1 else "", names)
            try:
                made.append({"name": element.getNamePath(), "class": name, **self.material(element, name)})
            except (Refused, LookupError, TypeError, ValueError, RuntimeError, mx.Exception) as error:
                made.append({"name": element.getNamePath(), "class": name, "problem": " ".join(str(error).split())[:400] or type(error).__name__})
        if len(elements) > MOST_MATERIALS:
            self.note(f"more than {MOST_MATERIALS} materials: the others are left out")
        return {"include": self.include, "notes": self.notes, "texts": list(self.texts), "materials": made}

    def shared(self, written):
        """A shader as it is printed: its name and parameters, and the number of its text, which many materials may share."""
        before, frame, body = written
        return {"frame": frame, "text": self.texts.setdefault((before, body), len(self.texts))}

    def elements(self):
        """The materials; of a document that has none, its shaders and outputs."""
        materials = list(self.document.getMaterialNodes())
        return materials or list(mx_shader.findRenderableElements(self.document))

    # ---- what the document may not do ---------------------------------------------------------------------------------------

    def check(self):
        for implementation in self.document.getImplementations():
            if implementation.hasAttribute("file") or implementation.hasAttribute("sourcecode"):
                self.note("nodes of which the document itself brings program code are left out: code is read from MaterialX's library alone")
                self.document.removeChild(implementation.getName())
        for element in self.document.traverseTree():
            for name in element.getAttributeNames():
                text = element.getAttribute(name)
                if name == "value" and "\\" in text and element.getAttribute("type") == "filename":
                    text = text.replace("\\", "/")
                    element.setAttribute(name, text)
                if name in PROSE or element.getCategory() == "comment":
                    continue
                if '"' in text or "\\" in text or any(ord(c) < 32 for c in text):
                    raise Refused(f"'{element.getNamePath()}' has a quotation mark, a backslash or a control character in '{name}'")
            if element.getCategory() in ("texcoord",) or element.getAttribute("defaultgeomprop") == "UV1":
                index = element.getInput("index") if hasattr(element, "getInput") else None
                if index is not None and index.getValueString() not in ("", "0"):
                    self.note("surface coordinates behind the first ('index' of texcoord) are the first")

    # ---- images --------------------------------------------------------------------------------------------------------------

    def find_images(self):
        """All names of files become those of files that are there and may be read; the others are told."""
        mx.flattenFilenames(self.document)
        for element in self.document.traverseTree():
            if element.getAttribute("colorspace") in SPACES:
                element.setAttribute("colorspace", SPACES[element.getAttribute("colorspace")])
        for element in self.document.traverseTree():
            make_linear(element)
            space = element.getAttribute("colorspace")
            if space and space != "none" and not self.known_space(space):
                self.note(f"the colour space '{space[:60]}' is not known: its colours are taken as linear with the primaries of sRGB")
            if element.getAttribute("type") != "filename" or not element.hasAttribute("value"):
                continue
            named = element.getAttribute("value")
            if not named:
                continue
            found = self.image(named, element)
            if found:
                self.require(found, named)
                element.setAttribute("value", found)
            else:
                self.note(f"there is no file '{named[:200]}': the value that its node has without one is used")
                element.setAttribute("value", "")

    def image(self, named, element):
        """Where a file is; of one with <UDIM> in its name, that name with its folder; empty: nowhere. It is searched beside the
        document that names it and, as MaterialX's programs have search paths, in the folders above that may be read; then by
        its name without folders."""
        source = element.getActiveSourceUri()
        beside = os.path.dirname(source) if os.path.isabs(source) else self.folder
        above = [beside]
        while len(above) < 32 and os.path.dirname(above[-1]) != above[-1] and self.allowed(os.path.dirname(above[-1])):
            above.append(os.path.dirname(above[-1]))
        for name in dict.fromkeys([named, os.path.basename(named)]):
            for folder in dict.fromkeys([beside, self.folder, *above] if name == named else [beside]):
                path = os.path.normpath(os.path.join(folder, name))
                if is_image(path):
                    return path
        return ""

    def known_space(self, space):
        return space in ("lin_rec709", "raw", "Raw") or self.document.getNodeDef(f"ND_{space}_to_lin_rec709_color3") is not None

    # ---- shaders -------------------------------------------------------------------------------------------------------------

    def material(self, element, name):
        if element.getType() in ("volumeshader", "lightshader", "VDF") or element.getCategory() == "volumematerial":
            raise Refused("media and lights of their own are not read: it is neither a surface nor a value")
        if element.getType() == "displacementshader":
            raise Refused("it displaces surfaces and has no surface of its own")
        surface = surface_of(element)
        text, emits = self.surface(element, name, surface)
        made = {"surface": self.shared(text), "emits": emits, "displacement": None, "vector": False}
        moved = element.getConnectedNode("displacementshader") if element.getCategory() == "surfacematerial" else None
        if moved is not None:
            text, made["vector"] = self.displacement(moved, name + "Displacement")
            made["displacement"] = self.shared(text)
        return made

    def generated(self, element, name):
        made = self.shaders.generate(name, element, self.context)
        text = made.getSourceCode("pixel")
        if len(text) > MOST_TEXT:
            raise Refused(f"its shader has more than {MOST_TEXT >> 20} MB")
        return made, Frame(text, name)

    def surface(self, element, name, surface):
        made, frame = self.generated(element, name)
        frame.kind = "surface"
        frame.end = {"closure color": "Ci = out;", "MATERIAL": "Ci = out;", "BSDF": "Ci = out;", "EDF": "Ci = out;",
                     "surfaceshader": "Ci = out.opacity * (out.bsdf + out.edf) + (1 - out.opacity) * transparent();",
                     "float": "Ci = color(out) * emission();", "int": "Ci = color(float(out)) * emission();", "color": "Ci = out * emission();",
                     "color4": "Ci = out.rgb * emission();", "vector": "Ci = color(out) * emission();",
                     # Of matrices the diagonal, as MaterialX's own pictures of them.
                     "matrix": "Ci = color(out[0][0], out[1][1], out[2][2]) * emission();",
                     "matrix33": "Ci = color(out.m[0][0], out.m[1][1], out.m[2][2]) * emission();",
                     "vector2": "Ci = color(out.x, out.y, 0) * emission();", "vector4": "Ci = color(out.x, out.y, out.z) * emission();",
                     }.get(frame.result, "")
        if not frame.end:
            raise Refused(f"there is no picture of values of the type {frame.result}")
        described = self.inputs(made, surface)
        frame.name_parameters(described, surface.getName() if surface is not None else "")
        kind = surface.getCategory() if surface is not None else ""
        frame.metadata["help"] = f"The material {element.getName()} of MaterialX" + (f", a {kind}." if kind else ".")
        opaque = frame.values_of(LIGHT_THROUGH.get(kind, {}))
        if opaque:
            frame.metadata["etendue_opaque"] = opaque
        dark = [frame.inner_name(key) for key in LIGHT_FROM.get(kind, ())]
        shines = re.search(r"_edf\b|\bemission\(", frame.text + frame.body) is not None
        emits = shines and frame.result != "BSDF" and not any(frame.is_zero(key) for key in dark if key)
        return frame.written(name), emits or "emission()" in frame.end

    def displacement(self, node, name):
        """A map: how far P moves along the normal, or with three outputs along the tangents and the normal."""
        made, frame = self.generated(node, name)
        definition = node.getNodeDef()
        vector = definition is not None and definition.getActiveInput("displacement") is not None \
            and definition.getActiveInput("displacement").getType() == "vector3"
        frame.kind = "shader"
        frame.name_parameters(self.inputs(made, node), node.getName())
        frame.outputs, frame.end = (("x", "y", "z"), "x = out[0]; y = out[1]; z = out[2];") if vector else (("height",), "height = out[0];")
        frame.metadata["help"] = "How far a material of MaterialX moves the surface."
        return frame.written(name), vector

    def inputs(self, made, surface):
        """{parameter: {"name", "help", "min", "max", ...}} of those that somebody may want to set."""
        found, definitions = {}, {}
        block = made.getStage("pixel").getUniformBlock("u")
        for i in range(block.size()):
            port = block[i]
            path = port.getPath()
            element = self.document.getDescendant(path) if path else None
            node, key = path.rsplit("/", 1) if "/" in path else (path, "")
            if node not in definitions:
                owner = self.document.getDescendant(node) if key else None
                definitions[node] = owner.getNodeDef() if isinstance(owner, mx.Node) else None
            definition = definitions[node].getActiveInput(key) if definitions[node] is not None else None
            described = {"own": surface is not None and node == surface.getNamePath(), "key": key, "node": node}
            for source in (definition, element):
                for attribute in ("uimin", "uimax", "uisoftmin", "uisoftmax", "doc", "uifolder"):
                    if source is not None and source.getAttribute(attribute):
                        described[attribute] = source.getAttribute(attribute)
            found[port.getVariable()] = described
        return found


def is_image(path):
    if "<UDIM>" not in path:
        return os.path.isfile(path)
    folder, pattern = os.path.dirname(path), re.escape(os.path.basename(path)).replace("<UDIM>", r"\d{4}")
    return os.path.isdir(folder) and any(re.fullmatch(pattern, name) for name in os.listdir(folder))


# Other names of colour spaces that the library knows.
SPACES = {"lin_rec709_scene": "lin_rec709", "srgb_rec709_scene": "srgb_texture", "lin_ap1_scene": "acescg", "lin_ap1": "acescg",
          "gamma22": "g22_rec709", "gamma18": "g18_rec709", "gamma24": "rec709_display", "g22_rec709_scene": "g22_rec709",
          "g18_rec709_scene": "g18_rec709", "lin_p3d65_scene": "lin_displayp3", "srgb_p3d65_scene": "srgb_displayp3"}


def make_linear(element):
    """A colour that is written encoded becomes the linear one, as the parameter that it is will be set by linear colours."""
    decode = DECODED.get(element.getActiveColorSpace()) if element.getAttribute("type") in ("color3", "color4") else None
    words = element.getAttribute("value").split(",") if decode and element.getCategory() == "input" else []
    if len(words) < 3:
        return
    try:
        values = [float(word) for word in words]
    except ValueError:
        return  # the generator says what is wrong with it
    element.setAttribute("value", ", ".join(f"{x:.9g}" for x in [*map(decode, values[:3]), *values[3:]]))
    element.setAttribute("colorspace", "lin_rec709")


# Of colour spaces with the primaries of sRGB: light from what is written.
DECODED = {"srgb_texture": lambda x: x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4,
           "g22_rec709": lambda x: max(x, 0.0) ** 2.2, "g18_rec709": lambda x: max(x, 0.0) ** 1.8}


def surface_of(element):
    """The surface node of a material; an element that is one itself."""
    if element.getCategory() == "surfacematerial":
        return element.getConnectedNode("surfaceshader")
    return element if element.getType() == "surfaceshader" and isinstance(element, mx.Node) else None


def class_name(stem, material, names):
    """A document's only material is named after the file, of several each by both."""
    words = [camel(stem), camel(material)]
    if words[1] and words[0].lower().endswith(words[1].lower()):
        words[1] = ""
    name = "".join(words) or "Material"
    if not name[0].isalpha():
        name = "Material" + name
    wanted, i = name[:100], 2
    while name in names:
        name, i = f"{wanted}{i}", i + 1
    names.add(name)
    return name


def camel(text):
    return "".join(word[:1].upper() + word[1:] for word in re.split("[^A-Za-z0-9]+", text))


RANGES = ("min", "max", "slidermin", "slidermax")

# "    string file = "a.png"" of the shader's list of parameters; metadata follow.
NAME = re.compile("[A-Za-z][A-Za-z0-9_]*")
WORD = re.compile(r"\b[A-Za-z_]\w*\b")
# "    closure color S_out = ...": a variable of the shader's body, not of a block in it.
LOCAL = re.compile(r"^    (?:closure color|[A-Za-z_]\w*) ([A-Za-z_]\w*)(?= = |;)", re.M)
PARAMETER = re.compile(r"^    (output )?(\w+) (\w+) = (.*?)(,?)$")


# Our closures of MaterialX are those of this version of the language.
VERSION = "#undef OSL_VERSION_MINOR\n#define OSL_VERSION_MINOR 14\n"


class Frame:
    """A generated shader in three pieces: what stands before it, its parameters, its body."""

    def __init__(self, text, name):
        parts = re.search(r"^(?:shader|surface) (\w+)\n\[\[.*?^\]\]\n\(\n(.*?)^\)\n\{\n(.*)^\}\s*\Z", text, re.M | re.S)
        if not parts:
            raise Refused("the package's generator writes shaders of a form that is not known here")
        self.text = VERSION + text[:parts.start()]
        self.body = parts.group(3)
        self.kind, self.end, self.outputs, self.metadata = "surface", "", (), {}
        self.result, self.result_value, self.result_name = "", "", ""
        self.words = set(re.findall(r"\w+", self.body))
        self.renamed = {}  # names of the body, and what they become when it is written
        self.parameters = []  # [type, name, value, {metadata}]
        for line in parts.group(2).split("\n"):
            given = PARAMETER.match(line)
            if given and given.group(1):
                self.result, self.result_name, self.result_value = given.group(2), given.group(3), given.group(4)
            elif given:
                self.parameters.append([given.group(2), given.group(3), given.group(4), {}])
            elif 'widget = "filename"' in line:
                self.parameters[-1][3]["widget"] = '"filename"'
            elif 'widget = "checkBox"' in line:
                self.parameters[-1][3]["widget"] = '"checkBox"'
        if self.result_name != "out":
            self.rename(self.result_name, "out")
        self.inner = {}  # of an input of the surface node: its parameter

    def rename(self, old, new):
        self.renamed[old] = new
        self.words.discard(old)
        self.words.add(new)

    def rename_locals(self):
        """Names of variables, which the generator makes from those of the document's nodes, become numbers: then materials that differ in
        names and values only have one text."""
        count = 0
        for name in dict.fromkeys(LOCAL.findall(self.body)):
            while f"value{count}" in self.words:
                count += 1
            if name not in TAKEN and name not in self.renamed and name != "out":
                self.rename(name, f"value{count}")

    def free(self, name):
        """Whether nothing in the shader is called so."""
        return NAME.fullmatch(name) and name not in TAKEN and name not in self.words and all(p[1] != name for p in self.parameters)

    def name_parameters(self, described, surface):
        kept, variables = [], []
        for parameter in self.parameters:
            kind, name, value, metadata = parameter
            about = described.get(name, {})
            key = about.get("key", "")
            plain = kind in ("float", "int", "color", "vector", "point", "normal") or metadata.get("widget") == '"filename"'
            meant = not name.startswith("geomprop_") and key not in ("frameoffset", "space", "index", "layer", "framerange")
            if not plain or not meant:
                variables.append(parameter)
                continue
            if about.get("own") and self.free(key):
                self.rename(name, key)
                parameter[1] = key
            if about.get("own"):
                self.inner[key] = parameter
            if about.get("doc"):
                metadata["help"] = quoted(about["doc"])
            if not about.get("own") and about.get("node"):
                metadata["page"] = quoted(about["node"])
            elif about.get("uifolder"):
                metadata["page"] = quoted(about["uifolder"])
            if kind in ("float", "int"):
                for attribute, meta in (("uimin", "min"), ("uimax", "max"), ("uisoftmin", "slidermin"), ("uisoftmax", "slidermax")):
                    if re.fullmatch(r"-?\d+(\.\d+)?", about.get(attribute, "")):
                        metadata[meta] = about[attribute]
            kept.append(parameter)
        self.parameters, self.variables = kept, variables

    def inner_name(self, key):
        return self.inner[key][1] if key in self.inner else ""

    def is_zero(self, name):
        return any(p[1] == name and all(float(x) == 0 for x in re.findall(r"-?\d+\.?\d*", p[2])) for p in self.parameters)

    def values_of(self, wanted):
        """"transmission=0 opacity=1", by the parameters' names; empty: not all of these can be set."""
        names = [(self.inner_name(key), value) for key, value in wanted.items()]
        return " ".join(f"{name}={value}" for name, value in names) if names and all(name for name, _ in names) else ""

    def written(self, name):
        """(what stands before the shader, its name and parameters, its body)"""
        self.rename_locals()
        body = WORD.sub(lambda word: self.renamed.get(word.group(), word.group()), self.body)
        lines = ["", f"{self.kind} {name}", "[["]
        lines.append(",\n".join(f"    string {key} = {quoted(value)}" for key, value in self.metadata.items()))
        lines += ["]]", "("]
        signature = []
        for kind, parameter, value, metadata in self.parameters:
            meta = [f"{kind if key in RANGES else 'string'} {key} = {given}" for key, given in metadata.items()]
            signature.append(f"    {kind} {parameter} = {value}" + (f" [[ {', '.join(meta)} ]]" if meta else ""))
        signature += [f"    output float {output} = 0" for output in self.outputs]
        lines += [",\n".join(signature), ")", ""]
        inner = [f"    {kind} {self.renamed.get(variable, variable)} = {self.known(value)};" for kind, variable, value, _ in self.variables]
        inner = ["{", *inner, f"    {self.result} out = {self.result_value};", body.rstrip("\n"), f"    {self.end}", "}", ""]
        return self.text.rstrip("\n") + "\n", "\n".join(lines), "\n".join(inner)

    @staticmethod
    def known(value):
        """Space "model" is that of the object, before it was deformed."""
        return '"object"' if value == '"model"' else value


def quoted(text):
    return '"' + " ".join(text.replace("\\", "/").replace('"', "'").split()) + '"'
