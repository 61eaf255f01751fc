#!/usr/bin/env python3
"""Turns spectral data in CSV files into the tables of src/color.

    tools/make_color_tables.py FOLDER_OF_CSV_FILES

Those of metals and glasses are made by tools/make_optical_constants.py. The tables are committed: building needs neither this
script nor the CSV files. Run it again only when data change.
"""
import csv
import pathlib
import sys
import textwrap

LOW, HIGH = 360, 830

# name in files, other names it is known by, name in the language
ILLUMINANTS = [("A", "", "A"), ("D50", "", "D50"), ("D65", "", "D65"), ("E", "", "E"), ("FL2", "FL2", "F2"), ("FL11", "FL11", "F11")]


def read(path):
    """The comment lines, without their marks, and the rows as dictionaries."""
    lines = path.read_text(encoding="utf-8").splitlines()
    comments = [line.lstrip("# ").rstrip() for line in lines if line.startswith("#")]
    return comments, list(csv.DictReader(line for line in lines if not line.startswith("#")))


def literal(text):
    """A C++ literal of type double with the digits of the file."""
    text = text.strip() or "0"
    return text if any(c in text for c in ".eE") else text + ".0"


def rows_of(items, per_line):
    return "\n".join("    " + ", ".join(items[i:i + per_line]) + "," for i in range(0, len(items), per_line))


def comment(lines):
    return "\n".join("// " + part for line in lines for part in textwrap.wrap(line, 120))


def write(folder, name, body):
    text = ("// Made by tools/make_color_tables.py; do not edit.\n// clang-format off\n\n"
            '#include "color/tables.h"\n\nnamespace etendue::tables {\n\n' + body + "\n}  // namespace etendue::tables\n")
    (folder / name).write_text(text, encoding="utf-8")


def observer(source, target):
    comments, rows = read(source / "cie1931_2deg_1nm.csv")
    assert [int(r["wavelength_nm"]) for r in rows] == list(range(LOW, HIGH + 1))
    items = ["{" + ", ".join(literal(r[c]) for c in ("xbar", "ybar", "zbar")) + "}" for r in rows]
    write(target, "tables_observer.cpp", comment(comments) + "\n// Rows: xbar, ybar, zbar.\n"
          "constexpr double observer[size][3] = {\n" + rows_of(items, 2) + "\n};\n\n"
          "constexpr std::array<ObserverRow, size> observer_rows = [] {\n"
          "  double integral = 0;\n"
          "  for (const auto& row : observer) integral += row[1];\n"
          "  std::array<ObserverRow, size> rows{};\n"
          "  for (size_t i = 0; i < size; ++i)\n"
          "    rows[i] = {float(observer[i][0] / integral), float(observer[i][1] / integral), float(observer[i][2] / integral), 0};\n"
          "  return rows;\n"
          "}();\n")


def illuminants(source, target):
    body, names = "", []
    for file, aliases, name in ILLUMINANTS:
        comments, rows = read(source / f"illuminant_{file}.csv")
        rows = [r for r in rows if LOW <= float(r["wavelength_nm"]) <= HIGH]
        nm = [float(r["wavelength_nm"]) for r in rows]
        assert all(b - a == 5 for a, b in zip(nm, nm[1:]))
        body += comment(comments) + f"\nstatic constexpr double power_{name}[] = {{\n" + rows_of([literal(r["power"]) for r in rows], 12) + "\n};\n\n"
        names.append(f'{{"{name}", "{aliases}", {nm[0]:g}, 5, power_{name}}}')
    write(target, "tables_illuminants.cpp", "// Cut to 360-830 nm.\n\n" + body + "static constexpr Illuminant all[] = {\n" + rows_of(names, 1) +
          "\n};\nconst std::span<const Illuminant> illuminants = all;\n")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    source = pathlib.Path(sys.argv[1])
    target = pathlib.Path(__file__).resolve().parent.parent / "src" / "color"
    for make in (observer, illuminants):
        make(source, target)


if __name__ == "__main__":
    main()
