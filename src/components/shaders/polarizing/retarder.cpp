// Retarder: a birefringent plate: a quarter-wave plate, a sheet of cellophane, stressed plastic.

#include "components/shaders/scalar_map.h"
#include "plate.h"

namespace etendue {
namespace {

// The plate's index is n_f for light polarized along the fast axis and n_s > n_f across it. At the thickness d the phase along
// the fast axis leads by phi = 2 pi d (n_s - n_f) / lambda. Of sheets between crossed polarizers, the fraction sin^2(phi / 2)
// passes, which depends on the wavelength: colours tell the path difference d (n_s - n_f) (Michel-Lévy 1888).
class Retarder final : public Shader, public PolarizingPlate {
 public:
  static void describe(Description<Retarder>& d) {
    d.summary(
         "A birefringent plate, for an open surface: light goes straight on, and that polarized along the fast axis leads. A "
         "quarter of a wave makes circular light of linear light at 45 degrees to the axis. Two polarizers are needed to see "
         "it, and a renderer that follows polarization, such as PolarizedPathTracer.",
         "Goldstein 2003, Polarized light, chapter 5")
        .member<&Retarder::angle>("angle", "deg",
                                  "of the fast axis, from the surface's u direction, counter-clockwise seen from the front",
                                  range(-360, 360), soft(0, 180))
        .member<&Retarder::retardance>(
            "retardance", "1",
            "how far light along the fast axis leads, in waves, the same at all wavelengths: 0.25 for "
            "a quarter-wave plate",
            Meaning::number, soft(0, 1), unless("path_difference"))
        .member<&Retarder::path_difference>(
            "path_difference", "nm",
            "how far light along the fast axis leads: the thickness times the difference of the indices. So wavelengths "
            "differ, "
            "and between polarizers there are colours: of cellophane, mica and stressed plastic",
            Meaning::number, soft(0, 2000));
  }
  void prepare() override {
    require_scalar(*this, "retardance", retardance, -most_waves, most_waves);
    if (path_difference) require_scalar(*this, "path_difference", path_difference, -most_path, most_path);
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    Plate::Matter matter;
    if (path_difference) {
      const float path = scalar_at(*path_difference, p, -most_path, most_path);
      for (int i = 0; i < spectrum_size; ++i) matter.phase.set(i, 2 * pi * (path / w[i]));
    } else {
      matter.phase = Spectrum(2 * pi * scalar_at(*retardance, p, -most_waves, most_waves));
    }
    return arena.make<Plate>(p, radians(angle), matter);
  }
  Lobes possible_lobes() const override { return null_scattering; }
  bool transmits() const override { return false; }
  bool lossless() const override { return true; }
  const char* deed() const override { return "changes polarization"; }

  float angle = 0;
  Ref<ObjectMap> retardance = constant(0.25f), path_difference;

 private:
  static constexpr float most_waves = 1000, most_path = 1e6f;
};

const Register<Retarder> registered;

}  // namespace
}  // namespace etendue
