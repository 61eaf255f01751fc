#!/usr/bin/env python3
"""Turns the data set of the Hosek-Wilkie sky model into the tables of src/components/emission.

    tools/make_sky_tables.py sunsky_datasets.bin

The file is the one Mitsuba 3 ships in data/sunsky: named arrays of doubles. The tables are committed: building needs neither
this script nor the file. The channel of 320 nm is left out; the sun's cubic pieces become the values and slopes at their ends.
"""
import pathlib
import struct
import sys

import numpy

LICENCE = """// Copyright (c) 2012 - 2013, Lukas Hosek and Alexander Wilkie
// All rights reserved.
//
// Redistribution and use in source and binary forms, with or without modification, are permitted provided that the following
// conditions are met:
//
//     * Redistributions of source code must retain the above copyright notice, this list of conditions and the following
//       disclaimer.
//     * Redistributions in binary form must reproduce the above copyright notice, this list of conditions and the following
//       disclaimer in the documentation and/or other materials provided with the distribution.
//     * None of the names of the contributors may be used to endorse or promote products derived from this software without
//       specific prior written permission.
//
// THIS SOFTWARE IS PROVIDED BY THE COPYRIGHT HOLDERS AND CONTRIBUTORS "AS IS" AND ANY EXPRESS OR IMPLIED WARRANTIES, INCLUDING,
// BUT NOT LIMITED TO, THE IMPLIED WARRANTIES OF MERCHANTABILITY AND FITNESS FOR A PARTICULAR PURPOSE ARE DISCLAIMED. IN NO EVENT
// SHALL THE COPYRIGHT HOLDERS BE LIABLE FOR ANY DIRECT, INDIRECT, INCIDENTAL, SPECIAL, EXEMPLARY, OR CONSEQUENTIAL DAMAGES
// (INCLUDING, BUT NOT LIMITED TO, PROCUREMENT OF SUBSTITUTE GOODS OR SERVICES; LOSS OF USE, DATA, OR PROFITS; OR BUSINESS
// INTERRUPTION) HOWEVER CAUSED AND ON ANY THEORY OF LIABILITY, WHETHER IN CONTRACT, STRICT LIABILITY, OR TORT (INCLUDING
// NEGLIGENCE OR OTHERWISE) ARISING IN ANY WAY OUT OF THE USE OF THIS SOFTWARE, EVEN IF ADVISED OF THE POSSIBILITY OF SUCH
// DAMAGE.
"""


def load(path):
    data = pathlib.Path(path).read_bytes()
    assert data[:12] == b"tensor_file\0"
    count, at, arrays = struct.unpack_from("<I", data, 14)[0], 18, {}
    for _ in range(count):
        length, = struct.unpack_from("<H", data, at)
        name = data[at + 2:at + 2 + length].decode()
        at += 2 + length
        dimensions, kind, offset = struct.unpack_from("<HBQ", data, at)
        shape = struct.unpack_from(f"<{dimensions}Q", data, at + 11)
        at += 11 + 8 * dimensions
        assert kind == 11  # doubles
        arrays[name] = numpy.frombuffer(data, "<f8", int(numpy.prod(shape)), offset).reshape(shape)
    return arrays


def sun(pieces):
    """Values and slopes [per radian] at the 46 borders of the pieces, whose cubics meet smoothly."""
    borders = numpy.pi / 2 * (numpy.arange(46) / 45) ** 3
    c = numpy.moveaxis(pieces, 1, 2)  # turbidity, channel, piece, power
    width = borders[45] - borders[44]
    values = numpy.append(c[..., 0], numpy.polynomial.polynomial.polyval(width, c[:, :, 44].transpose(2, 0, 1))[..., None], 2)
    end = c[:, :, 44, 1] + 2 * width * c[:, :, 44, 2] + 3 * width**2 * c[:, :, 44, 3]
    slopes = numpy.append(c[..., 1], end[..., None], 2)
    slopes[..., :3] = 0  # below 0.03 degrees the data jump
    return numpy.stack([values, slopes], -1)


def number(x, digits):
    text = f"{float(x):.{digits}g}".replace("e-0", "e-").replace("e+0", "e")
    text = text.replace("-0.", "-.") if text.startswith("-0.") else text[1:] if text.startswith("0.") else text
    return text + "f" if "." in text or "e" in text else text


def rows(array, per_line, digits):
    items = [number(x, digits) for x in array.ravel()]
    return "\n".join("    " + ", ".join(items[i:i + per_line]) + "," for i in range(0, len(items), per_line))


def write(path, parts):
    text = ("// clang-format off\n// Made by tools/make_sky_tables.py; do not edit.\n"
            "// Data of the sky model of Hosek & Wilkie 2012 (An analytic model for full spectral sky-dome radiance) and 2013 (Adding\n"
            "// a solar-radiance function to the Hosek-Wilkie skylight model), as in the file sunsky_datasets.bin of Mitsuba 3.\n//\n" +
            LICENCE + "\n"
            '#include "components/emission/sky_tables.h"\n\nnamespace etendue::sky_tables {\n\n' + "\n".join(parts) +
            "\n}  // namespace etendue::sky_tables\n")
    path.write_text(text, encoding="utf-8")


def table(name, array, per_line, digits):
    return f"const float {name}[{array.size}] = {{\n{rows(array, per_line, digits)}\n}};\n"


arrays = load(sys.argv[1])
folder = pathlib.Path(__file__).resolve().parent.parent / "src" / "emission"
write(folder / "sky_tables_shape.cpp", [table("shape", arrays["sky_params_spec"][:, :, :, 1:], 9, 7)])
write(folder / "sky_tables_radiance.cpp", [
    table("radiance", arrays["sky_rad_spec"][:, :, :, 1:], 9, 7),
    table("sun", sun(arrays["sun_rad_spec"])[:, 1:], 10, 6),
    table("limb", arrays["sun_ld_spec"][1:], 6, 7)])
