// A shader with textures, out of tree: a dusty surface after Minnaert 1941, darker towards its rim than a Lambertian one.
#include "etendue/core/warp.h"
#include "etendue/describe/description.h"
#include "etendue/object_map.h"
#include "etendue/scatter_model.h"

using namespace etendue;

// f = c (k + 1) / (2 pi) (cos_out cos_in)^(k - 1) [1/sr], k >= 1. It is reciprocal, and the integral of f cos_in over the
// hemisphere is c cos_out^(k - 1). Directions are sampled with the pdf (k + 1) / (2 pi) cos_in^k [1/sr].
class MinnaertScatter final : public ScatterModel<MinnaertScatter> {
 public:
  MinnaertScatter(const SurfacePoint& p, Spectrum color, float k) : ScatterModel(p, diffuse_reflection), color_(color), k_(k) {}

  Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes) const {
    return out.z * in.z > 0 ? color_ * ((k_ + 1) / (2 * pi) * std::pow(out.z * in.z, k_ - 1)) : Spectrum();
  }
  float local_pdf(const Vector3& out, const Vector3& in, Lobes) const {
    return out.z * in.z > 0 ? warp::power_cosine_pdf(std::abs(in.z), k_) : 0;
  }
  bool local_sample(const Vector3& out, float, Point2 u, Lobes lobes, LocalSample& s) const {
    s.in = warp::power_cosine(u, k_);
    s.in.z = std::copysign(s.in.z, out.z);
    s.lobe = diffuse_reflection;
    s.pdf = local_pdf(out, s.in, lobes);
    s.value = local_albedo(out, lobes) * s.pdf;
    return s.pdf > 0;
  }
  Spectrum local_albedo(const Vector3& out, Lobes) const { return color_ * std::pow(std::abs(out.z), k_ - 1); }

 private:
  Spectrum color_;
  float k_;
};

class MinnaertShader final : public Shader {
  Ref<ObjectMap> color = constant(0.5f), darkness = constant(0.5f);

 public:
  static void describe(Description<MinnaertShader>& d) {
    d.summary("A dusty surface: darker towards its rim than a matt one.",
              "Minnaert 1941, The reciprocity principle in lunar photometry")
        .member<&MinnaertShader::color>("color", "1", "fraction of light reflected straight back, per wavelength")
        .member<&MinnaertShader::darkness>("darkness", "1",
                                           "how much darker the rim is, from 0, a matt surface, to 10 (k - 1)");
  }
  void prepare() override {
    if (!color) fail("color", "is none");
    if (!darkness) fail("darkness", "is none");
  }
  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    const float k = 1 + clamp(darkness->scalar(p), 0, 10);
    return arena.make<MinnaertScatter>(p, color->reflectance(p, w), k);
  }
  Lobes possible_lobes() const override { return diffuse_reflection; }
};

static const Register<MinnaertShader> registered;
