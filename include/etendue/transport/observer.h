#pragma once
// PathObserver: who looks on while paths are made. Someone replays a sample and wants its vertices, a film wants features of
// first surfaces, `verify` wants light by path length. Every call does nothing, at the cost of one test, when nobody does.

#include <algorithm>
#include <span>

#include "etendue/film/image_tile.h"
#include "etendue/scene.h"
#include "etendue/shader.h"
#include "etendue/transport/path_record.h"

namespace etendue {

class PathObserver {
 public:
  Features* features = nullptr;      ///< to be filled at the first surface when not null
  PathRecord* record = nullptr;      ///< to be filled when not null
  std::span<Spectrum> lengths = {};  ///< radiance by path length, the last for all longer ones too

  /// Light, a part of the sample's own value, that came by a path of so many segments (1: a luminaire seen by the camera).
  /// Renderers that call this for all they return can be compared length by length.
  void light(int length, const Spectrum& value) {
    if (!lengths.empty()) [[unlikely]]
      lengths[std::min(size_t(length), lengths.size()) - 1] += value;
  }

  /// A path's next vertex, and the throughput it arrives with.
  void surface(const SurfacePoint& p, const Spectrum& throughput) {
    if (record) [[unlikely]]
      surface_slowly(p, throughput);
  }
  void medium(const Point3& at, const Spectrum& throughput) {
    if (record) [[unlikely]]
      medium_slowly(at, throughput);
  }
  void escape(const SceneObject& luminaire, const Ray& ray, const Spectrum& throughput) {
    if (record) [[unlikely]]
      escape_slowly(luminaire, ray, throughput);
  }
  /// How the path goes on from its last vertex.
  void scattered(const ScatterSample& sample) {
    if (record) [[unlikely]]
      scattered_slowly(sample);
  }
  /// Light of a luminaire met by a path of `length` segments, with its weight against having been sampled.
  void emitter_hit(const Spectrum& value, int length, float weight) {
    if (record && !value.black()) [[unlikely]]
      emitter_hit_slowly(value, length, weight);
  }
  /// Light of a luminaire sampled from the path's last vertex, with its weight against being met.
  void next_event(const Spectrum& value, int length, float weight) {
    if (record) [[unlikely]]
      next_event_slowly(value, length, weight);
  }

  /// The first surface of a camera path, of which features are wanted once. `scatter` may be null: black. `before`: the
  /// distance to the last boundary on the way that the path went straight through [m].
  void first_surface(const Scene& scene, const SurfacePoint& p, const Hit& hit, const Scatter* scatter, const Vector3& out,
                     const Wavelengths& w, float before = 0) {
    if (features) [[unlikely]]
      first_surface_slowly(scene, p, hit, scatter, out, w, before);
  }

 private:
  void surface_slowly(const SurfacePoint&, const Spectrum& throughput);
  void medium_slowly(const Point3&, const Spectrum& throughput);
  void escape_slowly(const SceneObject&, const Ray&, const Spectrum& throughput);
  void scattered_slowly(const ScatterSample&);
  void emitter_hit_slowly(const Spectrum&, int length, float weight);
  void next_event_slowly(const Spectrum&, int length, float weight);
  void first_surface_slowly(const Scene&, const SurfacePoint&, const Hit&, const Scatter*, const Vector3& out,
                            const Wavelengths&, float before);
};

/// How people know an object: by its name in the file, and its class.
std::string object_name(const SceneObject&);

/// "diffuse reflection", …
std::string lobe_name(Lobe);

}  // namespace etendue
