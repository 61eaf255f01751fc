#pragma once
// What a renderer notes for people: a replayed path's vertices, and the features of the first surface. All calls do
// nothing when nobody listens.

#include "etendue/renderer.h"
#include "etendue/shader.h"

namespace etendue {

void record_surface_slowly(PathRecord&, const SurfacePoint&, const Spectrum& throughput);
void record_escape_slowly(PathRecord&, const SceneObject&, const Ray&, const Spectrum& throughput, const Spectrum& light);
void record_scatter_slowly(PathRecord&, const ScatterSample&);

inline void record_surface(PathRecord* r, const SurfacePoint& p, const Spectrum& throughput) {
  if (r) [[unlikely]]
    record_surface_slowly(*r, p, throughput);
}
inline void record_escape(PathRecord* r, const SceneObject& o, const Ray& ray, const Spectrum& throughput,
                          const Spectrum& light) {
  if (r) [[unlikely]]
    record_escape_slowly(*r, o, ray, throughput, light);
}
inline void record_emission(PathRecord* r, const Spectrum& light) {
  if (r) [[unlikely]]
    r->vertices.back().emitted = light;
}
inline void record_direct(PathRecord* r, const Spectrum& light) {
  if (r) [[unlikely]]
    r->vertices.back().direct = light;
}
inline void record_scatter(PathRecord* r, const ScatterSample& s) {
  if (r) [[unlikely]]
    record_scatter_slowly(*r, s);
}

/// "diffuse reflection", …
std::string lobe_name(Lobe);

/// The auxiliary layers' values at the first surface of a camera path; scatter may be null (black).
void note_features(Features&, const Scene&, const SurfacePoint&, const Hit&, const Scatter* scatter, const Vector3& out,
                   const Wavelengths&);

}  // namespace etendue
