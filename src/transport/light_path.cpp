#include "etendue/transport/light_path.h"

#include "etendue/transport/mutation.h"
#include "path_lobes.h"

namespace etendue {
namespace {

double squared_distance(const Point3& a, const Point3& b) {
  const double x = double(a.x) - double(b.x), y = double(a.y) - double(b.y), z = double(a.z) - double(b.z);
  return x * x + y * y + z * z;
}
double cosine(const ChainVertex& v, const Vector3& direction) { return double(std::abs(dot(v.point.normal, direction))); }

/// Whether two unit vectors are equal, up to the rounding of the positions of vertices near each other.
bool same(const Vector3& a, const Vector3& b) { return dot(a, b) > 0.999f; }

}  // namespace

int LightPath::smooth_before(int i) const {
  for (--i; specular(i);) --i;
  return i;
}

double LightPath::camera_angle(int i) const {
  const ChainVertex &v = x[size_t(i)], &to = x[size_t(i) + 1];
  return cosine(v, v.out) / squared_distance(to.point.position, v.point.position);
}

double LightPath::light_angle(int i) const {
  const ChainVertex &b = x[size_t(i)], &before = x[size_t(i) - 1];
  if (!before.leaves_specularly) return cosine(b, before.out) / squared_distance(b.point.position, before.point.position);
  const ChainVertex& a = x[size_t(smooth_before(i))];
  double J = cosine(b, before.out) / cosine(a, a.out);
  for (int j = i - 1; specular(j); --j) J *= x[size_t(j)].beam;
  return J * camera_angle(i - 1);
}

std::vector<Lobe> LightPath::lobes(int i, int j) const {
  std::vector<Lobe> kinds;
  for (const int step = i < j ? 1 : -1; i != j + step; i += step) kinds.push_back(x[size_t(i)].lobe);
  return kinds;
}

void PathSpace::begin(LightPath& y, const LightPath& x, int vertices) const {
  y.x.assign(x.x.begin(), x.x.begin() + vertices);
  y.arena = x.arena;
  y.wavelengths = x.wavelengths;
  y.lens = x.lens;
}

void PathSpace::move(LightPath& path, Arena& to) const {
  path.arena = &to;
  for (ChainVertex& v : path.x)
    if (!v.on_surface()) {
      v.point.media = v.media = nullptr;  // on a luminaire that a walk hit; a walk from there finds the media again
      v.scatter = nullptr;
    } else {
      if (v.media) v.point.media = v.media = to.make<MediumStack>(*v.media);
      v.scatter = scattering_at(v.point, v.out, path.wavelengths, to);
    }
}

/// Computes fraction, beam and lobe probabilities of a specular vertex. False: the lobe does not scatter radiance along this
/// path.
bool PathSpace::fill_specular(LightPath& path, int i) const {
  ChainVertex& v = path.x[size_t(i)];
  const Vector3 out = v.out, in = -path.x[size_t(i) - 1].out;
  const auto radiance = follow_specular(v, out, Transport::radiance, v.lobe);
  if (!radiance || !same(radiance->direction, in)) return false;
  v.fraction = radiance->weight;
  if (radiance->dispersive) v.fraction *= path.seen.drop_secondary();
  v.lobe_from_camera = lobe_share(v, out, v.lobe);
  v.lobe_from_light = v.beam = 0;
  const auto importance = follow_specular(v, in, Transport::importance, v.lobe);
  if (importance && same(importance->direction, out) && importance->weight[0] > 0) {
    v.lobe_from_light = lobe_share(v, in, v.lobe);
    v.beam = double(radiance->weight[0]) / double(importance->weight[0]);
  }
  return true;
}

/// Multiplies f by the weight of the camera for light along a ray. False: it is 0.
bool PathSpace::weigh_camera(LightPath& path, const Ray& ray) const {
  CameraRay sent;
  Wavelengths left = path.wavelengths;
  if (!context.camera.sample_ray(path.film, path.lens, time, left, sent)) return false;
  if (left.single() != path.wavelengths.single() || !same(sent.ray.direction, ray.direction) ||
      squared_distance(context.camera.lens_point(sent.ray), ray.origin) >
          1e-6 * squared_distance(path.x[path.x.size() - 2].point.position, ray.origin))
    context.camera.fail({},
                        "sends rays that depend on the wavelength, or from places that depend on the film point, which "
                        "PathSpaceMetropolis cannot mutate");
  path.f *= sent.weight;
  return !path.f.black();
}

namespace {

/// Sets `out`, and the media to those on its side: a walk from a luminaire came to the vertex from the other side.
void turn(ChainVertex& v, const Vector3& out, Arena& arena) {
  MediumStack other;
  if (media_towards(v, out, other) == &other) v.point.media = v.media = arena.make<MediumStack>(other);
  v.out = out;
}

}  // namespace

bool PathSpace::complete(LightPath& path) const {
  std::vector<ChainVertex>& x = path.x;
  const int k = path.length();
  path.f = {};
  path.seen = path.wavelengths;
  if (k < 2) return false;
  const auto at = [&](int i) -> ChainVertex& { return x[size_t(i)]; };
  for (int i = 0; i < k; ++i) {
    const Vector3 way = at(i + 1).point.position - at(i).point.position;
    if (!(length_squared(way) > 0)) return false;
    turn(at(i), normalize(way), *path.arena);
  }
  for (int i = 1; i < k; ++i)
    if (path.specular(i) && !fill_specular(path, i)) return false;
  // Pdfs of walks from the luminaire.
  const SceneObject& luminaire = *at(0).point.object;
  at(0).from_light = double(lights.probability(luminaire)) * double(luminaire.area_pdf(at(0).point));
  for (int i = 1; i < k; ++i) {
    const ChainVertex& from = at(i - 1);
    double p = 0;
    if (from.leaves_specularly) {
      p = from.lobe_from_light;
    } else if (i == 1) {
      p = double(luminaire.emission->pdf(from.point, from.out));
    } else {
      const Vector3 before = -at(i - 2).out;
      p = double(scattering_pdf(from, before, from.out, Transport::importance)) * lobe_share(from, before, smooth_lobes);
    }
    // Along the surface p is 0, but light_angle is unbounded.
    at(i).from_light = path.specular(i) || !(p > 0) ? p : p * path.light_angle(i);
  }
  // Pdfs of walks from the camera, and f.
  Ray ray;
  ray.origin = at(k).point.position;
  ray.direction = -at(k - 1).out;
  ray.time = time;
  const std::optional<Point2> film = context.camera.film_point(ray);
  if (!film) return false;
  path.film = *film;
  const Camera::Reach reach = context.camera.reach(ray);
  const float far = distance(at(k - 1).point.position, ray.origin);
  if (far < reach.nearest || far > reach.farthest) return false;
  at(k - 1).from_camera = double(camera_direction_pdf(context.camera, ray)) * path.camera_angle(k - 1);
  path.scale = at(k - 1).from_camera;
  if (!context.scene.in_front(at(0).point, at(0).out)) return false;
  Spectrum f = luminaire.emission->radiance(at(0).point, at(0).out, path.wavelengths);
  for (int i = k - 2; i >= 0; --i) {
    const ChainVertex& from = at(i + 1);
    if (from.leaves_specularly) {
      at(i).from_camera = from.lobe_from_camera;
      f *= from.fraction;
    } else {
      const ScatterValue s = scattering(from, from.out, -at(i).out, Transport::radiance);
      at(i).from_camera = double(s.pdf) * lobe_share(from, from.out, smooth_lobes) * path.camera_angle(i);
      f *= s.value;
      path.scale *= path.camera_angle(i);
    }
    if (f.black()) return false;
  }
  path.f = f;
  return std::isfinite(path.scale) && weigh_camera(path, ray);
}

double PathSpace::pdf(const LightPath& path, int l, int r) {
  double sum = 0;
  for (int b = 0; b <= r; ++b) {
    // For b = 0 and l = 0 the camera walk hits the luminaire, and nothing is connected.
    if ((l > 0 || b > 0) && (path.specular(l + b - 1) || path.specular(l + b))) continue;
    double product = 1;
    for (int i = l; i < l + r; ++i) product *= i < l + b ? path.x[size_t(i)].from_light : path.x[size_t(i)].from_camera;
    sum += product;
  }
  return sum / (r + 1);
}

std::optional<Point2> moved_on_film(const PathSpace& space, Point2 from, float smallest, float largest,
                                    ChoiceNumbers& choices) {
  const auto width = float(space.context.image.width), height = float(space.context.image.height);
  const float distance = small_change(choices.next(), std::min(smallest, largest * width), largest * width);
  const auto angle = float(2 * M_PI * choices.next());
  const Point2 film{from.x + distance * std::cos(angle), from.y + distance * std::sin(angle)};
  if (!(film.x >= 0 && film.x < width && film.y >= 0 && film.y < height)) return {};
  return film;
}

Vector3 turned(const Vector3& direction, float angle, double u) {
  const Frame frame{Normal3(direction)};
  const float phi = 2 * pi * float(u), sine = std::sin(angle);
  return normalize(std::cos(angle) * direction + (sine * std::cos(phi)) * Vector3(frame.s) +
                   (sine * std::sin(phi)) * Vector3(frame.t));
}

}  // namespace etendue
