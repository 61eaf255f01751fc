// What all renderers share: the pass over camera paths.

#include "etendue/renderer.h"

#include <fmt/format.h>

#include <bit>

namespace etendue {

void Renderer::describe(Description<Renderer>& d) {
  d.summary("An image synthesis algorithm.")
      .member<&Renderer::samples>("samples", "1", "samples per pixel", range(1, 1 << 30))
      .member<&Renderer::sampler>("sampler", "", "where random numbers come from")
      .member<&Renderer::light_sampler>("light_sampler", "", "how luminaires are chosen")
      .member<&Renderer::map_filter>(
          "map_filter", "1",
          "width over which maps are averaged where paths from the camera meet them [pixels]; 0: maps as they are. Averages "
          "make less noise, and large images quicker, but they are a bias: what a surface does to light is not the mean of "
          "what its parts do, the pixel's own filter blurs once more, and paths from luminaires do not average",
          range(0, 64));
}
static const Register<Renderer> registered;

Renderer::Renderer()
    : sampler(ref_cast<Sampler>(Registry::instance().create("SobolSampler"))),
      light_sampler(ref_cast<LightSampler>(Registry::instance().create("PowerLightSampler"))) {}

void Renderer::begin(const RenderContext& context) {
  if (!sampler) fail("sampler", "a renderer needs a sampler");
  if (!light_sampler) fail("light_sampler", "a renderer needs a light sampler");
  light_sampler->build(context.scene);
}

namespace {

/// Dimensions of a camera sample, by purpose; the path's own begin after them.
enum CameraDimension : std::uint32_t {
  film_dimension = 0,
  lens_dimension = 2,
  time_dimension = 4,
  wavelength_dimension = 5,
  path_dimension = 6
};

/// How the picture and the samples of a pass are divided into items: tiles, and for small pictures parts of the sample
/// range as well. Depends on nothing but the picture's size and the pass, so results do not depend on threads.
struct Division {
  PixelArea area;
  int tile = 16, columns = 1, rows = 1;
  std::uint32_t begin = 0, end = 1, chunk = 1, chunks = 1;

  Division(const PixelArea& a, const Pass& pass) : area(a), begin(pass.begin), end(pass.end) {
    columns = (a.width() + tile - 1) / tile;
    rows = (a.height() + tile - 1) / tile;
    constexpr std::uint32_t enough = 64;
    const std::uint32_t tiles = std::uint32_t(columns) * std::uint32_t(rows), n = end - begin;
    const std::uint32_t wanted = std::clamp((enough + tiles - 1) / tiles, 1u, n);
    chunk = (n + wanted - 1) / wanted;
    chunks = (n + chunk - 1) / chunk;
  }
  std::uint64_t count() const { return std::uint64_t(columns) * std::uint64_t(rows) * chunks; }
  PixelArea pixels(std::uint64_t item) const {
    const int t = int(item / chunks), x = area.x0 + (t % columns) * tile, y = area.y0 + (t / columns) * tile;
    return {x, y, std::min(x + tile, area.x1), std::min(y + tile, area.y1)};
  }
  std::uint32_t first(std::uint64_t item) const { return begin + std::uint32_t(item % chunks) * chunk; }
  std::uint32_t last(std::uint64_t item) const { return std::min(first(item) + chunk, end); }
};

void record_camera(PathRecord& record, const Camera& camera, const Ray& ray) {
  PathRecord::Vertex v;
  v.kind = "camera";
  v.object = camera.class_info().name;
  v.position = ray.origin;
  v.normal = Normal3(ray.direction);
  v.throughput = Spectrum(1.0f);
  record.vertices.push_back(std::move(v));
}

Renderer::CameraSample take_sample(const Renderer& renderer, const RenderContext& context, int x, int y, const SampleKey& key,
                                   Arena& arena, const Renderer::Request& request) {
  const Ref<Sampler>& sampler = renderer.sampler;
  const Point2 within = sampler->pair(key, film_dimension);
  Renderer::CameraSample s{{float(x) + within.x, float(y) + within.y},
                           {},
                           context.wavelengths.sample(key, sampler->number(key, wavelength_dimension))};
  const Camera& camera = context.camera;
  const Point2 lens = camera.has_lens() ? sampler->pair(key, lens_dimension) : Point2{};
  const bool still = !(camera.shutter_close > camera.shutter_open);
  const float time = still ? camera.shutter_open : camera.shutter_time(sampler->number(key, time_dimension));
  SampleStream random(*sampler, key);
  random.jump(path_dimension);

  SampleContext sample{s.wavelengths, random, arena, request.features, request.record, request.lengths, request.splats};
  Ray ray = camera.ray(s.film, lens, time);
  ray.width *= renderer.map_filter;
  ray.spread *= renderer.map_filter;
  if (request.record) [[unlikely]]
    record_camera(*request.record, camera, ray);
  s.value = renderer.radiance(context, ray, sample);
  arena.reset();
  if (request.record) [[unlikely]] {
    request.record->wavelengths = s.wavelengths;
    request.record->result = s.value;
  }
  return s;
}

}  // namespace

void Renderer::pass(const RenderContext& context, Pass& pass) const {
  const Division division(context.image.area(), pass);
  const bool wants_features = context.image.wants_features();
  const size_t path_lengths = size_t(context.image.path_lengths);
  pass.run(division.count(), [&](std::uint64_t item, ImageTile& tile, Arena& arena) {
    const PixelArea area = division.pixels(item);
    tile.begin(context.image, area);
    std::vector<Splat> splats;
    std::vector<Spectrum> lengths(path_lengths);
    Features features;
    const Request request{wants_features ? &features : nullptr, nullptr, lengths, &splats};
    const std::uint32_t first = division.first(item), last = division.last(item);
    for (int y = area.y0; y < area.y1; ++y)
      for (int x = area.x0; x < area.x1; ++x)
        for (SampleKey key(context.seed, x, y, first); key.sample < last; ++key.sample) {
          if (request.features) features = {};
          splats.clear();
          for (Spectrum& light : lengths) light = {};
          const CameraSample s = take_sample(*this, context, x, y, key, arena, request);
          tile.count_path();
          tile.contribute(s.film, x, y, key.sample, s.value, s.wavelengths, 1, lengths);
          for (const Splat& splat : splats)
            tile.splat(splat.film, x, y, key.sample, splat.value, splat.wavelengths, splat.length);
          if (request.features) tile.features(x, y, features);
        }
  });
}

Renderer::CameraSample Renderer::camera_sample(const RenderContext& context, int x, int y, std::uint32_t n, Arena& arena,
                                               const Request& request) const {
  return take_sample(*this, context, x, y, SampleKey(context.seed, x, y, n), arena, request);
}

std::string Renderer::bias() const {
  const std::string algorithm = unbiased() ? "" : "exact only in the limit of many samples";
  if (!(map_filter > 0)) return algorithm;
  return algorithm + (algorithm.empty() ? "" : "; ") + fmt::format("maps are averaged over {} pixels (map_filter)", map_filter);
}

Spectrum Renderer::radiance(const RenderContext&, const Ray&, SampleContext&) const {
  fail({}, "renders neither passes nor single rays");
}

}  // namespace etendue
