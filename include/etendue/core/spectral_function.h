#pragma once
// SpectralFunction: a function of wavelength (Spectrum in pbrt): a colour, reflectance, emission or refractive index in a
// description.

#include <atomic>
#include <string>
#include <vector>

#include "etendue/core/ref.h"
#include "etendue/core/spectrum.h"

namespace etendue {

/// The quantity that a colour is used as. The values of a measured spectrum do not depend on it; an RGB colour is converted to
/// a spectrum according to it.
enum class ColorUse {
  reflectance,  ///< a fraction in [0, 1], smooth and bounded, seen under the colour space's white
  radiance,     ///< emitted light: RGB (1,1,1) has the colour space's white as its spectrum, with Y = 1
  coefficient,  ///< a non-negative number per wavelength that may exceed 1 (scattering, extinction)
};

/// Immutable. Stores the expression it was written as, so that it can be saved.
class SpectralFunction {
 public:
  virtual ~SpectralFunction() = default;
  virtual Spectrum evaluate(const Wavelengths&, ColorUse) const = 0;
  /// The value at one wavelength [nm].
  virtual float at(float wavelength, ColorUse) const = 0;
  /// The expression in a render description: `rgb(0.5, 0.2, 0.1)`, `spectrum("paint.csv")`, `0.5`.
  virtual std::string expression() const = 0;
  /// Whether the value varies with the wavelength (such a refractive index disperses light).
  virtual bool varies() const { return true; }
  /// The imaginary part k of a complex refractive index n + i k (of a metal), for which `evaluate` returns n. Null for real
  /// functions.
  virtual Ref<const SpectralFunction> imaginary() const { return nullptr; }

  /// The non-integer wavelengths [nm] at which the function has corners or steps. Between these and the integer wavelengths it
  /// is linear or smooth.
  virtual std::vector<float> corners() const { return {}; }
  /// The largest component of a colour given by components. As a reflectance, components are clamped to 1. 0: not given by
  /// components.
  virtual float largest_component() const { return 0; }

  void reference() const { count_.fetch_add(1, std::memory_order_relaxed); }
  void release() const {
    if (count_.fetch_sub(1, std::memory_order_acq_rel) == 1) delete this;
  }

 protected:
  SpectralFunction() = default;
  SpectralFunction(const SpectralFunction&) = delete;
  SpectralFunction& operator=(const SpectralFunction&) = delete;

 private:
  mutable std::atomic<int> count_{0};
};

using Color = Ref<const SpectralFunction>;

/// The smallest and the largest value over 360-830 nm, and their wavelengths [nm].
struct ValueRange {
  float least = 0, least_at = 0, most = 0, most_at = 0;
};
ValueRange range_of(const SpectralFunction&, ColorUse);

/// The same value at every wavelength.
Color flat_spectrum(float value);

}  // namespace etendue
