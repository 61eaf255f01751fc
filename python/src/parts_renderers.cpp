// Renderers that are written in Python. Their method `radiance` gets the camera paths of a tile of the picture at once.

#include <algorithm>

#include "etendue/transport/light_groups.h"
#include "parts_points.h"
#include "parts_rays.h"
#include "render/camera_path.h"
#include "render/division.h"

namespace etendue::python {

namespace {

const MethodName not_found_name("not_found"), expectation_name("expectation");

/// Renders camera paths, as RenderProcess does, but many at a time.
class TileProcess final : public RenderProcess {
 public:
  TileProcess(const Renderer& r, const PythonPart& part, const RenderContext& c) : RenderProcess(r, c), part_(part) {}

  void step(Schedule& schedule, const Step& step) override {
    const Division division(context.image, step.samples);
    schedule.film(division.count(), [&](std::uint64_t item, ImageTile& tile, Arena& arena) {
      const Division::Item work = division.item(item);
      tile.begin(context.image, work.area, work.block);
      // Up to 4096 paths: enough that the time of Python's own steps does not count, few enough that their arrays stay in the
      // caches. The number does not depend on the area, so that a crop has the pixels of the whole picture.
      constexpr std::uint32_t together = 16;
      for (std::uint32_t first = work.first; first < work.last && !schedule.aborted(); first += together) {
        const PathRange range{work.area, first, std::min(work.last, first + together)};
        render(range, tile, arena, schedule.abort);
        arena.reset();
      }
    });
  }

 private:
  struct PathRange {
    PixelArea area;
    std::uint32_t first, last;  ///< samples of each pixel
  };
  struct Path {
    int x, y;
    std::uint32_t sample;
    CameraSample contribution;
    CameraRay ray;
    bool blocked = false;
  };

  void render(const PathRange& range, ImageTile& tile, Arena& arena, const std::atomic<bool>* abort) const {
    const size_t count = size_t(range.area.width()) * size_t(range.area.height()) * (range.last - range.first);
    std::vector<Path> paths;
    paths.reserve(count);  // samples refer to the wavelengths within
    std::vector<Ray> rays;
    const Batch batch(new PathBatch{context, *renderer.light_sampler, arena, {}, {}, {}, {}, abort});
    for (int y = range.area.y0; y < range.area.y1; ++y)
      for (int x = range.area.x0; x < range.area.x1; ++x)
        for (SampleKey key(context.seed, x, y, range.first); key.sample < range.last; ++key.sample) {
          Path& path = paths.emplace_back(Path{x, y, key.sample, {}, {}});
          const PathSink sink{.abort = abort};
          SampleContext sample{path.contribution.wavelengths, {*renderer.sampler, key}, arena, sink};
          path.blocked = !begin_camera_path(*this, {x, y, x + 1, y + 1}, key, sample, path.contribution, path.ray);
          if (path.blocked) continue;
          batch->numbers.push_back(sample.numbers);
          batch->wavelengths.push_back(path.contribution.wavelengths);
          batch->film.push_back(path.contribution.film);
          batch->sinks.push_back(sink);
          rays.push_back(path.ray.ray);
        }
    const std::vector<Spectrum> light =
        rays.empty() ? std::vector<Spectrum>() : python_radiance(part_, camera_rays(batch, std::move(rays)));
    size_t next = 0;
    for (size_t i = 0; i < paths.size(); ++i) {
      Path& path = paths[i];
      CameraSample& s = path.contribution;
      if (!path.blocked) {
        s.value = path.ray.weight * light[next];
        s.wavelengths = batch->wavelengths[next++];
      }
      tile.count_path();
      tile.contribute(s.film, path.x, path.y, path.sample, s.value, s.wavelengths);
    }
  }

  const PythonPart& part_;
};

class PythonRenderer final : public PartOf<Renderer> {
 public:
  using PartOf::PartOf;

  /// One path, for replay and for renderers that contain this one.
  Spectrum radiance(const RenderContext& context, const Ray& ray, SampleContext& sample) const override {
    const Batch batch(new PathBatch{
        context, *light_sampler, sample.arena, {sample.numbers}, {sample.wavelengths}, {}, {sample.sink}, sample.sink.abort});
    const Spectrum light = python_radiance(*this, camera_rays(batch, {ray})).front();
    sample.numbers = batch->numbers.front();
    sample.wavelengths = batch->wavelengths.front();
    return light;
  }

  PathClasses finds() const override {
    // What a path tracer made of the functions of parts_rays.cpp does not find.
    constexpr PathClasses usual = delta_caustics | delta_caustics_in_mirrors | scattering_media | emitting_media |
                                  heterogeneous_media | subsurface_light | light_through_surfaces;
    if (!defines(not_found_name)) return all_paths & ~usual;
    const Interpreter lock;
    const Called called{declared_class().name, not_found_name.text};
    const nb::object names = attribute_or_call(*this, not_found_name);
    PathClasses lost = no_paths;
    if (!PyTuple_Check(names.ptr()) && !PyList_Check(names.ptr())) called.refuse(names, "a tuple of names of kinds of light");
    for (const nb::handle name : names) lost |= class_named(to_text(name, called), called);
    if (lost & delta_caustics) lost |= delta_caustics;  // what follows chains but not past panes is not written in Python
    return all_paths & ~lost;
  }

  Expectation expectation() const override {
    if (!defines(expectation_name)) return Expectation::unbiased;
    const Interpreter lock;
    const Called called{declared_class().name, expectation_name.text};
    const nb::object value = attribute_or_call(*this, expectation_name);
    const std::string text = to_text(value, called);
    constexpr std::pair<const char*, Expectation> all[] = {
        {"unbiased", Expectation::unbiased}, {"consistent", Expectation::consistent}, {"biased", Expectation::biased}};
    for (const auto& [name, expectation] : all)
      if (text == name) return expectation;
    called.refuse(value, "'unbiased', 'consistent' or 'biased'");
  }

 protected:
  std::unique_ptr<RenderProcess> begin(const RenderContext& context) const override {
    const LightGroups groups(context.scene, context.image);
    if (!LightParts(context.image, groups).lengths().empty())
      context.image.fail("path_lengths", declared_class().name +
                                             ", a renderer that is written in Python, does not report its light by path length "
                                             "or light group; leave out these layers");
    return std::make_unique<TileProcess>(*this, *this, context);
  }

 private:
  static PathClass class_named(const std::string& name, const Called& called) {
    std::vector<std::string> known;
    for (const PathClassInfo& c : path_classes()) {
      if (name == c.name) return c.bit;
      known.emplace_back(c.name);
    }
    throw Error(called.text() + ": there is no kind of light '" + name + "'" + suggestion(name, known));
  }
};

}  // namespace

PartInterface renderer_interface() {
  return {"Renderer",
          make_part<PythonRenderer>,
          {{"radiance", "self, context, rays, samples",
            "estimates of the radiance along N camera rays [W m^-2 sr^-1 nm^-1], shape (N, 8); context.intersect, .occluded; "
            "samples.uniform; the surfaces' emitted, direct, scatter, evaluate, albedo, leave"},
           {"not_found", "self", "names of the kinds of light that it finds in no scene, such as 'delta_caustics'"},
           {"expectation", "self", "'unbiased', 'consistent' or 'biased'; 'unbiased' by default"},
           prepare_method},
          {{"radiance"}}};
}

}  // namespace etendue::python
