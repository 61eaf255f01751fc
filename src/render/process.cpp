#include "etendue/render/process.h"

#include <algorithm>

#include "etendue/render/renderer.h"
#include "etendue/transport/light_groups.h"
#include "film/pixel_area.h"
#include "parallel_schedule.h"

namespace etendue {
namespace {

/// Divides the picture and the samples of a step into items: tiles, and for small pictures parts of the sample range as well.
/// The division depends only on the picture's size and the pass, so results do not depend on threads.
///
/// A crop uses the tiles of the whole picture, without those outside of it. Each pixel is then the same sum, of the same terms
/// in the same order, as in the whole picture. A pass of a crop contains several passes of the whole picture, one after the
/// other: a small crop has few tiles, and more items keep more threads busy.
class Division {
 public:
  struct Item {
    PixelArea area;
    std::uint32_t first, last;  ///< samples [first, last)
    std::uint32_t block;        ///< the pass of the whole picture they belong to, by its first sample
  };

  Division(const ImageBuffer& image, IndexRange pass) : area_(image.sampled_area()) {
    const PixelArea whole{0, 0, image.width, image.height};
    column_ = area_.x0 / tile;
    row_ = area_.y0 / tile;
    columns_ = (area_.x1 + tile - 1) / tile - column_;
    const int rows = (area_.y1 + tile - 1) / tile - row_;
    tiles_ = std::uint64_t(columns_) * std::uint64_t(rows);

    constexpr std::uint64_t enough = 64;
    const auto along = [](int pixels) { return std::uint64_t((pixels + tile - 1) / tile); };
    const std::uint64_t all_tiles = along(whole.width()) * along(whole.height());
    const std::uint32_t step = samples_per_step(whole);
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
  v.position = camera.lens_point(ray);
  v.normal = Normal3(ray.direction);
  v.throughput = Spectrum(1.0f);
  record.vertices.push_back(std::move(v));
}

/// Multiplies the parts of the sample's value in the sink by the camera's weight, as the value is.
void weigh_parts(const Spectrum& weight, const PathSink& sink) {
  for (Spectrum& light : sink.lengths) light *= weight;
  if (sink.record) [[unlikely]]
    for (PathRecord::Contribution& part : sink.record->contributions)
      if (!part.splat) part.value *= weight;
  LightParts::weigh(weight);
}

}  // namespace

RenderProcess::RenderProcess(const Renderer& r, const RenderContext& c) : renderer(r), context(c) {}
RenderProcess::~RenderProcess() = default;

Spectrum RenderProcess::radiance(const Ray& ray, SampleContext& sample) const {
  return renderer.radiance(context, ray, sample);
}

CameraSample RenderProcess::path(const PixelArea& area, const NumberSource& source, SampleKey key, Arena& arena,
                                 const PathSink& sink) const {
  const Camera& camera = context.camera;
  CameraSample s;
  SampleContext sample{s.wavelengths, {source, key}, arena, sink};
  NumberStream& numbers = sample.numbers;
  const Point2 within = numbers.next_pair();
  s.film = {float(area.x0) + within.x * float(area.width()), float(area.y0) + within.y * float(area.height())};
  const Point2 lens = camera.has_lens() ? numbers.next_pair() : (numbers.skip(2), Point2{});
  const bool still = !(camera.shutter_close > camera.shutter_open);
  const float at = still ? (numbers.skip(), camera.shutter_open) : time(numbers.next());
  s.wavelengths = wavelengths(key, numbers.next());
  CameraRay from;
  PathRecord* const record = sink.record;
  if (!camera.sample_ray(s.film, lens, at, s.wavelengths, from)) {
    // The lens blocks the ray, so the sample is black. The algorithm's splats from light subpaths do not pass through this ray,
    // and features do not depend on it: both are still computed.
    if (!renderer.splats() && !sink.features && !record) return s;
    from.ray = camera.ray(s.film, lens, at);
    from.weight = {};
  }
  from.ray.width *= renderer.map_filter;
  from.ray.spread *= renderer.map_filter;
  from.ray.of_camera = true;
  if (record) [[unlikely]]
    record_camera(*record, camera, from.ray);
  s.value = from.weight * radiance(from.ray, sample);
  if (Features* const features = sink.features; features && features->depth > 0) [[unlikely]]
    features->depth += camera.reach(from.ray).nearest;
  weigh_parts(from.weight, sink);
  arena.reset();
  if (record) [[unlikely]] {
    record->wavelengths = s.wavelengths;
    record->result = s.value;
  }
  return s;
}

CameraSample RenderProcess::sample(int x, int y, std::uint32_t number, Arena& arena, const PathSink& sink) const {
  return path({x, y, x + 1, y + 1}, *renderer.sampler, SampleKey(context.seed, x, y, number), arena, sink);
}

void RenderProcess::step(Schedule& schedule, const Step& step) { film_paths(schedule, step, nullptr); }

size_t RenderProcess::path_items(const Step& step) const { return size_t(Division(context.image, step.samples).count()); }

void RenderProcess::film_paths(Schedule& schedule, const Step& step,
                               const std::function<RecordList(std::uint64_t item)>& records_of) {
  const Division division(context.image, step.samples);
  const bool wants_features = context.image.wants_features();
  const LightGroups groups(context.scene, context.image);
  schedule.film(division.count(), [&](std::uint64_t item, ImageTile& tile, Arena& arena) {
    const auto [area, first, last, block] = division.item(item);
    tile.begin(context.image, area, block);
    std::vector<Splat> splats;
    LightParts parts(context.image, groups);
    Features features;
    const PathSink sink{.features = wants_features ? &features : nullptr,
                        .lengths = parts.lengths(),
                        .splats = &splats,
                        .records = records_of ? records_of(item) : RecordList(),
                        .abort = schedule.abort};
    for (int y = area.y0; y < area.y1; ++y)
      for (int x = area.x0; x < area.x1; ++x)
        for (SampleKey key(context.seed, x, y, first); key.sample < last; ++key.sample) {
          if (schedule.aborted()) return;
          if (wants_features) features = {};
          splats.clear();
          parts.clear();
          const CameraSample s = path({x, y, x + 1, y + 1}, *renderer.sampler, key, arena, sink);
          tile.count_path();
          tile.contribute(s.film, x, y, key.sample, s.value, s.wavelengths, 1, parts.all());
          for (const Splat& splat : splats)
            tile.splat(splat.film, x, y, key.sample, splat.value, splat.wavelengths, splat.length);
          if (wants_features) tile.features(x, y, key.sample, features);
        }
  });
}

}  // namespace etendue
