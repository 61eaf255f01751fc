#include "etendue/transport/photons.h"

#include <algorithm>

namespace etendue {

Spectrum in_wavelengths(const Spectrum& light, bool hero_only, const GatheringWavelengths& walk) {
  if (!walk.hero_only) return light;
  const int lane = std::max(walk.lane, 0);
  Spectrum one;
  one.set(0, light[lane]);
  if (hero_only) one *= lane == 0 ? walk.branches / float(spectrum_size) : 0;
  return one;
}

Spectrum scattered_from_photon(const PathVertex& at, const Photon& photon, const GatheringWavelengths& walk) {
  const Spectrum light = in_wavelengths(photon, walk);
  if (at.in_medium()) {
    if (!photon.in_medium) return {};
    const Spectrum s = at.medium.coefficients(at.point.position, at.point.time, walk.wavelengths).scattering;
    const float phase = at.medium.phase(at.point.position, at.point.time, at.out, photon.out);
    Spectrum scattered;
    for (int i = 0; i < spectrum_size; ++i) scattered.set(i, s[i] > 0 ? phase * light[i] / s[i] : 0);
    return scattered;
  }
  // The density of photons already includes the cosine of the incident direction.
  const float cosine = std::abs(dot(at.point.normal, photon.out));
  if (photon.in_medium || !at.scatter || !(cosine > 0)) return {};
  return at.scatter->evaluate(at.out, photon.out, {.lobes = at.lobes}) * light / cosine;
}

bool photon_occluded(const Scene& scene, const Point3& a, const Vector3& normal_a, float time, const Point3& b,
                     const Vector3& normal_b, float radius) {
  const float lift = 0.1f * radius;
  const Point3 from = a + lift * normal_a;
  const Vector3 between = b + lift * normal_b - from;
  Ray ray;
  ray.maximum = length(between);
  if (!(ray.maximum > 0)) return false;
  ray.origin = from;
  ray.direction = between / ray.maximum;
  ray.time = time;
  return scene.any(ray);
}

void PhotonMap::build(std::vector<Photon>&& photons) {
  photons_ = std::move(photons);
  std::vector<std::uint32_t> order = tree_.build(std::span<const Photon>(photons_), &Photon::position);
  // Sorted in place, cycle by cycle of the permutation, so that no second list is needed.
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    if (order[i] == i) continue;
    const Photon first = photons_[i];
    std::uint32_t to = i;
    for (std::uint32_t from = order[to]; from != i; from = order[to]) {
      photons_[to] = photons_[from];
      order[to] = to;
      to = from;
    }
    photons_[to] = first;
    order[to] = to;
  }
}

namespace {

/// The part of the weight of merging with vertex i that depends on the light subpath.
PhotonWeight weight_of(const std::vector<SubpathVertex>& walk, size_t i, float next_event_point_pdf,
                       const StrategyWeights& against, const EmissionPlane& front) {
  const SubpathVertex &photon = walk[i], &luminaire = walk[0];
  ConnectedPath path;
  path.light = walk.data();
  path.s = int(i);
  path.t = 2;  // at least: the merged vertex is not an end of the path
  path.light_last_from_camera = vertex_pdf(1, photon, walk[i - 1], photon.out, photon.mean_transmittance, front);
  path.next_event_point_pdf = next_event_point_pdf;
  path.pdf_emission_origin = luminaire.pdf_forward;
  path.emitter_can_be_hit = !luminaire.point.object->delta();
  path.merging = against.merging;
  return photon_weight(path, photon.pdf_forward, against.heuristic);
}

}  // namespace

void PhotonWalks::operator()(std::uint64_t item, std::vector<Photon>& photons, Arena& arena) const {
  std::vector<SubpathVertex> walk;
  EmittedLight light;
  const EmissionPlane front(context.scene);
  SubpathLimits of_walk = limits;
  of_walk.reverse_pdfs = against != nullptr;
  PathStates states(groups ? &groups->paths() : nullptr);
  for (std::uint64_t n = item * item_size; n < std::min(walks, (item + 1) * item_size); ++n) {
    const ArenaScope memory(arena);
    states.clear();
    Wavelengths w = wavelengths;
    NumberStream walk_samples(numbers, SampleKey(context.seed, -2 - int(kinds), int(step), std::uint32_t(n)));
    NumberStream chances = walk_samples.fork("kept");
    SampleContext sample{w, walk_samples, arena, {.abort = abort}};
    if (!generate_light_subpath(context.scene, lights, time, of_walk, sample, walk, light, targets)) continue;
    if (sample.aborted()) return;
    const float luminaire_pdf = walk.size() > 1 && against ? next_event_point_pdf(lights, walk[1], walk[0], walk[1].out) : 0;
    bool specular = true;  // whether all vertices since the luminaire are specular
    for (size_t i = 1; i < walk.size(); ++i) {
      const SubpathVertex& v = walk[i];
      const bool caustic = i > 1 && specular;
      specular = specular && v.leaves_specularly;
      const bool wanted = kinds == PhotonKinds::all || caustic == (kinds == PhotonKinds::caustics);
      if (!wanted || !v.connectable() || int(i) < (v.in_medium() ? fewest_in_media : fewest_vertices) ||
          (v.in_medium() && !in_homogeneous_media && v.medium.volume->homogeneous()) ||
          (kept < 1 && double(chances.next()) >= kept))
        continue;
      Photon& p = photons.emplace_back();
      p.position = v.point.position;
      p.out = v.out;
      for (int axis = 0; axis < 3; ++axis) p.normal[size_t(axis)] = std::int16_t(32767 * v.point.normal[axis]);
      p.throughput = v.throughput;
      p.vertices = std::uint32_t(i) & vertices_mask;
      p.hero_only = v.hero_only;
      p.in_medium = v.in_medium();
      p.caustic = caustic;
      p.luminaire = walk[0].point.object->luminaire_index();
      if (against) p.weight = weight_of(walk, i, luminaire_pdf, *against, front);
      if (PathStates::current() == &states) [[unlikely]] {
        const Photon whole = p;
        photons.pop_back();
        states.each(walk[i - 1].path, whole.throughput, [&](std::uint32_t state, const Spectrum& part) {
          photons.push_back(whole);
          photons.back().state = std::uint16_t(state);
          photons.back().throughput = part;
        });
      }
    }
  }
}

float seen_pixel_width(const RenderContext& context) {
  constexpr int across = 32;
  const float width = float(context.image.width), height = float(context.image.height);
  const float time = context.camera.shutter_open;
  std::vector<float> widths;
  for (int row = 0; row < across; ++row)
    for (int column = 0; column < across; ++column) {
      const Point2 film{(float(column) + 0.5f) / across * width, (float(row) + 0.5f) / across * height};
      const Point2 middle{0.5f, 0.5f};
      Ray ray = context.camera.ray(film, middle, time);
      ray.of_camera = true;
      const Ray next = context.camera.ray({film.x + (film.x > width / 2 ? -1.0f : 1.0f), film.y}, middle, time);
      Hit hit;
      if (context.scene.nearest(ray, hit)) widths.push_back(length(next(hit.distance) - ray(hit.distance)));
    }
  std::erase_if(widths, [](float w) { return !(w > 0) || !std::isfinite(w); });
  if (widths.empty()) return context.scene.radius() / 500;
  std::ranges::nth_element(widths, widths.begin() + std::ptrdiff_t(widths.size() / 2));
  return widths[widths.size() / 2];
}

double shrunk_area(std::uint32_t number, double a) {
  double area = 1;
  for (std::uint32_t k = 1; k <= number; ++k) area *= (k + a) / (k + 1);
  return area;
}

}  // namespace etendue
