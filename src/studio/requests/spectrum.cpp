// The spectrum of a pixel with its error.
//
// A film stores no squares of its bands: they would double its memory. The pixel is instead rendered R times by itself, with
// different seeds and n samples each. These renders are independent whatever the algorithm is, so the spread of their values
// L_r gives the standard deviation of one sample,
//   s = sqrt( n / (R - 1) sum_r (L_r - L)^2 ),
// and the standard error of a picture with N samples is s / sqrt(N), as far as the algorithm's error falls so.

#include <fmt/format.h>

#include <cmath>

#include "etendue/core/math.h"
#include "etendue/language/language.h"
#include "film/image_bands.h"
#include "film/picture_format.h"
#include "requests.h"

namespace etendue::studio {

namespace {

struct PixelBands {
  std::vector<double> sums, squares;
};

void add(PixelBands& all, const Image& picture, const std::vector<size_t>& channels) {
  all.sums.resize(channels.size());
  all.squares.resize(channels.size());
  for (size_t b = 0; b < channels.size(); ++b) {
    const double value = picture.at(0, 0, channels[b]);
    all.sums[b] += value;
    all.squares[b] += value * value;
  }
}

std::vector<size_t> band_channels(const Image& picture) {
  std::vector<size_t> channels;
  for (size_t c = 0; c < picture.channels.size(); ++c)
    if (measures_spectrum(picture.channels[c])) channels.push_back(c);
  return channels;
}

/// A job of the document's that renders one pixel.
Ref<Job> job_of_pixel(const Document& document, int x, int y, std::uint32_t samples) {
  const Ref<Job> job = load_job_text(document.text(), document.name(), document.folder());
  for (const auto& [path, expression] : document.overrides())
    if (path != "image.crop") set_path(*job, path, expression);
  set_path(*job, "image.crop", fmt::format("[{}, {}, {}, {}]", x, y, x + 1, y + 1));
  set_path(*job, "renderer.samples", std::to_string(samples));
  return job;
}

/// The means of the renders and the standard deviations of one sample; empty: the task was ended.
Json measured(const Ref<Job>& job, const RenderSettings& settings, int renders, std::uint32_t samples,
              const Tasks::Work& work) {
  Render single(job, settings);
  const std::uint64_t seed = mix_bits(job->seed + 0x5bec7ull);  // other numbers than the picture's
  PixelBands all;
  std::vector<size_t> channels;
  Json names = Json::array(), values = Json::array(), deviations = Json::array();
  for (int r = 0; r < renders; ++r) {
    single.restart(seed + std::uint64_t(r));
    while (!single.step())
      if (work.ended.load()) return Json::object();
    const Image picture = single.picture();
    if (r == 0) channels = band_channels(picture);
    add(all, picture, channels);
    work.done(double(r + 1) / renders);
    if (r > 0) continue;
    for (const size_t c : channels) names.push_back(picture.channels[c]);
  }
  for (size_t b = 0; b < channels.size(); ++b) {
    const double mean = all.sums[b] / renders;
    const double variance = std::max(0.0, all.squares[b] - renders * mean * mean) / (renders - 1);
    values.push_back(mean);
    deviations.push_back(std::sqrt(variance * samples));
  }
  return {{"renders", renders}, {"samples", samples}, {"channels", names}, {"values", values}, {"deviations", deviations}};
}

Json spectrum(const Call& call) {
  Studio& studio = call.studio;
  const auto render = studio.valid_render();
  const ImageBuffer& image = *render->job().image;
  if (!image.format()->bands) throw Error("the picture has no spectrum: its image is no SpectralFilm");
  const int x = int(call.integer("x", 0, 1 << 20)), y = int(call.integer("y", 0, 1 << 20));
  if (x >= image.width || y >= image.height) throw Error("there is no such pixel in the picture");
  const auto renders = int(call.integer_or("renders", 16, 2, 256));
  const auto samples = std::uint32_t(call.integer_or("samples", 64, 1, 1 << 16));
  const Ref<Job> job = job_of_pixel(studio.document(), x, y, samples);
  RenderSettings settings = studio.settings().render;
  settings.threads = 1;
  const auto work = [=](const Tasks::Work& task) -> Json {
    Json found = measured(job, settings, renders, samples, task);
    if (found.empty()) return found;
    found["x"] = x;
    found["y"] = y;
    return {{"spectrum", std::move(found)}};
  };
  return {{"task", studio.tasks().work(fmt::format("spectrum of {}, {}", x, y), work)}};
}

const RegisterRequests registered{
    {"spectrum", false, spectrum},
};

}  // namespace

}  // namespace etendue::studio
