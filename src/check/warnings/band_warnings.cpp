// Warns of bands of a spectral image in which no path ever carries a wavelength.

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "film/picture_format.h"
#include "film/spectral_bands.h"
#include "scene_warnings.h"

namespace etendue {
namespace {

/// The wavelengths [nm] that paths carry, if they are always the same ones; empty: there are more than `most`.
std::set<float> fixed_wavelengths(const WavelengthSampler& sampler, size_t most) {
  std::set<float> all;
  constexpr std::uint32_t samples = 1 << 14;
  for (std::uint32_t i = 0; i < samples; ++i) {
    // Pixels and samples are both varied, as a sampler may take its wavelengths in turns over either.
    const Wavelengths some = sampler.sample(SampleKey(0, i % 64, i / 64 % 64, i), (float(i) + 0.5f) / float(samples));
    for (int lane = 0; lane < spectrum_size; ++lane) all.insert(some[lane]);
    if (all.size() > most) return {};
  }
  return all;
}

}  // namespace

void warn_of_bands(const Job& job, std::vector<SceneWarning>& list) {
  constexpr size_t most = 4096;  // GridWavelengths has no more
  const auto& bands = job.image->format()->bands;
  if (!bands || bands->edges().empty() || !shows_light(*job.renderer)) return;
  const std::set<float> wavelengths = fixed_wavelengths(*job.wavelengths, most);
  if (wavelengths.empty()) return;
  const std::vector<float>& edges = bands->edges();
  size_t dark = 0, first = 0;
  for (size_t b = edges.size() - 1; b-- > 0;) {
    const auto inside = wavelengths.lower_bound(edges[b]);
    if (inside != wavelengths.end() && *inside < edges[b + 1]) continue;
    ++dark;
    first = b;
  }
  if (dark == 0) return;
  list.push_back({"dark bands",
                  fmt::format("{} of the {} bands, the first from {:g} to {:g} nm, will be black, and others too bright: paths "
                              "carry {} fixed wavelengths, none of which lies in them; make the bands wider, or take "
                              "HeroWavelengths",
                              dark, edges.size() - 1, edges[first], edges[first + 1], wavelengths.size()),
                  job.location_of("wavelengths")});
}

}  // namespace etendue
