// AshikhminShirley: an anisotropic Phong highlight with Fresnel reflection over a diffuse base, which darkens as the highlight
// grows.

#include "components/shaders/reflectance.h"
#include "components/shaders/scalar_map.h"
#include "components/shaders/tangent_frame.h"
#include "matte_glossy_scatter.h"

namespace etendue {
namespace {

// Ashikhmin & Shirley 2000: with the exponent n(h) = nu cos(phi)^2 + nv sin(phi)^2 in h's azimuth phi,
//   glossy   f = sqrt((nu + 1)(nv + 1)) / (8 pi) t^n(h) F(u) / (u max(v, v')),   F(u) = Rs + (1 - Rs)(1 - u)^5,
//   diffuse  f = 28 Rd / (23 pi) (1 - Rs) (1 - (1 - v/2)^5) (1 - (1 - v'/2)^5)   [1/sr].
//
// Sampling: h has the pdf sqrt((nu + 1)(nv + 1)) / (2 pi) t^n(h) [1/sr]. In a quarter turn phi = atan(sqrt((nu + 1)/(nv + 1))
// tan(pi x / 2)), t = y^(1/(n + 1)) for uniform x and y. With the Jacobian 1/(4 u) for `in`, f v' / pdf = F v' / max(v, v') <=
// F. The diffuse part is sampled with the pdf cos / pi; its albedo is Rd (1 - Rs) (1 - (1 - v/2)^5).
//
// Energy: the albedo is at most Rs + (1 - Rs) (E[(1 - u)^5] + 1 - (1 - v/2)^5). The least u is that of the grazing direction
// `in` opposite to `out`, (sqrt(1 + v) - sqrt(1 - v)) / 2 >= v/2; so the sum is at most 1.
struct PhongHalf {
  float nu, nv;

  Vector3 sample(Point2 u) const {
    const float x = 4 * u.x, quarter = std::floor(x);
    float sine = 0, cosine = 0;
    sin_cos_turn(0.25f * (x - quarter), sine, cosine);
    // (cos(phi), sin(phi)): a vector of the tangent given above, normalized.
    Vector3 v{std::sqrt(nv + 1) * cosine, std::sqrt(nu + 1) * sine, 0};
    v = v / length(v);
    const float n = nu * v.x * v.x + nv * v.y * v.y;
    const int q = int(quarter);
    if (q == 1 || q == 2) v.x = -v.x;
    if (q >= 2) v.y = -v.y;
    // 1 - t, which stays precise for large n.
    const float k = -std::expm1(std::log1p(-std::min(u.y, one_minus_epsilon)) / (n + 1)), s = safe_sqrt(k * (2 - k));
    return {s * v.x, s * v.y, 1 - k};
  }
  /// The pdf of h [1/sr].
  float pdf(const HalfVector& half) const {
    const float s2 = half.sine_squared();
    if (s2 >= 1) return 0;
    // t^n(h) = (1 - s2)^(n(h) / 2) and n(h) s2 = nu h.x^2 + nv h.y^2.
    const float power =
        s2 > 0 ? std::exp(0.5f * (nu * half.h.x * half.h.x + nv * half.h.y * half.h.y) / s2 * std::log1p(-s2)) : 1;
    return std::sqrt((nu + 1) * (nv + 1)) / (2 * pi) * power;
  }
};

/// Means of v' / max(v, v'), and of this times (1 - u)^5; tabulated by (n + 1)^(-1/4) along the azimuth of `out` and across it.
using Table = AlbedoTable<2>;
const Table& albedo_table() {
  static const Table table(
      [](float along, float across, Point2 u) {
        const auto exponent = [](float shape) { return 1 / square(square(std::max(shape, 0.03f))) - 1; };
        return PhongHalf{exponent(along), exponent(across)}.sample(u);
      },
      [](float, float, const Vector3& h, float cosine) {
        const float towards_h = dot(h, towards_x(cosine)), v = 2 * towards_h * h.z - cosine;
        if (v <= 0) return Table::Value{};
        const float level = v / std::max(v, cosine);
        return Table::Value{level, level * schlick_growth(towards_h)};
      });
  return table;
}

class AshikhminShirleyScatter final : public HalfVectorScatter<AshikhminShirleyScatter> {
 public:
  AshikhminShirleyScatter(const SurfacePoint& p, const Frame& frame, Lobes lobes, Spectrum matte, Spectrum specular,
                          PhongHalf shape, const Table& table)
      : HalfVectorScatter(p, frame, lobes),
        base_(matte * (Spectrum(1.0f) - specular)),
        specular_(specular),
        shape_(shape),
        table_(&table) {}

 private:
  friend class MatteGlossyScatter<AshikhminShirleyScatter>;
  friend class HalfVectorScatter<AshikhminShirleyScatter>;
  Spectrum matte(const Vector3& out, const Vector3& in) const { return base_ * (28 / (23 * pi) * passed(out) * passed(in)); }
  ScatterValue glossy(const Vector3& out, const Vector3& in) const {
    const HalfVector half = half_vector(out, in);
    const float pdf = shape_.pdf(half) / (4 * half.u);
    const Spectrum fresnel = specular_ + (Spectrum(1.0f) - specular_) * schlick_growth(half.u);
    return {fresnel * (pdf / std::max(std::abs(out.z), std::abs(in.z))), pdf};
  }
  Vector3 sample_half(Point2 u) const { return shape_.sample(u); }
  Spectrum matte_albedo(const Vector3& out) const { return base_ * passed(out); }
  Spectrum glossy_albedo(const Vector3& out) const {
    const Table::Value mean = table_->turned(out, width(shape_.nu), width(shape_.nv));
    return specular_ * mean[0] + (Spectrum(1.0f) - specular_) * mean[1];
  }
  float matte_weight(const Vector3& out) const { return base_.average() * passed(out); }
  float glossy_weight(const Vector3& out) const { return std::max(glossy_albedo(out).average(), 1e-4f); }

  static float passed(const Vector3& v) { return 1 - schlick_growth(0.5f * std::abs(v.z)); }
  static float width(float exponent) { return 1 / std::sqrt(std::sqrt(exponent + 1)); }

  Spectrum base_, specular_;  ///< base_: Rd (1 - Rs)
  PhongHalf shape_;
  const Table* table_;
};

class AshikhminShirley final : public Shader {
 public:
  static void describe(Description<AshikhminShirley>& d) {
    d.summary("An anisotropic Phong highlight that grows towards grazing angles, over a matt base that fades there.",
              "Ashikhmin & Shirley 2000, An anisotropic Phong BRDF model")
        .member<&AshikhminShirley::color>(
            "color", "1", "fraction the base reflects of the light that reaches it, per wavelength", Meaning::reflectance)
        .member<&AshikhminShirley::specular>(
            "specular", "1", "fraction the highlight reflects at normal incidence, per wavelength", Meaning::reflectance)
        .member<&AshikhminShirley::exponent_u>("exponent_u", "1", "sharpness of the highlight along u, from 0 to 1e6",
                                               Meaning::number, soft(1, 10000), logarithmic)
        .member<&AshikhminShirley::exponent_v>("exponent_v", "1", "the same across u", Meaning::number, soft(1, 10000),
                                               logarithmic)
        .member<&AshikhminShirley::rotation>("rotation", "turn", "by how many turns the pattern is rotated against u",
                                             Meaning::number, soft(0, 1));
  }
  void prepare() override {
    require_reflectance(*this, "color", color);
    require_reflectance(*this, "specular", specular);
    require_scalar(*this, "exponent_u", exponent_u, 0, sharpest);
    require_scalar(*this, "exponent_v", exponent_v, 0, sharpest);
    if (!rotation) fail("rotation", "a map or a number is needed");
    table_ = &albedo_table();
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    const Spectrum matte = reflectance_at(*color, p, w), glossy = reflectance_at(*specular, p, w);
    const bool base = !(matte * (Spectrum(1.0f) - glossy)).black();
    const PhongHalf shape{scalar_at(*exponent_u, p, 0, sharpest), scalar_at(*exponent_v, p, 0, sharpest)};
    const Frame frame = shape.nu == shape.nv ? Frame(p.shading_normal) : tangent_frame(p, rotation->scalar(p));
    return arena.make<AshikhminShirleyScatter>(p, frame, Lobes(glossy_reflection | (base ? diffuse_reflection : 0)), matte,
                                               glossy, shape, *table_);
  }
  /// Interpolation error of the albedo table.
  float albedo_error() const override { return 0.05f; }
  Lobes possible_lobes() const override { return diffuse_reflection | glossy_reflection; }

  Ref<ObjectMap> color = constant(0.5f), specular = constant(0.05f), exponent_u = constant(10.0f),
                 exponent_v = constant(100.0f), rotation = constant(0.0f);

 private:
  static constexpr float sharpest = 1e6f;
  const Table* table_ = nullptr;
};

const Register<AshikhminShirley> registered;

}  // namespace
}  // namespace etendue
