#!/usr/bin/env python3
"""Turns the cameras' spectral sensitivities of the library colour-science into src/color/tables_cameras.cpp.

    pip install colour-science && tools/make_camera_tables.py

The table is committed: building needs neither this script nor the library. Numbers are as published, relative.
"""
import csv
import os
import pathlib
import warnings

warnings.simplefilter("ignore")
import colour

DARRODI = ("M. M. Darrodi, G. Finlayson, T. Goodman and M. Mackiewicz. Reference data set for camera spectral sensitivity estimation. "
           "J. Opt. Soc. Am. A 32, 381-391 (2015); measured with a monochromator at the National Physical Laboratory")
ACADEMY = "Academy of Motion Picture Arts and Sciences, rawtoaces, data of cameras (2017)"


def measured(name):
    camera = colour.MSDS_CAMERA_SENSITIVITIES[name]
    return camera.wavelengths, camera.values


def from_file(name):
    path = os.path.join(os.path.dirname(colour.__file__), "characterisation", "datasets", "rawtoaces", name)
    with open(path, encoding="utf-8") as f:
        rows = [[float(x) for x in row] for row in list(csv.reader(f))[1:]]
    return [r[0] for r in rows], [r[1:] for r in rows]


# identifier, name in the language, other names, citation, data
CAMERAS = [
    ("nikon_d5100", "Nikon D5100", "Nikon 5100 (NPL),Nikon 5100", DARRODI, measured("Nikon 5100 (NPL)")),
    ("sigma_sd1_merrill", "Sigma SD1 Merrill", "Sigma SDMerill (NPL),Sigma SD Merrill,Sigma SDMerrill", DARRODI, measured("Sigma SDMerill (NPL)")),
    ("canon_eos_5d_mark_ii", "Canon EOS 5D Mark II", "Canon 5D Mark II", ACADEMY, from_file("CANON_EOS_5DMark_II_RGB_Sensitivities.csv")),
]


def main():
    text = ("// Made by tools/make_camera_tables.py; do not edit.\n// clang-format off\n\n#include \"color/tables.h\"\n\n"
            "namespace etendue::tables {\n\n// Rows: relative sensitivity of red, green, blue, as colour-science %s (BSD 3-clause licence) has it.\n\n" % colour.__version__)
    entries = []
    for identifier, name, aliases, source, (wavelengths, values) in CAMERAS:
        step = wavelengths[1] - wavelengths[0]
        assert all(abs(b - a - step) < 1e-9 for a, b in zip(wavelengths, wavelengths[1:]))
        assert all(v >= 0 for row in values for v in row)
        words, line = ("Source: " + source + ".").split(), "// %s." % name
        for word in words:
            if len(line) + 1 + len(word) > 120:
                text += line + "\n"
                line = "//"
            line += " " + word
        rows = ["{%s}" % ", ".join("%.6g" % v for v in row) for row in values]
        text += line + "\nstatic constexpr double sensitivity_%s[][3] = {\n" % identifier
        text += "".join("    " + ", ".join(rows[i:i + 4]) + ",\n" for i in range(0, len(rows), 4)) + "};\n\n"
        entries.append('    {"%s", "%s", %g, %g, sensitivity_%s},\n' % (name, aliases, wavelengths[0], step, identifier))
    text += "static constexpr Camera all[] = {\n" + "".join(entries) + "};\nconst std::span<const Camera> cameras = all;\n\n}  // namespace etendue::tables\n"
    (pathlib.Path(__file__).resolve().parent.parent / "src" / "color" / "tables_cameras.cpp").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
