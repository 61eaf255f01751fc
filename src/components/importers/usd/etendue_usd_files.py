"""Which files a USD scene may open: those in its own folder, and in folders that the person who reads it allows."""
import os
import re

from pxr import Ar, Sdf, Tf, UsdUtils

from etendue_usd_materialx import layer_of

LAYERS = (".usd", ".usda", ".usdc", ".usdz")


class Files:
    def __init__(self, path, allowed, note):
        self.path, self.note = path, note
        self.folders = [os.path.realpath(folder) for folder in [os.path.dirname(path) or ".", *allowed]]
        self.documents = {}  # of MaterialX, by path: the layers that stand for them
        self.layers = {}  # by path; kept, so that the stage finds them opened and as they were made here. None: not read

    def refused(self, path):
        """The folder of a file that may not be read, or nothing."""
        outer = os.path.realpath(Ar.SplitPackageRelativePathOuter(path)[0])
        inside = any(outer == folder or outer.startswith(folder.rstrip("/") + "/") for folder in self.folders)
        return None if inside else os.path.dirname(outer)

    def require(self, path, named):
        folder = self.refused(path)
        if folder is not None:
            raise ValueError(f"'{named}' is outside of the folder of '{self.path}'; --allow-path {folder} lets files be read there")

    def check_layers(self):
        """Follows all sublayers, references, payloads and clips, those in variants that are not chosen too, before a stage is
        made: it would open them wherever they are. What is not read is taken out, in memory, and told."""
        waiting, seen = [self.path], {self.path}
        while waiting:
            path = waiting.pop()
            layer, unread, instead = self.opened(path), set(), {}
            for named in self.named_layers(layer):
                found = self.found(layer, named)
                if found is not None and found.lower().endswith(".mtlx"):
                    instead[named] = self.materialx(found, named)
                    continue
                if found is None or (found not in seen and self.opened(found) is None):
                    unread.add(named)
                elif found not in seen:
                    seen.add(found)
                    waiting.append(found)
            if unread or instead:
                take_out(layer, unread, instead, self.note)

    def materialx(self, path, named):
        """The layer that stands for a MaterialX document; of one that cannot be read, without materials."""
        if path not in self.documents:
            try:
                self.documents[path] = layer_of(path)
            except (OSError, SyntaxError, ValueError) as error:
                self.note(f"the MaterialX document '{named}' cannot be read: {words_of(error)[:200]}: its materials are grey")
                self.documents[path] = Sdf.Layer.CreateAnonymous()
        return self.documents[path]

    def opened(self, path):
        """A layer, or None, which is told; an error where it is the scene itself."""
        if path in self.layers:
            return self.layers[path]
        try:
            layer, why = Sdf.Layer.FindOrOpen(path), ""
        except Tf.ErrorException as error:
            if path == self.path:
                raise
            layer, why = None, ": " + words_of(error)[:200]
        if layer is None:
            if path == self.path:
                raise ValueError("it is no USD file that can be read")
            self.note(f"the layer '{os.path.basename(path)}' cannot be read and is left out{why}")
        self.layers[path] = layer
        return layer

    @staticmethod
    def named_layers(layer):
        sublayers, references, payloads = UsdUtils.ExtractExternalReferences(layer.identifier)
        layered = [*sublayers, *payloads, *layer.GetCompositionAssetDependencies()]
        read = (*LAYERS, ".mtlx")
        layered += [r for r in references if Ar.SplitPackageRelativePathInner(r)[1].lower().endswith(read) or r.lower().endswith(read)]
        return [named for named in dict.fromkeys(layered) if named]

    def found(self, layer, named):
        """Where a layer is that another names; None: it is not read, which is told."""
        if named.startswith("`"):
            self.note(f"the file name {named[:80]} is computed: what it stands for is left out")
            return None
        found = str(Ar.GetResolver().Resolve(layer.ComputeAbsolutePath(named)))
        if not found:
            self.note(f"there is no file '{named}': it is left out")
            return None
        inner = Ar.SplitPackageRelativePathInner(found)[1] or found
        packed = Ar.IsPackageRelativePath(found)
        if inner.lower().endswith(".mtlx") and packed:
            self.note(f"'{named}' is a MaterialX document within a package, which is not read: its materials are grey")
            return None
        if not inner.lower().endswith((*LAYERS, ".mtlx")):
            self.note(f"'{named}' is no USD file; other formats are not read within a scene: it is left out")
            return None
        self.require(found, named)
        return found


def take_out(layer, unread, instead, note):
    """Sublayers, references and payloads of these names; those of `instead` are replaced by the layers there."""
    layer.SetPermissionToEdit(True)
    for i, path in enumerate(layer.subLayerPaths):
        if path in instead:
            layer.subLayerPaths[i] = instead[path].identifier
    for i in reversed(range(len(layer.subLayerPaths))):
        if layer.subLayerPaths[i] in unread:
            del layer.subLayerPaths[i]

    def visit(path):
        prim = layer.GetPrimAtPath(path) if path.IsPrimPath() or path.IsPrimVariantSelectionPath() else None
        for key in ("references", "payload"):
            if not prim or not prim.HasInfo(key):
                continue
            items = prim.GetInfo(key)
            for kind in ("explicitItems", "addedItems", "prependedItems", "appendedItems"):
                given = getattr(items, kind)
                left = [other(item, instead) for item in given if item.assetPath not in unread and is_there(item, instead, note)]
                if left != list(given):
                    setattr(items, kind, left)
            prim.SetInfo(key, items)

    layer.Traverse(Sdf.Path.absoluteRootPath, visit)


def other(item, instead):
    """A reference or payload to what stands for its file."""
    if item.assetPath not in instead:
        return item
    return type(item)(instead[item.assetPath].identifier, item.primPath, item.layerOffset)


def is_there(item, instead, note):
    """Whether what stands for a file has the prim that is referred to; what it has not is told."""
    if item.assetPath not in instead or item.primPath.isEmpty or instead[item.assetPath].GetPrimAtPath(item.primPath):
        return True
    note(f"'{item.assetPath}' has no material <{item.primPath}>: objects that are bound to it are grey")
    return False


def words_of(error):
    """What the library finds wrong, without the places in its own source and the types of its C++ functions."""
    words = re.sub(r"Error in '\S*' at line \d+ in file \S+ : ", "", " ".join(str(error).split()))
    words = re.sub(r"Python argument types in (\S*?)\(.*did not match C\+\+ signature.*", r"\1 of USD's library takes values of another type", words)
    return words.strip("' ")
