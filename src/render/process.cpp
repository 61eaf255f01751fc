#include "etendue/render/process.h"

#include "camera_path.h"
#include "division.h"
#include "etendue/render/renderer.h"
#include "etendue/transport/light_groups.h"

namespace etendue {
namespace {

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
  CameraSample s;
  SampleContext sample{s.wavelengths, {source, key}, arena, sink};
  CameraRay from;
  if (!begin_camera_path(*this, area, key, sample, s, from)) return s;
  PathRecord* const record = sink.record;
  if (record) [[unlikely]]
    record_camera(*record, context.camera, from.ray);
  // Fluorescence changes the wavelengths of the path; its value still belongs to those at which it left the film.
  std::optional<Wavelengths> film;
  if (context.scene.has_fluorescence()) [[unlikely]]
    film = s.wavelengths;
  s.value = from.weight * radiance(from.ray, sample);
  if (film) [[unlikely]]
    s.wavelengths = *film;
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

void RenderProcess::step(Schedule& schedule, const Step& step) {
  const PathWork work = path_work(schedule, step);
  schedule.film(path_items(step), [&](std::uint64_t item, ImageTile& tile, Arena& arena) { work(item, tile, {}, arena); });
}

std::uint64_t RenderProcess::path_items(const Step& step) const { return Division(context.image, step.samples).count(); }

RenderProcess::PathWork RenderProcess::path_work(const Schedule& schedule, const Step& step) const {
  const Division division(context.image, step.samples);
  const LightGroups groups(context.scene, context.image);
  return [this, &schedule, division, groups](std::uint64_t item, ImageTile& tile, RecordList records, Arena& arena) {
    const auto [area, first, last, block] = division.item(item);
    tile.begin(context.image, area, block);
    std::vector<Splat> splats;
    LightParts parts(context.image, groups);
    const PathSink sink{.lengths = parts.lengths(), .splats = &splats, .records = records, .abort = schedule.abort};
    for (int y = area.y0; y < area.y1; ++y)
      for (int x = area.x0; x < area.x1; ++x)
        for (SampleKey key(context.seed, x, y, first); key.sample < last; ++key.sample) {
          if (schedule.aborted()) return;
          splats.clear();
          parts.clear();
          const CameraSample s = path({x, y, x + 1, y + 1}, *renderer.sampler, key, arena, sink);
          tile.count_path();
          parts.require_all(s.value, s.wavelengths);
          tile.contribute(s.film, x, y, key.sample, s.value, s.wavelengths, 1, parts.all());
          for (const Splat& splat : splats)
            tile.splat(splat.film, x, y, key.sample, splat.value, splat.wavelengths, splat.length);
        }
  };
}

}  // namespace etendue
