#pragma once
// Images for the report, as data URIs.

#include "agreement.h"
#include "etendue/render/job.h"
#include "etendue/tone_map.h"

namespace etendue::verify {

/// An image of 8-bit sRGB: "data:image/png;base64,…"
std::string png_uri(int width, int height, const std::vector<unsigned char>& rgb);

/// A map of where the first renderer is brighter (red) or darker (blue): z of each tile of a layer, white at 0, full colour
/// from |z| = `z_of_full_color`. Tiles that disagree have a black frame, undecided ones a grey one. "data:image/png;base64,…"
std::string difference_map(const Layout&, const PairAgreement&, size_t layer);
inline constexpr double z_of_full_color = 5;

/// The colour of a z-score on these maps, each component from 0 to 255.
std::array<unsigned char, 3> difference_color(double z);

/// The tone map for the images of a report: the job's own, if its results fit a display, else the default one, prepared.
Ref<ToneMap> display_tone_map(const Job&);

/// An XYZ image, tone mapped, as a data URI.
std::string displayed_picture(const Image&, const ToneMap&);

}  // namespace etendue::verify
