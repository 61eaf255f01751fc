// The density of a cloud.

#include "components/maps/combining/blend.h"

namespace etendue {
namespace {

// The density of the medium "cloud" of pbrt-v4 (Pharr, Jakob & Humphreys 2023, "Physically Based Rendering", section 11.4.6),
// with other random numbers. With the noise n and its gradient g, points are first displaced in two octaves,
//     x_(i+1) = x_i + 0.05 w 2^-i g(10 1.99^i x_i),      x_0 = f p,
// which draws bumps out into wisps; w is the wispiness, f the frequency. Then, with the altitude y,
//     d(p) = clamp( clamp(4.5 (1 - y) a sum_(i<5) 2^-(i+1) n(1.99^i x_2)) + 2 max(0, 1/2 - y) ),
// where clamp is to [0, 1] and a is the amount. The cloud is solid up to the altitude 0, only noise above 1/2, and empty from 1
// on.
class CloudMap final : public BlendMap {
 public:
  CloudMap() : BlendMap(0, 1) {}
  static void describe(Description<CloudMap>& d) {
    d.summary("The density of a cloud that is solid at its foot and torn at its top, between two maps.",
              "Pharr, Jakob & Humphreys 2023, \"Physically Based Rendering\", 11.4.6")
        .group("Colours")
        .member<&CloudMap::first>("first", "1", "the map where there is no cloud")
        .member<&CloudMap::second>("second", "1", "the map where it is densest")
        .group("Place")
        .member<&CloudMap::size>("size", "m", "altitude of the top over the foot", more_than(0), soft(0.01, 1000), logarithmic)
        .member<&CloudMap::base>("base", "m", "the foot: there, and below, the cloud is solid")
        .member<&CloudMap::up>("up", "1", "the direction in which the altitude grows")
        .member<&CloudMap::seed>("seed", "1", "chooses one of many clouds of the same kind")
        .group("Cloud")
        .member<&CloudMap::amount>("amount", "1", "how much of it there is where it is torn", at_least(0), soft(0, 8))
        .member<&CloudMap::frequency>("frequency", "1", "how many billows there are along `size`", at_least(0), soft(0, 40))
        .member<&CloudMap::wispiness>("wispiness", "1", "how far they are drawn out", at_least(0), soft(0, 5));
  }

  void prepare() override {
    BlendMap::prepare();
    if (!is_finite(base - Point3{})) fail("base", "must be finite numbers");
    if (!is_finite(up) || !(length(up) > 0)) fail("up", "a direction is needed");
    if (!std::isfinite(amount)) fail("amount", "must be finite");
    if (!std::isfinite(frequency)) fail("frequency", "must be finite");
    if (!std::isfinite(wispiness)) fail("wispiness", "must be finite");
    direction_ = normalize(up);
  }

  float size = 1;
  Point3 base{0, 0, 0};
  Vector3 up{0, 0, 1};
  std::uint32_t seed = 0;
  float amount = 1, frequency = 5, wispiness = 1;

 private:
  float fraction(const SurfacePoint& p) const override {
    float mean = 0;
    over_footprint(p, [&](const Point3& q, float weight) { mean += weight * density((1 / size) * (q - base)); });
    return mean;
  }

  Vector3 gradient(const Vector3& p) const {
    constexpr float step = 0.01f;
    const auto along = [&](const Vector3& d) { return (perlin_noise(p + d, seed) - perlin_noise(p - d, seed)) / (2 * step); };
    return {along({step, 0, 0}), along({0, step, 0}), along({0, 0, step})};
  }

  float density(const Vector3& p) const {
    const float altitude = dot(p, direction_), solid = 2 * std::max(0.5f - altitude, 0.0f);
    if (!(solid < 1)) return std::isfinite(altitude) ? 1 : 0;
    if (altitude >= 1) return 0;
    Vector3 x = frequency * p;
    if (wispiness > 0) {
      float strength = 0.05f * wispiness, fineness = 10;
      for (int i = 0; i < 2; ++i) {
        x += strength * gradient(fineness * x);
        strength *= 0.5f;
        fineness *= 1.99f;
      }
    }
    float sum = 0, strength = 0.5f, fineness = 1;
    for (int i = 0; i < 5; ++i) {
      sum += strength * perlin_noise(fineness * x, seed);
      strength *= 0.5f;
      fineness *= 1.99f;
    }
    return clamp(clamp((1 - altitude) * 4.5f * amount * sum, 0, 1) + solid, 0, 1);
  }

  Vector3 direction_{0, 0, 1};
};

const Register<CloudMap> registered;

}  // namespace
}  // namespace etendue
