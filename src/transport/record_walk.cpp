#include "record_walk.h"

#include "bound.h"
#include "medium_tracking.h"
#include "record.h"

namespace etendue {

void record_walk(std::vector<PathRecord::Vertex>& vertices, std::span<const Vertex> walk) {
  for (const Vertex& w : walk) {
    PathRecord::Vertex v;
    switch (w.kind) {
      case Vertex::Kind::camera: v.kind = "camera"; break;
      case Vertex::Kind::luminaire: v.kind = "luminaire"; break;
      case Vertex::Kind::surface: v.kind = "surface"; break;
      case Vertex::Kind::volume: v.kind = "volume"; break;
      case Vertex::Kind::escape: v.kind = "escaped"; break;
    }
    if (w.point.object) v.object = object_name(*w.point.object);
    v.position = w.point.position;
    v.normal = w.point.normal;
    v.throughput = w.throughput;
    v.density = w.forward;
    if (w.specular) v.lobe = "specular";
    if (w.single) v.note = "the hero wavelength alone";
    vertices.push_back(std::move(v));
  }
}

void note_first_surface(const Scene& scene, const Ray& camera_ray, SampleContext& sample) {
  Ray ray = camera_ray;
  float crossed = 0;
  Hit hit;
  SurfacePoint point;
  for (int crossings = 0; crossings <= most_crossings && scene.nearest(ray, hit); ++crossings) {
    scene.locate(ray, hit, point);
    const Shader* shader = point.object->shader.get();
    if (shader && shader->possible_lobes() == pass_through) {
      crossed += hit.distance;
      ray.origin = point.exit(ray.direction);
      hit = {};
      continue;
    }
    const Scatter* scatter = shader ? bound(*shader, point, sample.wavelengths, sample.arena) : nullptr;
    note_features(*sample.features, scene, point, hit, scatter, -ray.direction, sample.wavelengths, crossed);
    return;
  }
}

}  // namespace etendue
