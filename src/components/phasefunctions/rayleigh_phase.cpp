// RayleighPhase: the phase function of particles much smaller than the wavelength, such as the molecules of air.

#include <cmath>

#include "etendue/core/math.h"
#include "etendue/polarizing_scatter.h"

namespace etendue {
namespace {

// A small spherical particle is a dipole that oscillates with the light's field (Rayleigh 1871). With c = cos(theta), for
// unpolarized light
//     p = 3 / (16 pi) (1 + c^2)  [1/sr].
// Molecules that are not spherical depolarize part of the light. With rho the ratio of the weaker to the stronger polarization
// of unpolarized light scattered at right angles, and gamma = rho / (2 - rho) (Chandrasekhar 1950, Radiative transfer, section
// 18; Bucholtz 1995, Rayleigh-scattering calculations for the terrestrial atmosphere, eq. 12),
//     p = 3 / (16 pi (1 + 2 gamma)) ((1 + 3 gamma) + (1 - gamma) c^2).
//
// Sampling. With a = (1 + 3 gamma) / (1 - gamma), the probability that the cosine is at least c is
//     P(c) = 1/2 - (3 a c + c^3) / (2 (3 a + 1)),
// so that c^3 + 3 a c = (1 - 2 u)(3 a + 1) = q. Its one real root is c = 2 sqrt(a) sinh(t) with
// 8 a^(3/2) sinh^3(t) + 6 a^(3/2) sinh(t) = 2 a^(3/2) sinh(3 t) = q.
//
// Polarization. In the components across (r) and in (l) the plane of both directions, a Stokes vector (I_l, I_r, U, V) is
// multiplied by (Chandrasekhar 1950, section 18, eq. 250)
//     3 / (2 (1 + 2 gamma)) ( c^2 + gamma s^2   gamma        0              0
//                             gamma             1            0              0
//                             0                 0   (1 - gamma) c           0
//                             0                 0            0   (1 - 3 gamma) c ),       s = sin(theta).
class RayleighPhase final : public PhaseFunction, public PolarizingPhase {
 public:
  static void describe(Description<RayleighPhase>& d) {
    d.summary(
         "Of particles much smaller than the wavelength, as molecules of air: as much back as straight on, half of it "
         "sideways. "
         "How much more of short wavelengths is scattered is a matter of the medium's coefficients.",
         "Rayleigh 1871, On the light from the sky; Chandrasekhar 1950, Radiative transfer, section 18")
        .member<&RayleighPhase::depolarization>(
            "depolarization", "1",
            "how far from round the particles are: of natural light that was scattered at right angles, the weaker "
            "polarization over the stronger; 0.0279 for air",
            range(0, 6.0 / 7), soft(0, 0.1));
  }
  void prepare() override {
    const double gamma = double(depolarization) / (2 - double(depolarization));
    a_ = (1 + 3 * gamma) / (1 - gamma);
    gamma_ = float(gamma);
    factor_ = float(3 * (1 - gamma) / (16 * double(pi) * (1 + 2 * gamma)));
  }
  float value(float h) const override { return factor_ * (float(a_) + square(1 - h)); }
  float sample(float u) const override {
    const double q = (1 - 2 * double(u)) * (3 * a_ + 1), root = std::sqrt(a_);
    return clamp(float(1 - 2 * root * std::sinh(std::asinh(q / (2 * a_ * root)) / 3)), 0, 2);
  }

  /// With I = I_l + I_r and S1 = I_r - I_l, as the reference direction is that across the plane.
  bool polarization(float h, Mueller& m) const override {
    const float c = 1 - h, along = c * c + gamma_ * (1 - c * c), all = along + 1 + 2 * gamma_;
    m = Mueller::diagonal((along + 1 - 2 * gamma_) / all, 2 * (1 - gamma_) * c / all, 2 * (1 - 3 * gamma_) * c / all);
    m(0, 1) = m(1, 0) = Spectrum((1 - along) / all);
    return true;
  }

  float depolarization = 0;

 private:
  float gamma_ = 0;
  double a_ = 1;
  float factor_ = 0;  // [1/sr]
};

const Register<RayleighPhase> registered;

}  // namespace
}  // namespace etendue
