// The integral behind the tables of microfacet_energy.cpp.
//
// Divided by alpha, the slopes (x, y) of facets have lengths r of a common distribution, with P(> r) the probability of a
// greater length. The albedo seen from v is
//   E(v) = integral of G1(v) A(v, m) D(m) max(v . m, 0) / v.z dm = mean over slopes of A' max(v.z - slope . v, 0) / v.z,
// where A' = F G2(v, r) + (1 - F) G2'(v, t) is the light that leaves along the reflected direction r, if it is above the
// surface, and along the refracted t, if it is below. The mean is computed by a product rule: Gauss-Legendre in q with P(> r) =
// q^2, which concentrates nodes at large slopes, and equal steps of the azimuth.

#include "microfacet_quadrature.h"

// GCC does not vectorize the following loops at the optimization level of the other code.
#if defined(__GNUC__) && !defined(__clang__)
#define ETENDUE_VECTORIZE [[gnu::optimize("O3")]]
#else
#define ETENDUE_VECTORIZE
#endif

namespace etendue::albedo {

using Kind = MicrofacetDistribution::Kind;

// Zeros of the Legendre polynomial by Newton's method.
std::vector<Node> gauss_legendre(int n) {
  std::vector<Node> rule;
  for (int i = 0; i < n; ++i) {
    double z = std::cos(3.14159265358979323846 * (i + 0.75) / (n + 0.5)), slope = 0;
    for (int step = 0; step < 8; ++step) {
      double p = 1, before = 0;
      for (int k = 1; k <= n; ++k) {
        const double next = ((2 * k - 1) * z * p - (k - 1) * before) / k;
        before = p;
        p = next;
      }
      slope = n * (z * p - before) / (z * z - 1);
      z -= p / slope;
    }
    rule.push_back({float((1 - z) / 2), float(1 / ((1 - z * z) * slope * slope))});
  }
  return rule;
}

Slopes::Slopes(Kind kind, int lengths, int azimuths, float end) {
  for (const Node& q : gauss_legendre(lengths)) {
    const float r = kind == Kind::ggx ? std::sqrt(1 - q.x * q.x) / q.x : std::sqrt(-2 * std::log(q.x));
    for (int k = 0; k < azimuths; ++k) {
      const float azimuth = end * (float(k) + 0.5f) / float(azimuths);
      x.push_back(r * std::cos(azimuth));
      y.push_back(r * std::sin(azimuth));
      weight.push_back(2 * q.x * q.weight / float(azimuths));
    }
  }
}

namespace {

/// MicrofacetDistribution::lambda from z and the squared length of (alpha_x x, alpha_y y), without calls and branches.
template <Kind kind>
inline float lambda(float z, float across2) {
  if constexpr (kind == Kind::ggx) return 0.5f * (std::sqrt(1 + across2 / (z * z)) - 1);
  const float a2 = std::min(z * z / (across2 + 1e-30f), 16.0f), a = std::sqrt(a2) + 1e-10f;
  // exp(-a^2) = (1 / exp(a^2 / 16))^16, the latter by its series.
  const float w = a2 / 16;
  float e = 1 / (1 + w * (1 + w * (1.0f / 2 + w * (1.0f / 6 + w * (1.0f / 24 + w * (1.0f / 120 + w * (1.0f / 720)))))));
  e *= e;
  e *= e;
  e *= e;
  e *= e;
  const float t = 1 / (1 + 0.3275911f * a);
  const float p = t * (0.254829592f + t * (-0.284496736f + t * (1.421413741f + t * (-1.453152027f + t * 1.061405429f))));
  return 0.5f * e * std::max(0.56418958354775628695f / a - p, 0.0f);
}

/// The loop has no branches, for vector instructions: light that does not leave is multiplied by 0.
template <Kind kind, Boundary boundary>
ETENDUE_VECTORIZE float missing_of(const MicrofacetDistribution& d, const Slopes& slopes, const Vector3& v, float eta) {
  constexpr int chunk = 64;
  const int count = int(slopes.x.size());
  const float ax = d.alpha_x, ay = d.alpha_y, ax2 = ax * ax, ay2 = ay * ay;
  const float vx = v.x, vy = v.y, vz = v.z, inverse_eta = 1 / eta, inverse_eta2 = inverse_eta * inverse_eta;
  const float out_lambda = lambda<kind>(vz, ax2 * vx * vx + ay2 * vy * vy);
  double albedo = 0;
  for (int from = 0; from < count; from += chunk) {
    const float *sx = &slopes.x[size_t(from)], *sy = &slopes.y[size_t(from)], *weight = &slopes.weight[size_t(from)];
    const int n = std::min(chunk, count - from);
    float leaving[chunk];
    for (int i = 0; i < n; ++i) {
      const float x = ax * sx[i], y = ay * sy[i], projected = std::max(vz - vx * x - vy * y, 0.0f);
      const float z2 = 1 / (1 + x * x + y * y), z = std::sqrt(z2), cosine = projected * z;  // m = (-x z, -y z, z)
      float reflected = 1, behind = 0;
      if constexpr (boundary != Boundary::mirror) {  // fresnel_dielectric
        behind = std::sqrt(std::max(1 - (1 - cosine * cosine) * inverse_eta2, 0.0f));
        const float s = (cosine - eta * behind) / (cosine + eta * behind + 1e-20f);
        const float p = (eta * cosine - behind) / (eta * cosine + behind + 1e-20f);
        reflected = behind > 0 ? 0.5f * (s * s + p * p) : 1;
      }
      const float twice = 2 * projected * z2;
      const float rx = -twice * x - vx, ry = -twice * y - vy, rz = twice - vz;
      const float G2 = 1 / (1 + out_lambda + lambda<kind>(rz, ax2 * rx * rx + ay2 * ry * ry));
      float leaves = rz > 0 ? reflected * G2 : 0;
      if constexpr (boundary == Boundary::dielectric) {
        const float along = (cosine * inverse_eta - behind) * z;
        const float tx = -along * x - vx * inverse_eta, ty = -along * y - vy * inverse_eta, tz = along - vz * inverse_eta;
        const float through = 1 / ((1 + out_lambda) * (1 + lambda<kind>(tz, ax2 * tx * tx + ay2 * ty * ty)));
        leaves += tz < 0 ? (1 - reflected) * through : 0;
      }
      leaving[i] = weight[i] * projected * leaves;
    }
    for (int i = 0; i < n; ++i) albedo += double(leaving[i]);
  }
  return clamp(float(1 - albedo / double(vz)), 0, 1);
}
template <Kind kind>
float missing_of(Boundary boundary, const MicrofacetDistribution& d, const Slopes& slopes, const Vector3& v, float eta) {
  switch (boundary) {
    case Boundary::mirror: return missing_of<kind, Boundary::mirror>(d, slopes, v, eta);
    case Boundary::dielectric: return missing_of<kind, Boundary::dielectric>(d, slopes, v, eta);
    case Boundary::coat: break;
  }
  return missing_of<kind, Boundary::coat>(d, slopes, v, eta);
}

}  // namespace

float missing(Boundary boundary, const MicrofacetDistribution& d, const Slopes& slopes, const Vector3& v, float eta) {
  return d.kind == Kind::ggx ? missing_of<Kind::ggx>(boundary, d, slopes, v, eta)
                             : missing_of<Kind::beckmann>(boundary, d, slopes, v, eta);
}

}  // namespace etendue::albedo
