#pragma once
// LobeMixture: a learned pdf of directions, as a mixture of a few lobes that point at positions.
//
// A lobe is a von Mises-Fisher distribution on the sphere around the unit direction m,
//     v(w) = k / (2 pi (1 - exp(-2 k))) exp(k (m . w - 1))   [1/sr]
// with the concentration k. A lobe that points at a nearby source of light must be rotated when it is used at another point
// (Ruppert, Herholz & Lensch 2020, "Robust fitting of parallax-aware mixtures for path guiding", section 5). Here a lobe stores
// the position that it points at, in homogeneous coordinates: with the direction m and the distance d as seen from c,
//     A = m + c / d,   and seen from x   v = A - x / d
// points at the same position, c + d m; if d is infinite, 1 / d = 0 and the direction is the same from all points. |v| is the
// distance from x relative to that from c. A source of a given width is seen under an angle in proportion to the inverse
// distance, so
//     k(x) = k |v|^2.
//
// There are eight lobes, each in a lane of a vector register.

#include <array>

#include "etendue/core/vector.h"

namespace etendue {

/// A number for each lobe.
using LobeLanes = float __attribute__((vector_size(32)));

struct LobeMixture {
  static constexpr int size = 8;
  /// The range of concentrations: from nearly uniform to a cone of half a degree.
  static constexpr float least_concentration = 0.1f, most_concentration = 20000;

  /// One lobe, as seen from a point.
  struct Lobe {
    Vector3 direction;        ///< unit
    float nearness = 0;       ///< 1 / d [1/m]; 0: at infinity
    float concentration = 1;  ///< k
    float weight = 0;         ///< the weights of all lobes add up to 1
  };

  LobeLanes x{}, y{}, z{};    ///< A
  LobeLanes nearness{};       ///< 1 / d [1/m]
  LobeLanes concentration{};  ///< k where |v| = 1
  LobeLanes weight{};

  Lobe seen_from(const Point3& from, int lobe) const;
  void set(const Point3& from, int lobe, const Lobe&);
};

/// A mixture as seen from a point.
class SeenLobes {
 public:
  SeenLobes() = default;
  SeenLobes(const LobeMixture&, const Point3& from);

  /// [1/sr]
  float pdf(const Vector3& direction) const {
    const LobeLanes each = pdfs(direction);
    float sum = 0;
    for (int i = 0; i < LobeMixture::size; ++i) sum += each[i];
    return sum;
  }
  /// The pdf of each lobe, times its weight [1/sr].
  LobeLanes pdfs(const Vector3& direction) const;
  /// Samples a direction with that pdf. `choice` selects the lobe.
  Vector3 sample(float choice, Point2 u) const;

 private:
  LobeLanes x_, y_, z_;  // m
  LobeLanes concentration_;
  LobeLanes factor_;  // the weight times the pdf on the lobe's axis [1/sr]
  LobeLanes weight_;
};

namespace detail {

/// exp(x) for x <= 0, with an error of about 2e-7: of 2^n e^r, the exponent is assembled from bits, and e^r is a minimax
/// polynomial (coefficients of S. Moshier's Cephes library, expf.c). x below -87 gives e^-87.
inline LobeLanes exp_of_negative(LobeLanes x) {
  using Int = std::int32_t __attribute__((vector_size(32)));
  const LobeLanes least = -87.0f - LobeLanes{};
  x = x > least ? x : least;
  const Int n = __builtin_convertvector(x * 1.44269504088896341f - 0.5f, Int);
  const LobeLanes whole = __builtin_convertvector(n, LobeLanes);
  const LobeLanes r = (x - whole * 0.693359375f) + whole * 2.12194440e-4f;
  LobeLanes p = r * 1.9875691500e-4f + 1.3981999507e-3f;
  p = p * r + 8.3334519073e-3f;
  p = p * r + 4.1665795894e-2f;
  p = p * r + 1.6666665459e-1f;
  p = p * r + 5.0000001201e-1f;
  p = p * (r * r) + r + 1.0f;
  return p * std::bit_cast<LobeLanes>((n + 127) << 23);
}

}  // namespace detail

inline SeenLobes::SeenLobes(const LobeMixture& m, const Point3& from) : weight_(m.weight) {
  const LobeLanes x = m.x - m.nearness * from.x, y = m.y - m.nearness * from.y, z = m.z - m.nearness * from.z;
  const LobeLanes tiny = 1e-20f - LobeLanes{};
  LobeLanes squared = x * x + y * y + z * z, length;
  squared = squared > tiny ? squared : tiny;
  for (int i = 0; i < LobeMixture::size; ++i) length[i] = std::sqrt(squared[i]);
  const LobeLanes inverse = 1 / length;
  x_ = x * inverse;
  y_ = y * inverse;
  z_ = z * inverse;
  const LobeLanes least = LobeMixture::least_concentration - LobeLanes{}, most = LobeMixture::most_concentration - LobeLanes{};
  const LobeLanes k = m.concentration * squared;
  concentration_ = k > least ? (k < most ? k : most) : least;
  factor_ = m.weight * concentration_ * (1 / (2 * pi)) / (1 - detail::exp_of_negative(-2 * concentration_));
}

inline LobeLanes SeenLobes::pdfs(const Vector3& w) const {
  // m . w - 1 = -|m - w|^2 / 2 without the cancellation.
  const LobeLanes x = x_ - w.x, y = y_ - w.y, z = z_ - w.z;
  return factor_ * detail::exp_of_negative((x * x + y * y + z * z) * concentration_ * -0.5f);
}

}  // namespace etendue
