#pragma once
// A function of wavelength: what is written for a colour, a reflectance, an emission or a refractive index.

#include <atomic>
#include <string>
#include <vector>

#include "etendue/core/ref.h"
#include "etendue/core/spectrum.h"

namespace etendue {

/// What a colour is asked as. A measured spectrum answers all alike; a colour given as RGB becomes a spectrum
/// according to what it is for.
enum class ColorUse {
  reflectance,  ///< a fraction in [0, 1], smooth and bounded, seen under the colour space's white
  radiance,     ///< emitted light: RGB (1,1,1) has the colour space's white as its spectrum, with Y = 1
  coefficient,  ///< a non-negative number per wavelength that may exceed 1 (scattering, extinction)
};

/// Immutable. Knows how it was written, so that it can be saved.
class SpectralFunction {
 public:
  virtual ~SpectralFunction() = default;
  virtual Spectrum evaluate(const Wavelengths&, ColorUse) const = 0;
  /// The value at one wavelength [nm].
  virtual float at(float wavelength, ColorUse) const = 0;
  /// As in a render description: `rgb(0.5, 0.2, 0.1)`, `spectrum("paint.csv")`, `0.5`.
  virtual std::string expression() const = 0;
  /// Whether it differs between wavelengths (a refractive index that does disperses light).
  virtual bool varies() const { return true; }
  /// Of a complex refractive index n + i k (a metal's), whose values are n: k. Null for everything real.
  virtual Ref<const SpectralFunction> imaginary() const { return nullptr; }

  /// Wavelengths [nm] other than whole ones where it has corners or steps. Between these and the whole ones its values are
  /// linear, or smooth.
  virtual std::vector<float> corners() const { return {}; }
  /// Of a colour given by components: the largest. As a reflectance, what is more than 1 is cut. 0: it has none.
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

/// The least and the largest value over 360-830 nm, and where they are [nm].
struct ValueRange {
  float least = 0, least_at = 0, most = 0, most_at = 0;
};
ValueRange range_of(const SpectralFunction&, ColorUse);

/// The same value at every wavelength.
Color flat_spectrum(float value);

}  // namespace etendue
