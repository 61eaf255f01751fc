#include "mattes.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <tuple>
#include <unordered_map>

#include "etendue/core/arena.h"
#include "etendue/transport/ray_tree.h"
#include "film/filter_window.h"
#include "film/picture_format.h"
#include "render/camera_path.h"

namespace etendue {
namespace {

/// The names of all objects and shaders of a scene and its nested scenes.
class Names {
 public:
  explicit Names(const Scene& scene) { add(scene); }

  /// From the scene to the object: the object itself is the last. Nested scenes that are no objects of a list are left out.
  std::vector<std::string> path(const Hit& hit) const {
    std::vector<std::string> names;
    for (int i = hit.depth; i-- > 0;)
      if (const auto found = names_.find(hit.scenes[i]); found != names_.end()) names.push_back(found->second);
    names.push_back(name_of(*hit.object));
    return names;
  }
  std::string material(const SceneObject& object) const {
    const auto found = names_.find(object.shader.get());
    return found == names_.end() ? "none" : found->second;
  }

 private:
  void add(const Scene& scene) {
    for (const Ref<SceneObject>& object : scene.objects) {
      add(*object);
      if (object->shader) add(*object->shader);
      if (const Scene* inner = scene_within(*object)) add(*inner);
    }
  }
  void add(const Component& part) {
    if (names_.contains(&part)) return;
    const std::string& type = part.class_info().name;
    const bool named = part.origin && !part.origin->name.empty();
    names_[&part] = named ? part.origin->name : type + " " + std::to_string(++numbers_[type]);
    if (part.origin) written_[place_of(part)] = names_[&part];
  }
  /// Where an instance has replaced the shader, another object stands for the one of the list: it has the same origin.
  std::string name_of(const SceneObject& object) const {
    if (const auto found = names_.find(&object); found != names_.end()) return found->second;
    if (!object.origin) return object.class_info().name;
    const auto found = written_.find(place_of(object));
    return found != written_.end() ? found->second : object.class_info().name;
  }
  using Place = std::tuple<std::string, int, int>;
  static Place place_of(const Component& part) {
    const Location& at = part.origin->location;
    return {at.file, at.line, at.column};
  }
  std::unordered_map<const Component*, std::string> names_;
  std::map<std::string, int> numbers_;
  std::map<Place, std::string> written_;
};

/// What a sample sees: the film point, and a key of the object in its instances; 0: nothing.
struct Seen {
  Point2 film;
  std::uint64_t key = 0;
};

/// What is seen along a camera ray first. Null scattering, as in holes and panes, is left to chance as in the paths of
/// renderers.
bool see(const Scene& scene, Ray ray, SampleContext& sample, Hit& hit) {
  NumberStream numbers = sample.numbers.fork("mattes");
  MediumStack stack;
  MediumStack* const media = media_around(scene, ray, stack);
  SurfacePoint point;
  for (int crossings = 0; crossings <= most_crossings; ++crossings) {
    hit = {};
    if (!meet_surface(scene, ray, media, hit, point)) return false;
    const Vector3 out = -ray.direction;
    const Shader* const shader = point.object->shader.get();
    if (!shader || !(shader->possible_lobes() & null_scattering)) return true;
    const Scatter* const scatter = scattering_at(point, out, sample.wavelengths, sample.arena);
    const std::optional<ScatterSample> next = scatter ? scatter->sample(out, 0, {}, {.lobes = null_scattering}) : std::nullopt;
    // The lobe alone has the transmittance as its weight, of which there may be one for each wavelength.
    float transmittance = 0;
    if (next)
      for (int i = 0; i < spectrum_size; ++i) transmittance += next->weight[i] / spectrum_size;
    if (!(numbers.next() < transmittance)) return true;
    go_on(point, *next, ray, media);
  }
  return false;
}

/// The sums of filter weights of a pixel.
struct PixelSums {
  double whole = 0;
  std::vector<std::pair<std::uint64_t, double>> parts;
  void add(std::uint64_t key, double weight) {
    whole += weight;
    if (key == 0) return;
    const auto found = std::ranges::find(parts, key, &std::pair<std::uint64_t, double>::first);
    found == parts.end() ? void(parts.emplace_back(key, weight)) : void(found->second += weight);
  }
};

template <class F>
void over_rows(int first, int end, F f) {
  tbb::parallel_for(tbb::blocked_range<int>(first, end, 1), [&](const auto& rows) {
    for (int y = rows.begin(); y != rows.end(); ++y) f(y);
  });
}

class MatteMaker {
 public:
  explicit MatteMaker(const Render& render)
      : process_(render.start_at(0)),
        format_(*process_->context.image.format()),
        samples_(std::uint32_t(process_->renderer.samples)),
        sums_(format_.pixels()) {}

  /// Adds the samples of the rows, which are seen in parallel, and then added row by row of the picture, in the order of the
  /// samples: the sums do not depend on the number of threads.
  void add_rows(int first, int end) {
    const PixelArea& sampled = format_.sampled_area;
    const size_t row = size_t(sampled.width()) * samples_;
    std::vector<Seen> seen(row * size_t(end - first));
    over_rows(first, end, [&](int y) { see_row(y, &seen[row * size_t(y - first)]); });
    const int reach = format_.reach();
    over_rows(std::max(first - reach, format_.area.y0), std::min(end + reach, format_.area.y1), [&](int y) {
      for (int from = std::max(y - reach, first); from < std::min(y + reach + 1, end); ++from) {
        const Seen* s = &seen[row * size_t(from - first)];
        for (int x = sampled.x0; x < sampled.x1; ++x)
          for (std::uint32_t i = 0; i < samples_; ++i, ++s) add(*s, x, y);
      }
    });
  }

  /// The coverages by the names that `name_of` gives the objects.
  template <class F>
  Cryptomatte mattes(const std::string& name, F name_of) const {
    Cryptomatte made{name, {}, format_.area.width(), format_.area.height(), {}};
    std::unordered_map<std::uint64_t, std::uint32_t> identifiers;
    for (const auto& [key, hit] : objects_) {
      const std::string of = name_of(hit);
      identifiers[key] = made.manifest[of] = cryptomatte_identifier(of);
    }
    made.pixels.reserve(sums_.size());
    for (const PixelSums& sums : sums_) {
      std::map<std::uint32_t, double> by_identifier;
      for (const auto& [key, weight] : sums.parts) by_identifier[identifiers.at(key)] += weight;
      std::vector<Cryptomatte::Rank> ranks;
      // Filters with negative weights can give negative sums, and more than the whole.
      for (const auto& [identifier, weight] : by_identifier)
        if (const double coverage = weight / sums.whole; coverage > 0)
          ranks.push_back({identifier, float(std::min(coverage, 1.0))});
      std::ranges::stable_sort(ranks, std::greater(), &Cryptomatte::Rank::coverage);
      made.pixels.push_back(std::move(ranks));
    }
    return made;
  }

  const Scene& scene() const { return process_->context.scene; }
  const PixelArea& sampled() const { return format_.sampled_area; }
  std::uint32_t samples() const { return samples_; }

 private:
  void see_row(int y, Seen* to) {
    Arena arena;
    std::unordered_map<std::uint64_t, Hit> found;
    for (int x = format_.sampled_area.x0; x < format_.sampled_area.x1; ++x)
      for (std::uint32_t i = 0; i < samples_; ++i, ++to) {
        const SampleKey key(process_->context.seed, x, y, i);
        CameraSample s;
        SampleContext sample{s.wavelengths, {*process_->renderer.sampler, key}, arena, {}};
        CameraRay from;
        Hit hit;
        if (begin_camera_path(*process_, {x, y, x + 1, y + 1}, key, sample, s, from) && see(scene(), from.ray, sample, hit)) {
          to->key = key_of(hit);
          found.try_emplace(to->key, hit);
        }
        to->film = s.film;
        arena.reset();
      }
    const std::lock_guard lock(mutex_);
    objects_.merge(found);
  }

  /// Of the object in its instances, within this process. Not 0.
  static std::uint64_t key_of(const Hit& hit) {
    std::uint64_t key = mix_bits(std::uint64_t(reinterpret_cast<std::uintptr_t>(hit.object)));
    for (int i = 0; i < hit.depth; ++i) key = mix_bits(key ^ std::uint64_t(reinterpret_cast<std::uintptr_t>(hit.scenes[i])));
    return key ? key : 1;
  }

  /// Adds a sample of a pixel in column x to the pixels of row y that its filter covers.
  void add(const Seen& seen, int x, int y) {
    const PixelArea& area = format_.area;
    if (format_.box) {
      if (area.contains(x, y)) sums_[format_.index(x, y)].add(seen.key, 1);
      return;
    }
    constexpr int size = PictureFormat::table_size;
    const FilterWindow down(seen.film.y, format_.radius, size, y, y + 1);
    if (down.count == 0) return;
    const FilterWindow across(seen.film.x, format_.radius, size, area.x0, area.x1);
    for (int i = 0; i < across.count; ++i)
      sums_[format_.index(across.first + i, y)].add(
          seen.key, double(format_.table[size_t(down.cells[0] * size + across.cells[size_t(i)])]));
  }

  const std::unique_ptr<RenderProcess> process_;
  const PictureFormat& format_;
  const std::uint32_t samples_;
  std::vector<PixelSums> sums_;
  std::mutex mutex_;
  std::unordered_map<std::uint64_t, Hit> objects_;
};

}  // namespace

std::vector<Cryptomatte> render_mattes(const Render& render, int threads, const std::function<bool(double)>& go_on) {
  MatteMaker maker(render);
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  // Bands of rows, whose samples take some tens of megabytes.
  const PixelArea& area = maker.sampled();
  const size_t row = size_t(area.width()) * maker.samples() * sizeof(Seen);
  const int rows = int(std::clamp(size_t(1 << 26) / std::max(row, size_t(1)), size_t(1), size_t(64)));
  for (int y = area.y0; y < area.y1; y += rows) {
    arena.execute([&] { maker.add_rows(y, std::min(y + rows, area.y1)); });
    if (!go_on(double(std::min(y + rows, area.y1) - area.y0) / area.height())) return {};
  }
  const Names names(maker.scene());
  const auto object = [&](const Hit& hit) {
    std::string path;
    for (const std::string& name : names.path(hit)) path += (path.empty() ? "" : "/") + name;
    return path;
  };
  return {maker.mattes("crypto_object", object),
          maker.mattes("crypto_material", [&](const Hit& hit) { return names.material(*hit.object); }),
          maker.mattes("crypto_asset", [&](const Hit& hit) { return names.path(hit).front(); })};
}

}  // namespace etendue
