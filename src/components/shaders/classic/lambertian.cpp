// Lambertian: diffuse reflection, with equal radiance in all directions on the side the light came from.

#include "components/shaders/lambertian_scatter.h"
#include "components/shaders/reflectance.h"

namespace etendue {
namespace {

class Lambertian final : public Shader {
 public:
  static void describe(Description<Lambertian>& d) {
    d.summary("A matt surface: light leaves alike in all directions.", "Lambert 1760, Photometria")
        .member<&Lambertian::color>("color", "1", "fraction of light reflected, per wavelength", Meaning::reflectance);
  }
  void prepare() override { require_reflectance(*this, "color", color); }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    const Spectrum reflectance = reflectance_at(*color, p, w);
    if (reflectance.black()) return nullptr;
    return arena.make<LambertianScatter>(p, reflectance);
  }
  Lobes possible_lobes() const override { return diffuse_reflection; }

  Ref<ObjectMap> color = constant(0.5f);
};

const Register<Lambertian> registered;

}  // namespace
}  // namespace etendue
