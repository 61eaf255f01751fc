#pragma once
// What a renderer notes for people: a replayed path's vertices, and the features of the first surface. All calls do
// nothing when nobody listens.

#include "etendue/shader.h"
#include "etendue/transport/sample_context.h"

namespace etendue {

void record_surface_slowly(PathRecord&, const SurfacePoint&, const Spectrum& throughput);
void record_escape_slowly(PathRecord&, const SceneObject&, const Ray&, const Spectrum& throughput);
void record_scatter_slowly(PathRecord&, const ScatterSample&);
void record_volume_slowly(PathRecord&, const Point3&, const Spectrum& throughput);

inline void record_surface(PathRecord* r, const SurfacePoint& p, const Spectrum& throughput) {
  if (r) [[unlikely]]
    record_surface_slowly(*r, p, throughput);
}
inline void record_escape(PathRecord* r, const SceneObject& o, const Ray& ray, const Spectrum& throughput) {
  if (r) [[unlikely]]
    record_escape_slowly(*r, o, ray, throughput);
}
/// Light of a luminaire met by a path of `length` segments, and its weight against having been sampled.
inline void record_emission(PathRecord* r, const Spectrum& light, int length, float weight) {
  if (!r || light.black()) [[likely]]
    return;
  r->vertices.back().emitted += light;
  r->contribute({"luminaire met", length, weight, light, {}, false});
}
/// Light of a luminaire sampled from the path's last vertex, and its weight against being met.
inline void record_direct(PathRecord* r, const Spectrum& light, int length, float weight) {
  if (!r) [[likely]]
    return;
  r->vertices.back().direct = light;
  r->contribute({"luminaire sampled", length, weight, light, {}, false});
}
inline void record_scatter(PathRecord* r, const ScatterSample& s) {
  if (r) [[unlikely]]
    record_scatter_slowly(*r, s);
}

inline void record_volume(PathRecord* r, const Point3& p, const Spectrum& throughput) {
  if (r) [[unlikely]]
    record_volume_slowly(*r, p, throughput);
}

/// How people know an object: by its name in the file, and its class.
std::string object_name(const SceneObject&);

/// "diffuse reflection", …
std::string lobe_name(Lobe);

/// The auxiliary layers' values at the first surface of a camera path; scatter may be null (black).
void note_features(Features&, const Scene&, const SurfacePoint&, const Hit&, const Scatter* scatter, const Vector3& out,
                   const Wavelengths&, float distance_before = 0);

}  // namespace etendue
