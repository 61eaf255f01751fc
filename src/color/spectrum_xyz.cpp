// The estimate of a path's colour in XYZ, computed once per path.

#include <limits>

#include "etendue/describe/bands.h"
#include "tables.h"

namespace etendue {

namespace {

/// One band alone, which dispersion would leave, gives no colour: such a sample is reported as bad.
Xyz to_xyz_from_bands(const Spectrum& s, const Wavelengths& bands) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (bands.single()) return {none, none, none};
  const auto& m = space_of_bands(bands).to_xyz;
  const double r = double(s[0]), g = double(s[1]), b = double(s[2]);
  return {m[0] * r + m[1] * g + m[2] * b, m[3] * r + m[4] * g + m[5] * b, m[6] * r + m[7] * g + m[8] * b};
}

}  // namespace

Xyz to_xyz(const Spectrum& spectrum, const Wavelengths& wavelengths) {
  if (in_bands(wavelengths)) [[unlikely]]
    return to_xyz_from_bands(spectrum, wavelengths);
  // X = 1/size sum_i S_i xbar(lambda_i) / (p_i integral of ybar); rows hold xbar, ybar, zbar over that integral.
  using Row = float __attribute__((vector_size(16)));
  Row sum{};
  const detail::Lanes& pdfs = wavelengths.pdfs();
  // Wavelengths without a pdf have the weight 0.
  const detail::Lanes weights = pdfs > 0 ? spectrum.lanes() / pdfs : detail::Lanes{};
  for (int i = 0; i < spectrum_size; ++i) {
    const tables::ObserverRow* row = &tables::observer_rows[size_t(wavelengths.table_index(i))];
    Row a, b;
    __builtin_memcpy(&a, row, sizeof a);
    __builtin_memcpy(&b, row + 1, sizeof b);
    sum += (a + wavelengths.table_fraction(i) * (b - a)) * weights[i];
  }
  constexpr double scale = 1.0 / spectrum_size;
  return {scale * double(sum[0]), scale * double(sum[1]), scale * double(sum[2])};
}

}  // namespace etendue
