#pragma once
// A table of one value per nanometre over 360-830 nm, linearly interpolated; most spectra are evaluated from one.

#include <array>
#include <cstring>

#include "etendue/core/spectrum.h"
#include "tables.h"

namespace etendue {

class DenseTable {
 public:
  DenseTable() = default;
  /// Tabulates a function of the wavelength [nm].
  template <class F>
  explicit DenseTable(const F& f) {
    for (int i = 0; i < tables::size; ++i) values_[size_t(i)] = float(f(double(wavelength_low) + i));
  }

  Spectrum evaluate(const Wavelengths& wavelengths) const {
    detail::Lanes a{}, b{};
    entries(wavelengths, a, b);
    return Spectrum(a + wavelengths.table_fractions() * (b - a));
  }
  /// 0 outside 360-830 nm.
  float at(float wavelength) const {
    const float x = wavelength - wavelength_low;
    if (!(x >= 0 && x <= float(tables::size - 1))) return 0;
    const int i = std::min(int(x), tables::size - 2);
    const float* entry = &values_[size_t(i)];
    return entry[0] + (x - float(i)) * (entry[1] - entry[0]);
  }
  float entry(int i) const { return values_[size_t(i)]; }
  void set_entry(int i, float value) { values_[size_t(i)] = value; }

 private:
  using Four = float __attribute__((vector_size(16)));
  using Eight = float __attribute__((vector_size(32)));

  /// The table entries below and above each wavelength. (A template, so that code for other numbers of lanes is not compiled.)
  template <class Lanes>
  void entries(const Wavelengths& wavelengths, Lanes& a, Lanes& b) const {
    if constexpr (sizeof(Lanes) == sizeof(Four)) {
      four_entries(wavelengths, 0, a, b);
    } else if constexpr (sizeof(Lanes) == sizeof(Eight)) {
      Four a0, b0, a1, b1;
      four_entries(wavelengths, 0, a0, b0);
      four_entries(wavelengths, 4, a1, b1);
      a = __builtin_shufflevector(a0, a1, 0, 1, 2, 3, 4, 5, 6, 7);
      b = __builtin_shufflevector(b0, b1, 0, 1, 2, 3, 4, 5, 6, 7);
    } else {
      for (int i = 0; i < spectrum_size; ++i) {
        const float* entry = &values_[size_t(wavelengths.table_index(i))];
        a[i] = entry[0];
        b[i] = entry[1];
      }
    }
  }
  void four_entries(const Wavelengths& wavelengths, int first, Four& a, Four& b) const {
    // An entry and its successor are loaded together.
    using Pair = float __attribute__((vector_size(8)));
    const auto pair = [&](int i) {
      Pair p;
      std::memcpy(&p, &values_[size_t(wavelengths.table_index(first + i))], sizeof p);
      return p;
    };
    const Four low = __builtin_shufflevector(pair(0), pair(1), 0, 1, 2, 3);
    const Four high = __builtin_shufflevector(pair(2), pair(3), 0, 1, 2, 3);
    a = __builtin_shufflevector(low, high, 0, 2, 4, 6);
    b = __builtin_shufflevector(low, high, 1, 3, 5, 7);
  }

  std::array<float, tables::size> values_{};
};

}  // namespace etendue
