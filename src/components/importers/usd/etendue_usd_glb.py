"""A .glb that is put together piece by piece, with the private extensions of src/components/importers/gltf/described.h."""
import json
import struct

import numpy


class Glb:
    def __init__(self):
        self.json = {"asset": {"version": "2.0", "extras": {"notes": []}}}
        self.buffer = bytearray()
        self.known = {}

    def add(self, where, element):
        self.json.setdefault(where, []).append(element)
        return len(self.json[where]) - 1

    def same(self, where, element):
        """The place of an element in a list, to which it is added when it is new."""
        key = (where, json.dumps(element, sort_keys=True))
        if key not in self.known:
            self.known[key] = self.add(where, element)
        return self.known[key]

    def view(self, data):
        self.buffer += bytes(-len(self.buffer) % 4)
        offset = len(self.buffer)
        self.buffer += data
        return self.add("bufferViews", {"buffer": 0, "byteOffset": offset, "byteLength": len(data)})

    def accessor(self, values, component, kind):
        return self.add("accessors", {"bufferView": self.view(values.tobytes()), "componentType": component, "type": kind,
                                      "count": len(values)})

    def vectors(self, values):
        """Numbers, or vectors of 2 to 4."""
        values = numpy.ascontiguousarray(values, dtype="<f4")
        return self.accessor(values, 5126, "SCALAR" if values.ndim == 1 else f"VEC{values.shape[1]}")

    def indices(self, values):
        return self.accessor(numpy.ascontiguousarray(numpy.reshape(values, -1), dtype="<u4"), 5125, "SCALAR")

    def note(self, text):
        notes = self.json["asset"]["extras"]["notes"]
        if text not in notes and len(notes) < 100:
            notes.append(text)

    def write(self, out):
        self.buffer += bytes(-len(self.buffer) % 4)
        self.json["buffers"] = [{"byteLength": len(self.buffer)}]
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        whole = 28 + len(text) + len(self.buffer)
        if whole >= 1 << 32:
            raise ValueError("it holds more than 4 GB")
        out.write(b"glTF" + struct.pack("<II", 2, whole))
        out.write(struct.pack("<I", len(text)) + b"JSON" + text + struct.pack("<I", len(self.buffer)) + b"BIN\0")
        out.write(self.buffer)


def plain(values):
    """As numbers that JSON has; what is none is 0."""
    return [x if abs(x) < float("inf") else 0.0 for x in map(float, values)]
