#include "first_surface.h"

#include "core/hash.h"
#include "etendue/describe/color.h"
#include "etendue/transport/ray_tree.h"

namespace etendue {

FirstSurfaces::FirstSurfaces(const Scene& scene, const Camera& camera, const SurfaceLayers& layers, const ObjectNames& names,
                             const std::vector<Ref<ObjectGroup>>& groups)
    : scene_(scene), camera_(camera), layers_(layers), names_(names) {
  for (const Ref<ObjectGroup>& group : groups) {
    Group& made = groups_.emplace_back();
    made.name = group->name;
    for (const std::string& object : group->objects) made.objects.emplace_back(object);
  }
}

bool FirstSurfaces::nearest_visible(Ray ray, SampleContext& sample, MediumStack& stack, Hit& hit, SurfacePoint& point) const {
  NumberStream numbers = sample.numbers.fork("mattes");
  MediumStack* const media = media_around(scene_, ray, stack);
  for (int crossings = 0; crossings <= most_crossings; ++crossings) {
    hit = {};
    if (!meet_surface(scene_, ray, media, hit, point)) return false;
    const Vector3 out = -ray.direction;
    const Shader* const shader = point.object->shader.get();
    if (!shader || !(shader->possible_lobes() & null_scattering)) return true;
    const Scatter* const scatter = scattering_at(point, out, sample.wavelengths, sample.arena);
    const std::optional<ScatterSample> next = scatter ? scatter->sample(out, 0, {}, {.lobes = null_scattering}) : std::nullopt;
    // The lobe alone has the transmittance as its weight, of which there may be one for each wavelength.
    const float transmittance = next ? next->weight.average() : 0;
    if (!(numbers.next() < transmittance)) return true;
    go_on(point, *next, ray, media);
  }
  return false;
}

namespace {

/// Of an object in its instances, within this process.
std::uint64_t address_of(const Hit& hit) {
  std::uint64_t key = mix_bits(std::uint64_t(reinterpret_cast<std::uintptr_t>(hit.object)));
  for (int i = 0; i < hit.depth; ++i) key = mix_bits(key ^ std::uint64_t(reinterpret_cast<std::uintptr_t>(hit.scenes[i])));
  return key;
}

/// A key of names that is the same in all processes; not 0.
std::uint64_t key_of(const SurfaceNames& names) {
  Hash hash;
  for (const std::string& name : names) {
    hash.add(std::as_bytes(std::span(name)));
    hash.add(std::as_bytes(std::span("\xff", 1)));  // no UTF-8 text has this byte
  }
  return hash.value() | 1;
}

}  // namespace

FirstSurfaces::Met::Object FirstSurfaces::named(const Hit& hit, Met& met, SurfaceTile& tile) const {
  const auto [found, fresh] = met.objects.try_emplace(address_of(hit));
  if (!fresh) return found->second;
  const NamePath path = names_.path(hit);
  SurfaceNames names;
  const auto name = [&](MatteKind kind) -> std::string& { return names[size_t(kind)]; };
  for (const std::string& part : path) name(MatteKind::object) += (&part == &path.front() ? "" : "/") + part;
  name(MatteKind::material) = names_.material(*hit.object);
  name(MatteKind::asset) = path.front();
  for (const Group& group : groups_)
    if (std::ranges::any_of(group.objects, [&](const NamePattern& pattern) { return pattern.matches(path); })) {
      name(MatteKind::group) = group.name;
      break;
    }
  found->second = {key_of(names), names_.object_number(hit), names_.material_number(*hit.object)};
  if (layers_.mattes()) tile.name(found->second.key, std::move(names));
  return found->second;
}

Vector3 linear_srgb(const Spectrum& reflectance, const Wavelengths& wavelengths) {
  static const RgbSpace& srgb = rgb_space("srgb");
  const Xyz c = to_xyz(reflectance * srgb.illuminant->evaluate(wavelengths, ColorUse::radiance), wavelengths);
  const auto& m = srgb.from_xyz;
  return {float(m[0] * c.x + m[1] * c.y + m[2] * c.z), float(m[3] * c.x + m[4] * c.y + m[5] * c.z),
          float(m[6] * c.x + m[7] * c.y + m[8] * c.z)};
}

namespace {

/// The maps that say how rough a shader is: one, or one for each of two directions; none: no member says so.
std::vector<Ref<const ObjectMap>> roughness_maps(const Shader& shader) {
  const auto map = [&](const char* name) {
    const Member* const member = shader.class_info().find(name);
    const Value value = member ? member->get(shader, *member) : Value();
    const auto* part = value.as<Ref<Component>>();
    return part && *part ? Ref<const ObjectMap>(dynamic_cast<const ObjectMap*>(part->get())) : Ref<const ObjectMap>();
  };
  std::vector<Ref<const ObjectMap>> maps;
  for (const char* name : {"roughness", "roughness_u", "roughness_v", "specular_roughness"})
    if (Ref<const ObjectMap> found = map(name)) maps.push_back(std::move(found));
  return maps;
}

/// How far a BSDF spreads light, from 0 for a mirror to 1 for a Lambertian surface, where no member says so. With the mean
/// direction m of the scattered light, |m|^2 is 1 for the one and 4/9 for the other; for two independent directions a and b the
/// expected value of a b is |m|^2. An estimate: single ones may be negative, or larger than 1.
float spread_of(const Scatter& scatter, const Vector3& out, NumberStream numbers) {
  std::array<Vector3, 2> directions;
  for (Vector3& direction : directions) {
    const float choice = numbers.next();
    const auto next = scatter.sample(out, choice, numbers.next_pair(), {.lobes = vertex_lobes});
    if (!next) return 0;
    direction = next->direction;
  }
  return 9.0f / 5 * (1 - dot(directions[0], directions[1]));
}

}  // namespace

void FirstSurfaces::describe_scattering(const SurfacePoint& point, const Vector3& out, SampleContext& sample, Met& met,
                                        FirstSurface& surface) const {
  const bool wants_albedo = layers_.place(SurfaceNumber::albedo) >= 0;
  const bool wants_roughness = layers_.place(SurfaceNumber::roughness) >= 0;
  if (!wants_albedo && !wants_roughness && layers_.place(SurfaceNumber::normal) < 0) return;
  const Scatter* const scatter = scattering_at(point, out, sample.wavelengths, sample.arena);
  if (!scatter) return;
  const Normal3 normal = scatter->frame().n;  // tilted by maps of bumps or normals
  surface.normal = Vector3(dot(normal, out) < 0 ? -normal : normal);
  if (wants_albedo) surface.albedo = linear_srgb(scatter->albedo(out), sample.wavelengths);
  if (!wants_roughness) return;
  const Lobes lobes = Lobes(scatter->lobes() & vertex_lobes);
  if (!(lobes & glossy_lobes)) {
    surface.roughness = lobes & diffuse_lobes ? 1 : 0;
    if ((lobes & diffuse_lobes) && (lobes & specular_lobes))
      surface.roughness = spread_of(*scatter, out, sample.numbers.fork("roughness"));
    return;
  }
  const auto [maps, fresh] = met.roughness.try_emplace(point.object->shader.get());
  if (fresh) maps->second = roughness_maps(*point.object->shader);
  if (maps->second.empty()) {
    surface.roughness = spread_of(*scatter, out, sample.numbers.fork("roughness"));
    return;
  }
  for (const Ref<const ObjectMap>& map : maps->second) surface.roughness += map->scalar(point) / float(maps->second.size());
}

// ---- motion ----------------------------------------------------------------------------------------------------------------

DoublePoint3 position_at(const Hit& hit, const SurfacePoint& point, float time) {
  DoublePoint3 p(point.position);
  for (int i = hit.depth; i-- > 0;) p = hit.scenes[i]->transform.at(point.time).back(p);
  if (hit.object->mesh_facts()) {  // points of meshes are stored by their triangle
    Ray ray;
    ray.time = time;
    SurfacePoint moved;
    hit.object->surface_point(ray, hit, moved);
    p = DoublePoint3(moved.position);
  } else {
    const AnimatedTransform& own = hit.object->transform;
    p = own.at(time)(own.at(point.time).back(p));
  }
  for (int i = 0; i < hit.depth; ++i) p = hit.scenes[i]->transform.at(time)(p);
  return p;
}

// Newton's method for the film point f of which the ray o(f) + t d(f) leads to the point, with differences of one pixel.
std::optional<Point2> shown_at(const Camera& camera, const DoublePoint3& at, float time, Point2 near) {
  const Point2 middle{0.5f, 0.5f};
  const Point3 point{float(at.x), float(at.y), float(at.z)};
  if (const std::optional<LensSample> lens = camera.sample_lens(point, time, middle)) return lens->film;
  constexpr int most_steps = 32;
  constexpr float enough = 1e-3f;  // [pixels]
  Point2 film = near;
  for (int step = 0; step < most_steps; ++step) {
    const auto ray = [&](float dx, float dy) { return camera.ray({film.x + dx, film.y + dy}, middle, time); };
    const Ray through = ray(0, 0);
    const float t = dot(point - camera.lens_point(through), through.direction);
    if (!(t > 0)) return std::nullopt;
    const auto reached = [&](const Ray& r) { return camera.lens_point(r) + t * r.direction; };
    const Point3 here = reached(through);
    const Vector3 right = reached(ray(1, 0)) - here, down = reached(ray(0, 1)) - here, rest = point - here;
    const float a = dot(right, right), b = dot(right, down), c = dot(down, down), determinant = a * c - b * b;
    if (!(determinant > 0)) return std::nullopt;
    const float u = dot(right, rest), v = dot(down, rest);
    const Vector2 by{(c * u - b * v) / determinant, (a * v - b * u) / determinant};
    film = film + by;
    if (!std::isfinite(film.x) || !std::isfinite(film.y)) return std::nullopt;
    if (std::abs(by.x) + std::abs(by.y) < enough) return film;
  }
  return std::nullopt;
}

void FirstSurfaces::describe_motion(const Hit& hit, const SurfacePoint& point, Point2 film, FirstSurface& surface) const {
  const auto shown = [&](float time) { return shown_at(camera_, position_at(hit, point, time), time, film); };
  const std::optional<Point2> now = shown(point.time);
  if (!now) return;
  const float by = layers_.motion_time;
  const std::optional<Point2> before = shown(by > 0 ? point.time - by : camera_.shutter_open),
                              after = shown(by > 0 ? point.time + by : camera_.shutter_close);
  if (before) surface.motion_previous = *before - *now;
  if (after) surface.motion_next = *after - *now;
}

FirstSurface FirstSurfaces::see(const Ray& ray, Point2 film, SampleContext& sample, Met& met, SurfaceTile& tile) const {
  FirstSurface surface;
  MediumStack stack;
  Hit hit;
  SurfacePoint point;
  if (!nearest_visible(ray, sample, stack, hit, point)) return surface;
  const Met::Object object = named(hit, met, tile);
  surface.key = object.key;
  surface.object = object.object;
  surface.material = object.material;
  surface.primitive = hit.primitive;
  const Vector3 out = -ray.direction;
  const auto facing = [&](const Normal3& n) { return Vector3(dot(n, out) < 0 ? -n : n); };
  surface.geometric_normal = facing(point.normal);
  surface.normal = facing(point.shading_normal);
  surface.position = world_position(point);
  surface.depth = double(distance(camera_.lens_point(ray), point.position));
  surface.uv = point.uv;
  describe_scattering(point, out, sample, met, surface);
  if (layers_.motion()) describe_motion(hit, point, film, surface);
  return surface;
}

}  // namespace etendue
