// PhongShader: a Phong lobe over a Lambertian base, normalized so that energy is conserved and f is reciprocal.

#include "components/shaders/reflectance.h"
#include "matte_glossy_scatter.h"

namespace etendue {
namespace {

// f = kd / pi + ks (n + 2) / (2 pi) cos(alpha)^n  [1/sr]   (Lafortune & Willems 1994, eq. 6) where alpha is the angle between
// `in` and the mirror direction of `out`; f = kd / pi where alpha > 90 degrees. The lobe's albedo is ks at normal incidence and
// less elsewhere, so the total albedo is at most kd + ks.
//
// Sampling: the lobe is chosen with probability proportional to an estimate of its albedo. Diffuse directions have the pdf cos
// / pi, glossy ones (n + 1) / (2 pi) cos(alpha)^n around the mirror direction. Glossy directions below the surface are
// absorbed, so the pdf integrates to less than 1 at grazing angles.
//
// The glossy lobe's albedo over ks is a(c) = (n + 2) / (n + 1) E[max(cos(in), 0)] under its own sampling pdf, c being the
// cosine of `out`. It is 1 at c = 1, and at c = 0 the mean of sin(alpha) max(cos(phi), 0), which gives a0 = (n + 2) / (2 pi)
// B((n + 1) / 2, 3 / 2). a is convex between, so the straight line between the ends bounds it from above; it is exact for n = 0
// and in the limit of large n.
class PhongScatter final : public MatteGlossyScatter<PhongScatter> {
 public:
  PhongScatter(const SurfacePoint& p, Lobes lobes, Spectrum diffuse, Spectrum specular, float exponent, float grazing_albedo)
      : MatteGlossyScatter(p, lobes),
        diffuse_(diffuse),
        specular_(specular),
        exponent_(exponent),
        grazing_albedo_(grazing_albedo),
        diffuse_weight_(diffuse.average()),
        specular_weight_(specular.average()) {}

  bool local_sample(const Vector3& out, float choice, Point2 u, Lobes lobes, LocalSample& s) const {
    const float probability = glossy_probability(out, lobes);
    const Vector3 r = mirror(out);
    float power = 0;
    if (choice < probability) {
      // cos(alpha) = u^(1/(n+1)), computed from t = 1 - cos(alpha), which stays precise for sharp lobes.
      const float t = -std::expm1(std::log(std::max(u.x, 1e-30f)) / (exponent_ + 1));
      const float sine = safe_sqrt(t * (2 - t)), phi = 2 * pi * u.y;
      const Frame around(Normal3{r});
      s.in = around.to_world({sine * std::cos(phi), sine * std::sin(phi), 1 - t});
      s.lobe = glossy_reflection;
      if (!(s.in.z * out.z > 0)) return false;
      power = lobe_power(2 * t);
    } else {
      s.in = warp::cosine_hemisphere(u);
      if (out.z < 0) s.in.z = -s.in.z;
      s.lobe = diffuse_reflection;
      if (s.in.z == 0) return false;
      power = lobe_power(length_squared(s.in - r));
    }
    return complete(s, combine(s.in, probability, lobes, [&] { return matte(out, s.in); }, [&] { return lobe(power); }));
  }

 private:
  friend class MatteGlossyScatter<PhongScatter>;
  Spectrum matte(const Vector3&, const Vector3&) const { return diffuse_ * inverse_pi; }
  ScatterValue glossy(const Vector3& out, const Vector3& in) const {
    return lobe(lobe_power(length_squared(in - mirror(out))));
  }
  Spectrum matte_albedo(const Vector3&) const { return diffuse_; }
  Spectrum glossy_albedo(const Vector3& out) const { return specular_ * relative_albedo(out); }
  float matte_weight(const Vector3&) const { return diffuse_weight_; }
  float glossy_weight(const Vector3& out) const { return specular_weight_ * relative_albedo(out); }
  float relative_albedo(const Vector3& out) const { return lerp(std::abs(out.z), grazing_albedo_, 1); }

  static Vector3 mirror(const Vector3& v) { return {-v.x, -v.y, v.z}; }
  /// cos(alpha)^n from the squared distance d2 of the two unit vectors: cos(alpha) = 1 - d2 / 2.
  float lobe_power(float d2) const {
    if (d2 >= 2) return 0;
    return std::exp(exponent_ * std::log1p(-0.5f * d2));
  }
  ScatterValue lobe(float power) const {
    return {specular_ * ((exponent_ + 2) * power / (2 * pi)), (exponent_ + 1) * power / (2 * pi)};
  }

  Spectrum diffuse_, specular_;
  float exponent_, grazing_albedo_, diffuse_weight_, specular_weight_;
};

class PhongShader final : public Shader {
 public:
  static void describe(Description<PhongShader>& d) {
    d.summary(
         "Energy-conserving Phong lobe over a Lambertian base. Where `color` and `specular` together exceed 1, both are scaled "
         "down to a sum of 1.",
         "Lafortune & Willems 1994, Using the modified Phong reflectance model for physically based rendering, eq. 6")
        .member<&PhongShader::color>("color", "1", "fraction of light reflected diffusely, per wavelength",
                                     Meaning::reflectance)
        .member<&PhongShader::specular>("specular", "1",
                                        "fraction of light reflected by the lobe at normal incidence, per wavelength",
                                        Meaning::reflectance)
        .member<&PhongShader::exponent>("exponent", "1", "lobe sharpness", range(0, 1e6), soft(1, 10000), logarithmic);
  }

  void prepare() override {
    require_reflectance(*this, "color", color);
    require_reflectance(*this, "specular", specular);
    warn_of_sum(*this, "color", color, "specular", specular);
    // Without <cmath>'s beta: B(a, b) = Gamma(a) Gamma(b) / Gamma(a + b); Gamma(3/2) = sqrt(pi) / 2.
    const double n = exponent;
    const double beta = std::exp(std::lgamma((n + 1) / 2) - std::lgamma((n + 4) / 2)) * 0.88622692545275801365;
    grazing_albedo_ = float((n + 2) / (2 * 3.14159265358979323846) * beta);
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    Spectrum diffuse = reflectance_at(*color, p, w), glossy = reflectance_at(*specular, p, w);
    const Lobes lobes = Lobes((diffuse.black() ? 0 : diffuse_reflection) | (glossy.black() ? 0 : glossy_reflection));
    if (lobes == no_lobes) return nullptr;
    const Spectrum scale = Spectrum(1.0f) / max(diffuse + glossy, 1.0f);
    return arena.make<PhongScatter>(p, lobes, diffuse * scale, glossy * scale, exponent, grazing_albedo_);
  }
  /// The glossy albedo, a convex curve, is approximated by a straight line (see PhongScatter).
  float albedo_error() const override { return 0.3f; }
  Lobes possible_lobes() const override { return diffuse_reflection | glossy_reflection; }

  Ref<ObjectMap> color = constant(0.5f), specular = constant(0.3f);
  float exponent = 32;

 private:
  float grazing_albedo_ = 0;
};

const Register<PhongShader> registered;

}  // namespace
}  // namespace etendue
