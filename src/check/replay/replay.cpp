// Recomputes samples of one pixel. Each sample is a function of the description, the seed, its pixel and its number, so it can
// be computed alone: first all samples of the pixel for their values, then the brightest ones again with a record of their
// paths.

#include "replay.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <tuple>

namespace etendue {

double splat_weight(const ImageBuffer& image) {
  const PixelArea& area = image.sampled_area();
  return double(image.width) * double(image.height) / (double(area.width()) * double(area.height()));
}

namespace {

/// The luminance Y of a value as the film counts it. Returns false, with 0, if the value is not a finite non-negative spectrum.
bool luminance_of(Spectrum value, const Wavelengths& wavelengths, double& luminance) {
  luminance = 0;
  float largest = 0, least = 0;
  for (int i = 0; i < spectrum_size; ++i) {
    // Values at dropped secondary wavelengths are ignored if they are not valid numbers.
    if (i > 0 && wavelengths.single() && !(value[i] >= 0 && value[i] <= std::numeric_limits<float>::max())) value.set(i, 0);
    if (!std::isfinite(value[i])) return false;
    largest = std::max(largest, value[i]);
    least = std::min(least, value[i]);
  }
  constexpr float rounding = 1e-5f;
  if (least < -rounding * largest) return false;
  const double y = to_xyz(max(value, 0), wavelengths).y;
  if (!std::isfinite(y)) return false;
  luminance = y;
  return true;
}

/// The luminance that a sample's splats add to the image; splats outside the image are lost.
double splatted_luminance(const ImageBuffer& image, const std::vector<Splat>& splats) {
  const PixelArea& area = image.area();
  double sum = 0, luminance = 0;
  for (const Splat& s : splats) {
    if (!(s.film.x >= float(area.x0) && s.film.x < float(area.x1) && s.film.y >= float(area.y0) && s.film.y < float(area.y1)))
      continue;
    if (luminance_of(s.value, s.wavelengths, luminance)) sum += luminance * splat_weight(image);
  }
  return sum;
}

struct Bright {
  double light = 0;
  std::uint32_t sample = 0;
};

/// Equal samples are ordered by their numbers, so that the result does not depend on threads.
bool brighter(const Bright& a, const Bright& b) { return std::tuple(-a.light, a.sample) < std::tuple(-b.light, b.sample); }

void keep_brightest(std::vector<Bright>& all, size_t most) {
  const size_t kept = std::min(all.size(), most);
  std::partial_sort(all.begin(), all.begin() + std::ptrdiff_t(kept), all.end(), brighter);
  all.resize(kept);
}

ReplayedPath replay(const RenderProcess& process, int x, int y, std::uint32_t sample) {
  ReplayedPath path;
  path.sample = sample;
  Arena arena;
  std::vector<Splat> splats;
  PathSink sink;
  sink.record = &path.record;
  sink.splats = &splats;
  const CameraSample s = process.sample(x, y, sample, arena, sink);
  path.record.to_world_space(process.context.camera.rendering_origin);
  path.film = s.film;
  path.bad = !luminance_of(s.value, s.wavelengths, path.luminance);
  path.splatted = splatted_luminance(process.context.image, splats);
  return path;
}

PixelReplay begin(const Job& job, int x, int y) {
  if (!job.image->sampled_area().contains(x, y)) throw Error(fmt::format("there is no pixel {},{} in the picture", x, y));
  PixelReplay result;
  result.x = x;
  result.y = y;
  result.samples = std::uint32_t(job.renderer->samples);
  return result;
}

}  // namespace

PixelReplay replay_sample(const Render& render, int x, int y, std::uint32_t sample) {
  PixelReplay result = begin(render.job(), x, y);
  result.paths.push_back(replay(*render.start_at(sample), x, y, sample));
  return result;
}

std::string replay_refusal(const Render& render) {
  if (render.job().renderer->estimator() == Estimator::independent) return {};
  const PixelArea& area = render.job().image->area();
  try {
    static_cast<void>(replay_sample(render, area.x0, area.y0, 0));
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

PixelReplay replay_pixel(const Render& render, int x, int y, size_t most) {
  PixelReplay result = begin(render.job(), x, y);

  // Samples are computed in parts of fixed size, whose sums are added in order, so that sums are the same for any number of
  // threads. A RenderProcess is valid only for the samples of its step.
  const std::uint32_t step = render.samples_per_step(), part_size = std::min(step, 1024u);
  struct Part {
    double sum = 0;
    std::vector<Bright> brightest;
  };
  std::vector<Part> parts((result.samples + part_size - 1) / part_size);
  struct Memory {
    Arena arena;
    std::vector<Splat> splats;
  };
  tbb::enumerable_thread_specific<Memory> memories;
  std::unique_ptr<RenderProcess> process;
  const auto compute = [&](size_t index) {
    Part& part = parts[index];
    Memory& memory = memories.local();
    PathSink sink;
    sink.splats = &memory.splats;
    const auto first = std::uint32_t(index) * part_size, last = std::min(first + part_size, result.samples);
    for (std::uint32_t n = first; n < last; ++n) {
      memory.splats.clear();
      const CameraSample s = process->sample(x, y, n, memory.arena, sink);
      double luminance = 0;
      luminance_of(s.value, s.wavelengths, luminance);
      part.sum += luminance;
      part.brightest.push_back({luminance + splatted_luminance(*render.job().image, memory.splats), n});
    }
    keep_brightest(part.brightest, most);
  };
  const int wanted = render.settings().threads, threads = wanted > 0 ? wanted : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(threads));
  tbb::task_arena tasks(threads);
  const auto parts_before = [&](std::uint32_t sample) { return size_t((sample + part_size - 1) / part_size); };
  for (std::uint32_t begin = 0; begin < result.samples; begin += step) {
    process = render.start_at(begin);
    const std::uint32_t end = std::min(begin + step, result.samples);
    tasks.execute([&] { tbb::parallel_for(parts_before(begin), parts_before(end), compute); });
  }

  double sum = 0;
  std::vector<Bright> brightest;
  for (const Part& part : parts) {
    sum += part.sum;
    brightest.insert(brightest.end(), part.brightest.begin(), part.brightest.end());
  }
  keep_brightest(brightest, most);
  result.luminance = sum / result.samples;
  for (const Bright& bright : brightest) {
    ReplayedPath path = replay(*render.start_at(bright.sample), x, y, bright.sample);
    if (sum > 0) path.share = path.luminance / sum;
    result.paths.push_back(std::move(path));
  }
  return result;
}

}  // namespace etendue
