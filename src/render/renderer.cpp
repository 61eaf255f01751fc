// What all renderers share: the pass over camera paths.

#include "etendue/render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "film/pixel_area.h"
#include "pass_runner.h"

namespace etendue {

void Renderer::describe(Description<Renderer>& d) {
  d.summary(
       "An image synthesis algorithm. The length of paths (`max_depth`, `roulette_depth`) is counted in segments, from camera "
       "to "
       "luminaire: light seen directly has come by 1, light that was scattered n times by n + 1. Reflection, refraction and "
       "scattering in a medium count, and the way inside a body that scatters light beneath its surface counts as one segment; "
       "what goes straight on (through holes, thin panes, the bounds of media, bodies within others of higher priority) does "
       "not.")
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
///
/// A crop is divided as the whole picture is, with what does not reach it left out. Each of its pixels is then the same sum, of
/// the same parts in the same order, as in the whole picture. Its passes hold several of those of the whole picture, one after
/// the other: a small crop has few tiles, and the more items the more threads find work.
class Division {
 public:
  struct Item {
    PixelArea area;
    std::uint32_t first, last;  ///< samples, the last not included
    std::uint32_t block;        ///< which pass of the whole picture they belong to
  };

  Division(const ImageBuffer& image, const Pass& pass) : area_(image.sampled_area()) {
    const PixelArea whole{0, 0, image.width, image.height};
    column_ = area_.x0 / tile;
    row_ = area_.y0 / tile;
    columns_ = (area_.x1 + tile - 1) / tile - column_;
    const int rows = (area_.y1 + tile - 1) / tile - row_;
    tiles_ = std::uint64_t(columns_) * std::uint64_t(rows);

    constexpr std::uint64_t enough = 64;
    const auto along = [](int pixels) { return std::uint64_t((pixels + tile - 1) / tile); };
    const std::uint64_t all_tiles = along(whole.width()) * along(whole.height());
    const std::uint32_t step = samples_per_pass(whole);
    for (std::uint32_t begin = pass.begin; begin < pass.end;) {
      const std::uint32_t end = std::uint32_t(std::min<std::uint64_t>(pass.end, (std::uint64_t(begin) / step + 1) * step));
      const std::uint32_t n = end - begin;
      const auto wanted = std::uint32_t(std::clamp<std::uint64_t>((enough + all_tiles - 1) / all_tiles, 1, n));
      const std::uint32_t chunk = (n + wanted - 1) / wanted, chunks = (n + chunk - 1) / chunk;
      parts_.push_back({begin, end, chunk, chunks, count_});
      count_ += tiles_ * chunks;
      begin = end;
    }
  }

  std::uint64_t count() const { return count_; }

  Item item(std::uint64_t number) const {
    const Part& part = *(std::ranges::upper_bound(parts_, number, {}, &Part::first_item) - 1);
    const std::uint64_t rest = number - part.first_item;
    const int t = int(rest / part.chunks), x = (column_ + t % columns_) * tile, y = (row_ + t / columns_) * tile;
    const std::uint32_t first = part.begin + std::uint32_t(rest % part.chunks) * part.chunk;
    return {intersection({x, y, x + tile, y + tile}, area_), first, std::min(first + part.chunk, part.end), part.begin};
  }

 private:
  static constexpr int tile = 16;
  /// A pass of the whole picture.
  struct Part {
    std::uint32_t begin, end, chunk, chunks;
    std::uint64_t first_item;
  };

  PixelArea area_;
  int column_ = 0, row_ = 0, columns_ = 1;
  std::uint64_t tiles_ = 1, count_ = 0;
  std::vector<Part> parts_;
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

  SampleContext sample{s.wavelengths,  random,          arena,          request.features,
                       request.record, request.lengths, request.splats, request.abort};
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
  const Division division(context.image, pass);
  const bool wants_features = context.image.wants_features();
  const size_t path_lengths = size_t(context.image.path_lengths);
  pass.run(division.count(), [&](std::uint64_t item, ImageTile& tile, Arena& arena) {
    const auto [area, first, last, block] = division.item(item);
    tile.begin(context.image, area, block);
    std::vector<Splat> splats;
    std::vector<Spectrum> lengths(path_lengths);
    Features features;
    const Request request{wants_features ? &features : nullptr, nullptr, lengths, &splats, pass.abort};
    for (int y = area.y0; y < area.y1; ++y)
      for (int x = area.x0; x < area.x1; ++x)
        for (SampleKey key(context.seed, x, y, first); key.sample < last; ++key.sample) {
          if (pass.aborted()) return;
          if (request.features) features = {};
          splats.clear();
          for (Spectrum& light : lengths) light = {};
          const CameraSample s = take_sample(*this, context, x, y, key, arena, request);
          tile.count_path();
          tile.contribute(s.film, x, y, key.sample, s.value, s.wavelengths, 1, lengths);
          for (const Splat& splat : splats)
            tile.splat(splat.film, x, y, key.sample, splat.value, splat.wavelengths, splat.length);
          if (request.features) tile.features(x, y, key.sample, features);
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
