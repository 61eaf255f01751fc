#pragma once
// Base class and helpers of maps that compute with other maps.

#include "components/volumes/bounded_map.h"
#include "etendue/object_map.h"

namespace etendue {

/// Each value, or 0 where the value is infinite or NaN.
inline Spectrum finite_or_zero(const Spectrum& s) {
  const detail::Lanes v = s.lanes(), zero{};
  return Spectrum((v - v) == zero ? v : zero);  // NOLINT(misc-redundant-expression): an infinity less itself is not 0
}

/// a / b, and 0 where b is 0.
inline Spectrum safe_quotient(const Spectrum& a, const Spectrum& b) { return finite_or_zero(a / b); }

/// The power, or 0 for a negative base and where the power would be infinite.
inline float safe_power(float base, float exponent) {
  if (!(base >= 0)) return 0;
  const float x = std::pow(base, exponent);
  return std::isfinite(x) ? x : 0;
}

/// Clamps a computed spectrum to the range of its use: to [0, 1] as a reflectance, else to values that are not negative.
inline Spectrum as_used(const Spectrum& s, ColorUse use) {
  const detail::Lanes v = finite_or_zero(s).lanes(), zero{}, one = zero + 1.0f, low = v > zero ? v : zero;
  return Spectrum(use == ColorUse::reflectance ? (low < one ? low : one) : low);
}

/// An operation on two maps, or on three where it is associative. color() applies the operation to the maps' spectra at the
/// path's wavelengths, scalar() to the maps' numbers.
class CombinedMap : public ObjectMap, public BoundedMap {
 public:
  void prepare() override {
    if (!first) fail("first", "a map is needed");
    if (!second) fail("second", "a map is needed");
  }
  Spectrum color(const SurfacePoint& p, const Wavelengths& w, ColorUse use) const final {
    Spectrum result = apply(first->color(p, w, use), second->color(p, w, use_of_others(use)));
    if (third) result = apply(result, third->color(p, w, use_of_others(use)));
    return as_used(result, use);
  }
  float scalar(const SurfacePoint& p) const final {
    Spectrum result = apply(first->scalar(p), second->scalar(p));
    if (third) result = apply(result, third->scalar(p));
    return finite_or_zero(result)[0];
  }
  float bound() const final {
    const float most = bound(bound_of(*first), bound_of(*second));
    return third ? bound(most, bound_of(*third)) : most;
  }

  Ref<ObjectMap> first, second, third;

 protected:
  CombinedMap(float a, float b) : first(etendue::constant(a)), second(etendue::constant(b)) {}
  virtual Spectrum apply(const Spectrum&, const Spectrum&) const = 0;
  /// Upper bound of the result of `apply`, from the upper bounds of its arguments.
  virtual float bound(float, float) const { return infinity; }
  /// The ColorUse with which the maps after the first are evaluated.
  virtual ColorUse use_of_others(ColorUse use) const { return use; }
};

/// The ColorUse of a factor: the product of two radiances would contain the spectrum of the white twice.
inline ColorUse use_of_factor(ColorUse use) { return use == ColorUse::radiance ? ColorUse::coefficient : use; }

template <class Map>
Description<Map>& describe_two(Description<Map>& d, const char* first, const char* second) {
  return d.template member<&Map::first>("first", "1", first).template member<&Map::second>("second", "1", second);
}
template <class Map>
Description<Map>& describe_three(Description<Map>& d, const char* text) {
  return describe_two(d, text, "the second map").template member<&Map::third>("third", "1", "one more map, or none");
}

}  // namespace etendue
