// Checks of every denoiser: it changes only radiance channels, creates no light, and accepts any numbers; or it throws an Error
// with the reason why it cannot work here.

#include "etendue/denoiser.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "conformance.h"

namespace etendue::conform {
namespace {

class DenoiserTrial {
 public:
  explicit DenoiserTrial(Trial& t) : trial(t), denoiser_(t.part<Denoiser>()) {}

  void check() {
    try {
      denoiser_.require();
    } catch (const Error& error) {
      trial.expect(std::string_view(error.what()).size() > 0, "what it lacks is said");
      bool thrown = false;
      try {
        static_cast<void>(denoiser_.denoised(picture(0.5), Image(width, height, {}), 1));
      } catch (const Error&) {
        thrown = true;
      }
      trial.expect(thrown, "without what it needs it makes nothing");
      return;
    }
    trial.expect(!denoiser_.worker().empty(), "it says what does the work");
    for (const bool guided : {false, true}) check_light(guided);
    check_sizes();
  }

 private:
  static constexpr int width = 40, height = 24;

  /// A grey image with one further channel.
  static Image picture(double value) {
    Image image(width, height, {"X", "Y", "Z", "object.ID"});
    for (size_t i = 0; i < image.values.size(); ++i) image.values[i] = i % 4 == 3 ? double(i) : value;
    image.metadata["seed"] = "7";
    return image;
  }
  static Image guides(bool wanted) {
    if (!wanted) return Image(width, height, {});
    Image image(width, height, {"albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y", "normal.Z"});
    for (size_t i = 0; i < image.values.size(); ++i) image.values[i] = i % 6 < 3 ? 0.5 : i % 6 == 5;
    return image;
  }

  void check_light(bool guided) {
    const auto largest_change = [](const Image& image, double from) {
      double most = 0;
      for (size_t i = 0; i < image.values.size(); ++i)
        if (i % 4 != 3) most = std::isfinite(image.values[i]) ? std::max(most, std::abs(image.values[i] - from)) : infinity;
      return most;
    };
    const Image grey = picture(0.5), result = denoiser_.denoised(grey, guides(guided), 1);
    bool same = result.width == width && result.height == height && result.channels == grey.channels &&
                result.metadata == grey.metadata && result.values.size() == grey.values.size();
    for (size_t i = 3; same && i < result.values.size(); i += 4) same = result.values[i] == grey.values[i];
    if (!trial.expect(same, "sizes, channels, texts and layers stay")) return;
    double sums[4] = {};
    for (size_t i = 0; i < result.values.size(); ++i) sums[i % 4] += result.values[i] / (width * height);
    const double change = std::max({std::abs(sums[0] / 0.5 - 1), std::abs(sums[1] / 0.5 - 1), std::abs(sums[2] / 0.5 - 1)});
    trial.expect(change < 0.05, "a grey picture keeps its light in the mean",
                 [&] { return fmt::format("it is changed by {}", change); });
    const double most = largest_change(result, 0.5);
    trial.expect(most < 0.25, "a grey picture is grey everywhere", [&] { return fmt::format("0.5 is changed by {}", most); });
    const double lit = largest_change(denoiser_.denoised(picture(0), guides(guided), 1), 0);
    trial.expect(lit < 1e-3, "a black picture stays black", [&] { return fmt::format("{}", lit); });
    Image odd = grey;
    const double strange[] = {std::nan(""), double(infinity), -double(infinity), -1, 1e300};
    for (size_t i = 0; i < odd.values.size(); ++i)
      if (i % 4 != 3 && trial.uniform() < 0.01f) odd.values[i] = strange[trial.random() % std::size(strange)];
    const double found = largest_change(denoiser_.denoised(odd, guides(guided), 1), 0);
    trial.expect(std::isfinite(found), "of any numbers finite ones are made");
  }

  void check_sizes() {
    bool thrown = false;
    try {
      Image small = guides(true);
      small.width /= 2;
      small.values.resize(small.values.size() / 2);
      static_cast<void>(denoiser_.denoised(picture(0.5), small, 1));
    } catch (const Error&) {
      thrown = true;
    }
    trial.expect(thrown, "guides of another size are refused");
  }

  Trial& trial;
  Denoiser& denoiser_;
};

const RegisterCheck<Denoiser> registered([](Trial& trial) { DenoiserTrial(trial).check(); });

}  // namespace
}  // namespace etendue::conform
