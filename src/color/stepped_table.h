#pragma once
// Values at given wavelengths, linearly interpolated and 0 outside: exact, steps included, yet nearly as fast as a DenseTable.

#include <cmath>
#include <vector>

#include "dense_table.h"

namespace etendue {

/// A DenseTable with exceptions. A DenseTable cannot represent a kink or step at a wavelength inside one of its cells of 1 nm,
/// nor the ends of the table. The first value of such a cell is NaN; evaluation detects this and then interpolates the original
/// entries.
class SteppedTable {
 public:
  SteppedTable() = default;
  /// Wavelengths [nm] increase.
  SteppedTable(std::vector<float> wavelengths, std::vector<float> values);

  Spectrum evaluate(const Wavelengths& w) const {
    Spectrum s = dense_.evaluate(w);
    if (any_bent_ && !is_number(s)) [[unlikely]]
      correct(w, s);
    return s;
  }
  double exact(double wavelength) const;
  /// Integral of the values times max(0, 1 - |w - centre|): the mean under a hat of 2 nm width.
  double hat_mean(double centre) const;
  /// See SpectralFunction.
  std::vector<float> corners() const;

  /// The number of cells in which evaluation interpolates the original entries.
  int bent_cells() const { return bent_cells_; }
  const std::vector<float>& wavelengths() const { return wavelengths_; }
  const std::vector<float>& values() const { return values_; }

 private:
  static constexpr int cells = tables::size - 1;

  static bool is_number(const Spectrum& s) {
    const detail::IntLanes equal = s.lanes() == s.lanes();  // NaN equals nothing
    std::uint64_t all = ~std::uint64_t(0);
    for (const std::uint64_t part : std::bit_cast<std::array<std::uint64_t, spectrum_size / 2>>(equal)) all &= part;
    return all == ~std::uint64_t(0);
  }
  void find_bent_cells();
  void correct(const Wavelengths&, Spectrum&) const;
  float in_cell(int cell, float wavelength) const;

  DenseTable dense_;
  std::vector<float> wavelengths_, values_;
  std::vector<float> slopes_;         // from each entry to the next [1/nm]; empty if no cell has a kink or step
  std::vector<std::uint32_t> first_;  // the first entry above the beginning of each cell; likewise
  int bent_cells_ = 0;
  bool any_bent_ = false;
};

}  // namespace etendue
