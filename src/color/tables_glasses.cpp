// Made by tools/make_optical_constants.py; do not edit.
// clang-format off

#include "tables.h"

namespace etendue::tables {

// Coefficients of Sellmeier's formula, n^2 = 1 + sum_i B_i L^2 / (L^2 - C_i), L in micrometres, C_i in micrometres squared
// (squared here where the source gives the resonance's wavelength).
// Source: refractiveindex.info database (github.com/polyanskiy/refractiveindex.info-database, CC0 1.0), pages named with
// each. Other formulas and tables are met by one of Sellmeier's.
static constexpr Glass all[] = {
    // SCHOTT optical glass catalogue of 20 January 2017, at 20 C; specs/schott/optical/N-BK7; valid 300-2500 nm
    {"N-BK7", "BK7",
     {1.03961212, 0.231792344, 1.01046945, 0.0},
     {0.00600069867, 0.0200179144, 103.560653, 0.0}},
    // SCHOTT optical glass catalogue of 20 January 2017, at 20 C; specs/schott/optical/N-SF11; valid 370-2500 nm
    {"N-SF11", "SF11",
     {1.73759695, 0.313747346, 1.89878101, 0.0},
     {0.013188707, 0.0623068142, 155.23629, 0.0}},
    // SCHOTT optical glass catalogue of 20 January 2017, at 20 C; specs/schott/optical/F2; valid 320-2500 nm
    {"F2", "",
     {1.34533359, 0.209073176, 0.937357162, 0.0},
     {0.00997743871, 0.0470450767, 111.886764, 0.0}},
    // I. H. Malitson. Interspecimen comparison of the refractive index of fused silica. J. Opt. Soc. Am. 55, 1205-1208
    // (1965), at 20 C; main/SiO2/nk/Malitson; valid 210-6700 nm
    {"fused silica", "silica,fused quartz",
     {0.6961663, 0.4079426, 0.8974794, 0.0},
     {0.004679148258, 0.01351206307, 97.93400254, 0.0}},
    // F. Peter. Über Brechungsindizes und Absorptionskonstanten des Diamanten zwischen 644 und 226 mμ. Zeitschrift für
    // Physik 15, 358-368 (1923); main/C/nk/Peter; valid 226-760 nm
    {"diamond", "",
     {0.3306, 4.3356, 0.0, 0.0},
     {0.030625, 0.011236, 0.0, 0.0}},
    // M. Daimon and A. Masumura. Measurement of the refractive index of distilled water from the near-infrared region to
    // the ultraviolet region. Appl. Opt. 46, 3811-3820 (2007), at 20 C; main/H2O/nk/Daimon-20.0C; valid 182-1129 nm
    {"water", "H2O",
     {0.5684027565, 0.1726177391, 0.02086189578, 0.1130748688},
     {0.005101829712, 0.01821153936, 0.02620722293, 10.69792721}},
    // SCHOTT optical glass catalogue of 20 January 2017, at 20 C; specs/schott/optical/N-K5; valid 310-2500 nm
    {"N-K5", "K5",
     {1.08511833, 0.199562005, 0.930511663, 0.0},
     {0.00661099503, 0.024110866, 111.982777, 0.0}},
    // SCHOTT optical glass catalogue of 20 January 2017, at 20 C; specs/schott/optical/N-FK51A; valid 290-2500 nm
    {"N-FK51A", "FK51A",
     {0.971247817, 0.216901417, 0.904651666, 0.0},
     {0.00472301995, 0.0153575612, 168.68133, 0.0}},
    // SCHOTT optical glass catalogue of 20 January 2017, at 20 C; specs/schott/optical/N-PK52A; valid 290-2500 nm
    {"N-PK52A", "PK52A",
     {1.029607, 0.1880506, 0.736488165, 0.0},
     {0.00516800155, 0.0166658798, 138.964129, 0.0}},
    // SCHOTT optical glass catalogue of 20 January 2017, at 20 C; specs/schott/optical/N-BAK4; valid 334-2500 nm
    {"N-BAK4", "BAK4",
     {1.28834642, 0.132817724, 0.945395373, 0.0},
     {0.00779980626, 0.0315631177, 105.965875, 0.0}},
    // SCHOTT optical glass catalogue of 20 January 2017, at 20 C; specs/schott/optical/N-BAF10; valid 350-2500 nm
    {"N-BAF10", "BAF10",
     {1.5851495, 0.143559385, 1.08521269, 0.0},
     {0.00926681282, 0.0424489805, 105.613573, 0.0}},
    // SCHOTT optical glass catalogue of 20 January 2017, at 20 C; specs/schott/optical/N-SK16; valid 310-2500 nm
    {"N-SK16", "SK16",
     {1.34317774, 0.241144399, 0.994317969, 0.0},
     {0.00704687339, 0.0229005, 92.7508526, 0.0}},
    // SCHOTT optical glass catalogue of 20 January 2017, at 20 C; specs/schott/optical/N-LAK9; valid 300-2500 nm
    {"N-LAK9", "LAK9",
     {1.46231905, 0.344399589, 1.15508372, 0.0},
     {0.00724270156, 0.0243353131, 85.4686868, 0.0}},
    // SCHOTT optical glass catalogue of 20 January 2017, at 20 C; specs/schott/optical/N-LASF9; valid 365-2500 nm
    {"N-LASF9", "LASF9",
     {2.00029547, 0.298926886, 1.80691843, 0.0},
     {0.0121426017, 0.0538736236, 156.530829, 0.0}},
    // SCHOTT optical glass catalogue of 20 January 2017, at 20 C; specs/schott/optical/N-LASF31A; valid 250-2500 nm
    {"N-LASF31A", "LASF31A",
     {1.96485075, 0.475231259, 1.48360109, 0.0},
     {0.00982060155, 0.0344713438, 110.739863, 0.0}},
    // SCHOTT optical glass catalogue of 20 January 2017, at 20 C; specs/schott/optical/N-KZFS4; valid 334-2500 nm
    {"N-KZFS4", "KZFS4",
     {1.35055424, 0.197575506, 1.09962992, 0.0},
     {0.0087628207, 0.0371767201, 90.3866994, 0.0}},
    // SCHOTT optical glass catalogue of 20 January 2017, at 20 C; specs/schott/optical/LLF1; valid 310-2500 nm
    {"LLF1", "",
     {1.21640125, 0.13366454, 0.883399468, 0.0},
     {0.00857807248, 0.0420143003, 107.59306, 0.0}},
    // SCHOTT optical glass catalogue of 20 January 2017, at 20 C; specs/schott/optical/N-SF5; valid 370-2500 nm
    {"N-SF5", "SF5",
     {1.52481889, 0.187085527, 1.42729015, 0.0},
     {0.011254756, 0.0588995392, 129.141675, 0.0}},
    // SCHOTT optical glass catalogue of 20 January 2017, at 20 C; specs/schott/optical/N-SF6; valid 370-2500 nm
    {"N-SF6", "SF6",
     {1.77931763, 0.338149866, 2.08734474, 0.0},
     {0.0133714182, 0.0617533621, 174.01759, 0.0}},
    // SCHOTT optical glass catalogue of 20 January 2017, at 20 C; specs/schott/optical/N-SF10; valid 380-2500 nm
    {"N-SF10", "SF10",
     {1.62153902, 0.256287842, 1.64447552, 0.0},
     {0.0122241457, 0.0595736775, 147.468793, 0.0}},
    // SCHOTT optical glass catalogue of 20 January 2017, at 20 C; specs/schott/optical/N-SF57; valid 370-2500 nm
    {"N-SF57", "SF57",
     {1.87543831, 0.37375749, 2.30001797, 0.0},
     {0.0141749518, 0.0640509927, 177.389795, 0.0}},
    // SCHOTT optical glass catalogue of 20 January 2017, at 20 C; specs/schott/optical/N-SF66; valid 390-2500 nm
    {"N-SF66", "SF66",
     {2.0245976, 0.470187196, 2.59970433, 0.0},
     {0.0147053225, 0.0692998276, 161.817601, 0.0}},
    // M. Rubin. Optical properties of soda lime silica glasses. Sol. Energy Mater. 12, 275-288 (1985); glass/misc/soda-
    // lime/nk/Rubin-clear; valid 310-4600 nm; fitted here, within 3e-07
    {"soda-lime glass", "window glass,float glass",
     {-8.6140918, 9.90316231, 0.943991756, 0.0},
     {0.0, 0.00121212802, 100.0, 0.0}},
    // BOROFLOAT® 33 – Optical Properties, June 2021 (obtained from http://www.schott.com); specs/schott/misc/BOROFLOAT33;
    // valid 240-1550 nm
    {"borosilicate glass", "pyrex,BOROFLOAT33",
     {0.3542, 0.78657, 0.18285, 0.0},
     {0.0, 0.0117852736, 19.598329, 0.0}},
    // I. H. Malitson and M. J. Dodge. Refractive index and birefringence of synthetic sapphire. J. Opt. Soc. Am. 62, 1405
    // (1972), at 20 C; main/Al2O3/nk/Malitson-o; valid 200-5000 nm
    {"sapphire", "Al2O3,corundum,ruby",
     {1.4313493, 0.65054713, 5.3414021, 0.0},
     {0.005279926102, 0.01423826471, 325.0178341, 0.0}},
    // G. Ghosh. Dispersion-equation coefficients for the refractive index and birefringence of calcite and quartz
    // crystals. Opt. Commun. 163, 95-102 (1999); main/SiO2/nk/Ghosh-o; valid 198-2053.1 nm
    {"quartz", "rock crystal",
     {0.28604141, 1.07044083, 1.10202242, 0.0},
     {0.0, 0.0100585997, 100.0, 0.0}},
    // G. Ghosh. Dispersion-equation coefficients for the refractive index and birefringence of calcite and quartz
    // crystals. Opt. Commun. 163, 95-102 (1999); main/CaCO3/nk/Ghosh-o; valid 204-2172 nm
    {"calcite", "CaCO3",
     {0.73358749, 0.96464345, 1.82831454, 0.0},
     {0.0, 0.0194325203, 120.0, 0.0}},
    // I. H. Malitson. A redetermination of some optical properties of calcium fluoride. Appl. Opt. 2, 1103-1107 (1963);
    // main/CaF2/nk/Malitson; valid 230-9700 nm
    {"fluorite", "CaF2",
     {0.5675888, 0.4710914, 3.8484723, 0.0},
     {0.002526429988, 0.0100783328, 1200.555973, 0.0}},
    // M. J. Dodge. Refractive properties of magnesium fluoride. Appl. Opt. 23, 1980-1985 (1984), at 18.85 C;
    // main/MgF2/nk/Dodge-o; valid 200-7000 nm
    {"magnesium fluoride", "MgF2",
     {0.48755108, 0.39875031, 2.3120353, 0.0},
     {0.001882178397, 0.008951888472, 566.1355913, 0.0}},
    // W. J. Tropf and M. E. Thomas, Magnesium aluminum spinel (MgAlO4), in E. D. Palik (ed.), Handbook of Optical
    // Constants of Solids II, Academic Press, Orlando, 1991, pp. 881-895; main/MgAl2O4/nk/Tropf; valid 350-5500 nm
    {"spinel", "MgAl2O4",
     {1.8938, 3.0755, 0.0, 0.0},
     {0.0098843364, 250.462276, 0.0, 0.0}},
    // D. E. Zelmon, D. L. Small and R. Page. Refractive-index measurements of undoped yttrium aluminum garnet from 0.4 to
    // 5.0 μm. Appl. Opt. 37, 4933-4935 (1998); main/Y3Al5O12/nk/Zelmon; valid 400-5000 nm
    {"YAG", "Y3Al5O12",
     {2.282, 3.27644, 0.0, 0.0},
     {0.01185, 282.734, 0.0, 0.0}},
    // D. L Wood and K. Nassau. Refractive index of cubic zirconia stabilized with yttria. Appl. Opt. 21, 2978-2981 (1982);
    // other/mixed crystals/ZrO2-Y2O3/nk/Wood; valid 361-5135 nm
    {"cubic zirconia", "",
     {1.347091, 2.117788, 9.452943, 0.0},
     {0.003911626849, 0.02780189412, 591.4901251, 0.0}},
    // W. L. Bond. Measurement of the refractive indices of several crystals. J. Appl. Phys. 36, 1674-1677 (1965);
    // main/SrTiO3/nk/Bond; valid 430-3800 nm
    {"strontium titanate", "SrTiO3",
     {3.042143, 1.170065, 30.83326, 0.0},
     {0.02178286714, 0.08720716923, 1101.314578, 0.0}},
    // S. Wang, M. Zhan, G. Wang, H. Xuan, W. Zhang, C. Liu, C. Xu, Y. Liu, Z. Wei, X. Chen. 4H-SiC: A new nonlinear
    // material for midinfrared lasers. Laser Photonics Rev. 7, 831–838 (2013); main/SiC/nk/Wang-6H-o; valid 435.8-2325 nm;
    // fitted here, within 3e-07
    {"moissanite", "SiC",
     {1.160695, 4.41146711, 2.12151185, 0.0},
     {0.0, 0.031764928, 100.0, 0.0}},
    // J. R. Devore. Refractive indices of rutile and sphalerite. J. Opt. Soc. Am. 41, 416-419 (1951);
    // main/TiO2/nk/Devore-o; valid 430-1530 nm; fitted here, within 1e-07
    {"rutile", "TiO2",
     {1.87311585, 3.03987905, -0.000519079318, 0.0},
     {0.0, 0.0802996421, 100.0, 0.0}},
    // D. T. F. Marple. Refractive index of ZnSe, ZnTe, and CdTe. J. Appl. Phys. 35, 539-542 (1964); main/ZnSe/nk/Marple;
    // valid 480-2500 nm
    {"zinc selenide", "ZnSe",
     {3.0, 1.9, 0.0, 0.0},
     {0.0, 0.113, 0.0, 0.0}},
    // H. H. Li. Refractive index of alkali halides and its wavelength and temperature derivatives. J. Phys. Chem. Ref.
    // Data 5, 329-528 (1976) and references therein; main/NaCl/nk/Li; valid 200-30000 nm; fitted here, within 2e-06
    {"sodium chloride", "NaCl,rock salt",
     {0.333654694, 0.996042552, 0.110528482, 0.0},
     {0.0, 0.018146879, 100.0, 0.0}},
    // G. Beadie, M. Brindza, R. A. Flynn, A. Rosenberg, J. S. Shirk. Refractive index measurements of poly(methyl
    // methacrylate) (PMMA) from 0.4-1.6 μm. Appl. Opt. 54, F139-F143 (2015), at 20.1 C; organic/(C5H8O2)n - poly(methyl
    // methacrylate)/nk/Beadie; valid 420-1620 nm; fitted here, within 2e-05
    {"PMMA", "acrylic glass,acrylic,plexiglass",
     {0.700485493, 0.495221318, 0.442277697, 0.0},
     {0.0, 0.0218524558, 100.0, 0.0}},
    // N. Sultanova, S. Kasarova, I. Nikolov. Dispersion properties of optical polymers. Acta Physica Polonica A 116,
    // 585-587 (2009), at 20 C; organic/(C16H14O3)n - polycarbonate/nk/Sultanova; valid 436.8-1052 nm
    {"polycarbonate", "PC",
     {1.4182, 0.0, 0.0, 0.0},
     {0.021304, 0.0, 0.0, 0.0}},
    // N. Sultanova, S. Kasarova, I. Nikolov. Dispersion properties of optical polymers. Acta Physica Polonica A 116,
    // 585-587 (2009), at 20 C; organic/(C8H8)n - polystyrene/nk/Sultanova; valid 436.8-1052 nm
    {"polystyrene", "PS",
     {1.4435, 0.0, 0.0, 0.0},
     {0.020216, 0.0, 0.0, 0.0}},
    // X. Zhang, J. Qiu, X. Li, J. Zhao, L. Liu. Complex refractive indices measurements of polymers in visible and near-
    // infrared bands. Appl. Opt. 59, 2337-2344 (2020) (0.4-2 µm); organic/(C10H8O4)n - polyethylene
    // terephthalate/nk/Zhang; valid 400-19942 nm; fitted here, within 0.0008
    {"PET", "polyethylene terephthalate",
     {1.11908804, 0.287230494, 2.81512873, 0.0},
     {0.0, 0.0644545102, 100.0, 0.0}},
    // V. Gupta, P. T. Probst, F. R. Goßler, A. M. Steiner, J. Schubert, Y. Brasse, T. A. F. König, A. Fery. Mechanotunable
    // surface lattice resonances in the visible optical range by soft lithography templates and directed self-assembly.
    // ACS Appl. Mater. Interfaces 11, 28189-28196 (2019) (Numerical data kindly provided by Tobias König);
    // organic/(C2H6OSi)n - polydimethylsiloxane/nk/Gupta; valid 300-1690 nm; fitted here, within 4e-05
    {"PDMS", "silicone",
     {0.709101195, 0.254839471, -0.338636598, 0.0},
     {0.0, 0.033258636, 100.0, 0.0}},
    // S. G. Warren and R. E. Brandt. Optical constants of ice from the ultraviolet to the microwave: A revised
    // compilation. J. Geophys. Res. 113, D14220 (2008), at -7 C; main/H2O/nk/Warren-2008; valid 44.3-2e+09 nm; fitted
    // here, within 5e-05
    {"ice", "water ice",
     {0.195981196, 0.505893678, 1.35281951, 0.0},
     {0.0, 0.0120131212, 100.0, 0.0}},
    // J. Rheims, J Köser, T Wriedt. Refractive-index measurements in the near-IR using an Abbe refractometer. Meas. Sci.
    // Technol. 8, 601-605 (1997), at 20 C; organic/C2H6O - ethanol/nk/Rheims; valid 476.5-830 nm; fitted here, within
    // 5e-08
    {"ethanol", "alcohol",
     {-0.321806907, 1.15144182, -0.00167380552, 0.0},
     {0.0, 0.00720292414, 100.0, 0.0}},
    // J. Rheims, J Köser, T Wriedt. Refractive-index measurements in the near-IR using an Abbe refractometer. Meas. Sci.
    // Technol. 8, 601-605 (1997), at 20 C; organic/C3H6O - acetone/nk/Rheims; valid 476.5-830 nm; fitted here, within
    // 3e-07
    {"acetone", "",
     {0.334441864, 0.487288161, -0.0125462158, 0.0},
     {0.0, 0.0171899661, 100.0, 0.0}},
    // V. Gupta, O. Aftenieva, P. T. Probst, S. Sarkar, A. M. Steiner, N. Vogel, A. Fery, T. A. F. König. Advanced
    // colloidal sensors enabled by an out-of-plane lattice resonance. Adv. Photonics Res. 2022, 2200152 (see supporting
    // information); organic/C3H8O3 - glycerol/nk/Gupta; valid 400-710 nm; fitted here, within 2e-05
    {"glycerol", "glycerine,glycerin",
     {-102.964336, 104.097599, 0.169563574, 0.0},
     {0.0, 0.000106604085, 100.0, 0.0}},
    // K. Moutzouris, M. Papamichael, S. C. Betsis, I. Stavrakas, G. Hloupis, D. Triantis. Refractive, dispersive and
    // thermo-optic properties of twelve organic solvents in the visible and near-infrared. Appl. Phys. B 116, 617-622
    // (2013), at 26.85 C; organic/C6H6 - benzene/nk/Moutzouris; valid 450-1551 nm; fitted here, within 2e-05
    {"benzene", "",
     {0.819957475, 0.359534337, 0.51543769, 0.0},
     {0.0, 0.0490454655, 100.0, 0.0}},
    // S. Kedenburg, M. Vieweg, T. Gissibl, H. Giessen. Linear refractive index and absorption measurements of nonlinear
    // optical liquids in the visible and near-infrared spectral region. Opt. Mater. Express 2, 1588-1611 (2012), at 20 C;
    // organic/CCl4 - carbon tetrachloride/nk/Kedenburg; valid 500-1600 nm
    {"carbon tetrachloride", "CCl4",
     {1.09215, 0.0, 0.0, 0.0},
     {0.01187, 0.0, 0.0, 0.0}},
    // P. E. Ciddor. Refractive index of air: new equations for the visible and near infrared. Appl. Optics 35, 1566-1573
    // (1996), at 15 C; other/mixed gases/air/nk/Ciddor; valid 230-1690 nm; fitted here, within 4e-10
    {"air", "",
     {0.000218445791, 0.000326902392, 2.68905771e-06, 0.0},
     {0.0, 0.00933751615, 100.0, 0.0}},
};
const std::span<const Glass> glasses = all;

}  // namespace etendue::tables
