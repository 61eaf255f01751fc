#include "etendue/transport/path_sink.h"

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

}  // namespace etendue
