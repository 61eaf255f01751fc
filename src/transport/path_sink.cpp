#include "etendue/transport/path_sink.h"

#include "etendue/describe/color.h"

namespace etendue {

std::string object_name(const SceneObject& placed) {
  const SceneObject& object = placed.original();
  const std::string& name = object.class_info().name;
  return object.origin && !object.origin->name.empty() ? object.origin->name + " (" + name + ")" : name;
}

std::string lobe_name(Lobe lobe) {
  switch (lobe) {
    case diffuse_reflection: return "diffuse reflection";
    case diffuse_transmission: return "diffuse transmission";
    case glossy_reflection: return "glossy reflection";
    case glossy_transmission: return "glossy transmission";
    case specular_reflection: return "specular reflection";
    case specular_transmission: return "specular transmission";
    case null_scattering: return "null scattering";
  }
  return "unknown";
}

void PathSink::record_surface(const SurfacePoint& p, const Spectrum& throughput) {
  PathRecord::Vertex v;
  v.kind = "surface";
  v.object = object_name(*p.object);
  v.position = p.position;
  v.normal = p.normal;
  v.throughput = throughput;
  record->add(std::move(v));
}

void PathSink::record_medium(const Point3& position, const Spectrum& throughput) {
  PathRecord::Vertex v;
  v.kind = "volume";
  v.position = position;
  v.throughput = throughput;
  record->add(std::move(v));
}

void PathSink::record_escape(const SceneObject& far, const Ray& ray, const Spectrum& throughput) {
  PathRecord::Vertex v;
  v.kind = "escaped";
  v.object = object_name(far);
  v.position = ray.origin;
  v.normal = Normal3(ray.direction);
  v.throughput = throughput;
  record->add(std::move(v));
}

void PathSink::record_scattering(const ScatterSample& s) {
  PathRecord::Vertex& v = record->vertices.back();
  v.lobe = lobe_name(s.lobe);
  v.pdf = s.pdf;
  if (s.dispersive) v.note = "dispersion: only the hero wavelength goes on";
}

void PathSink::record_emitter_hit(const Spectrum& light, int length, float weight) {
  record->vertices.back().emitted += light;
  record->contribute({"emitter hit", length, weight, light, {}, false});
}

void PathSink::record_next_event(const Spectrum& light, int length, float weight) {
  record->vertices.back().direct = light;
  record->contribute({"next event estimation", length, weight, light, {}, false});
}

namespace {

/// The index of an object among the scene's objects. For scenes with many objects each thread caches a sorted list for the last
/// scene, identified by its version.
int place_in(const Scene& scene, const SceneObject* object) {
  constexpr size_t few = 32;
  if (scene.objects.size() <= few) {
    const auto place =
        std::find_if(scene.objects.begin(), scene.objects.end(), [&](const Ref<SceneObject>& o) { return o.get() == object; });
    return int(place - scene.objects.begin());
  }
  static thread_local std::uint64_t version = 0;
  static thread_local std::vector<std::pair<const SceneObject*, int>> places;
  if (version != scene.version()) {
    places.clear();
    for (const Ref<SceneObject>& o : scene.objects) places.emplace_back(o.get(), int(places.size()));
    std::sort(places.begin(), places.end());
    version = scene.version();
  }
  const auto place = std::lower_bound(places.begin(), places.end(), std::pair(object, 0));
  return place != places.end() && place->first == object ? place->second : int(scene.objects.size());
}

}  // namespace

void PathSink::store_features(const Scene& scene, const SurfacePoint& point, const Hit& hit, const Scatter* scatter,
                              const Vector3& out, const Wavelengths& wavelengths, float before) {
  Features& f = *features;
  features = nullptr;
  f.normal = Vector3(dot(point.shading_normal, out) < 0 ? -point.shading_normal : point.shading_normal);
  f.depth = before + hit.distance;
  const SceneObject* top = hit.depth > 0 ? hit.scenes[hit.depth - 1] : hit.object;
  f.object = place_in(scene, top) + 1;
  if (!scatter) return;
  static const RgbSpace& srgb = rgb_space("srgb");
  const Xyz c = to_xyz(scatter->albedo(out) * srgb.illuminant->evaluate(wavelengths, ColorUse::reflectance), wavelengths);
  const auto& m = srgb.from_xyz;
  f.albedo = {float(m[0] * c.x + m[1] * c.y + m[2] * c.z), float(m[3] * c.x + m[4] * c.y + m[5] * c.z),
              float(m[6] * c.x + m[7] * c.y + m[8] * c.z)};
}

}  // namespace etendue
