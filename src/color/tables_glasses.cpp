// Made by tools/make_color_tables.py; do not edit.
// clang-format off

#include "tables.h"

namespace etendue::tables {

// Sellmeier coefficients: n^2 = 1 + sum_i B_i L^2 / (L^2 - C_i), L = vacuum/air wavelength in micrometres as given by the
// source, C_i in micrometres squared (squared here where the source gives the resonance wavelength).
// Source: refractiveindex.info database (polyanskiy/refractiveindex.info-database, CC0 1.0), pages named in the last
// column.
static constexpr Glass all[] = {
    // SCHOTT catalogue 2017-01-20b at 20 C; specs/schott/optical/N-BK7.yml; valid 300-2500 nm
    {"N-BK7", "BK7",
     {1.03961212, 0.231792344, 1.01046945, 0.0},
     {0.00600069867, 0.0200179144, 103.560653, 0.0}},
    // SCHOTT catalogue 2017-01-20b at 20 C; specs/schott/optical/N-SF11.yml; valid 370-2500 nm
    {"N-SF11", "SF11",
     {1.73759695, 0.313747346, 1.89878101, 0.0},
     {0.013188707, 0.0623068142, 155.23629, 0.0}},
    // SCHOTT catalogue 2017-01-20b at 20 C; specs/schott/optical/F2.yml; valid 320-2500 nm
    {"F2", "",
     {1.34533359, 0.209073176, 0.937357162, 0.0},
     {0.00997743871, 0.0470450767, 111.886764, 0.0}},
    // Malitson 1965 at 20 C; main/SiO2/nk/Malitson.yml; valid 210-6700 nm
    {"fused silica", "silica,fused quartz",
     {0.6961663, 0.4079426, 0.8974794, 0.0},
     {0.004679148258, 0.01351206307, 97.93400254, 0.0}},
    // Peter 1923 at room temperature; main/C/nk/Peter.yml; valid 226-760 nm
    {"diamond", "",
     {0.3306, 4.3356, 0.0, 0.0},
     {0.030625, 0.011236, 0.0, 0.0}},
    // Daimon and Masumura 2007 at 20.0 C; main/H2O/nk/Daimon-20.0C.yml; valid 182-1129 nm
    {"water", "H2O",
     {0.5684027565, 0.1726177391, 0.02086189578, 0.1130748688},
     {0.005101829712, 0.01821153936, 0.02620722293, 10.69792721}},
};
const std::span<const Glass> glasses = all;

}  // namespace etendue::tables
