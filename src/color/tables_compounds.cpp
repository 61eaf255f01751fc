// Made by tools/make_optical_constants.py; do not edit.
// clang-format off

#include "tables.h"

namespace etendue::tables {

// Rows: wavelength [nm], n, k.

// Complex refractive index n + i k of titanium carbide (TiC).
// Source: J. Pflüger, J. Fink. Determination of optical constants by high-energy, electron-energy-loss spectroscopy
// (EELS), in Handbook of optical constants of solids II, Edward D. Palik, ed. Academic Press, 1991. pp. 293-310. By
// refractiveindex.info (CC0 1.0), main/TiC/nk/Pfluger.
static constexpr double index_TiC[][3] = {
    {354.2, 2.57, 2.34}, {413.3, 2.78, 2.43}, {495.9, 2.95, 2.38}, {619.9, 3.05, 2.67},
    {826.6, 3.51, 3.07}, {1239.9, 3.97, 3.78},
};

// Complex refractive index n + i k of titanium nitride (TiN).
// Source: J. Pflüger, J. Fink. Determination of optical constants by high-energy, electron-energy-loss spectroscopy
// (EELS), in Handbook of optical constants of solids II, Edward D. Palik, ed. Academic Press, 1991. pp. 293-310. By
// refractiveindex.info (CC0 1.0), main/TiN/nk/Pfluger.
static constexpr double index_TiN[][3] = {
    {354.2, 2.14, 1.06}, {413.3, 1.74, 1.04}, {495.9, 1.2, 1.65}, {619.9, 1.32, 2.69},
    {826.6, 1.82, 3.81}, {1239.9, 2.69, 5.04},
};

// Complex refractive index n + i k of vanadium carbide (VC).
// Source: J. Pflüger, J. Fink. Determination of optical constants by high-energy, electron-energy-loss spectroscopy
// (EELS), in Handbook of optical constants of solids II, Edward D. Palik, ed. Academic Press, 1991. pp. 293-310. By
// refractiveindex.info (CC0 1.0), main/VC/nk/Pfluger.
static constexpr double index_VC[][3] = {
    {354.2, 2.59, 2.12}, {413.3, 2.77, 2.16}, {495.9, 2.84, 2.21}, {619.9, 3.01, 2.51},
    {826.6, 3.37, 2.88}, {1239.9, 3.66, 3.42},
};

// Complex refractive index n + i k of vanadium nitride (VN).
// Source: J. Pflüger, J. Fink. Determination of optical constants by high-energy, electron-energy-loss spectroscopy
// (EELS), in Handbook of optical constants of solids II, Edward D. Palik, ed. Academic Press, 1991. pp. 293-310. By
// refractiveindex.info (CC0 1.0), main/VN/nk/Pfluger.
static constexpr double index_VN[][3] = {
    {354.2, 2.18, 1.58}, {413.3, 2.13, 1.7}, {495.9, 2.17, 1.98}, {619.9, 2.35, 2.47},
    {826.6, 2.73, 2.92}, {1239.9, 3.19, 3.66},
};

// Complex refractive index n + i k of cuprous oxide (Cu2O).
// Source: Palik (ed.), Handbook of Optical Constants of Solids II, Academic Press 1991; as Mitsuba's Python package 3.9.1
// has it, data/ior/Cu2O.eta.spd and .k.spd.
static constexpr double index_Cu2O[][3] = {
    {350.028015, 2.4, 1.44}, {399.935028, 2.8, 0.99}, {449.85498, 3.06, 0.6}, {499.919006, 3.12, 0.35},
    {549.799988, 3.1, 0.19}, {599.80603, 3.02, 0.13}, {649.789978, 2.9, 0.1}, {700.05603, 2.83, 0.083},
    {750.029968, 2.77, 0.07}, {799.871033, 2.7, 0.06}, {849.759949, 2.66, 0.053},
};

// Complex refractive index n + i k of cupric oxide (CuO).
// Source: Palik (ed.), Handbook of Optical Constants of Solids II, Academic Press 1991; as Mitsuba's Python package 3.9.1
// has it, data/ior/CuO.eta.spd and .k.spd.
static constexpr double index_CuO[][3] = {
    {350.028015, 2.24, 1.03}, {399.935028, 2.34, 0.87}, {449.85498, 2.45, 0.77}, {499.919006, 2.54, 0.68},
    {549.799988, 2.58, 0.59}, {599.80603, 2.65, 0.5}, {649.789978, 2.72, 0.4}, {700.05603, 2.88, 0.31},
    {750.029968, 2.97, 0.22}, {799.871033, 2.94, 0.11}, {849.759949, 2.81, 0.04},
};

// Complex refractive index n + i k of magnesium oxide (MgO).
// Source: Palik (ed.), Handbook of Optical Constants of Solids II, Academic Press 1991; as Mitsuba's Python package 3.9.1
// has it, data/ior/MgO.eta.spd and .k.spd.
// Held constant above 767.678 nm.
static constexpr double index_MgO[][3] = {
    {355.549011, 1.7755, 1e-06}, {360.932007, 1.7732, 1e-06}, {361.141998, 1.77318, 1e-06}, {364.968994, 1.77186, 0.0},
    {382.065002, 1.7668, 0.0}, {386.712006, 1.7655, 0.0}, {393.337982, 1.7638, 0.0}, {404.634003, 1.76104, 0.0},
    {430.935028, 1.7557, 0.0}, {435.781982, 1.75471, 0.0}, {457.82901, 1.7512, 0.0}, {477.949036, 1.7483, 0.0},
    {486.004974, 1.74711, 0.0}, {487.91803, 1.7469, 0.0}, {499.919006, 1.7454, 0.0}, {502.350006, 1.7453, 0.0},
    {508.531982, 1.74446, 0.0}, {514.440002, 1.7439, 0.0}, {546.166992, 1.74077, 0.0}, {589.258972, 1.73737, 0.0},
    {632.874023, 1.7346, 0.0}, {643.718018, 1.734, 0.0}, {656.325989, 1.73335, 0.0}, {667.635986, 1.73277, 0.0},
    {690.695984, 1.73191, 0.0}, {706.439026, 1.73101, 0.0}, {767.677979, 1.72872, 0.0}, {830.0, 1.72872, 0.0},
};

// Complex refractive index n + i k of titanium dioxide (rutile), named as the ordinary ray but with the numbers of the
// extraordinary one (TiO2).
// Source: Palik (ed.), Handbook of Optical Constants of Solids, Academic Press 1985; as Mitsuba's Python package 3.9.1 has
// it, data/ior/TiO2.eta.spd and .k.spd.
static constexpr double index_TiO2[][3] = {
    {359.988007, 3.87, 0.251}, {388.044006, 3.49, 0.0}, {399.935028, 3.4, 0.0}, {412.031006, 3.24, 0.022},
    {419.985992, 3.29, 0.0}, {439.957001, 3.2, 0.0}, {460.037018, 3.13, 0.0}, {479.985016, 3.08, 0.0},
    {499.919006, 3.03, 0.0}, {520.049988, 3.0, 0.0}, {539.044006, 2.95, 0.0}, {539.983032, 2.97, 0.0},
    {559.981995, 2.94, 0.0}, {579.888, 2.92, 0.0}, {600.097046, 2.9, 0.0}, {619.900024, 2.88, 0.0},
    {640.062012, 2.87, 0.0}, {659.819031, 2.85, 0.0}, {680.088013, 2.84, 0.0}, {700.05603, 2.83, 0.0},
    {719.97699, 2.82, 0.0}, {740.179016, 2.81, 0.0}, {760.147034, 2.81, 0.0}, {779.747986, 2.8, 0.0},
    {799.871033, 2.79, 0.0}, {819.97406, 2.79, 0.0}, {839.973083, 2.78, 0.0},
};

// Complex refractive index n + i k of titanium dioxide (rutile), named as the extraordinary ray but with the numbers of
// the ordinary one (TiO2-e).
// Source: Palik (ed.), Handbook of Optical Constants of Solids, Academic Press 1985; as Mitsuba's Python package 3.9.1 has
// it, data/ior/TiO2-e.eta.spd and .k.spd.
static constexpr double index_TiO2_e[][3] = {
    {358.013, 3.38, 0.117}, {388.044006, 2.88, 0.0}, {399.935028, 3.0, 0.0}, {402.01001, 3.0, 0.008},
    {419.985992, 2.91, 0.0}, {439.957001, 2.84, 0.0}, {460.037018, 2.79, 0.0}, {479.985016, 2.75, 0.0},
    {499.919006, 2.71, 0.0}, {520.049988, 2.68, 0.0}, {539.983032, 2.66, 0.0}, {559.981995, 2.64, 0.0},
    {579.888, 2.62, 0.0}, {600.097046, 2.6, 0.0}, {619.900024, 2.59, 0.0}, {640.062012, 2.58, 0.0},
    {659.819031, 2.57, 0.0}, {680.088013, 2.56, 0.0}, {700.05603, 2.55, 0.0}, {719.97699, 2.54, 0.0},
    {740.179016, 2.54, 0.0}, {760.147034, 2.53, 0.0}, {779.747986, 2.52, 0.0}, {799.871033, 2.52, 0.0},
    {819.97406, 2.52, 0.0}, {839.973083, 2.51, 0.0},
};

// Complex refractive index n + i k of thorium fluoride (ThF4).
// Source: Palik (ed.), Handbook of Optical Constants of Solids II, Academic Press 1991; as Mitsuba's Python package 3.9.1
// has it, data/ior/ThF4.eta.spd and .k.spd.
// Held constant above 799.871 nm.
static constexpr double index_ThF4[][3] = {
    {359.988007, 1.534, 0.0}, {369.979004, 1.532, 0.0}, {379.957001, 1.531, 0.0}, {389.997009, 1.53, 0.0},
    {399.935028, 1.529, 0.0}, {409.98703, 1.528, 0.0}, {419.985992, 1.527, 0.0}, {430.037994, 1.526, 0.0},
    {435.781982, 1.533, 0.0}, {439.957001, 1.526, 0.0}, {450.018036, 1.525, 0.0}, {460.037018, 1.524, 0.0},
    {469.97702, 1.524, 0.0}, {479.985016, 1.523, 0.0}, {490.040009, 1.523, 0.0}, {499.919006, 1.523, 0.0},
    {509.996002, 1.522, 0.0}, {520.049988, 1.522, 0.0}, {539.983032, 1.521, 0.0}, {545.927002, 1.521, 0.0},
    {559.981995, 1.521, 0.0}, {579.888, 1.52, 0.0}, {600.097046, 1.52, 0.0}, {619.900024, 1.52, 0.0},
    {640.062012, 1.519, 0.0}, {659.819031, 1.519, 0.0}, {700.05603, 1.519, 0.0}, {739.737, 1.518, 0.0},
    {779.747986, 1.518, 0.0}, {799.871033, 1.518, 0.0}, {830.0, 1.518, 0.0},
};

// Complex refractive index n + i k of caesium iodide (CsI).
// Source: Palik (ed.), Handbook of Optical Constants of Solids II, Academic Press 1991; as Mitsuba's Python package 3.9.1
// has it, data/ior/CsI.eta.spd and .k.spd.
static constexpr double index_CsI[][3] = {
    {359.988007, 1.88363, 0.0}, {364.968994, 1.87866, 0.0}, {369.979004, 1.87397, 0.0}, {375.014984, 1.86954, 0.0},
    {379.957001, 1.86535, 0.0}, {385.031006, 1.86138, 0.0}, {389.997009, 1.85762, 0.0}, {394.96701, 1.85404, 0.0},
    {399.935028, 1.85064, 0.0}, {409.98703, 1.84433, 0.0}, {419.985992, 1.83859, 0.0}, {430.037994, 1.83336, 0.0},
    {439.957001, 1.82857, 0.0}, {450.018036, 1.82417, 0.0}, {460.037018, 1.82012, 0.0}, {469.97702, 1.81637, 0.0},
    {479.985016, 1.81291, 0.0}, {490.040009, 1.8097, 0.0}, {499.919006, 1.80672, 0.0}, {509.996002, 1.80393, 0.0},
    {520.049988, 1.80134, 0.0}, {530.05603, 1.79891, 0.0}, {539.983032, 1.79664, 0.0}, {550.044006, 1.79451, 0.0},
    {559.981995, 1.7925, 0.0}, {570.02301, 1.79062, 0.0}, {579.888, 1.78884, 0.0}, {590.100037, 1.78717, 0.0},
    {600.097046, 1.78559, 0.0}, {619.900024, 1.78268, 0.0}, {640.062012, 1.78006, 0.0}, {659.819031, 1.7777, 0.0},
    {680.088013, 1.77557, 0.0}, {700.05603, 1.77363, 0.0}, {719.97699, 1.77186, 0.0}, {740.179016, 1.77025, 0.0},
    {760.147034, 1.76877, 0.0}, {779.747986, 1.76741, 0.0}, {799.871033, 1.76615, 0.0}, {819.97406, 1.765, 0.0},
    {839.973083, 1.76392, 0.0},
};

static constexpr Metal all[] = {
    {"TiC", "titanium carbide", index_TiC},
    {"TiN", "titanium nitride", index_TiN},
    {"VC", "vanadium carbide", index_VC},
    {"VN", "vanadium nitride", index_VN},
    {"Cu2O", "cuprous oxide", index_Cu2O},
    {"CuO", "cupric oxide", index_CuO},
    {"MgO", "magnesium oxide", index_MgO},
    {"TiO2", "rutile", index_TiO2},
    {"TiO2-e", "", index_TiO2_e},
    {"ThF4", "thorium fluoride", index_ThF4},
    {"CsI", "caesium iodide", index_CsI},
};
const std::span<const Metal> compounds = all;

}  // namespace etendue::tables
