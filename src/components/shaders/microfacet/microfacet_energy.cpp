// MultipleReflection, MultipleRefraction and CoatTransmittance: albedos of single scattering, in tables computed at first use.
//
// Masking changes most with v where v is as steep as the facets' slopes, Fresnel's F over all angles. The coordinate t = (c (1
// + b) / (c + b) + c) / 2 with b = a / 2, of the cosine c of v and the alpha a along v, gives half of the table to each range,
// and puts grazing directions at the same t for all a; so few entries are enough for linear interpolation. For isotropic
// surfaces the tables are within 0.001 (F = 1) or 0.0035 (dielectrics; 0.005 from the denser side where the index is below
// 1.2), for others within 0.01 of E. Each takes 3 to 30 ms to compute, those of dielectrics as much for each step of the index.

#include <array>
#include <memory>
#include <mutex>
#include <vector>

#include "components/shaders/fresnel.h"
#include "microfacet_quadrature.h"

namespace etendue {
namespace {

using albedo::Boundary, albedo::Node, albedo::Slopes, albedo::gauss_legendre;
using Kind = MicrofacetDistribution::Kind;

// ---- coordinates of tables ---------------------------------------------------------------------------------------------

/// The interval of a coordinate among n values at equal steps over [0, 1], and the fraction within it.
struct Place {
  int index;
  float fraction;
  Place(float x, int n) {
    x = clamp(x, 0, 1) * float(n - 1);
    index = std::min(int(x), n - 2);
    fraction = x - float(index);
  }
  float mix(float a, float b) const { return lerp(fraction, a, b); }
};

float alpha_at(int k, int n) { return std::max(square(float(k) / float(n - 1)), MicrofacetDistribution::smooth_below); }
Place alpha_place(float alpha, int n) { return {std::sqrt(alpha), n}; }

float cosine_coordinate(float c, float a) {
  const float b = 0.5f * a;
  return 0.5f * (c * (1 + b) / (c + b) + c);
}
float cosine_at(int k, int n, float a) {
  // Solves c^2 + p c - 2 t b = 0.
  const double t = double(k) / (n - 1), b = 0.5 * double(a), p = 1 + 2 * b - 2 * t, root = std::sqrt(p * p + 8 * t * b);
  return clamp(float(p > 0 ? 4 * t * b / (p + root) : (root - p) / 2), 1e-6f, 1);
}

Vector3 direction(float cosine, float azimuth) {
  const float s = safe_sqrt(1 - cosine * cosine);
  return {s * std::cos(azimuth), s * std::sin(azimuth), cosine};
}

/// The mean of a function of the cosine over diffuse illumination: the integral of 2 f(c) c dc.
template <class F>
float diffuse_mean(const std::vector<Node>& rule, F&& f) {
  float sum = 0;
  for (const Node& c : rule) sum += 2 * c.weight * c.x * f(c.x);
  return sum;
}

// ---- one boundary ------------------------------------------------------------------------------------------------------

/// Table of 1 - E of isotropic surfaces for one eta, by alpha and cosine.
template <Boundary boundary, int alphas, int cosines>
class IsotropicPlane {
 public:
  IsotropicPlane(Kind kind, float eta, const Slopes& slopes, const std::vector<Node>& rule) {
    for (int i = 0; i < alphas; ++i)
      for (int k = 0; k < cosines; ++k) {
        const float a = alpha_at(i, alphas);
        missing_[i][k] = albedo::missing(boundary, {kind, a}, slopes, direction(cosine_at(k, cosines, a), 0), eta);
      }
    for (int i = 0; i < alphas; ++i) {
      const MicrofacetDistribution d(kind, alpha_at(i, alphas));
      mean_[i] = diffuse_mean(rule, [&](float c) { return missing(d, direction(c, 0)); });
    }
  }
  float missing(const MicrofacetDistribution& d, const Vector3& v) const {
    const Place a = alpha_place(d.alpha_x, alphas), c(cosine_coordinate(std::abs(v.z), d.alpha_x), cosines);
    const float *low = missing_[a.index] + c.index, *high = low + cosines;
    return a.mix(c.mix(low[0], low[1]), c.mix(high[0], high[1]));
  }
  float mean(const MicrofacetDistribution& d) const {
    const Place a = alpha_place(d.alpha_x, alphas);
    return a.mix(mean_[a.index], mean_[a.index + 1]);
  }

 private:
  float missing_[alphas][cosines], mean_[alphas];
};

/// Table of 1 - E of anisotropic surfaces of F = 1, by both alphas, azimuth and cosine. The azimuth is that of v after the
/// stretch by alpha, over a quarter turn: so it resolves which of the alphas matters along v, however much they differ.
template <int alphas, int azimuths, int cosines>
class AnisotropicPlane {
 public:
  AnisotropicPlane(Kind kind, int lengths, int slope_azimuths) {
    const Slopes slopes(kind, lengths, slope_azimuths, 2 * pi);
    const auto rule = gauss_legendre(12);
    for (int i = 0; i < alphas; ++i)
      for (int j = 0; j <= i; ++j)
        for (int k = 0; k < azimuths; ++k)
          for (int l = 0; l < cosines; ++l) {
            const MicrofacetDistribution d(kind, alpha_at(i, alphas), alpha_at(j, alphas));
            const float stretched = pi / 2 * float(k) / float(azimuths - 1);
            const float azimuth = std::atan2(d.alpha_x * std::sin(stretched), d.alpha_y * std::cos(stretched));
            const float along = std::hypot(d.alpha_x * std::cos(azimuth), d.alpha_y * std::sin(azimuth));
            missing_[i][j][k][l] = missing_[j][i][azimuths - 1 - k][l] =
                albedo::missing(Boundary::mirror, d, slopes, direction(cosine_at(l, cosines, along), azimuth), 1);
          }
    constexpr int steps = 12;
    for (int i = 0; i < alphas; ++i)
      for (int j = 0; j <= i; ++j) {
        const MicrofacetDistribution d(kind, alpha_at(i, alphas), alpha_at(j, alphas));
        float sum = 0;
        for (int k = 0; k < steps; ++k)
          sum += diffuse_mean(rule, [&](float c) { return missing(d, direction(c, pi / 2 * (float(k) + 0.5f) / steps)); });
        mean_[i][j] = mean_[j][i] = sum / steps;
      }
  }
  float missing(const MicrofacetDistribution& d, const Vector3& v) const {
    const float x = d.alpha_x * std::abs(v.x), y = d.alpha_y * std::abs(v.y), s2 = v.x * v.x + v.y * v.y;
    const float along = s2 > 0 ? std::sqrt((x * x + y * y) / s2) : d.alpha_x;
    const Place i = alpha_place(d.alpha_x, alphas), j = alpha_place(d.alpha_y, alphas);
    const Place k(s2 > 0 ? std::atan2(y, x) / (pi / 2) : 0, azimuths), l(cosine_coordinate(std::abs(v.z), along), cosines);
    const auto cell = [&](int p, int q) {
      const auto& rows = missing_[i.index + p][j.index + q];
      const float *low = rows[k.index] + l.index, *high = rows[k.index + 1] + l.index;
      return k.mix(l.mix(low[0], low[1]), l.mix(high[0], high[1]));
    };
    return i.mix(j.mix(cell(0, 0), cell(0, 1)), j.mix(cell(1, 0), cell(1, 1)));
  }
  float mean(const MicrofacetDistribution& d) const {
    const Place i = alpha_place(d.alpha_x, alphas), j = alpha_place(d.alpha_y, alphas);
    const auto row = [&](int p) { return j.mix(mean_[i.index + p][j.index], mean_[i.index + p][j.index + 1]); };
    return i.mix(row(0), row(1));
  }

 private:
  float missing_[alphas][alphas][azimuths][cosines], mean_[alphas][alphas];
};

// ---- all boundaries ----------------------------------------------------------------------------------------------------

/// Reflection at F = 1.
struct ReflectionTable {
  explicit ReflectionTable(Kind kind) : isotropic(kind, 1, Slopes(kind, 48, 24, pi), gauss_legendre(32)) {}
  IsotropicPlane<Boundary::mirror, 40, 40> isotropic;
};
struct AnisotropicReflectionTable {
  explicit AnisotropicReflectionTable(Kind kind) : anisotropic(kind, 20, 20) {}
  AnisotropicPlane<14, 13, 18> anisotropic;
};

/// Tables of isotropic dielectrics, by the index behind the surface over that in front: at equal steps of sqrt(1 - 1 / n), n
/// being the higher index over the lower, up to 4, and by side. For n near 1 this is proportional to the cosine of the critical
/// angle, on which albedos depend most: seen from the denser side, light at facets of one orientation is abruptly either lost
/// or not. So the steps are small, and the table of each is computed at first use.
template <Boundary boundary>
class EtaTable {
 public:
  explicit EtaTable(Kind kind) : kind_(kind) {}
  float missing(float eta, const MicrofacetDistribution& d, const Vector3& v) const {
    return between(eta, [&](const Plane& plane) { return plane.missing(d, v); });
  }
  float mean(float eta, const MicrofacetDistribution& d) const {
    return between(eta, [&](const Plane& plane) { return plane.mean(d); });
  }

 private:
  static constexpr int etas = 96;
  static constexpr float highest = 4;
  using Plane = IsotropicPlane<boundary, 28, 56>;
  struct Slot {
    std::once_flag made;
    std::unique_ptr<const Plane> plane;
  };

  const Plane& plane(int index, bool denser_side) const {
    Slot& slot = slots_[denser_side][size_t(index)];
    std::call_once(slot.made, [&] {
      const float n = std::max(1 / (1 - (1 - 1 / highest) * square(float(index) / float(etas - 1))), 1.001f);
      slot.plane = std::make_unique<const Plane>(kind_, denser_side ? 1 / n : n, slopes_, rule_);
    });
    return *slot.plane;
  }
  template <class F>
  float between(float eta, F&& f) const {
    const Place e(std::sqrt((1 - std::min(eta, 1 / eta)) / (1 - 1 / highest)), etas);
    return e.mix(f(plane(e.index, eta < 1)), f(plane(e.index + 1, eta < 1)));
  }

  Kind kind_;
  Slopes slopes_{kind_, 64, 32, pi};
  std::vector<Node> rule_ = gauss_legendre(24);
  mutable std::array<Slot, etas> slots_[2];
};
using RefractionTable = EtaTable<Boundary::dielectric>;
using CoatTable = EtaTable<Boundary::coat>;

/// The table of a kind of distribution, computed at first use.
template <class Table>
const Table& table(Kind kind) {
  if (kind == Kind::ggx) {
    static const auto made = std::make_unique<const Table>(Kind::ggx);
    return *made;
  }
  static const auto made = std::make_unique<const Table>(Kind::beckmann);
  return *made;
}

}  // namespace

// The ratio of the alphas is limited to 20: stronger anisotropy makes little difference, and the table is too coarse for it.
MultipleReflection::MultipleReflection(const MicrofacetDistribution& made)
    : distribution_(made.kind, std::max(made.alpha_x, made.alpha_y / 20), std::max(made.alpha_y, made.alpha_x / 20)) {
  const MicrofacetDistribution& d = distribution_;
  mean_missing_ = d.isotropic() ? table<ReflectionTable>(d.kind).isotropic.mean(d)
                                : table<AnisotropicReflectionTable>(d.kind).anisotropic.mean(d);
}

float MultipleReflection::missing(const Vector3& v) const {
  const MicrofacetDistribution& d = distribution_;
  return d.isotropic() ? table<ReflectionTable>(d.kind).isotropic.missing(d, v)
                       : table<AnisotropicReflectionTable>(d.kind).anisotropic.missing(d, v);
}

// Of the energy that single scattering misses for light from side a, the share x_a is transmitted and 1 - x_a reflected. f is
// reciprocal across the boundary (up to n^2, as in MultipleRefraction::value) if x_a n_a^2 Ma = x_b n_b^2 Mb with the means M
// of the missing energy. With the mean F of a smooth boundary, (1 - F) n^2 is the same on both sides; so x_a = (1 - F_a) min(1,
// Mb / Ma) fulfils this, and equals the transmittance of a smooth boundary where both sides miss the same energy.
MultipleRefraction::MultipleRefraction(const MicrofacetDistribution& d, float eta) : distribution_(d), eta_{eta, 1 / eta} {
  const RefractionTable& albedos = table<RefractionTable>(d.kind);
  for (const int side : {0, 1}) mean_missing_[side] = albedos.mean(eta_[side], d);
  for (const int side : {0, 1}) {
    const float ratio = mean_missing_[1 - side] / std::max(mean_missing_[side], 1e-7f);
    transmitted_[side] = (1 - mean_fresnel_dielectric(eta_[side])) * std::min(ratio, 1.0f);
  }
}

float MultipleRefraction::missing(const Vector3& v) const {
  return table<RefractionTable>(distribution_.kind).missing(eta_[v.z < 0], distribution_, v);
}

CoatTransmittance::CoatTransmittance(const MicrofacetDistribution& d, float eta)
    : distribution_(d), eta_(eta), mean_(table<CoatTable>(d.kind).mean(eta, d)) {}

float CoatTransmittance::operator()(const Vector3& v) const {
  return table<CoatTable>(distribution_.kind).missing(eta_, distribution_, v);
}

}  // namespace etendue
