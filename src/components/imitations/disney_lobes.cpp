#include "disney_lobes.h"

#include "components/shaders/fresnel.h"
#include "components/shaders/microfacet/microfacet_quadrature.h"
#include "etendue/describe/color.h"

namespace etendue::disney {

Spectrum schlick(Spectrum f0, float cosine, float eta) {
  if (eta < 1) fresnel_dielectric(cosine, eta, cosine);
  const float growth = schlick_growth(cosine);
  return f0 * (1 - growth) + Spectrum(growth);
}

namespace {

/// Albedos of the lobes without facets, by the cosine. The diffuse lobe is a polynomial of second degree in the roughness, so
/// its values at three roughnesses are enough.
struct SmoothTable {
  static constexpr int count = 49;
  float diffuse_at[count][2][3] = {}, sheen_at[count] = {};  // diffuse: by cosine, flatness 0 and 1, roughness 0, 1/2 and 1

  SmoothTable() {
    constexpr int steps = 64, turns = 32;
    for (int i = 0; i < count; ++i) {
      const float c = std::max(square(float(i) / (count - 1)), 1e-5f), s = safe_sqrt(1 - c * c);
      for (int k = 0; k < steps * turns; ++k) {
        // in.z^2 is uniform: the pdf contains the cosine.
        const float z = std::sqrt((float(k / turns) + 0.5f) / steps), r = safe_sqrt(1 - z * z);
        const float turn = pi * (float(k % turns) + 0.5f) / turns;
        const float u = 0.5f * std::sqrt(std::max(2 + 2 * (c * z + s * r * std::cos(turn)), 0.0f));
        for (int flat = 0; flat < 2; ++flat)
          for (int rough = 0; rough < 3; ++rough)
            diffuse_at[i][flat][rough] += diffuse(c, z, u, 0.5f * float(rough), float(flat)) / (steps * turns);
        sheen_at[i] += pi * schlick_growth(u) / (steps * turns);
      }
    }
  }
  template <class F>
  static float between(float cosine, const F& at) {
    const float x = std::sqrt(clamp(cosine, 0, 1)) * (count - 1);
    const int i = std::min(int(x), count - 2);
    return lerp(x - float(i), at(i), at(i + 1));
  }
};
const SmoothTable& smooth_table() {
  static const SmoothTable made;
  return made;
}

/// Albedo of facets with F = (1 - u)^5, by the roots of alpha and of the cosine. Towards a lower index, eta < 1, u is the
/// cosine of the refracted direction.
struct GrazingTable {
  static constexpr int count = 25;
  float value[count][count] = {};

  explicit GrazingTable(float eta) {
    const albedo::Slopes slopes(MicrofacetDistribution::ggx, 48, 32, pi);
    for (int a = 0; a < count; ++a)
      for (int i = 0; i < count; ++i) {
        const MicrofacetDistribution d(MicrofacetDistribution::ggx, square(float(a) / (count - 1)));
        const float c = std::max(square(float(i) / (count - 1)), 1e-4f);
        const Vector3 v{safe_sqrt(1 - c * c), 0, c};
        double sum = 0, seen = 0;
        for (size_t k = 0; k < slopes.x.size(); ++k) {
          const Vector3 m = normalize(Vector3{-d.alpha_x * slopes.x[k], -d.alpha_x * slopes.y[k], 1});
          const float u = dot(v, m);
          if (!(u > 0)) continue;
          const double weight = double(slopes.weight[k] * u / m.z);
          seen += weight;
          const Vector3 in = reflect(v, m);
          if (in.z > 0) sum += weight * double(schlick(Spectrum(), u, eta)[0] * d.G1(in, m));
        }
        value[a][i] = float(sum / seen);
      }
  }

  /// Interpolated along the cosine if `between`, else the greater of two neighbours, because reflection becomes total abruptly
  /// at the critical angle.
  float at(float alpha, float cosine, bool between) const {
    constexpr int last = count - 1;
    const float a = std::sqrt(std::min(alpha, 1.0f)) * last, c = std::sqrt(std::abs(cosine)) * last;
    const int i = std::min(int(a), last - 1), k = std::min(int(c), last - 1);
    const float y = std::min(c - float(k), 1.0f);
    const auto along = [&](const float* row) { return between ? lerp(y, row[k], row[k + 1]) : std::max(row[k], row[k + 1]); };
    return lerp(a - float(i), along(value[i]), along(value[i + 1]));
  }
};

float grazing_albedo(float alpha, const Vector3& v, float eta) {
  static const GrazingTable outside(1);
  if (eta >= 1) return outside.at(alpha, v.z, true);
  constexpr int indices = 25;
  constexpr float least = 0.25f, step = (1 - least) / (indices - 1);
  static const std::vector<GrazingTable> inside = [] {
    std::vector<GrazingTable> all;
    for (int i = 0; i < indices; ++i) all.emplace_back(least + step * float(i));
    return all;
  }();
  const float x = clamp((eta - least) / step, 0, indices - 1);
  const size_t i = std::min(size_t(x), size_t(indices - 2));
  return lerp(x - float(i), inside[i].at(alpha, v.z, false), inside[i + 1].at(alpha, v.z, false));
}

/// The least and the greatest value for the alphas across and along the grooves and their geometric mean.
template <class Albedo>
Bounds bounds(const MicrofacetDistribution& d, const Albedo& of) {
  const float between = of(std::sqrt(d.alpha_x * d.alpha_y));
  if (d.alpha_x == d.alpha_y) return {between, between};
  const auto [least, greatest] = std::minmax({between, of(d.alpha_x), of(d.alpha_y)});
  return {least, greatest};
}

}  // namespace

MicrofacetDistribution facets(float roughness, float anisotropy) {
  const float aspect = std::sqrt(1 - 0.9f * anisotropy), squared = square(roughness);
  MicrofacetDistribution d(MicrofacetDistribution::ggx, squared);
  d.alpha_x = std::max(squared / aspect, MicrofacetDistribution::smooth_below);
  d.alpha_y = std::max(squared * aspect, MicrofacetDistribution::smooth_below);
  return d;
}

float diffuse(float cosine_out, float cosine_in, float half_cosine, float roughness, float flatness) {
  const float o = schlick_growth(cosine_out), i = schlick_growth(cosine_in), r = 2 * roughness * square(half_cosine);
  float value = (1 - 0.5f * o) * (1 - 0.5f * i) + r * (o + i + o * i * (r - 1));
  if (flatness > 0) {
    const float f = lerp(o, 1, r / 2) * lerp(i, 1, r / 2);
    value = lerp(flatness, value, 1.25f * (f * (1 / (cosine_out + cosine_in) - 0.5f) + 0.5f));
  }
  return value;
}

float diffuse_albedo(float cosine, float roughness, float flatness) {
  const auto of = [&](int flat) {
    return SmoothTable::between(cosine, [&](int i) {
      const float* v = smooth_table().diffuse_at[i][flat];  // Lagrange's polynomial
      const float r = 2 * roughness;
      return 0.5f * (r - 1) * (r - 2) * v[0] - r * (r - 2) * v[1] + 0.5f * r * (r - 1) * v[2];
    });
  };
  return flatness > 0 ? lerp(flatness, of(0), of(1)) : of(0);
}

float sheen_albedo(float cosine) {
  return SmoothTable::between(cosine, [](int i) { return smooth_table().sheen_at[i]; });
}

Bounds grazing_albedo(const MicrofacetDistribution& d, const Vector3& v, float eta) {
  return bounds(d, [&](float alpha) { return grazing_albedo(alpha, v, eta); });
}

Bounds whole_albedo(const MicrofacetDistribution& d, const Vector3& v) {
  return bounds(d, [&](float alpha) { return 1 - MultipleReflection({d.kind, alpha}).missing(v); });
}

// Close to an index of 1, F rises within the last degree, between two entries of the table: the least value is then that of a
// smooth boundary.
Bounds dielectric_albedo(const MicrofacetDistribution& d, const Vector3& v, float eta) {
  const auto table = [&](float alpha) { return 1 - CoatTransmittance({d.kind, alpha}, clamp(eta, 0.25f, 4))(v); };
  const auto [least, greatest] = bounds(d, table);
  return {std::min(least, fresnel_dielectric(std::abs(v.z), eta)), greatest};
}

Spectrum tint_of(const ObjectMap& color, Spectrum at_path, const SurfacePoint& p) {
  constexpr int sets = 5, all = sets * spectrum_size;
  static const std::array<double, all> weights = [] {
    std::array<double, all> w{};
    const Color daylight = illuminant_spectrum("D65");
    double sum = 0;
    for (int i = 0; i < all; ++i) {
      const float lambda = 400 + 300 * (float(i) + 0.5f) / all;
      sum += w[size_t(i)] = observer(lambda).y * double(daylight->at(lambda, ColorUse::radiance));
    }
    for (double& x : w) x /= sum;
    return w;
  }();
  double luminance = 0;
  for (int set = 0; set < sets; ++set) {
    Wavelengths w;
    for (int i = 0; i < spectrum_size; ++i) w.place(i, 400 + 300 * (float(set * spectrum_size + i) + 0.5f) / all, 1 / 300.0f);
    const Spectrum s = color.reflectance(p, w);
    for (int i = 0; i < spectrum_size; ++i) luminance += weights[size_t(set * spectrum_size + i)] * double(s[i]);
  }
  return luminance > 0 ? at_path / float(luminance) : Spectrum(1.0f);
}

}  // namespace etendue::disney
