#!/usr/bin/env python3
"""etendue_materialx.py [--text] FILE [FOLDER ...]: the materials of a MaterialX document as shaders in the Open Shading Language, in JSON on
standard output; what is wrong goes to standard error.

It is started in a process of its own (src/materialx/materialx_document.h). PyPI's package `materialx` reads the document and
writes the shaders; etendue_materialx_shaders.py makes of them what our compiler takes. Files outside of FILE's folder and of the
FOLDERs are not read: neither documents that this one includes, nor images. With --text the document comes from standard input,
as if it stood in FILE, which is of another format.

{"files": [all documents that were read], "include": [folders of the headers that the shaders include], "notes": [texts],
 "texts": [[what stands before a shader, its body]],
 "materials": [{"name", "class", "problem"} or {"name", "class", "surface": shader, "emits", "displacement": shader or null, "vector": bool}]}
with shader = {"frame": its name and parameters with their values, "text": a number in "texts"}. Materials that differ in values only share a text.
"""
import json
import os
import resource
import sys

sys.dont_write_bytecode = True

try:
    import MaterialX as mx
    from etendue_materialx_shaders import Generator, Refused
except ImportError as missing:
    sys.exit(f"MaterialX documents are read by a Python package that is not installed ({missing.name or missing}): pip install materialx; "
             "the environment variable ETENDUE_PYTHON names the Python that has it")

MOST_BYTES = 64 << 20  # of a document with all that it includes


class Files:
    """Which files may be read: those in the document's own folder, and in folders that the person who reads it allows."""

    def __init__(self, path, allowed):
        self.path = path
        self.folders = [os.path.realpath(folder) for folder in [os.path.dirname(path) or ".", *allowed]]
        self.read, self.open, self.bytes = [], [], 0

    def allowed(self, path):
        real = os.path.realpath(path)
        return any(folder == "/" or real == folder or real.startswith(folder + "/") for folder in self.folders)

    def require(self, path, named):
        if not self.allowed(path):
            real = os.path.realpath(path)
            raise Refused(f"'{named}' is outside of the folder of '{self.path}'; --allow-path {os.path.dirname(real)} lets files be read there")

    def document(self, document, path, options):
        """Reads a document, and by `include` those that it includes."""
        path = os.path.abspath(path)
        if path in self.open:
            raise Refused(f"'{path}' includes itself")
        if not os.path.isfile(path):
            raise Refused(f"there is no file '{path}'" if not os.path.exists(path) else f"'{path}' is no file")
        self.bytes += os.path.getsize(path)
        if self.bytes > MOST_BYTES:
            raise Refused(f"the document and what it includes are larger than {MOST_BYTES >> 20} MB")
        self.open.append(path)
        if path not in self.read:
            self.read.append(path)

        def include(inner, name, search_path, inner_options):
            named = name.asString() if hasattr(name, "asString") else str(name)
            found = named if os.path.isabs(named) else os.path.join(os.path.dirname(path), named)
            self.require(found, named)
            self.document(inner, found, inner_options)

        own = mx.XmlReadOptions()
        own.readComments = False
        own.upgradeVersion = options.upgradeVersion if options else True
        own.readXIncludeFunction = include
        mx.readFromXmlFileBase(document, path, mx.FileSearchPath(), own)
        self.open.pop()


def limit(what, wanted):
    """Lower limits that the process was started with stay."""
    soft, hard = resource.getrlimit(what)
    lowest = min([wanted] + [x for x in (soft, hard) if x != resource.RLIM_INFINITY])
    resource.setrlimit(what, (lowest, hard))


def main():
    given = sys.argv[1] == "--text"
    if given:
        del sys.argv[1]
    path = os.path.abspath(sys.argv[1])
    limit(resource.RLIMIT_CORE, 0)
    limit(resource.RLIMIT_AS, 4 << 30)
    started_with = resource.getrlimit(resource.RLIMIT_CPU)[0]
    limit(resource.RLIMIT_CPU, 60)
    files = Files(path, sys.argv[2:])
    document = mx.createDocument()
    if given:
        mx.readFromXmlString(document, sys.stdin.read())
        files.read.append(path)
    else:
        files.document(document, path, None)
    if started_with == resource.RLIM_INFINITY:  # a large document may take longer than a small one that was made to
        hard = resource.getrlimit(resource.RLIMIT_CPU)[1]
        more = 60 + len(document.getMaterialNodes()) // 50
        resource.setrlimit(resource.RLIMIT_CPU, (more if hard == resource.RLIM_INFINITY else min(more, hard), hard))
    made = Generator(document, os.path.dirname(path), files).run(os.path.splitext(os.path.basename(path))[0])
    made["files"] = files.read
    json.dump(made, sys.stdout)


if __name__ == "__main__":
    try:
        main()
    except MemoryError:
        sys.exit(f"it needs more memory than its reader may have ({resource.getrlimit(resource.RLIMIT_AS)[0] >> 20} MB, see 'ulimit -v')")
    except RecursionError:
        sys.exit("its elements are nested too deeply")
    except Exception as error:
        sys.exit(" ".join(str(error).split())[:400] or type(error).__name__)
