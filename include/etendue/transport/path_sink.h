#pragma once
// PathSink: receives the results of a path besides the radiance that it returns. These are radiance by path length, splats,
// training samples of a guide, and the record of a replay. Each is optional: an unused one costs one test.

#include <algorithm>
#include <atomic>
#include <span>
#include <typeinfo>
#include <vector>

#include "etendue/film/image_tile.h"
#include "etendue/scene.h"
#include "etendue/shader.h"
#include "etendue/transport/path_record.h"

namespace etendue {

/// A contribution to another point of the film than the sample's own, from a path that started at a luminaire.
struct Splat {
  Point2 film;
  Spectrum value;  ///< the contribution of one path to the mean radiance over the whole film, with importance normalised to an
                   ///< integral of 1: see ImageTile::splat
  Wavelengths wavelengths;
  int length = 0;  ///< segments of the path; with light groups SplatLabel::packed
};

/// A list of records of one type, for which paths need not know the algorithm that reads them: training samples, reservoirs.
class RecordList {
 public:
  RecordList() = default;
  /// `list` must outlive it.
  template <class T>
  explicit RecordList(std::vector<T>& list) : list_(&list), type_(&typeid(T)) {}
  explicit operator bool() const { return list_ != nullptr; }
  /// Does nothing when there is no list, or one of another type.
  template <class T>
  void add(T&& record) {
    using Record = std::remove_cvref_t<T>;
    if (list_ && *type_ == typeid(Record)) static_cast<std::vector<Record>*>(list_)->push_back(std::forward<T>(record));
  }

 private:
  void* list_ = nullptr;
  const std::type_info* type_ = nullptr;
};

struct PathSink {
  PathRecord* record = nullptr;              ///< filled when a sample is replayed; null: not needed
  std::span<Spectrum> lengths = {};          ///< radiance by path length, the last entry for all longer paths too
  std::vector<Splat>* splats = nullptr;      ///< null: splats are dropped
  RecordList records = {};                   ///< of RenderProcess::film_paths<T>; empty in a replay
  const std::atomic<bool>* abort = nullptr;  ///< true: the results are no longer needed; null: they always are

  /// Whether the path may end with any result. A path or a tree of rays can take hours (between white walls, with a large
  /// `max_depth`), so every loop over vertices tests this now and then.
  bool aborted() const { return abort && abort->load(std::memory_order_relaxed); }

  /// A part of the sample's own radiance, of a path of `length` segments (1: a luminaire seen by the camera). Renderers that
  /// call this for all radiance they return can be compared length by length.
  void light(int length, const Spectrum& value) {
    if (!lengths.empty()) [[unlikely]]
      lengths[std::min(size_t(length), lengths.size()) - 1] += value;
  }
  /// A contribution to a point of the film, besides the sample's own radiance. `length`: see Splat.
  void splat(Point2 film, const Spectrum& value, const Wavelengths& wavelengths, int length) {
    if (splats) splats->push_back({film, value, wavelengths, length});
  }

  /// The next vertex of a path, with the throughput of the path up to it.
  void surface(const SurfacePoint& point, const Spectrum& throughput) {
    if (record) [[unlikely]]
      record_surface(point, throughput);
  }
  void medium(const Point3& at, const Spectrum& throughput) {
    if (record) [[unlikely]]
      record_medium(at, throughput);
  }
  void escape(const SceneObject& luminaire, const Ray& ray, const Spectrum& throughput) {
    if (record) [[unlikely]]
      record_escape(luminaire, ray, throughput);
  }
  /// The direction that was sampled at the last vertex.
  void scattered(const ScatterSample& sample) {
    if (record) [[unlikely]]
      record_scattering(sample);
  }
  /// The contribution of an emitter hit by a path of `length` segments, and its weight against next event estimation.
  void emitter_hit(const Spectrum& value, int length, float weight) {
    if (record && !value.black()) [[unlikely]]
      record_emitter_hit(value, length, weight);
  }
  /// The contribution of next event estimation at the last vertex, and its weight against an emitter hit.
  void next_event(const Spectrum& value, int length, float weight) {
    if (record) [[unlikely]]
      record_next_event(value, length, weight);
  }

  // The rare case of each, out of line.
  void record_surface(const SurfacePoint&, const Spectrum& throughput);
  void record_medium(const Point3&, const Spectrum& throughput);
  void record_escape(const SceneObject&, const Ray&, const Spectrum& throughput);
  void record_scattering(const ScatterSample&);
  void record_emitter_hit(const Spectrum&, int length, float weight);
  void record_next_event(const Spectrum&, int length, float weight);
};

/// The description of an object for users: its name in the file, and its class.
std::string object_name(const SceneObject&);

/// "diffuse reflection", …
std::string lobe_name(Lobe);

}  // namespace etendue
