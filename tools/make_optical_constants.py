#!/usr/bin/env python3
"""Turns published optical constants into the tables of metals and glasses of src/color.

    tools/make_optical_constants.py DATABASE MITSUBA_IOR

DATABASE is the folder `database/data` of refractiveindex.info (github.com/polyanskiy/refractiveindex.info-database, CC0 1.0),
commit ff11b5897ef0754b15d939d921eb6c745693cbd1 of 14 June 2026. MITSUBA_IOR is the folder `mitsuba/data/ior` that the Python
package `mitsuba` 3.9.1 installs: rows of the luxpop.com tables, which for most materials are those of Palik's handbook.

Where both have the same measurement, it is taken from the first. Needs numpy, scipy and PyYAML. The tables are committed:
building needs neither this script nor the data.
"""
import html
import math
import pathlib
import re
import sys
import textwrap

import numpy
import scipy.optimize
import yaml

from optical_constants_sources import GLASSES, LEFT_OUT, LUXPOP, METALS, PAGE, PALIK1, PALIK2, SCHOTT

LOW, HIGH = 360, 830  # [nm]
MANY = 60             # rows of a table that is thinned out

# ---- reading ----------------------------------------------------------------------------------------------------------------


def page(database, name):
    return yaml.safe_load((database / (name + ".yml")).read_text(encoding="utf-8"))


def plain(text):
    """Without the marks of HTML; the first of several references."""
    text = html.unescape(re.sub(r"<[^>]*>", "", re.split(r"<br ?/?>|\n\s*2\)", str(text))[0]))
    return re.sub(r"^1\) ", "", " ".join(text.replace("\u2009", " ").split())).strip()


def rows_of_page(database, name):
    """Wavelengths [nm], n and k, where n and k are on the same wavelengths."""
    for data in page(database, name)["DATA"]:
        if data["type"] == "tabulated nk":
            table = numpy.array([[float(x) for x in line.split()] for line in data["data"].split("\n") if line.strip()])
            return table[:, 0] * 1e3, table[:, 1], table[:, 2]
    raise ValueError(name)


def rows_of_mitsuba(folder, name):
    def part(of):
        lines = (folder / f"{name}.{of}.spd").read_text(encoding="utf-8").splitlines()
        return numpy.array([[float(x) for x in line.split()] for line in lines if line.strip() and not line.startswith("#")])

    n, k = part("eta"), part("k")
    assert (n[:, 0] == k[:, 0]).all()
    sound = (n[:, 1] > 0) & ~numpy.isin(n[:, 0], LEFT_OUT.get(name, ([],))[0])
    return n[sound, 0], n[sound, 1], k[sound, 1]


# ---- metals -----------------------------------------------------------------------------------------------------------------


def reflectance(n, k):
    return ((n - 1)**2 + k**2) / ((n + 1)**2 + k**2)


def needed(w, n, k):
    """Which rows are needed so that those left out are met by straight lines: n and k within 0.2 % and 0.001, the reflectance
    at normal incidence within 0.1 %."""

    def met(a, b):
        inner = slice(a + 1, b)
        t = (w[inner] - w[a]) / (w[b] - w[a])
        nn, kk = n[a] + t * (n[b] - n[a]), k[a] + t * (k[b] - k[a])
        r = reflectance(n[inner], k[inner])
        return ((abs(nn - n[inner]) <= 0.001 + 0.002 * n[inner]).all() and (abs(kk - k[inner]) <= 0.001 + 0.002 * k[inner]).all()
                and (abs(reflectance(nn, kk) - r) <= 0.001 * r).all())

    kept = [0]
    while kept[-1] < len(w) - 1:
        end = kept[-1] + 1
        while end + 1 < len(w) and met(kept[-1], end + 1):
            end += 1
        kept.append(end)
    return kept


def visible(w, n, k):
    """From the last row up to LOW to the first one from HIGH on."""
    first = max(numpy.searchsorted(w, LOW, "right") - 1, 0)
    last = min(numpy.searchsorted(w, HIGH, "left"), len(w) - 1)
    return (x[first:last + 1] for x in (w, n, k))


def number(x, digits):
    text = f"{x:.{digits}g}"
    return text if any(c in text for c in ".e") else text + ".0"


def identifier(name):
    return "index_" + re.sub(r"\W", "_", name)


def metal(database, ior, name, _aliases, what, source, file=None):
    """The C++ text of one table."""
    from_package = source in (PALIK1, PALIK2, LUXPOP)
    w, n, k = visible(*(rows_of_mitsuba(ior, file or name) if from_package else rows_of_page(database, source)))
    low, high = w[0], w[-1]
    kept = needed(w, n, k) if len(w) > MANY else range(len(w))
    rows = [(w[i], n[i], k[i]) for i in kept]
    ends = []
    if low > LOW:
        rows.insert(0, (LOW, *rows[0][1:]))
        ends.append(f"below {low:g}")
    if high < HIGH:
        rows.append((HIGH, *rows[-1][1:]))
        ends.append(f"above {high:g}")
    if from_package:
        cited = f"{source}; as Mitsuba's Python package 3.9.1 has it, data/ior/{file or name}.eta.spd and .k.spd."
    else:
        cited = f"{plain(page(database, source)['REFERENCES'])}. By refractiveindex.info (CC0 1.0), {source}."
    lines = [f"Complex refractive index n + i k of {what} ({name})." if what != name else f"Complex refractive index n + i k of {name}.",
             "Source: " + cited.replace("..", ".")]
    if ends:
        lines.append(f"Held constant {' and '.join(ends)} nm.")
    if from_package and (file or name) in LEFT_OUT:
        lines.append(LEFT_OUT[file or name][1])
    items = ["{" + ", ".join((number(a, 9), number(b, 7), number(c, 7))) + "}" for a, b, c in rows]
    return (comment(lines) + f"\nstatic constexpr double {identifier(name)}[][3] = {{\n" + rows_text(items, 4) + "\n};\n\n")


def metals(database, ior, target):
    for file, (variable, entries) in METALS.items():
        body = "// Rows: wavelength [nm], n, k.\n\n" + "".join(metal(database, ior, *entry) for entry in entries)
        names = [f'{{"{e[0]}", "{e[1]}", {identifier(e[0])}}}' for e in entries]
        write(target, file, body + "static constexpr Metal all[] = {\n" + rows_text(names, 1) +
              f"\n}};\nconst std::span<const Metal> {variable} = all;\n")


def metals_page(database, ior):
    """The rows of docs/optical-constants.md."""
    for file, (_, entries) in METALS.items():
        for name, aliases, what, source, *_other in entries:
            from_package = source in (PALIK1, PALIK2, LUXPOP)
            w, n, k = rows_of_mitsuba(ior, _other[0] if _other else name) if from_package else rows_of_page(database, source)
            r = [f"{reflectance(numpy.interp(at, w, n), numpy.interp(at, w, k)):.3f}" for at in (450, 550, 650)]
            cited = {PALIK1: "Palik 1985", PALIK2: "Palik 1991", LUXPOP: "luxpop.com"}.get(source) or short(page(database, source), source)
            measured = f"{max(w[0], LOW):.0f}-{min(w[-1], HIGH):.0f}"
            yield f"| {quoted([name, *aliases.split(',')])} | {what} | {' '.join(r)} | {measured} | {cited} |"


def short(data, source):
    """The first author and the year."""
    if source.startswith(SCHOTT):
        return "SCHOTT 2017"
    text = plain(data["REFERENCES"])
    year = re.search(r"\(((?:19|20)\d\d)\)", text) or re.search(r"\b((?:19|20)\d\d)\b", text)
    author = re.split(r"[-.]", source.split("/")[-1])[0]
    return author + (" " + year[1] if year else "")


def quoted(names):
    return ", ".join(f"`{name}`" for name in names if name)


# ---- glasses ----------------------------------------------------------------------------------------------------------------


def by_formula(kind, c, w):
    """The dispersion formulas of refractiveindex.info, at wavelengths in nm."""
    l = w * 1e-3
    pairs = list(zip(c[1::2], c[2::2]))
    if kind == 1:
        return numpy.sqrt(1 + c[0] + sum(b * l**2 / (l**2 - x**2) for b, x in pairs))
    if kind == 2:
        return numpy.sqrt(1 + c[0] + sum(b * l**2 / (l**2 - x) for b, x in pairs))
    if kind == 3:
        return numpy.sqrt(c[0] + sum(b * l**x for b, x in pairs))
    if kind == 4:
        terms = [c[i:i + 4] for i in range(1, min(9, len(c)), 4)]
        return numpy.sqrt(c[0] + sum(t[0] * l**t[1] / (l**2 - t[2]**t[3]) for t in terms) + sum(b * l**x for b, x in zip(c[9::2], c[10::2])))
    if kind == 5:
        return c[0] + sum(b * l**x for b, x in pairs)
    if kind == 6:
        return 1 + c[0] + sum(b / (x - l**-2) for b, x in pairs)
    raise ValueError(kind)


def fitted(w, n):
    """Sellmeier's formula through given indices: a constant, one or two resonances in the ultraviolet and one in the infrared."""
    l2 = (w * 1e-3)**2

    def solve(c):
        terms = numpy.stack([l2 / (l2 - x) for x in c], 1)
        b = numpy.linalg.lstsq(terms / (2 * n)[:, None], (n**2 - 1) / (2 * n), rcond=None)[0]
        return b, abs(numpy.sqrt(1 + terms @ b) - n).max()

    def worst(x):
        return solve([0, *x, 100])[1]

    one = scipy.optimize.minimize_scalar(lambda x: worst([x]), bounds=(1e-4, 0.1), method="bounded").x
    b, error = solve([0, one, 100])
    return b, [0, one, 100], error


PAGE_OF_GLASSES = []


def glass(database, name, aliases, source):
    data = page(database, source)
    cited = plain(data["REFERENCES"])
    cited = "SCHOTT optical glass catalogue of 20 January 2017" if "SCHOTT Zemax" in cited else cited
    conditions = data.get("CONDITIONS") or {}
    if "temperature" in conditions:
        cited += f", at {conditions['temperature'] - 273.15 if conditions['temperature'] != 293 else 20:g} C"
    note = ""
    index = next(d for d in data["DATA"] if "formula" in d["type"] or d["type"].split()[1] in ("n", "nk"))
    if "formula" in index["type"]:
        kind = int(index["type"].split()[1])
        c = [float(x) for x in str(index["coefficients"]).split()]
        low, high = (float(x) * 1e3 for x in index["wavelength_range"].split())
        b, r = c[1::2], c[2::2]
        if c[0]:
            b, r = [c[0], *b], [0, *r]
        if kind == 1:
            r = [x * x for x in r]
        exact = kind in (1, 2) and len(b) <= 4
        w = numpy.arange(max(low, LOW), min(high, HIGH) + 0.1, 5.0)
        n = by_formula(kind, c, w)
    else:
        table = numpy.array([[float(x) for x in line.split()] for line in index["data"].split("\n") if line.strip()])
        w, n = table[:, 0] * 1e3, table[:, 1]
        low, high, exact = w[0], w[-1], False
        inside = (w >= LOW - 10) & (w <= HIGH + 10)
        w, n = w[inside], n[inside]
    if not exact:
        b, r, error = fitted(w, n)
        note = f"; fitted here, within {error:.1g}"
        b, r = [float(f"{x:.9g}") for x in b], [float(f"{x:.9g}") for x in r]
        print(f"{name}: fit of {low:g}-{high:g} nm within {error:.2g}")
    b, r = list(b) + [0] * (4 - len(b)), list(r) + [0] * (4 - len(r))
    l2 = (numpy.arange(LOW, HIGH + 1) * 1e-3)**2
    n2 = 1 + sum(x * l2 / (l2 - y) for x, y in zip(b, r))
    assert (numpy.diff(n2) < 0).all() and n2.min() > 1, name
    f, d, c_line = (math.sqrt(1 + sum(x * l * l / (l * l - y) for x, y in zip(b, r))) for l in (0.4861327, 0.5875618, 0.6562725))
    PAGE_OF_GLASSES.append(f"| {quoted([name, *aliases.split(',')])} | {d:.5f} | {(d - 1) / (f - c_line):.1f} | {max(low, LOW):.0f}-"
                           f"{min(high, HIGH):.0f} | {short(data, source)}{', fitted' if note else ''} |")
    lines = [f"{cited.rstrip('.')}; {source}; valid {low:.5g}-{high:.5g} nm{note}"]
    return ("\n".join("    // " + part for part in textwrap.wrap(lines[0], 116)) +
            f'\n    {{"{name}", "{aliases}",\n     {{{", ".join(number(x, 10) for x in b)}}},\n     {{{", ".join(number(x, 10) for x in r)}}}}}')


def glasses(database, target):
    head = comment(["Coefficients of Sellmeier's formula, n^2 = 1 + sum_i B_i L^2 / (L^2 - C_i), L in micrometres, C_i in "
                    "micrometres squared (squared here where the source gives the resonance's wavelength).",
                    "Source: refractiveindex.info database (github.com/polyanskiy/refractiveindex.info-database, CC0 1.0), pages named with "
                    "each. Other formulas and tables are met by one of Sellmeier's."])
    write(target, "tables_glasses.cpp", head + "\nstatic constexpr Glass all[] = {\n" +
          ",\n".join(glass(database, *entry) for entry in GLASSES) + ",\n};\nconst std::span<const Glass> glasses = all;\n")


# ---- writing ----------------------------------------------------------------------------------------------------------------


def rows_text(items, per_line):
    return "\n".join("    " + ", ".join(items[i:i + per_line]) + "," for i in range(0, len(items), per_line))


def comment(lines):
    return "\n".join("// " + part for line in lines for part in textwrap.wrap(line, 120))


def write(folder, name, body):
    (folder / name).write_text("// Made by tools/make_optical_constants.py; do not edit.\n// clang-format off\n\n"
                               '#include "tables.h"\n\nnamespace etendue::tables {\n\n' + body + "\n}  // namespace etendue::tables\n",
                               encoding="utf-8")


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    database, ior = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    target = pathlib.Path(__file__).resolve().parent.parent / "src" / "color"
    metals(database, ior, target)
    glasses(database, target)
    text = PAGE.format(metals="\n".join(metals_page(database, ior)), glasses="\n".join(PAGE_OF_GLASSES))
    (target.parent.parent / "docs" / "optical-constants.md").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
