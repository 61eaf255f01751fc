#include "measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "delta_light.h"
#include "etendue/describe/color.h"
#include "etendue/language/language.h"
#include "film/image_bands.h"
#include "film/picture_format.h"

namespace etendue::measure {
namespace {

constexpr int meter_side = 16;  // pixels; the more, the better samples are spread over the directions
constexpr double lumens_per_watt = 683;

template <class T>
Ref<T> created(const char* name) {
  return ref_cast<T>(Registry::instance().create(name));
}

/// The mean of each channel over the picture.
std::vector<double> means_of(const Image& image) {
  std::vector<double> means(image.channels.size());
  for (size_t i = 0; i < image.values.size(); ++i) means[i % means.size()] += image.values[i];
  for (double& mean : means) mean /= double(image.width) * double(image.height);
  return means;
}

/// A function of the channels' means: its value for the mean of all renders. The standard error is that of the mean of the
/// values of single renders, var / n; for a quotient, such as a chromaticity, this is right to first order.
template <class F>
Reading reading(const std::vector<std::vector<double>>& renders, const F& f) {
  const auto n = double(renders.size());
  std::vector<double> mean(renders[0].size());
  for (const std::vector<double>& render : renders)
    for (size_t c = 0; c < mean.size(); ++c) mean[c] += render[c] / n;
  double average = 0, squares = 0;
  for (const std::vector<double>& render : renders) average += f(render) / n;
  for (const std::vector<double>& render : renders) squares += (f(render) - average) * (f(render) - average);
  return {f(mean), std::sqrt(squares / (n - 1) / n)};
}

/// A meter sees the world: also what pictures leave out.
void make_visible(Scene& scene) {
  for (const Ref<SceneObject>& object : scene.objects) {
    object->visible_to_camera = true;
    if (const Scene* inner = scene_within(*object)) make_visible(const_cast<Scene&>(*inner));
  }
}

double chromaticity(const std::vector<double>& mean, size_t component) {
  const double sum = mean[0] + mean[1] + mean[2];
  return sum > 0 ? mean[component] / sum : 0;
}

}  // namespace

void prepare_image(Job& job, const Options& options) {
  if (!job.image) job.fail("image", "a job needs an image buffer");
  if (!job.image->crop.empty()) job.image->fail("crop", "the whole picture is measured: it must not be cropped");
  const bool spectral = dynamic_cast<const HasBands*>(job.image.get()) != nullptr;
  Ref<ImageBuffer> image = spectral ? ref_cast<ImageBuffer>(copy(*job.image)) : created<ImageBuffer>("SpectralFilm");
  if (!spectral) set_path(*image, "bands", std::to_string(options.bands));
  image->width = job.image->width;
  image->height = job.image->height;
  if (dynamic_cast<const Meter*>(job.camera.get())) {
    image->width = image->height = meter_side;
    if (job.scene) make_visible(*job.scene);
  }
  image->filter = created<Filter>("BoxFilter");
  image->layers.clear();
  image->path_lengths = 0;
  job.image = image;
}

Measurement measure(const Ref<Job>& job, const Options& options) {
  prepare_image(*job, options);
  const double pixels = double(job->image->width) * double(job->image->height);
  const int renders = std::max(options.renders, 2);
  job->renderer->samples = int(std::clamp(std::ceil(options.samples / pixels / renders), 1.0, 1e9));
  job->time_limit = 0;
  job->error_limit = 0;
  // Measurements with neighbouring seeds share no renders.
  job->seed *= 10000;
  Render render(job, {.threads = options.threads});

  Measurement m;
  const auto* meter = dynamic_cast<const Meter*>(job->camera.get());
  if (meter) m.quantity = meter->measures();
  m.bias = job->renderer->bias();
  std::vector<std::vector<double>> means;
  Image image;
  const std::uint64_t seed = job->seed;
  for (int i = 0; i < renders; ++i) {
    if (i > 0) render.restart(seed + std::uint64_t(i));
    if (render.run() != Ended::samples) throw Error("the measurement was interrupted");
    image = render.picture();
    means.push_back(means_of(image));
    if (meter && has_delta_light(*job)) {
      const Image direct = delta_light(*job, job->seed);
      for (size_t c = 0; c < direct.channels.size(); ++c) means.back()[c] += direct.at(0, 0, c);
    }
    m.samples += render.film().samples();
    m.bad_samples += render.film().bad_samples();
    m.renders = i + 1;
    if (options.go_on && !options.go_on(i + 1)) throw Error("the measurement was interrupted");
  }

  const double factor = m.quantity.factor;
  const std::vector<double> edges = band_edges_of(image);
  for (size_t c = 3; c < image.channels.size(); ++c) {
    BandReading band{image.channels[c], 0, 0, reading(means, [&](const auto& mean) { return factor * mean[c]; })};
    if (!edges.empty()) band.low = edges[c - 3], band.high = edges[c - 2];
    m.bands.push_back(band);
  }
  if (!edges.empty())
    m.total = reading(means, [&](const auto& mean) {
      double sum = 0;
      for (size_t b = 0; b + 1 < edges.size(); ++b) sum += factor * mean[3 + b] * (edges[b + 1] - edges[b]);
      return sum;
    });
  m.photometric = reading(means, [&](const auto& mean) { return factor * lumens_per_watt * observer_y_integral() * mean[1]; });
  m.x = reading(means, [](const auto& mean) { return chromaticity(mean, 0); });
  m.y = reading(means, [](const auto& mean) { return chromaticity(mean, 1); });
  return m;
}

}  // namespace etendue::measure
