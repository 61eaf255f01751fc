// Samples of one pixel computed again. Any sample is a function of the description, the seed, its pixel and its number, so
// it can be computed alone: first all samples of the pixel for their values, then the brightest again with a record.

#include "app/replay.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <tuple>

namespace etendue {

namespace {

// ---- computing --------------------------------------------------------------------------------------------------------

RenderContext context_of(const Job& job) { return {*job.scene, *job.camera, *job.image, *job.wavelengths, job.seed}; }

/// Y of a value as the film counts it: 0, with false, for what is not a finite non-negative spectrum.
bool luminance_of(Spectrum value, const Wavelengths& wavelengths, double& luminance) {
  luminance = 0;
  float largest = 0, least = 0;
  for (int i = 0; i < spectrum_size; ++i) {
    // Values at wavelengths that were dropped mean nothing when they are no numbers.
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

/// What a splat counts for beside a sample's own value, which counts 1 / n of its pixel: paths from luminaires spread over
/// the whole film, but there are only n of them for each pixel that is rendered.
double splat_weight(const ImageBuffer& image) {
  const PixelArea& area = image.area();
  return double(image.width) * double(image.height) / (double(area.width()) * double(area.height()));
}

/// What the splats of a sample bring to the picture: those that fall beside it are lost.
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

/// Equal ones in the order of their numbers, so that the result does not depend on threads.
bool brighter(const Bright& a, const Bright& b) { return std::tuple(-a.light, a.sample) < std::tuple(-b.light, b.sample); }

void keep_brightest(std::vector<Bright>& all, size_t most) {
  const size_t kept = std::min(all.size(), most);
  std::partial_sort(all.begin(), all.begin() + std::ptrdiff_t(kept), all.end(), brighter);
  all.resize(kept);
}

ReplayedPath replay(const RenderContext& context, const Renderer& renderer, int x, int y, std::uint32_t sample) {
  ReplayedPath path;
  path.sample = sample;
  Arena arena;
  std::vector<Splat> splats;
  Renderer::Request request;
  request.record = &path.record;
  request.splats = &splats;
  const Renderer::CameraSample s = renderer.camera_sample(context, x, y, sample, arena, request);
  path.film = s.film;
  path.bad = !luminance_of(s.value, s.wavelengths, path.luminance);
  path.splatted = splatted_luminance(context.image, splats);
  return path;
}

PixelReplay begin(Job& job, int x, int y) {
  if (!job.image->area().contains(x, y)) throw Error(fmt::format("there is no pixel {},{} in the picture", x, y));
  job.renderer->begin(context_of(job));
  PixelReplay result;
  result.x = x;
  result.y = y;
  result.samples = std::uint32_t(job.renderer->samples);
  return result;
}

}  // namespace

PixelReplay replay_sample(Job& job, int x, int y, std::uint32_t sample) {
  PixelReplay result = begin(job, x, y);
  result.paths.push_back(replay(context_of(job), *job.renderer, x, y, sample));
  return result;
}

PixelReplay replay_pixel(Job& job, int x, int y, size_t most) {
  PixelReplay result = begin(job, x, y);
  const RenderContext context = context_of(job);
  const Renderer& renderer = *job.renderer;

  // In parts of a fixed size, put together in their order: sums are the same on any number of threads.
  constexpr std::uint32_t part_size = 1024;
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
  const auto compute = [&](size_t index) {
    Part& part = parts[index];
    Memory& memory = memories.local();
    Renderer::Request request;
    request.splats = &memory.splats;
    const auto first = std::uint32_t(index) * part_size, last = std::min(first + part_size, result.samples);
    for (std::uint32_t n = first; n < last; ++n) {
      memory.splats.clear();
      const Renderer::CameraSample s = renderer.camera_sample(context, x, y, n, memory.arena, request);
      double luminance = 0;
      luminance_of(s.value, s.wavelengths, luminance);
      part.sum += luminance;
      part.brightest.push_back({luminance + splatted_luminance(context.image, memory.splats), n});
    }
    keep_brightest(part.brightest, most);
  };
  const int threads = job.threads > 0 ? job.threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(threads));
  tbb::task_arena tasks(threads);
  tasks.execute([&] { tbb::parallel_for(size_t(0), parts.size(), compute); });

  double sum = 0;
  std::vector<Bright> brightest;
  for (const Part& part : parts) {
    sum += part.sum;
    brightest.insert(brightest.end(), part.brightest.begin(), part.brightest.end());
  }
  keep_brightest(brightest, most);
  result.luminance = sum / result.samples;
  for (const Bright& bright : brightest) {
    ReplayedPath path = replay(context, renderer, x, y, bright.sample);
    if (sum > 0) path.share = path.luminance / sum;
    result.paths.push_back(std::move(path));
  }
  return result;
}

std::string replay_command(const std::string& picture_command, int x, int y, std::uint32_t sample) {
  return fmt::format("{} --pixel {},{} --sample {}", picture_command, x, y, sample);
}

// ---- for people -------------------------------------------------------------------------------------------------------

namespace {

std::string numbers(const Spectrum& s) {
  std::string text;
  for (int i = 0; i < spectrum_size; ++i) text += fmt::format("{}{:>12.6g}", i ? " " : "", s[i]);
  return text;
}

template <class V>
std::string place(const V& v) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z);
}

std::string vertex_text(const PathRecord::Vertex& v, const char* what, size_t place_in_path) {
  std::string text = fmt::format("{} {}: {}{}\n", what, place_in_path, v.kind, v.object.empty() ? "" : " on " + v.object);
  const auto add = [&](const char* label, const std::string& value) { text += fmt::format("    {:<12}{}\n", label, value); };
  if (v.kind != "escaped") add("position", place(v.position) + " m");
  if (v.normal.x != 0 || v.normal.y != 0 || v.normal.z != 0) add("normal", place(v.normal));
  add("throughput", numbers(v.throughput));
  if (!v.emitted.black()) add("emitted", numbers(v.emitted));
  if (!v.direct.black()) add("direct", numbers(v.direct));
  if (!v.lobe.empty()) add("sampled", fmt::format("{}, density {:.6g}", v.lobe, v.density));
  if (!v.note.empty()) add("note", v.note);
  return text;
}

std::string contribution_text(const PathRecord::Contribution& c, const Wavelengths& wavelengths) {
  std::string text =
      fmt::format("    {}, length {}, weight {:.6g}, Y {:.6g}", c.strategy, c.length, c.weight, to_xyz(c.value, wavelengths).y);
  if (c.splat) text += fmt::format(", falls at ({:.6f}, {:.6f})", c.film.x, c.film.y);
  return text + fmt::format("\n    {:<12}{}\n", "", numbers(c.value));
}

std::string percent(double fraction) { return fmt::format("{:.3g} %", 100 * fraction); }

}  // namespace

std::string path_text(const PathRecord& record, Point2 film) {
  Spectrum lambda, density;
  for (int i = 0; i < spectrum_size; ++i) {
    lambda.set(i, record.wavelengths[i]);
    density.set(i, record.wavelengths.density(i));
  }
  std::string text = fmt::format("film point      ({:.6f}, {:.6f}) pixels\n", film.x, film.y);
  text += "wavelength [nm] " + numbers(lambda) + "\n";
  text += "density [1/nm]  " + numbers(density) + (record.wavelengths.single() ? "  (the hero alone is left)" : "") + "\n";
  for (size_t i = 0; i < record.vertices.size(); ++i) text += vertex_text(record.vertices[i], "vertex", i);
  for (size_t i = 0; i < record.light_vertices.size(); ++i) text += vertex_text(record.light_vertices[i], "light vertex", i);
  if (!record.contributions.empty()) text += "contributions\n";
  for (const PathRecord::Contribution& c : record.contributions) text += contribution_text(c, record.wavelengths);
  const Xyz color = to_xyz(record.result, record.wavelengths);
  text += "radiance        " + numbers(record.result) + "  W/(m^2 sr nm)\n";
  text += fmt::format("X Y Z           {:>12.6g} {:>12.6g} {:>12.6g}\n", color.x, color.y, color.z);
  return text;
}

std::string replay_text(const PixelReplay& replay, const std::string& picture_command) {
  std::string text;
  if (replay.luminance) {
    double light = 0;
    for (const ReplayedPath& path : replay.paths) light += path.share.value_or(0);
    text += fmt::format("pixel {},{}: {} samples, mean Y {:.6g}", replay.x, replay.y, replay.samples, *replay.luminance);
    if (*replay.luminance > 0) text += fmt::format("; the {} brightest bring {} of it", replay.paths.size(), percent(light));
    text += "\n";
  }
  for (const ReplayedPath& path : replay.paths) {
    if (replay.luminance) {
      text += fmt::format("\nsample {}: Y {:.6g}", path.sample, path.luminance);
      if (path.share) text += fmt::format(", {} of its pixel's light", percent(*path.share));
      text += "\n" + replay_command(picture_command, replay.x, replay.y, path.sample) + "\n";
    } else {
      text += fmt::format("pixel {},{} sample {}\n", replay.x, replay.y, path.sample);
      if (path.sample >= replay.samples)
        text += fmt::format("(the picture has samples 0 to {}; this one is not in it)\n", replay.samples - 1);
    }
    text += path_text(path.record, path.film);
    if (path.bad) text += "This is not a finite non-negative spectrum: it counts as black.\n";
    if (path.splatted > 0) text += fmt::format("Y splatted      {:>12.6g}\n", path.splatted);
  }
  return text;
}

// ---- for programs -----------------------------------------------------------------------------------------------------

namespace {

using Json = nlohmann::ordered_json;

Json array(const Spectrum& s) {
  Json json = Json::array();
  for (int i = 0; i < spectrum_size; ++i) json.push_back(s[i]);
  return json;
}

template <class V>
Json triple(const V& v) {
  return {v.x, v.y, v.z};
}

Json vertices_json(const std::vector<PathRecord::Vertex>& vertices) {
  Json list = Json::array();
  for (const PathRecord::Vertex& v : vertices)
    list.push_back({{"kind", v.kind},
                    {"object", v.object},
                    {"position", triple(v.position)},
                    {"normal", triple(v.normal)},
                    {"lobe", v.lobe},
                    {"density", v.density},
                    {"throughput", array(v.throughput)},
                    {"emitted", array(v.emitted)},
                    {"direct", array(v.direct)},
                    {"note", v.note}});
  return list;
}

Json contributions_json(const ReplayedPath& path, double of_splats) {
  const PathRecord& record = path.record;
  Json list = Json::array();
  for (const PathRecord::Contribution& c : record.contributions) {
    const Point2 film = c.splat ? c.film : path.film;
    list.push_back({{"strategy", c.strategy},
                    {"length", c.length},
                    {"weight", c.weight},
                    {"value", array(c.value)},
                    {"luminance", to_xyz(c.value, record.wavelengths).y * (c.splat ? of_splats : 1)},
                    {"film", {film.x, film.y}},
                    {"splat", c.splat}});
  }
  return list;
}

}  // namespace

std::string replay_json(const Job& job, const PixelReplay& replay, const std::string& file,
                        const std::string& picture_command) {
  Json paths = Json::array();
  for (const ReplayedPath& path : replay.paths) {
    const PathRecord& record = path.record;
    Json wavelengths = Json::array(), densities = Json::array();
    for (int i = 0; i < spectrum_size; ++i) {
      wavelengths.push_back(record.wavelengths[i]);
      densities.push_back(record.wavelengths.density(i));
    }
    paths.push_back({{"sample", path.sample},
                     {"command", replay_command(picture_command, replay.x, replay.y, path.sample)},
                     {"film", {path.film.x, path.film.y}},
                     {"wavelengths", wavelengths},
                     {"densities", densities},
                     {"single", record.wavelengths.single()},
                     {"result", array(record.result)},
                     {"bad", path.bad},
                     {"luminance", path.luminance},
                     {"splatted", path.splatted},
                     {"share", path.share ? Json(*path.share) : Json()},
                     {"vertices", vertices_json(record.vertices)},
                     {"light_vertices", vertices_json(record.light_vertices)},
                     {"contributions", contributions_json(path, splat_weight(*job.image))}});
  }
  const Json json = {{"file", file},
                     {"renderer", job.renderer->class_info().name},
                     {"seed", job.seed},
                     {"pixel", {replay.x, replay.y}},
                     {"samples", replay.samples},
                     {"luminance", replay.luminance ? Json(*replay.luminance) : Json()},
                     {"paths", paths}};
  // A file name may hold bytes that are not UTF-8.
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace etendue
