#pragma once
// Pictures for the report, as data URIs.

#include "agreement.h"
#include "etendue/tone_map.h"

namespace etendue::verify {

/// RFC 4648, with padding.
std::string base64(const std::vector<unsigned char>& bytes);

/// An image of 8-bit sRGB: "data:image/png;base64,…"
std::string png_uri(int width, int height, const std::vector<unsigned char>& rgb);

/// Where a renderer sees more (red) or less (blue) than the other: z of each tile of a layer, white at 0, full colour from
/// `z_of_full_color` on. Tiles that disagree have a black frame, undecided ones a grey one. "data:image/png;base64,…"
std::string difference_map(const Layout&, const PairAgreement&, size_t layer);
inline constexpr double z_of_full_color = 5;

/// The color of a z-score on these maps, each part from 0 to 255.
std::array<unsigned char, 3> difference_color(double z);

/// A picture in X Y Z as it is displayed.
std::string displayed_picture(const Image&, const ToneMap&);

}  // namespace etendue::verify
