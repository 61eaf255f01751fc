#pragma once
// The data of the Hosek-Wilkie sky model, for wavelengths of 360, 400, ... 720 nm; the files of the tables name their source.

namespace etendue::sky_tables {

inline constexpr int turbidities = 10;  ///< 1, 2, ... 10
inline constexpr int albedos = 2;       ///< of the ground: 0 and 1
inline constexpr int controls = 6;      ///< of a Bezier curve over the cube root of the sun's elevation, 90 degrees being 1
inline constexpr int channels = 10;     ///< 360 nm + 40 nm * channel
inline constexpr int shapes = 9;        ///< parameters of the radiance's distribution
inline constexpr int sun_nodes = 46;    ///< at elevations of 90 degrees * (i / 45)^3
inline constexpr int limbs = 6;         ///< coefficients of a polynomial

extern const float shape[turbidities * albedos * controls * channels * shapes];
extern const float radiance[turbidities * albedos * controls * channels];  ///< [W m^-2 sr^-1 nm^-1]
/// Mean radiance of the sun's disc [W m^-2 sr^-1 nm^-1] at a turbidity, channel and node, and its slope [per rad].
extern const float sun[turbidities * channels * sun_nodes * 2];
/// Limb darkening: radiance over that of the disc's middle, in powers of the cosine seen from the sun's centre.
extern const float limb[channels * limbs];

}  // namespace etendue::sky_tables
