"""Which files a USD scene may open: those in its own folder, and in folders that the person who reads it allows."""
import os

from pxr import Ar, Sdf, UsdUtils

LAYERS = (".usd", ".usda", ".usdc", ".usdz")


class Files:
    def __init__(self, path, allowed, note):
        self.path, self.note = path, note
        self.folders = [os.path.realpath(folder) for folder in [os.path.dirname(path) or ".", *allowed]]
        self.layers = []  # kept, so that the stage finds them opened

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
        made: it would open them wherever they are."""
        waiting, seen = [self.path], {self.path}
        resolver = Ar.GetResolver()
        while waiting:
            path = waiting.pop()
            layer = Sdf.Layer.FindOrOpen(path)
            if layer is None:
                if path == self.path:
                    raise ValueError("it is no USD file that can be read")
                self.note(f"the layer '{os.path.basename(path)}' cannot be read: it is left out")
                continue
            self.layers.append(layer)
            sublayers, references, payloads = UsdUtils.ExtractExternalReferences(layer.identifier)
            layered = [*sublayers, *payloads, *layer.GetCompositionAssetDependencies()]
            layered += [r for r in references if Ar.SplitPackageRelativePathInner(r)[1].lower().endswith(LAYERS) or r.lower().endswith(LAYERS)]
            for named in dict.fromkeys(layered):
                if not named:
                    continue
                if named.startswith("`"):
                    raise ValueError(f"the file name {named[:80]} is computed, which is not read")
                found = str(resolver.Resolve(layer.ComputeAbsolutePath(named)))
                if not found:
                    self.note(f"there is no file '{named}': it is left out")
                    continue
                self.require(found, named)
                inner = Ar.SplitPackageRelativePathInner(found)[1] or found
                if not inner.lower().endswith(LAYERS):
                    raise ValueError(f"'{named}' is no USD file; other formats are not read within a scene")
                if found not in seen:
                    seen.add(found)
                    waiting.append(found)
