// DiffuseTransmitter: a thin sheet that reflects and transmits light diffusely: paper, a leaf, a lamp shade.

#include "components/shaders/reflectance.h"
#include "etendue/core/warp.h"
#include "etendue/scatter_model.h"

namespace etendue {
namespace {

// f = R / pi for directions on the same side and T / pi for directions on opposite sides [1/sr]: the fraction R of the light is
// reflected and T transmitted, both with Lambert's distribution. The side is chosen in proportion to R and T (means over the
// path's wavelengths), the direction there with the pdf cos / pi.
class DiffuseTransmitterScatter final : public ScatterModel<DiffuseTransmitterScatter> {
 public:
  DiffuseTransmitterScatter(const SurfacePoint& p, Lobes lobes, Spectrum reflectance, Spectrum transmittance)
      : ScatterModel(p, lobes), reflectance_(reflectance), transmittance_(transmittance) {
    const float r = reflectance.average(), t = transmittance.average();
    reflect_probability_ = r / (r + t);
  }

  Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes) const {
    return (out.z * in.z > 0 ? reflectance_ : transmittance_) * inverse_pi;
  }
  float local_pdf(const Vector3& out, const Vector3& in, Lobes lobes) const {
    const float reflect = reflect_probability(lobes);
    return (out.z * in.z > 0 ? reflect : 1 - reflect) * std::abs(in.z) * inverse_pi;
  }
  bool local_sample(const Vector3& out, float choice, Point2 u, Lobes lobes, LocalSample& s) const {
    const float reflect = reflect_probability(lobes);
    const bool reflected = choice < reflect;
    s.in = warp::cosine_hemisphere(u);
    const float pdf = s.in.z * inverse_pi;
    s.value = (reflected ? reflectance_ : transmittance_) * pdf;
    s.pdf = (reflected ? reflect : 1 - reflect) * pdf;
    s.lobe = reflected ? diffuse_reflection : diffuse_transmission;
    if ((out.z < 0) == reflected) s.in.z = -s.in.z;
    return s.pdf > 0;
  }
  Spectrum local_albedo(const Vector3&, Lobes lobes) const {
    Spectrum sum;
    if (lobes & diffuse_reflection) sum += reflectance_;
    if (lobes & diffuse_transmission) sum += transmittance_;
    return sum;
  }

 private:
  float reflect_probability(Lobes lobes) const {
    if (!(lobes & diffuse_transmission)) return 1;
    return lobes & diffuse_reflection ? reflect_probability_ : 0;
  }

  Spectrum reflectance_, transmittance_;
  float reflect_probability_;
};

class DiffuseTransmitter final : public Shader {
 public:
  static void describe(Description<DiffuseTransmitter>& d) {
    d.summary(
         "A thin matt sheet that light also passes through, leaving alike in all directions on either side. Where "
         "reflectance and transmittance together exceed 1, both are scaled down to a sum of 1.")
        .member<&DiffuseTransmitter::reflectance>(
            "reflectance", "1", "fraction of light that leaves on the side it came from, per wavelength", Meaning::reflectance)
        .member<&DiffuseTransmitter::transmittance>(
            "transmittance", "1", "fraction of light that leaves on the other side, per wavelength", Meaning::reflectance);
  }
  void prepare() override {
    require_reflectance(*this, "reflectance", reflectance);
    require_reflectance(*this, "transmittance", transmittance);
    warn_of_sum(*this, "reflectance", reflectance, "transmittance", transmittance);
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    const Spectrum r = reflectance_at(*reflectance, p, w), t = reflectance_at(*transmittance, p, w);
    const Lobes lobes = Lobes((r.black() ? 0 : diffuse_reflection) | (t.black() ? 0 : diffuse_transmission));
    if (lobes == no_lobes) return nullptr;
    const Spectrum scale = Spectrum(1.0f) / max(r + t, 1.0f);
    return arena.make<DiffuseTransmitterScatter>(p, lobes, r * scale, t * scale);
  }
  Lobes possible_lobes() const override { return diffuse_reflection | diffuse_transmission; }
  bool transmits() const override { return false; }  // a thin sheet has no interior

  Ref<ObjectMap> reflectance = constant(0.4f), transmittance = constant(0.4f);
};

const Register<DiffuseTransmitter> registered;

}  // namespace
}  // namespace etendue
