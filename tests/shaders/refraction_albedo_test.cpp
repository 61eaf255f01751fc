// The light that single scattering of a rough dielectric loses, which the multiple-scattering tables add: against quadrature in
// double precision.

#include <gtest/gtest.h>

#include <cmath>

#include "components/shaders/microfacet/microfacet.h"

namespace etendue {
namespace {

using Kind = MicrofacetDistribution::Kind;

/// Smith's lambda of a surface of alpha 1 (Heitz 2014, sections 5.3 and 5.4), from the cotangent over alpha.
double masking(Kind kind, double a) {
  if (kind == Kind::ggx) return (std::sqrt(1 + 1 / (a * a)) - 1) / 2;
  return (std::exp(-a * a) / (a * std::sqrt(M_PI)) - std::erfc(a)) / 2;
}

double fresnel(double c, double eta, double& behind) {
  const double squared = 1 - (1 - c * c) / (eta * eta);
  if (squared <= 0) return 1;
  behind = std::sqrt(squared);
  const double s = (c - eta * behind) / (c + eta * behind), p = (eta * c - behind) / (eta * c + behind);
  return (s * s + p * p) / 2;
}

/// 1 - E(v), v = (sin, 0, cos): one minus the mean, over the slopes (x, y) of microfacets, of the light that leaves; the
/// slopes' lengths r have P(> r) = q^2.
double lost(Kind kind, double alpha, double eta, double angle) {
  const double vx = std::sin(angle), vz = std::cos(angle);
  const auto lambda = [&](double x, double y, double z) {
    return masking(kind, std::abs(z) / std::max(alpha * std::hypot(x, y), 1e-12));
  };
  const double own = lambda(vx, 0, vz);
  constexpr int lengths = 200, azimuths = 48;
  double sum = 0;
  for (int i = 0; i < lengths; ++i) {
    const double q = (i + 0.5) / lengths,
                 r = alpha * (kind == Kind::ggx ? std::sqrt(1 / (q * q) - 1) : std::sqrt(-2 * std::log(q)));
    for (int k = 0; k < azimuths; ++k) {
      const double phi = M_PI * (k + 0.5) / azimuths, mz = 1 / std::sqrt(1 + r * r), mx = -r * std::cos(phi) * mz,
                   my = -r * std::sin(phi) * mz, c = vx * mx + vz * mz;
      if (c <= 0) continue;
      double behind = 0;
      const double reflected = fresnel(c, eta, behind), along = c / eta - behind;
      const double rx = 2 * c * mx - vx, ry = 2 * c * my, rz = 2 * c * mz - vz;
      const double tx = along * mx - vx / eta, ty = along * my, tz = along * mz - vz / eta;
      double leaves = rz > 0 ? reflected / (1 + own + lambda(rx, ry, rz)) : 0;
      if (tz < 0) leaves += (1 - reflected) / ((1 + own) * (1 + lambda(tx, ty, tz)));
      sum += 2 * q / (lengths * azimuths) * leaves * c / (mz * vz);
    }
  }
  return 1 - sum;
}

// Tables that interpolate too coarsely, or whose own quadrature is coarse, create light at grazing angles: a total of up to
// 1.017 was once observed.
TEST(MultipleRefraction, GivesBackWhatIsLost) {
  for (const Kind kind : {Kind::ggx, Kind::beckmann})
    for (const double eta : {1.5, 1 / 1.5, 1 / 1.33, 1 / 1.1})
      for (const double alpha : {0.05, 0.2, 0.3, 0.9}) {
        const MultipleRefraction tables({kind, float(alpha)}, float(std::max(eta, 1 / eta)));
        for (const double degrees : {10.0, 40.0, 65.0, 75.0, 83.0, 87.0, 89.0}) {
          const double angle = degrees * M_PI / 180;
          const Vector3 v{float(std::sin(angle)), 0, float(std::copysign(std::cos(angle), eta - 1))};
          EXPECT_NEAR(tables.missing(v), lost(kind, alpha, eta, angle), eta > 0.8 && eta < 1 ? 0.005 : 0.0035)
              << (kind == Kind::ggx ? "ggx" : "beckmann") << ", eta " << eta << ", alpha " << alpha << " at " << degrees;
        }
      }
}

// The multiple scattering of surfaces with F = 1 has the albedo that single scattering lacks, for any anisotropy.
TEST(MultipleReflection, GivesBackWhatIsLost) {
  for (const Kind kind : {Kind::ggx, Kind::beckmann})
    for (const auto& [x, y] : {std::pair{0.4f, 0.4f}, {0.5f, 0.1f}, {0.4f, 0.8f}, {0.9f, 0.6f}}) {
      const MultipleReflection more({kind, x, y});
      const Vector3 out{0.6f, 0, 0.8f};
      double albedo = 0;
      constexpr int heights = 200, azimuths = 96;
      for (int i = 0; i < heights; ++i)
        for (int k = 0; k < azimuths; ++k) {  // uniform points of the disc are cosine-weighted directions
          const float r = std::sqrt((float(i) + 0.5f) / heights), phi = 2 * pi * (float(k) + 0.5f) / azimuths;
          const Vector3 in{r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - r * r)};
          albedo += double(more.value(out, in)) * M_PI / (heights * azimuths);
        }
      EXPECT_NEAR(albedo / double(more.missing(out)), 1, 0.01) << (kind == Kind::ggx ? "ggx " : "beckmann ") << x << " " << y;
    }
}

}  // namespace
}  // namespace etendue
