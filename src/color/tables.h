#pragma once
// The measured data of src/color/tables_*.cpp, which tools/make_color_tables.py, make_optical_constants.py and
// make_camera_tables.py generate.

#include <array>
#include <span>

namespace etendue::tables {

/// The number of entries of a table with one value per nanometre over 360-830 nm.
inline constexpr int size = 471;

/// CIE 1931 2 degree observer: xbar, ybar, zbar at 360 nm + row.
extern const double observer[size][3];
/// The same divided by the integral of ybar [1/nm], with four floats per row, so that a row is loaded at once.
struct alignas(16) ObserverRow {
  float x, y, z, padding;
};
extern const std::array<ObserverRow, size> observer_rows;

/// `aliases` of all tables are separated by commas.
struct Illuminant {
  const char* name;
  const char* aliases;
  double low, step;               ///< wavelength of the first value, distance to the next [nm]
  std::span<const double> power;  ///< relative; 0 outside
};
extern const std::span<const Illuminant> illuminants;

struct Camera {
  const char* name;
  const char* aliases;
  double low, step;                 ///< as for illuminants
  std::span<const double[3]> rows;  ///< relative sensitivity of red, green and blue; 0 outside
};
extern const std::span<const Camera> cameras;

/// n^2 = 1 + sum_i b_i L^2 / (L^2 - c_i), L in micrometres.
struct Glass {
  const char* name;
  const char* aliases;
  double b[4], c[4];
};
extern const std::span<const Glass> glasses;

struct Metal {
  const char* name;
  const char* aliases;
  std::span<const double[3]> rows;  ///< wavelength [nm], n, k, over the visible range
};
extern const std::span<const Metal> metals, plain_metals, transition_metals, alloys, semiconductors, compounds;

}  // namespace etendue::tables
