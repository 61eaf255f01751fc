// FogPhase: the phase function of water droplets.

#include <cmath>

#include "etendue/core/math.h"
#include "etendue/phase_function.h"
#include "henyey_greenstein.h"

namespace etendue {
namespace {

// By Mie's theory a droplet has a narrow forward peak, a broad lobe, and scatters more light backwards than sideways. Jendersie
// & d'Eon (2023, An approximate Mie scattering function for fog and cloud rendering) fit this by a Henyey-Greenstein lobe for
// the peak and a lobe of Draine (2003, Scattering by interstellar dust grains, eq. 8) for the rest, in the ratio 1 - w to w:
//     p_D = (1 - g^2) / (4 pi (1 + g^2 - 2 g c)^(3/2)) (1 + a c^2) / (1 + a (1 + 2 g^2) / 3)  [1/sr],   c = cos(theta),
// with parameters that are functions of the droplets' diameter between 5 and 50 micrometres (their table 1).
//
// Sampling Draine's lobe. Let s^2 = 1 + g^2 - 2 g c, with s from 1 - g forward to 1 + g backward, A = 1 + g^2 and B = 2 g. Then
// c = (A - s^2) / B, and the probability of an angle up to that of s is N (F(s) - F(1 - g)) with
//     F(s) = -1/s + a / B^2 (-A^2 / s - 2 A s + s^3 / 3),   N = (1 - g^2) / (B (1 + a (1 + 2 g^2) / 3)).
// F increases, as its derivative is (1 + a c^2) / s^2; N (F(s) - F(1 - g)) = u is solved by Newton's method, with bisection as
// a safeguard.
class FogPhase final : public PhaseFunction {
 public:
  static void describe(Description<FogPhase>& d) {
    d.summary(
         "Of droplets of water, as in fog and clouds, by a fit to Mie's theory: a narrow peak straight on, a broad lobe, and a "
         "brighter back. The larger the droplets, the narrower the peak.",
         "Jendersie & d'Eon 2023, An approximate Mie scattering function for fog and cloud rendering")
        .member<&FogPhase::droplet_diameter>(
            "droplet_diameter", "m", "of the droplets: of fog 5 to 20 micrometres, of clouds 10 to 50, for which the fit holds",
            range(5e-6, 50e-6), soft(5e-6, 50e-6));
  }
  void prepare() override {
    const double d = double(droplet_diameter) * 1e6;
    peak_ = float(std::exp(-0.0990567 / (d - 1.67154)));
    g_ = std::exp(-2.20679 / (d + 3.91029) - 0.428934);
    a_ = std::exp(3.62489 - 8.29288 / (d + 5.52825));
    broad_ = float(std::exp(-0.599085 / (d - 0.641583) - 0.665888));
    whole_ = 1 + a_ * (1 + 2 * g_ * g_) / 3;
  }
  float value(float h) const override {
    const double c = 1 - double(h);
    const float draine = henyey_greenstein::value(float(g_), h) * float((1 + a_ * c * c) / whole_);
    return lerp(broad_, henyey_greenstein::value(peak_, h), draine);
  }
  float sample(float u) const override {
    return u < broad_ ? sample_draine(double(u) / double(broad_))
                      : henyey_greenstein::sample(peak_, std::min((u - broad_) / (1 - broad_), 1.0f));
  }

  float droplet_diameter = 20e-6f;

 private:
  float sample_draine(double u) const {
    const double A = 1 + g_ * g_, B = 2 * g_, N = (1 - g_ * g_) / (B * whole_);
    const auto F = [&](double s) { return -1 / s + a_ / (B * B) * (-A * A / s - 2 * A * s + s * s * s / 3); };
    double low = 1 - g_, high = 1 + g_, s = 1;
    const double wanted = u / N + F(low);
    for (int step = 0; step < 60; ++step) {
      const double off = F(s) - wanted, c = (A - s * s) / B;
      (off < 0 ? low : high) = s;
      double next = s - off * s * s / (1 + a_ * c * c);
      if (!(next > low && next < high)) next = (low + high) / 2;
      if (std::abs(next - s) < 1e-10) break;
      s = next;
    }
    return clamp(float((s - (1 - g_)) * (s + (1 - g_)) / B), 0, 2);
  }

  double g_ = 0, a_ = 0, whole_ = 1;  // of Draine's lobe: g, a, 1 + a (1 + 2 g^2) / 3
  float peak_ = 0, broad_ = 0;        // g of the peak, and the weight w of Draine's lobe
};

const Register<FogPhase> registered;

}  // namespace
}  // namespace etendue
