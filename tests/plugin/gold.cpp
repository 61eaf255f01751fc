// A shader in one file, out of tree: gold that scatters diffusely.
#include "etendue/describe/color.h"
#include "etendue/describe/description.h"
#include "etendue/scatter_model.h"

using namespace etendue;

class GoldScatter final : public ScatterModel<GoldScatter> {
 public:
  GoldScatter(const SurfacePoint& p, Spectrum color) : ScatterModel(p, diffuse_reflection), color_(color) {}

  Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes) const {
    return out.z * in.z > 0 ? color_ * inverse_pi : Spectrum();
  }
  float local_pdf(const Vector3& out, const Vector3& in, Lobes) const {
    return out.z * in.z > 0 ? std::abs(in.z) * inverse_pi : 0;
  }
  bool local_sample(const Vector3& out, float, Point2 u, Lobes lobes, LocalSample& s) const {
    // Uniform points of the unit disc, lifted to the hemisphere: the pdf is cos / pi [1/sr].
    const float r = std::sqrt(u.x), phi = 2 * pi * u.y, z = safe_sqrt(1 - u.x);
    s.in = {r * std::cos(phi), r * std::sin(phi), std::copysign(z, out.z)};
    s.lobe = diffuse_reflection;
    s.pdf = local_pdf(out, s.in, lobes);
    s.value = color_ * s.pdf;
    return true;
  }
  Spectrum local_albedo(const Vector3&, Lobes) const { return color_; }

 private:
  Spectrum color_;
};

class GoldShader final : public Shader {
  float purity = 1;
  Color index = metal_index("Au");

 public:
  static void describe(Description<GoldShader>& d) {
    d.summary("Gold leaf that has lost its shine: reflectance at normal incidence, scattered diffusely.")
        .member<&GoldShader::purity>("purity", "1", "fraction that is gold; the rest is black", range(0, 1))
        .member<&GoldShader::index>("index", "1", "complex refractive index of the metal");
  }
  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    const Spectrum n = index->evaluate(w, ColorUse::coefficient), k = index->imaginary()->evaluate(w, ColorUse::coefficient);
    const Spectrum m = n - 1.0f, q = n + 1.0f;
    return arena.make<GoldScatter>(p, purity * (m * m + k * k) / (q * q + k * k));
  }
  Lobes possible_lobes() const override { return diffuse_reflection; }
};

static const Register<GoldShader> registered;
