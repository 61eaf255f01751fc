#pragma once
// Spectrum: values at the few wavelengths of a path (SampledSpectrum in pbrt), and Wavelengths (SampledWavelengths in pbrt).

#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "etendue/core/math.h"

namespace etendue {

/// The number of wavelengths per path; docs/decisions explains how it was chosen.
inline constexpr int spectrum_size = 8;

/// The range of wavelengths [nm] that all spectral data covers: visible light.
inline constexpr float wavelength_low = 360, wavelength_high = 830;

namespace detail {
using Lanes = float __attribute__((vector_size(spectrum_size * sizeof(float))));
using IntLanes = std::int32_t __attribute__((vector_size(spectrum_size * sizeof(std::int32_t))));
}  // namespace detail

/// One value for each wavelength of a path (the thesis's Spectrum). The meaning of the values (radiance, throughput,
/// reflectance) is documented at each declaration.
class Spectrum {
 public:
  constexpr Spectrum() : v_{} {}
  constexpr Spectrum(float all) : v_(all - detail::Lanes{}) {}  // NOLINT: a number is a flat spectrum
  explicit constexpr Spectrum(detail::Lanes v) : v_(v) {}

  float operator[](int i) const { return v_[i]; }
  void set(int i, float value) { v_[i] = value; }
  const detail::Lanes& lanes() const { return v_; }

  friend Spectrum operator+(Spectrum a, Spectrum b) { return Spectrum(a.v_ + b.v_); }
  friend Spectrum operator-(Spectrum a, Spectrum b) { return Spectrum(a.v_ - b.v_); }
  friend Spectrum operator*(Spectrum a, Spectrum b) { return Spectrum(a.v_ * b.v_); }
  friend Spectrum operator/(Spectrum a, Spectrum b) { return Spectrum(a.v_ / b.v_); }
  friend Spectrum operator*(Spectrum a, float s) { return Spectrum(a.v_ * s); }
  friend Spectrum operator*(float s, Spectrum a) { return Spectrum(a.v_ * s); }
  friend Spectrum operator/(Spectrum a, float s) { return Spectrum(a.v_ * (1 / s)); }
  Spectrum operator-() const { return Spectrum(-v_); }
  Spectrum& operator+=(Spectrum b) {
    v_ += b.v_;
    return *this;
  }
  Spectrum& operator*=(Spectrum b) {
    v_ *= b.v_;
    return *this;
  }
  Spectrum& operator*=(float s) {
    v_ *= s;
    return *this;
  }
  Spectrum& operator/=(float s) {
    v_ *= 1 / s;
    return *this;
  }

  bool black() const { return none(v_ != detail::Lanes{}); }
  float maximum() const {
    float m = v_[0];
    for (int i = 1; i < spectrum_size; ++i) m = std::max(m, v_[i]);
    return m;
  }
  float minimum() const {
    float m = v_[0];
    for (int i = 1; i < spectrum_size; ++i) m = std::min(m, v_[i]);
    return m;
  }
  float average() const {
    float sum = 0;
    for (int i = 0; i < spectrum_size; ++i) sum += v_[i];
    return sum / spectrum_size;
  }
  /// Whether all values are finite: x - x is 0 for finite numbers only.
  bool finite() const { return none((v_ - v_) != detail::Lanes{}); }

 private:
  static bool none(const detail::IntLanes& mask) {
    std::uint64_t all = 0;
    for (const std::uint64_t part : std::bit_cast<std::array<std::uint64_t, spectrum_size / 2>>(mask)) all |= part;
    return all == 0;
  }

  detail::Lanes v_;
};

/// Applies a function of one number to each value: map(s, [](float x) { return std::exp(-x); }).
template <class F>
Spectrum map(Spectrum a, F&& f) {
  Spectrum r;
  for (int i = 0; i < spectrum_size; ++i) r.set(i, f(a[i]));
  return r;
}
inline Spectrum max(Spectrum a, float b) {
  return map(a, [b](float x) { return std::max(x, b); });
}
inline Spectrum clamp(Spectrum a, float low, float high) {
  return map(a, [=](float x) { return clamp(x, low, high); });
}
inline Spectrum exp(Spectrum a) {
  return map(a, [](float x) { return std::exp(x); });
}
inline Spectrum sqrt(Spectrum a) {
  return map(a, [](float x) { return safe_sqrt(x); });
}

/// A colour in the CIE 1931 XYZ space of the 2 degree observer, scaled so that a flat spectrum of 1 has Y = 1:
/// X = integral of S(lambda) xbar(lambda) over 106.8569 nm, the integral of ybar. A radiance's luminance [cd/m^2] is
/// Y times 683 times 106.8569.
struct Xyz {
  double x = 0, y = 0, z = 0;
  Xyz& operator+=(const Xyz& b) {
    x += b.x;
    y += b.y;
    z += b.z;
    return *this;
  }
  friend Xyz operator*(double s, const Xyz& c) { return {s * c.x, s * c.y, s * c.z}; }
  friend Xyz operator+(Xyz a, const Xyz& b) { return a += b; }
  bool operator==(const Xyz&) const = default;
};

/// The wavelengths [nm] of one path and their pdfs [1/nm]. The first is the hero wavelength (Wilkie et al. 2014): it alone
/// determines the direction at a dispersive surface, and the path continues with it alone.
class Wavelengths {
 public:
  Wavelengths() = default;
  Wavelengths(const std::array<float, spectrum_size>& lambda, const std::array<float, spectrum_size>& pdf) {
    for (int i = 0; i < spectrum_size; ++i) place(i, lambda[size_t(i)], pdf[size_t(i)]);
  }

  /// The same, given as vectors.
  Wavelengths(const detail::Lanes& lambda, const detail::Lanes& pdf) : lambda_(lambda), pdf_(pdf) {
    constexpr float length = wavelength_high - wavelength_low;
    detail::Lanes x = lambda - wavelength_low;
    x = x > 0 ? x : detail::Lanes{};  // zero for what is not a number
    x = x < length ? x : length - detail::Lanes{};
    const detail::IntLanes k = __builtin_convertvector(x, detail::IntLanes), last = int(length) - 1 - detail::IntLanes{};
    index_ = k < last ? k : last;
    fraction_ = x - __builtin_convertvector(index_, detail::Lanes);
  }

  float operator[](int i) const { return lambda_[i]; }
  float hero() const { return lambda_[0]; }
  /// [1/nm]
  float pdf(int i) const { return pdf_[i]; }

  /// Lets the path continue with the hero wavelength only (TerminateSecondary in pbrt). Returns the factor by which the
  /// throughput must be multiplied: spectrum_size for the hero, 0 for the others; 1 if the secondary wavelengths were dropped
  /// before. So the mean over wavelengths in `to_xyz` stays an unbiased estimate, and radiance gathered before keeps all its
  /// wavelengths.
  Spectrum drop_secondary() {
    Spectrum factor(1.0f);
    if (single_) return factor;
    single_ = true;
    factor = Spectrum();
    factor.set(0, float(spectrum_size));
    return factor;
  }
  bool single() const { return single_; }
  /// The wavelengths with the i-th as the only one, in the place of the hero, for a branch of a split path that follows it. The
  /// old hero takes the i-th place.
  Wavelengths alone(int i) const {
    Wavelengths one = *this;
    one.place(0, lambda_[i], pdf_[i]);
    one.place(i, lambda_[0], pdf_[0]);
    one.single_ = true;
    return one;
  }

  /// Position in tables with one entry per nanometre from 360 nm: the index of an entry and the fraction towards the next.
  int table_index(int i) const { return index_[i]; }
  float table_fraction(int i) const { return fraction_[i]; }
  const detail::IntLanes& table_indices() const { return index_; }
  const detail::Lanes& table_fractions() const { return fraction_; }
  /// The pdfs of all wavelengths [1/nm].
  const detail::Lanes& pdfs() const { return pdf_; }

  void place(int i, float lambda, float pdf) {
    lambda_[i] = lambda;
    pdf_[i] = pdf;
    const float x = clamp(lambda - wavelength_low, 0, wavelength_high - wavelength_low);
    const int k = std::min(int(x), int(wavelength_high - wavelength_low) - 1);
    index_[i] = k;
    fraction_[i] = x - float(k);
  }

 private:
  detail::Lanes lambda_{}, pdf_{}, fraction_{};
  detail::IntLanes index_{};
  bool single_ = false;
};

/// The Monte Carlo estimate of a spectrum's colour from its values at a path's wavelengths:
/// X = 1/size * sum_i S_i xbar(lambda_i) / (p(lambda_i) * 106.8569), and likewise for Y and Z.
Xyz to_xyz(const Spectrum&, const Wavelengths&);

}  // namespace etendue
