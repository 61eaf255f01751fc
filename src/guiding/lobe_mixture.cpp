#include "etendue/guiding/lobe_mixture.h"

namespace etendue {

LobeMixture::Lobe LobeMixture::seen_from(const Point3& c, int i) const {
  const Vector3 v{x[i] - nearness[i] * c.x, y[i] - nearness[i] * c.y, z[i] - nearness[i] * c.z};
  const float squared = std::max(length_squared(v), 1e-20f), scale = 1 / std::sqrt(squared);
  return {scale * v, scale * nearness[i], clamp(concentration[i] * squared, least_concentration, most_concentration),
          weight[i]};
}

void LobeMixture::set(const Point3& c, int i, const Lobe& lobe) {
  x[i] = lobe.direction.x + lobe.nearness * c.x;
  y[i] = lobe.direction.y + lobe.nearness * c.y;
  z[i] = lobe.direction.z + lobe.nearness * c.z;
  nearness[i] = lobe.nearness;
  concentration[i] = clamp(lobe.concentration, least_concentration, most_concentration);
  weight[i] = lobe.weight;
}

Vector3 SeenLobes::sample(float choice, Point2 u) const {
  int lobe = 0;
  while (lobe + 1 < LobeMixture::size && choice >= weight_[lobe]) choice -= weight_[lobe++];
  // The inverse of the cosine's cumulative distribution function (Jakob 2012, "Numerically stable sampling of the von
  // Mises-Fisher distribution on S^2"), for h = 1 - cosine.
  const float k = concentration_[lobe];
  const float h = clamp(-std::log(1 - (1 - std::exp(-2 * k)) * u.x) / k, 0, 2);
  const float r = safe_sqrt(h * (2 - h));
  float sine = 0, cosine = 0;
  sin_cos_turn(u.y, sine, cosine);
  return Frame(Normal3(x_[lobe], y_[lobe], z_[lobe])).to_world({r * cosine, r * sine, 1 - h});
}

}  // namespace etendue
