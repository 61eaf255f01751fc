#pragma once
// SkyModel: the radiance of a clear sky and of the sun.

#include <array>

#include "etendue/describe/bands.h"

namespace etendue {

// Hosek & Wilkie 2012, "An analytic model for full spectral sky-dome radiance", equations 6 to 9 and section 5. With theta the
// angle to the zenith and gamma the angle to the sun, the radiance at each of ten wavelengths is
//     F(theta, gamma) = (1 + A e^(B / (cos theta + 0.01)))
//                       (C + D e^(E gamma) + F cos^2 gamma + G chi(H, gamma) + I sqrt(cos theta)),
//     chi(g, gamma) = (1 + cos^2 gamma) / (1 + g^2 - 2 g cos gamma)^(3/2),
// times a mean radiance. These ten numbers are Bezier curves of fifth degree over the cube root of the sun's elevation, and
// linear in the turbidity and the ground's albedo. Between wavelengths the radiance is linear.
//
// The sun: Hosek & Wilkie 2013, "Adding a solar-radiance function to the Hosek-Wilkie skylight model": a radiance for each
// elevation, by which the setting sun is redder at its lower edge than at its upper one, and the limb darkening of Neckel &
// Labs. The authors multiply the two, but the radiance is already the disc's mean: at turbidity 1 in the zenith, the radiance
// times the sun's true solid angle equals the extraterrestrial irradiance (ASTM E-490) reduced by Rayleigh scattering and
// ozone, to 1 % at 520 and 720 nm, whereas the product with the limb darkening would be a fifth too low. So the limb darkening
// is divided here by its mean over the disc, which keeps the irradiance.
//
// The data end at 720 nm. Beyond, radiance falls as that of a black body of the sun's 5778 K does.
class SkyModel {
 public:
  static constexpr int channels = 10;
  static float wavelength(int channel) { return 360 + 40 * float(channel); }

  SkyModel() = default;
  /// The albedo at the channels' wavelengths; elevation [rad] of the sun, within [0, pi/2].
  SkyModel(float turbidity, const std::array<float, channels>& albedo, float elevation);

  /// [W m^-2 sr^-1 nm^-1], of the sky without the sun.
  Spectrum sky(float cos_theta, float gamma, const Wavelengths&) const;
  float sky(int channel, float cos_theta, float gamma) const { return sky(channel, View(cos_theta, gamma)); }
  /// Of the sun's disc at an elevation [rad] above the horizon; `cos_psi` is the cosine, seen from the sun's centre, between
  /// the place on its surface and the observer: 1 in the middle, 0 at the limb.
  Spectrum sun(float elevation, float cos_psi, const Wavelengths&) const;
  /// Interpolates the values of the channels at the wavelengths of a path.
  template <class F>
  static Spectrum between_channels(const Wavelengths& w, const F& value) {
    if (in_bands(w)) {
      Xyz sum;
      for (int c = 0; c < channels; ++c) sum += double(value(c)) * color_of_channel(c);
      return xyz_in_bands(sum, ColorUse::radiance, w);
    }
    Spectrum result;
    for (int i = 0; i < spectrum_size; ++i) {
      const float x = clamp((w[i] - 360) / 40, 0, float(channels - 1));
      const int low = int(x);
      if (low == channels - 1)
        result.set(i, value(low) * beyond(w[i]));
      else
        result.set(i, lerp(x - float(low), value(low), value(low + 1)));
    }
    return result;
  }
  /// The colour of light that is 1 at a channel's wavelength and 0 at all others, as interpolated between.
  static const Xyz& color_of_channel(int channel);
  /// The radiance at a wavelength beyond 720 nm, relative to that at 720 nm.
  static float beyond(float wavelength);

 private:
  /// Functions of a direction that are the same for all channels.
  struct View {
    View(float cos_theta, float gamma);
    float gamma, cosine, inverse_zenith, root;
  };
  /// The interval of nodes that contains an elevation: the index of its first node, the fraction towards the second node, and
  /// the distance of the nodes [rad].
  struct Piece {
    explicit Piece(float elevation);
    size_t node;
    float t, width;
  };
  float sky(int channel, const View&) const;
  float sun(int channel, const Piece&) const;

  std::array<std::array<float, 9>, channels> shape_{};  // A ... I, as in sky_tables
  std::array<float, channels> radiance_{};
  std::array<std::array<float, 6>, channels> limb_{};  // of mean 1
  std::array<std::array<float, 92>, channels> sun_{};  // values and slopes
};

}  // namespace etendue
