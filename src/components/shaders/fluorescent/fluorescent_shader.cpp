// FluorescentShader: a matt surface with a fluorescent dye.

#include "components/shaders/lambertian_scatter.h"
#include "components/shaders/reflectance.h"
#include "components/shaders/scalar_map.h"
#include "etendue/dye.h"

namespace etendue {
namespace {

// The dye lies over or in a matt body of the reflectance rho. With its optical depth c x(l) for light on its way in and out, x
// the dye's absorption relative to its largest and c the concentration, it absorbs the fraction
//     a(l) = 1 - exp(-c x(l))     (Beer and Lambert),
// the body reflects rho (1 - a), and the dye emits, alike in all directions,
//     Phi(l' -> l) = a(l') y(l' -> l)     [1/nm], y the dye's yield (etendue/dye.h).
// The dye's light is taken to leave the surface: where it is absorbed again on its way out, the quantum yield given is that of
// the surface as a whole. So of the photons that arrive at l' the fraction rho (1 - a) + Q a leaves, which is at most 1.
class DyedReradiation final : public Reradiation {
 public:
  DyedReradiation(const Scatter& directions, const Dye& dye, float concentration)
      : Reradiation(directions), dye_(dye), concentration_(concentration) {}

  float value(float absorbed, float emitted) const override { return fraction(absorbed) * dye_.yield(absorbed, emitted); }
  // 1 - exp(-c x) = c x if little is absorbed, and more than x for c > 1: an estimate, which is all that a choice needs.
  float received(float emitted) const override { return std::min(concentration_, 1.0f) * dye_.received(emitted); }
  float given(float absorbed) const override { return fraction(absorbed) * dye_.given(absorbed); }
  float sample_absorbed(float, float u, float& pdf) const override { return dye_.absorption().sample(u, pdf); }

 private:
  float fraction(float wavelength) const { return -std::expm1(-concentration_ * dye_.absorption()(wavelength)); }

  const Dye& dye_;
  const float concentration_;
};

class FluorescentShader final : public Shader, public FluorescentSurface {
 public:
  static void describe(Description<FluorescentShader>& d) {
    d.summary(
         "A matt surface with a fluorescent dye, which turns light of one wavelength into light of others: paper with a "
         "brightener, highlighter, signal paint.",
         "Donaldson 1954; Jung, Hanika & Dachsbacher 2018, A simple diffuse fluorescent BBRRDF model")
        .member<&FluorescentShader::color>("color", "1", "fraction of light that the surface would reflect without the dye",
                                           Meaning::reflectance)
        .member<&FluorescentShader::dye>("dye", "", "the dye", required)
        .member<&FluorescentShader::concentration>(
            "concentration", "1",
            "optical depth of the dye where it absorbs most: of this light the fraction exp(-concentration) is left to the "
            "surface",
            Meaning::number, soft(0, 5));
  }

  void prepare() override {
    require_reflectance(*this, "color", color);
    if (!dye) fail("dye", "a dye is needed");
    require_scalar(*this, "concentration", concentration, 0, most);
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    const float c = concentration_at(p);
    const Spectrum left = exp(dye->absorption_at(w) * -c), reflectance = reflectance_at(*color, p, w) * left;
    if (reflectance.black()) return nullptr;
    return arena.make<LambertianScatter>(p, reflectance);
  }
  Lobes possible_lobes() const override { return diffuse_reflection; }

  const Reradiation* bind_reradiation(const SurfacePoint& p, Arena& arena) const override {
    const float c = concentration_at(p);
    if (!(c > 0)) return nullptr;
    return arena.make<DyedReradiation>(*arena.make<LambertianScatter>(p, Spectrum(1.0f)), *dye, c);
  }

  Ref<ObjectMap> color = constant(0.8f);
  Ref<Dye> dye;
  Ref<ObjectMap> concentration = constant(1);

 private:
  static constexpr float most = 1e6f;
  float concentration_at(const SurfacePoint& p) const { return scalar_at(*concentration, p, 0, most); }
};

const Register<FluorescentShader> registered;

}  // namespace
}  // namespace etendue
