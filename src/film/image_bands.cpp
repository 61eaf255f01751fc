#include "image_bands.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "picture_format.h"

namespace etendue {
namespace {

constexpr std::string_view emissive_prefix = "S0.", reflective_prefix = "T.";

struct Prefix {
  std::string_view name;
  double factor;
};
// "da" stands before "d".
constexpr std::array<Prefix, 17> metric = {{{"Y", 1e24},
                                            {"Z", 1e21},
                                            {"E", 1e18},
                                            {"P", 1e15},
                                            {"T", 1e12},
                                            {"G", 1e9},
                                            {"M", 1e6},
                                            {"k", 1e3},
                                            {"h", 1e2},
                                            {"da", 1e1},
                                            {"d", 1e-1},
                                            {"c", 1e-2},
                                            {"m", 1e-3},
                                            {"u", 1e-6},
                                            {"n", 1e-9},
                                            {"p", 1e-12},
                                            {"", 1}}};

/// The wavelength [nm] of "405,5nm" or "500THz".
std::optional<double> wavelength_of(std::string_view text) {
  const bool frequency = text.ends_with("Hz");
  if (!frequency && !text.ends_with("m")) return {};
  text.remove_suffix(frequency ? 2 : 1);
  std::string number(text);
  std::ranges::replace(number, ',', '.');
  double value = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error != std::errc()) return {};
  const std::string_view prefix(end, size_t(number.data() + number.size() - end));
  const auto* found = std::ranges::find(metric, prefix, &Prefix::name);
  if (found == metric.end()) return {};
  value *= found->factor;
  constexpr double light_speed = 299792458;  // [m/s]
  const double metres = frequency ? light_speed / value : value;
  if (!(metres > 0) || !std::isfinite(metres)) return {};
  // Rounded to a femtometre: 405.5 nm are 405.5, not 405.50000000000006.
  return std::round(metres * 1e15) * 1e-6;
}

}  // namespace

std::optional<ImageBand> band_of_name(std::string_view channel) {
  const bool emissive = channel.starts_with(emissive_prefix);
  if (!emissive && !channel.starts_with(reflective_prefix)) return {};
  channel.remove_prefix(emissive ? emissive_prefix.size() : reflective_prefix.size());
  const std::optional<double> wavelength = wavelength_of(channel);
  if (!wavelength) return {};
  return ImageBand{emissive ? BandKind::emissive : BandKind::reflective, *wavelength, 0};
}

std::vector<ImageBand> bands_of(const Image& image, BandKind kind) {
  std::vector<ImageBand> bands;
  for (size_t c = 0; c < image.channels.size(); ++c)
    if (std::optional<ImageBand> band = band_of_name(image.channels[c]); band && band->kind == kind) {
      band->channel = c;
      bands.push_back(*band);
    }
  std::ranges::stable_sort(bands, {}, &ImageBand::wavelength);
  return bands;
}

std::vector<double> band_edges_of(const Image& image) {
  const auto found = image.metadata.find(band_edges_key);
  if (found == image.metadata.end()) return {};
  std::vector<double> edges;
  std::istringstream text(found->second);
  for (double edge; text >> edge;) edges.push_back(edge);
  const std::vector<ImageBand> bands = bands_of(image);
  if (edges.size() != bands.size() + 1) return {};
  for (size_t b = 0; b < bands.size(); ++b)
    if (!(edges[b] < bands[b].wavelength && bands[b].wavelength < edges[b + 1])) return {};
  return edges;
}

bool measures_spectrum(std::string_view channel) {
  return channel.starts_with(response_prefix) || band_of_name(channel).has_value();
}

}  // namespace etendue
