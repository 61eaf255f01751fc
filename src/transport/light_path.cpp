#include "etendue/transport/light_path.h"

#include "etendue/transport/mutation.h"

namespace etendue {
namespace {

float next(ChoiceNumbers& choices) { return std::min(float(choices.next()), one_minus_epsilon); }
Point2 next_pair(ChoiceNumbers& choices) {
  const float x = next(choices);
  return {x, next(choices)};
}

}  // namespace

float LightPath::solid_angle(int i) const {
  const Vector3 way = x[size_t(i)].point.position - x[size_t(i) - 1].point.position;
  const float squared = length_squared(way);
  return std::abs(dot(x[size_t(i)].point.normal, way)) / (squared * std::sqrt(squared));
}

void PathSpace::begin(LightPath& y, const LightPath& x, int vertices) const {
  y.x.assign(x.x.begin(), x.x.begin() + vertices);
  y.arena = x.arena;
  y.wavelengths = x.wavelengths;
  y.lens = x.lens;
}

void PathSpace::move(LightPath& path, Arena& to) const {
  path.arena = &to;
  for (KeptVertex& v : path.x)
    if (v.on_surface()) v.scatter = scattering_at(v.point, v.out, path.wavelengths, to);
}

KeptVertex PathSpace::lens(const LightPath& y) const {
  KeptVertex v;
  v.kind = Vertex::Kind::camera;
  v.point.position =
      context.camera.ray({0.5f * float(context.image.width), 0.5f * float(context.image.height)}, y.lens, time).origin;
  v.point.time = time;
  return v;
}

bool PathSpace::follow(const KeptVertex& from, const Vector3& direction, LightPath& y, KeptVertex& to) const {
  const Ray ray = leaving_ray(from, direction);
  Hit hit;
  if (!context.scene.nearest(ray, hit)) return false;
  to = {};
  context.scene.locate(ray, hit, to.point);
  to.out = -direction;
  to.lobes = smooth_lobes;
  to.scatter = scattering_at(to.point, to.out, y.wavelengths, *y.arena);
  return to.scatters_smoothly();
}

bool PathSpace::follow_camera(Point2 film, LightPath& y, KeptVertex& to) const {
  const Ray ray = context.camera.ray(film, y.lens, time);
  KeptVertex from;
  from.kind = Vertex::Kind::camera;
  from.point.position = ray.origin;
  from.point.time = time;
  return follow(from, ray.direction, y, to);
}

bool PathSpace::walk(std::vector<KeptVertex>& walk, int count, Transport transport, ChoiceNumbers& choices,
                     LightPath& y) const {
  for (; count > 0; --count) {
    KeptVertex to;
    if (walk.empty()) {
      const LightChoice choice = lights.choose(next(choices));
      if (!choice.luminaire || choice.luminaire->infinite() || choice.luminaire->delta()) return false;
      const SurfaceSample s = choice.luminaire->sample_area(next_pair(choices), time);
      if (!(s.density > 0)) return false;
      to.kind = Vertex::Kind::luminaire;
      to.point = s.point;
    } else if (const KeptVertex& from = walk.back(); from.kind == Vertex::Kind::camera) {
      const Point2 u = next_pair(choices);
      if (!follow_camera({u.x * float(context.image.width), u.y * float(context.image.height)}, y, to)) return false;
    } else if (from.kind == Vertex::Kind::luminaire) {
      const DirectionSample d = from.point.object->emission->sample(from.point, next_pair(choices));
      if (!(d.density > 0) || !follow(from, d.direction, y, to)) return false;
    } else {
      const Vector3 out = normalize(walk[walk.size() - 2].point.position - from.point.position);
      const auto s = from.scatter->sample(out, next(choices), next_pair(choices), transport, smooth_lobes);
      if (!s || !follow(from, s->direction, y, to)) return false;
    }
    walk.push_back(to);
  }
  return true;
}

bool PathSpace::visible(const LightPath& path, int i) const {
  const KeptVertex &a = path.x[size_t(i)], &b = path.x[size_t(i) + 1];
  if (b.kind != Vertex::Kind::camera) return !context.scene.any(connecting_ray(a, b));
  const Vector3 way = b.point.position - a.point.position;
  Ray ray = leaving_ray(a, normalize(way));
  ray.maximum = length(way) * SurfacePoint::almost_there;
  return !context.scene.any(ray);
}

bool PathSpace::complete(LightPath& path) const {
  std::vector<KeptVertex>& x = path.x;
  const int k = path.length();
  path.f = {};
  if (k < 2) return false;
  for (size_t i = 0; i < size_t(k); ++i) {
    const Vector3 way = x[i + 1].point.position - x[i].point.position;
    if (!(length_squared(way) > 0)) return false;
    x[i].out = normalize(way);
  }
  const auto at = [&](int i) -> KeptVertex& { return x[size_t(i)]; };
  // From the luminaire.
  const SceneObject& luminaire = *at(0).point.object;
  at(0).forward = lights.probability(luminaire) * luminaire.area_density(at(0).point);
  at(1).forward = luminaire.emission->density(at(0).point, at(0).out) * path.solid_angle(1);
  for (int i = 2; i < k; ++i)
    at(i).forward = scattering_density(at(i - 1), -at(i - 2).out, at(i - 1).out, Transport::importance) * path.solid_angle(i);
  // From the camera.
  Ray ray;
  ray.origin = at(k).point.position;
  ray.direction = -at(k - 1).out;
  ray.time = time;
  const std::optional<Point2> film = context.camera.film_point(ray);
  if (!film) return false;
  path.film = *film;
  const auto seen = [&](int i) {  // as solid_angle, from x_{i+1}
    return std::abs(dot(at(i).point.normal, at(i).out)) / length_squared(at(i + 1).point.position - at(i).point.position);
  };
  at(k - 1).reverse = camera_direction_density(context.camera, ray) * seen(k - 1);
  for (int i = 0; i < k - 1; ++i)
    at(i).reverse = scattering_density(at(i + 1), at(i + 1).out, -at(i).out, Transport::radiance) * seen(i);

  Spectrum f = luminaire.emission->radiance(at(0).point, at(0).out, path.wavelengths) * at(k - 1).reverse;
  for (int i = 0; i < k - 1; ++i) {
    f *= scattering(at(i + 1), at(i + 1).out, -at(i).out, Transport::radiance).value * seen(i);
    if (f.black()) return false;
  }
  // Of vertices so near one another that squares of distances leave the range of floats nothing can be told.
  if (!std::isfinite(f.maximum())) return false;
  path.f = f;
  return true;
}

double PathSpace::density(const LightPath& path, int l, int r) {
  double sum = 0;
  const int fewest = l == 0 ? 1 : 0;
  for (int b = fewest; b <= r; ++b) {
    double product = 1;
    for (int i = l; i < l + r; ++i) product *= double(i < l + b ? path.x[size_t(i)].forward : path.x[size_t(i)].reverse);
    sum += product;
  }
  return sum / (r + 1 - fewest);
}

bool PathSpace::join(LightPath& y, const std::vector<KeptVertex>& rest, int r, ChoiceNumbers& choices) const {
  const int fewest = y.x.empty() ? 1 : 0, b = fewest + int(choices.next() * (r + 1 - fewest));
  if (!walk(y.x, b, Transport::importance, choices, y)) return false;
  // The camera's walk comes against the order of vertices.
  std::vector<KeptVertex> camera(rest.rbegin(), rest.rend());
  if (!walk(camera, r - b, Transport::radiance, choices, y)) return false;
  const int joint = int(y.x.size()) - 1;
  y.x.insert(y.x.end(), camera.rbegin(), camera.rend());
  return complete(y) && visible(y, joint);
}

Vector3 turned(const Vector3& direction, float angle, double u) {
  const Frame frame{Normal3(direction)};
  const float phi = 2 * pi * float(u), sine = std::sin(angle);
  return normalize(std::cos(angle) * direction + (sine * std::cos(phi)) * Vector3(frame.s) +
                   (sine * std::sin(phi)) * Vector3(frame.t));
}

}  // namespace etendue
