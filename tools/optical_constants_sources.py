"""What tools/make_optical_constants.py makes tables of, and the page of documentation that lists them."""

PALIK1 = "Palik (ed.), Handbook of Optical Constants of Solids, Academic Press 1985"
PALIK2 = "Palik (ed.), Handbook of Optical Constants of Solids II, Academic Press 1991"
LUXPOP = "luxpop.com database"
QUERRY = "other/alloys/Cu-Zn/nk/Querry-"

# file -> (name in the language, other names, what it is, where it is from). From Palik's handbook or luxpop.com: as Mitsuba's
# package has it, under the name in the fifth place or that of the language; else a page of refractiveindex.info.
METALS = {
    "tables_metals.cpp": ("metals", [
        ("Au", "gold", "gold", LUXPOP),
        ("Ag", "silver", "silver", LUXPOP),
        ("Al", "aluminium,aluminum", "aluminium", LUXPOP),
        ("Cu", "copper", "copper", LUXPOP),
        ("Cr", "chromium,chrome", "chromium", PALIK2),
        ("Cu_palik", "", "copper, fewer rows", PALIK1),
    ]),
    "tables_metals_plain.cpp": ("plain_metals", [
        ("Li", "lithium", "lithium", "main/Li/nk/Rasigni"),
        ("Na", "sodium", "sodium", "main/Na/nk/Smith"),
        ("K", "potassium", "potassium", "main/K/nk/Smith"),
        ("Rb", "rubidium", "rubidium", "main/Rb/nk/Smith"),
        ("Cs", "caesium,cesium", "caesium", "main/Cs/nk/Smith"),
        ("Be", "beryllium", "beryllium", PALIK2),
        ("Mg", "magnesium", "magnesium, film", "main/Mg/nk/Palm"),
        ("Ca", "calcium", "calcium", "main/Ca/nk/Mathewson"),
        ("Zn", "zinc", "zinc, from its reflectance alone", "main/Zn/nk/Querry"),
        ("Hg", "mercury", "mercury, liquid", "main/Hg/nk/Inagaki"),
        ("In", "indium", "indium", "main/In/nk/Mathewson-298K"),
        ("Pb", "lead", "lead", "main/Pb/nk/Mathewson-298K"),
        ("Bi", "bismuth", "bismuth", "main/Bi/nk/Hagemann"),
    ]),
    "tables_metals_transition.cpp": ("transition_metals", [
        ("Ti", "titanium", "titanium", "main/Ti/nk/Johnson"),
        ("V", "vanadium", "vanadium", PALIK2, "V_palik"),
        ("Mn", "manganese", "manganese", "main/Mn/nk/Johnson"),
        ("Fe", "iron", "iron", "main/Fe/nk/Querry"),
        ("Co", "cobalt", "cobalt", "main/Co/nk/Johnson"),
        ("Ni", "nickel", "nickel", PALIK1, "Ni_palik"),
        ("Zr", "zirconium", "zirconium", "main/Zr/nk/Querry"),
        ("Nb", "niobium", "niobium", PALIK2),
        ("Mo", "molybdenum", "molybdenum", PALIK1),
        ("Rh", "rhodium", "rhodium", "main/Rh/nk/Weaver"),
        ("Pd", "palladium", "palladium", "main/Pd/nk/Johnson"),
        ("Ta", "tantalum", "tantalum", PALIK2),
        ("W", "tungsten", "tungsten", PALIK1),
        ("Ir", "iridium", "iridium", PALIK1),
        ("Os", "osmium", "osmium, ordinary ray", "main/Os/nk/Nemoshkalenko-o"),
        ("Pt", "platinum", "platinum, a model fitted to several measurements", "main/Pt/nk/Rakic-LD"),
    ]),
    "tables_metals_alloys.cpp": ("alloys", [
        ("CuZn", "brass,CuZn30", "brass, 70 % copper, 30 % zinc", QUERRY + "Cu70Zn30"),
        ("CuZn15", "red brass", "red brass, 85 % copper, 15 % zinc", QUERRY + "Cu85Zn15"),
        ("CuZn10", "commercial bronze", "commercial bronze, 90 % copper, 10 % zinc", QUERRY + "Cu90Zn10"),
        ("AuAg", "electrum", "half gold, half silver, by a model fitted to films", "other/alloys/Au-Ag/nk/Rioux-Au50Ag50"),
        ("stainless steel", "steel", "austenitic stainless steel, much like AISI 316",
         "other/alloys/stainless steel/nk/Karlsson-austenitic"),
    ]),
    "tables_semiconductors.cpp": ("semiconductors", [
        ("a-C", "amorphous carbon", "amorphous carbon, film", "main/C/nk/Arakawa"),
        ("d-C", "", "diamond", PALIK1),
        ("graphite", "", "graphite, ordinary ray, a model fitted to several measurements", "main/C/nk/Djurisic-o"),
        ("Si", "silicon", "silicon", "main/Si/nk/Green-2008"),
        ("Ge", "germanium", "germanium", "main/Ge/nk/Jellison"),
        ("Se", "selenium", "selenium, ordinary ray", PALIK2),
        ("Se-e", "", "selenium, extraordinary ray", PALIK2),
        ("Te", "tellurium", "tellurium, ordinary ray", PALIK2),
        ("Te-e", "", "tellurium, extraordinary ray", PALIK2),
        ("GaAs", "gallium arsenide", "gallium arsenide", "main/GaAs/nk/Jellison"),
        ("AlAs", "aluminium arsenide", "aluminium arsenide", PALIK2),
        ("AlSb", "aluminium antimonide", "aluminium antimonide", PALIK2),
        ("HgTe", "mercury telluride", "mercury telluride", PALIK2),
        ("SnTe", "tin telluride", "tin telluride, without k, which is not given", PALIK2),
        ("SiC", "silicon carbide", "silicon carbide, ordinary ray", PALIK2),
    ]),
    "tables_compounds.cpp": ("compounds", [
        ("TiC", "titanium carbide", "titanium carbide", "main/TiC/nk/Pfluger"),
        ("TiN", "titanium nitride", "titanium nitride", "main/TiN/nk/Pfluger"),
        ("VC", "vanadium carbide", "vanadium carbide", "main/VC/nk/Pfluger"),
        ("VN", "vanadium nitride", "vanadium nitride", "main/VN/nk/Pfluger"),
        ("Cu2O", "cuprous oxide", "cuprous oxide", PALIK2),
        ("CuO", "cupric oxide", "cupric oxide", PALIK2),
        ("MgO", "magnesium oxide", "magnesium oxide", PALIK2),
        ("TiO2", "rutile", "titanium dioxide (rutile), named as the ordinary ray but with the numbers of the extraordinary one",
         PALIK1),
        ("TiO2-e", "", "titanium dioxide (rutile), named as the extraordinary ray but with the numbers of the ordinary one",
         PALIK1),
        ("ThF4", "thorium fluoride", "thorium fluoride", PALIK2),
        ("CsI", "caesium iodide", "caesium iodide", PALIK2),
    ]),
}

# Rows of Mitsuba's files that are no measurement: their wavelengths [nm], beside those without n, and what is told of it.
LEFT_OUT = {
    "AlAs": ([], "Left out: rows of 393.6 to 435 nm in which n is 0, not being given."),
    "Te-e": ([619.900024], "Left out: a row at 619.9 nm whose n is a misprint, 4.67, as its k."),
}

SCHOTT = "specs/schott/optical/"
# name in the language, other names, page of refractiveindex.info
GLASSES = [
    ("N-BK7", "BK7", SCHOTT + "N-BK7"), ("N-SF11", "SF11", SCHOTT + "N-SF11"), ("F2", "", SCHOTT + "F2"),
    ("fused silica", "silica,fused quartz", "main/SiO2/nk/Malitson"), ("diamond", "", "main/C/nk/Peter"),
    ("water", "H2O", "main/H2O/nk/Daimon-20.0C"),
    ("N-K5", "K5", SCHOTT + "N-K5"), ("N-FK51A", "FK51A", SCHOTT + "N-FK51A"), ("N-PK52A", "PK52A", SCHOTT + "N-PK52A"),
    ("N-BAK4", "BAK4", SCHOTT + "N-BAK4"), ("N-BAF10", "BAF10", SCHOTT + "N-BAF10"), ("N-SK16", "SK16", SCHOTT + "N-SK16"),
    ("N-LAK9", "LAK9", SCHOTT + "N-LAK9"), ("N-LASF9", "LASF9", SCHOTT + "N-LASF9"), ("N-LASF31A", "LASF31A", SCHOTT + "N-LASF31A"),
    ("N-KZFS4", "KZFS4", SCHOTT + "N-KZFS4"), ("LLF1", "", SCHOTT + "LLF1"), ("N-SF5", "SF5", SCHOTT + "N-SF5"),
    ("N-SF6", "SF6", SCHOTT + "N-SF6"), ("N-SF10", "SF10", SCHOTT + "N-SF10"), ("N-SF57", "SF57", SCHOTT + "N-SF57"),
    ("N-SF66", "SF66", SCHOTT + "N-SF66"),
    ("soda-lime glass", "window glass,float glass", "glass/misc/soda-lime/nk/Rubin-clear"),
    ("borosilicate glass", "pyrex,BOROFLOAT33", "specs/schott/misc/BOROFLOAT33"),
    ("sapphire", "Al2O3,corundum,ruby", "main/Al2O3/nk/Malitson-o"), ("quartz", "rock crystal", "main/SiO2/nk/Ghosh-o"),
    ("calcite", "CaCO3", "main/CaCO3/nk/Ghosh-o"), ("fluorite", "CaF2", "main/CaF2/nk/Malitson"),
    ("magnesium fluoride", "MgF2", "main/MgF2/nk/Dodge-o"), ("spinel", "MgAl2O4", "main/MgAl2O4/nk/Tropf"),
    ("YAG", "Y3Al5O12", "main/Y3Al5O12/nk/Zelmon"), ("cubic zirconia", "", "other/mixed crystals/ZrO2-Y2O3/nk/Wood"),
    ("strontium titanate", "SrTiO3", "main/SrTiO3/nk/Bond"), ("moissanite", "SiC", "main/SiC/nk/Wang-6H-o"),
    ("rutile", "TiO2", "main/TiO2/nk/Devore-o"), ("zinc selenide", "ZnSe", "main/ZnSe/nk/Marple"),
    ("sodium chloride", "NaCl,rock salt", "main/NaCl/nk/Li"),
    ("PMMA", "acrylic glass,acrylic,plexiglass", "organic/(C5H8O2)n - poly(methyl methacrylate)/nk/Beadie"),
    ("polycarbonate", "PC", "organic/(C16H14O3)n - polycarbonate/nk/Sultanova"),
    ("polystyrene", "PS", "organic/(C8H8)n - polystyrene/nk/Sultanova"),
    ("PET", "polyethylene terephthalate", "organic/(C10H8O4)n - polyethylene terephthalate/nk/Zhang"),
    ("PDMS", "silicone", "organic/(C2H6OSi)n - polydimethylsiloxane/nk/Gupta"),
    ("ice", "water ice", "main/H2O/nk/Warren-2008"),
    ("ethanol", "alcohol", "organic/C2H6O - ethanol/nk/Rheims"), ("acetone", "", "organic/C3H6O - acetone/nk/Rheims"),
    ("glycerol", "glycerine,glycerin", "organic/C3H8O3 - glycerol/nk/Gupta"),
    ("benzene", "", "organic/C6H6 - benzene/nk/Moutzouris"),
    ("carbon tetrachloride", "CCl4", "organic/CCl4 - carbon tetrachloride/nk/Kedenburg"),
    ("air", "", "other/mixed gases/air/nk/Ciddor"),
]

PAGE = """# Optical constants: the metals and glasses that are known by name

Made by `tools/make_optical_constants.py` together with the tables of `src/color`, where each has its full citation.

## `metal("…")`

Complex indices n + i k of what reflects light and lets none through far: metals, semiconductors, and compounds that are used
as such. Names are known in capitals or not. R is the reflectance at normal incidence in air at 450, 550 and 650 nm. Between the
published rows n and k are linear; where a table ends within 360-830 nm (the column of nm), its first and last values go on.

| names | of what | R | nm | source |
|---|---|---|---|---|
{metals}

Sources: Palik (ed.), *Handbook of Optical Constants of Solids*, 1985, and *II*, 1991, and luxpop.com, by the rows that Mitsuba 3.9.1 has
of them; all others by refractiveindex.info (CC0). What Mitsuba names besides is here by another source of the same numbers: its `a-C` is
Arakawa's, `Hg` Inagaki's, `K` and `Na_palik` Smith's, `Li` Rasigni's, `Rh` Weaver's, `TiC`, `TiN`, `VC` and `VN` Pflüger's. Its
`TiO2` has the numbers of rutile's extraordinary ray and `TiO2-e` those of the ordinary one; so have they here. Its `AlAs` has n = 0 from
394 to 435 nm, where none was given, and its `Te-e` a misprint at 620 nm: these rows are left out. Tin, gallium, cadmium, rhenium
and ruthenium are missing: none of these sources has them in the visible range. Films, oxides and polish change a metal's reflectance by
several per cent, and so do tables of one metal: write `complex(n, k)` with `spectrum(…)` for one of your own.

## `glass("…")`

Real indices by Sellmeier's formula. n is at 587.6 nm, V Abbe's number; nm is where the source says that its formula holds (beyond,
it goes on). Crystals that split light have the index of the ordinary ray.

| names | n | V | nm | source |
|---|---|---|---|---|
{glasses}
"""
