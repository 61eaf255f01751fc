#include "media.h"

#include <algorithm>

#include "closure_walk.h"
#include "components/phasefunctions/henyey_greenstein.h"
#include "etendue/core/warp.h"
#include "etendue/describe/color.h"

namespace etendue::osl {

namespace {

// With the weight w of a component:
//   anisotropic_vdf(albedo, extinction, g): extinction coefficient w extinction, of which the part albedo scatters;
//   medium_vdf(albedo, depth, T, g, ...): likewise with -ln(T) / depth, so that T is what is left of light after that distance;
//   henyey_greenstein(g) and isotropic(): scattering coefficient w;    absorption(): absorption coefficient w [1/m];
//   emission(): radiance per distance w.
enum class Medium : unsigned char { none, vdf, depth, henyey_greenstein, isotropic, absorption };

Medium medium_named(const String* name) {
  static const std::pair<const String*, Medium> known[] = {{intern_string("anisotropic_vdf"), Medium::vdf},
                                                           {intern_string("medium_vdf"), Medium::depth},
                                                           {intern_string("henyey_greenstein"), Medium::henyey_greenstein},
                                                           {intern_string("isotropic"), Medium::isotropic},
                                                           {intern_string("absorption"), Medium::absorption}};
  for (const auto& [other, medium] : known)
    if (other == name) return medium;
  return Medium::none;
}

constexpr float thinnest = 1e-6f;  ///< the least that medium_vdf lets through

float component_of(float x) { return x > 0 ? std::min(x, 1e12f) : 0; }  // also of what is no number
Triple positive(const Triple& c) { return {component_of(c.x), component_of(c.y), component_of(c.z)}; }
Triple fraction(const Triple& c) {
  return {std::min(component_of(c.x), 1.0f), std::min(component_of(c.y), 1.0f), std::min(component_of(c.z), 1.0f)};
}

float anisotropy_of(const ClosureComponent& c, Medium m) {
  const float g = m == Medium::vdf                 ? c.argument<float>(2)
                  : m == Medium::depth             ? c.argument<float>(3)
                  : m == Medium::henyey_greenstein ? c.argument<float>(0)
                                                   : 0;
  return std::isfinite(g) ? clamp(g, -0.9999f, 0.9999f) : 0;
}

/// The scattering coefficient as RGB, of which the mean is a lobe's share of the phase function.
float scattering_of(const ClosureComponent& c, Medium m, const Triple& weight, const Spectrum& spectral) {
  Triple s = weight;
  if (m == Medium::vdf) s = s * fraction(c.argument<Triple>(0)) * c.argument<Triple>(1);
  if (m == Medium::depth) {
    const Triple through = c.argument<Triple>(2);
    const float depth = c.argument<float>(1);
    s = s * fraction(c.argument<Triple>(0));
    for (int i = 0; i < 3; ++i) s[i] *= depth > 0 ? -std::log(clamp(through[i], thinnest, 1)) / depth : 0;
  }
  s = positive(s);
  return (s.x + s.y + s.z) / 3 * std::max(spectral.average(), 0.0f);
}

}  // namespace

VolumeCoefficients medium_of(const ClosureNode* node, const RgbSpace& space, const Wavelengths& w) {
  VolumeCoefficients sum;
  const auto coefficient = [&](const Triple& c) {
    const Triple k = positive(c);
    return k.x == k.y && k.y == k.z ? Spectrum(k.x) : rgb_spectrum(space, k.x, k.y, k.z, ColorUse::coefficient, w);
  };
  const auto reflectance = [&](const Triple& c) {
    const Triple k = fraction(c);
    return k.x == k.y && k.y == k.z ? Spectrum(k.x) : rgb_spectrum(space, k.x, k.y, k.z, ColorUse::reflectance, w);
  };
  each_component(node, [&](const ClosureComponent& c, const Triple& weight, const Spectrum& given) {
    const Medium m = medium_named(c.shape->name);
    if (m == Medium::none) return;
    const Spectrum spectral = max(given, 0);
    if (m == Medium::absorption) {
      sum.absorption += coefficient(weight) * spectral;
      return;
    }
    if (m == Medium::henyey_greenstein || m == Medium::isotropic) {
      sum.scattering += coefficient(weight) * spectral;
      return;
    }
    Spectrum extinction;
    if (m == Medium::vdf) {
      extinction = coefficient(weight * c.argument<Triple>(1)) * spectral;
    } else if (const float depth = c.argument<float>(1); depth > 0) {
      const Spectrum through = reflectance(c.argument<Triple>(2));
      extinction =
          map(through, [&](float t) { return -std::log(std::max(t, thinnest)) / depth; }) * coefficient(weight) * spectral;
    }
    const Spectrum scattering = extinction * reflectance(c.argument<Triple>(0));
    sum.scattering += scattering;
    sum.absorption += max(extinction - scattering, 0);
  });
  sum.emission = max(light_of(node, space, w), 0);
  return sum;
}

PhaseMixture::PhaseMixture(const ClosureNode* node) {
  float all = 0;
  each_component(node, [&](const ClosureComponent& c, const Triple& weight, const Spectrum& spectral) {
    const Medium m = medium_named(c.shape->name);
    if (m == Medium::none || m == Medium::absorption) return;
    const float share = scattering_of(c, m, weight, spectral);
    if (!(share > 0)) return;
    if (count_ == most) throw Error(fmt::format("a medium has more than {} closures that scatter at one point", most));
    lobes_[count_++] = {anisotropy_of(c, m), share};
    all += share;
  });
  for (int i = 0; i < count_; ++i) lobes_[i].share /= all;
  // Where nothing scatters nothing asks, but for rounding.
  if (count_ == 0) lobes_[count_++] = {0, 1};
}

// See PhasedVolume: h = 1 - cos(theta), and a negative anisotropy is the same function of the angle to the opposite direction.
float PhaseMixture::value(const Vector3& out, const Vector3& in) const {
  float sum = 0;
  for (int i = 0; i < count_; ++i) {
    const Vector3 peak = lobes_[i].anisotropy < 0 ? out : -out;
    sum += lobes_[i].share * henyey_greenstein::value(std::abs(lobes_[i].anisotropy), length_squared(in - peak) / 2);
  }
  return sum;
}

Vector3 PhaseMixture::sample(const Vector3& out, Point2 u, float& pdf) const {
  int i = 0;
  float x = u.x;
  for (; i + 1 < count_ && x >= lobes_[i].share; ++i) x -= lobes_[i].share;
  x = std::min(x / lobes_[i].share, one_minus_epsilon);
  const float h = henyey_greenstein::sample(std::abs(lobes_[i].anisotropy), x), r = safe_sqrt(h * (2 - h));
  float sine = 0, cosine = 0;
  sin_cos_turn(u.y, sine, cosine);
  const Vector3 in = Frame(Normal3(lobes_[i].anisotropy < 0 ? out : -out)).to_world({r * cosine, r * sine, 1 - h});
  pdf = value(out, in);
  return in;
}

}  // namespace etendue::osl
