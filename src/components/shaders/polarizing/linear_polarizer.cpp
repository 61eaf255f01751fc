// LinearPolarizer: a sheet that lets light of one linear polarization pass.

#include "components/shaders/reflectance.h"
#include "plate.h"

namespace etendue {
namespace {

class LinearPolarizer final : public Shader, public PolarizingPlate {
 public:
  static void describe(Description<LinearPolarizer>& d) {
    d.summary(
         "A polarizing sheet, for an open surface such as a Rectangle: light goes straight on, if it is polarized along the "
         "axis. "
         "Half of unpolarized light passes. Renderers that do not follow polarization let half of the light pass at each "
         "sheet; "
         "PolarizedPathTracer follows it.",
         "Goldstein 2003, Polarized light, chapter 5; Korger et al. 2013, The polarization properties of a tilted polarizer")
        .member<&LinearPolarizer::angle>("angle", "deg",
                                         "of the axis, from the surface's u direction, counter-clockwise seen from the front",
                                         range(-360, 360), soft(0, 180))
        .member<&LinearPolarizer::transmitted>("transmitted", "1", "fraction of the light polarized along the axis that passes",
                                               Meaning::reflectance)
        .member<&LinearPolarizer::leaked>("leaked", "1",
                                          "fraction of the light polarized across the axis that passes; 0 for an ideal sheet",
                                          Meaning::reflectance);
  }
  void prepare() override {
    require_reflectance(*this, "transmitted", transmitted);
    require_reflectance(*this, "leaked", leaked);
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    return arena.make<Plate>(p, radians(angle),
                             Plate::Matter{reflectance_at(*transmitted, p, w), reflectance_at(*leaked, p, w), Spectrum()});
  }
  Lobes possible_lobes() const override { return null_scattering; }
  bool transmits() const override { return false; }
  const char* deed() const override { return "polarizes"; }

  float angle = 0;
  Ref<ObjectMap> transmitted = constant(1.0f), leaked = constant(0.0f);
};

const Register<LinearPolarizer> registered;

}  // namespace
}  // namespace etendue
