// SpectralFilm: an image that stores the spectrum of light besides its colour.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "etendue/describe/color.h"
#include "etendue/film/image_buffer.h"
#include "spectral_bands.h"

namespace etendue {
namespace {

constexpr int most_bands = 4096;

class SpectralFilm final : public ImageBuffer, public HasBands {
 public:
  using Parent = ImageBuffer;
  static void describe(Description<SpectralFilm>& d) {
    d.summary(
         "A picture that stores the spectrum of each pixel besides its colour: the mean radiance in each of any number of "
         "bands "
         "[W/(m2 sr nm)], as channels S0.405nm, … or response.NAME.",
         "Fichet, Pacanowski & Wilkie 2021, An OpenEXR layout for spectral images")
        .group("Bands")
        .member<&SpectralFilm::bands>("bands", "1",
                                      "number of bands of equal width between low and high; without effect where edges or "
                                      "responses are given",
                                      range(1, most_bands))
        .member<&SpectralFilm::low>("low", "nm", "lower edge of the first band",
                                    range(double(wavelength_low), double(wavelength_high)))
        .member<&SpectralFilm::high>("high", "nm", "upper edge of the last band",
                                     range(double(wavelength_low), double(wavelength_high)))
        .member<&SpectralFilm::edges>("edges", "nm",
                                      "the edges of bands of any width, increasing: one more than there are bands; empty: "
                                      "bands, low and high hold")
        .member<&SpectralFilm::responses>("responses", "1",
                                          "response curves, such as those of a sensor, in place of bands with edges: the value "
                                          "is the mean of the radiance, weighted by the curve",
                                          Meaning::coefficient)
        .member<&SpectralFilm::response_names>("response_names", "",
                                               "the names of the response curves; empty: 1, 2, 3 and so on");
  }

  std::shared_ptr<const SpectralBands> make_bands() const override {
    if (!responses.empty()) return of_responses();
    std::vector<float> all = edges.empty() ? uniform_edges() : checked_edges();
    return made("edges", [&] { return std::make_shared<const SpectralBands>(std::move(all)); });
  }

  int bands = 47;
  float low = wavelength_low, high = wavelength_high;
  std::vector<float> edges;
  std::vector<Color> responses;
  std::vector<std::string> response_names;

 private:
  /// The bands that a function makes; its errors get the location of a member.
  template <class Make>
  std::shared_ptr<const SpectralBands> made(const char* member, const Make& make) const {
    try {
      return make();
    } catch (const Error& e) {
      fail(member, e.what());
    }
  }
  std::vector<float> uniform_edges() const {
    if (!(low < high)) fail("high", "must exceed low");
    std::vector<float> all;
    for (int b = 0; b <= bands; ++b) all.push_back(float(double(low) + (double(high) - double(low)) * b / bands));
    return all;
  }
  std::vector<float> checked_edges() const {
    if (edges.size() < 2) fail("edges", "one band needs two edges");
    if (edges.size() > most_bands + 1) fail("edges", fmt::format("there may be {} bands at most", most_bands));
    for (size_t i = 0; i < edges.size(); ++i) {
      if (!(edges[i] >= wavelength_low && edges[i] <= wavelength_high))
        fail("edges", fmt::format("{} nm is outside of {} to {} nm, in which light is computed", edges[i], wavelength_low,
                                  wavelength_high));
      if (i > 0 && !(edges[i] > edges[i - 1]))
        fail("edges", fmt::format("must increase: {} nm follows {} nm", edges[i], edges[i - 1]));
    }
    return edges;
  }
  std::shared_ptr<const SpectralBands> of_responses() const {
    if (!edges.empty()) fail("edges", "bands have either edges or responses, not both");
    if (responses.size() > most_bands) fail("responses", fmt::format("there may be {} bands at most", most_bands));
    std::vector<std::string> names = response_names;
    if (names.empty())
      for (size_t b = 0; b < responses.size(); ++b) names.push_back(std::to_string(b + 1));
    if (names.size() != responses.size())
      fail("response_names", fmt::format("{} names for {} responses", names.size(), responses.size()));
    for (size_t b = 0; b < names.size(); ++b) {
      if (names[b].empty() || names[b].find_first_of(". ") != std::string::npos)
        fail("response_names", fmt::format("'{}' cannot name a channel: it is empty or has a full stop or a space", names[b]));
      if (std::find(names.begin(), names.begin() + std::ptrdiff_t(b), names[b]) != names.begin() + std::ptrdiff_t(b))
        fail("response_names", fmt::format("'{}' is named twice", names[b]));
      if (!responses[b]) fail("responses", fmt::format("'{}' has no curve", names[b]));
      if (range_of(*responses[b], ColorUse::coefficient).least < 0)
        fail("responses", fmt::format("'{}' is negative at some wavelengths", names[b]));
    }
    return made("responses", [&] { return std::make_shared<const SpectralBands>(std::move(names), responses); });
  }
};

const Register<SpectralFilm> registered;

}  // namespace
}  // namespace etendue
