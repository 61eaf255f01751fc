#pragma once
// The bands of an image: channels named by a wavelength, as the layout of Fichet, Pacanowski & Wilkie 2021 (An OpenEXR layout
// for spectral images, JCGT 10(3), section 3) writes them and spectral films develop them.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "etendue/core/image.h"

namespace etendue {

/// The quantity of a band.
enum class BandKind : std::uint8_t {
  emissive,    ///< "S0.405nm": radiance; "S1" to "S3" (polarization) are no bands here
  reflective,  ///< "T.405nm": reflectance or transmittance
};

struct ImageBand {
  BandKind kind = BandKind::emissive;
  double wavelength = 0;  ///< [nm]
  size_t channel = 0;     ///< index in Image::channels
};

/// The kind and wavelength of a channel's name; empty: it is not the name of a band. Frequencies ("S0.500THz") and all metric
/// prefixes of the layout are converted.
std::optional<ImageBand> band_of_name(std::string_view channel);

/// An image's bands of one kind, by increasing wavelength.
std::vector<ImageBand> bands_of(const Image&, BandKind = BandKind::emissive);

/// The edges of an image's bands [nm], one more than there are bands, from its metadata; empty: not known, or other than its
/// bands.
std::vector<double> band_edges_of(const Image&);

/// Whether a channel holds light as a spectral film measures it: in a band, or with a response curve.
bool measures_spectrum(std::string_view channel);

}  // namespace etendue
