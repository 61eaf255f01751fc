// PerfectSpecular: a mirror.

#include "components/shaders/polarized_fresnel.h"
#include "components/shaders/reflectance.h"
#include "etendue/scatter_model.h"

namespace etendue {
namespace {

class PerfectSpecularScatter final : public ScatterModel<PerfectSpecularScatter>, public PolarizingScatter {
 public:
  PerfectSpecularScatter(const SurfacePoint& p, Spectrum reflectance)
      : ScatterModel(p, specular_reflection), reflectance_(reflectance) {}

  Spectrum local_evaluate(const Vector3&, const Vector3&, Lobes) const { return {}; }
  float local_pdf(const Vector3&, const Vector3&, Lobes) const { return 0; }
  bool local_sample(const Vector3& out, float, Point2, Lobes, LocalSample& s) const {
    s.in = {-out.x, -out.y, out.z};
    s.value = reflectance_;
    s.pdf = 1;
    s.lobe = specular_reflection;
    return true;
  }
  Spectrum local_albedo(const Vector3&, Lobes lobes) const { return (lobes & specular_reflection) ? reflectance_ : Spectrum(); }
  /// As the limit of a conductor whose index grows: a_s = -1, a_p = 1.
  bool polarization(const Vector3& out, const Vector3& in, Lobes, Polarization& event) const override {
    event = polarized::reflection(out, in, [](int, float) { return polarized::Amplitudes{-1, 1}; });
    return true;
  }

 private:
  Spectrum reflectance_;
};

class PerfectSpecular final : public Shader {
 public:
  static void describe(Description<PerfectSpecular>& d) {
    d.summary("A mirror, of the same reflectance at every angle, on both sides.")
        .member<&PerfectSpecular::color>("color", "1", "fraction of light reflected, per wavelength", Meaning::reflectance);
  }
  void prepare() override { require_reflectance(*this, "color", color); }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    const Spectrum reflectance = reflectance_at(*color, p, w);
    if (reflectance.black()) return nullptr;
    return arena.make<PerfectSpecularScatter>(p, reflectance);
  }
  Lobes possible_lobes() const override { return specular_reflection; }

  Ref<ObjectMap> color = constant(1.0f);
};

const Register<PerfectSpecular> registered;

}  // namespace
}  // namespace etendue
