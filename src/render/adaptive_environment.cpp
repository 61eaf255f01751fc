#include "etendue/render/adaptive_environment.h"

#include <algorithm>
#include <cmath>

#include "camera_path.h"
#include "etendue/transport/roulette.h"
#include "etendue/transport/visibility.h"
#include "etendue/transport/walk.h"

namespace etendue {
namespace {

/// A vertex of a camera path, from which shadow rays are traced.
struct Viewpoint {
  Point3 position;
  Normal3 normal;  ///< zero in media
  Point3 origin;   ///< of rays on the side to which the path was scattered
  Vector3 side;    ///< the normal on that side; zero in media
  float time = 0;
};

// How much is learned. Few regions about which much is known are better than many about which little is: with the same number
// of rays, 256 regions with 8 rays for each tile had less error indoors than 512 with 4, 1024 with 2, or 128 with 8
// (docs/decisions/060-price-of-samples.md).
constexpr int rays_of_tile = 8;
constexpr int places_of_region = 16;
constexpr int longest = 8;  // segments of a path
constexpr float defensive = 0.05f;
constexpr std::uint32_t paths_at_once = 64;

/// Learning takes as many rays as a part of a sample for each pixel does: so many candidates, half of which are below the
/// surface. Returns the logarithm of the number of regions.
int depth_for(double pixels) {
  const double rays = std::clamp(16 * pixels, 0x1p11, 0x1p21);
  return int(std::log2(rays / (EnvironmentGuide::tiles * rays_of_tile)));
}

/// The vertices of one camera path at which next event estimation finds light.
void look_around(const RenderProcess& process, const PixelArea& picture, SampleKey key, Arena& arena,
                 std::vector<Viewpoint>& viewpoints) {
  const Scene& scene = process.context.scene;
  CameraSample s;
  SampleContext sample{s.wavelengths, NumberStream(*process.renderer.sampler, key).fork("adaptive environment"), arena};
  CameraRay from;
  if (!begin_camera_path(process, picture, key, sample, s, from)) return;
  Walk<false> walk(scene, sample, from.ray, longest);
  if (scene.has_interiors()) media_at(scene, walk.ray.origin, walk.ray.time, walk.media);
  const Roulette roulette{3};
  while (walk.next_vertex() && walk.vertex.kind != PathVertex::Kind::escape && walk.length < longest) {
    const NumberStream::Bounce u = walk.numbers.next_bounce();
    const PathVertex& vertex = walk.vertex;
    const std::optional<ScatterSample> next = walk.sample_direction(u.lobe_choice, u.direction);
    if (!next) break;
    if (vertex.in_medium())
      viewpoints.push_back({vertex.point.position, {}, vertex.point.position, {}, walk.ray.time});
    else if (vertex.scatters_smoothly())
      viewpoints.push_back({vertex.point.position, vertex.point.normal, vertex.point.exit(next->direction),
                            std::copysign(1.0f, dot(vertex.point.normal, next->direction)) * Vector3(vertex.point.normal),
                            walk.ray.time});
    if (vertex.on_surface() && enters_subsurface(vertex.point, *next)) break;
    walk.leave(*next);
    if (!roulette.survives(walk)) break;
  }
  arena.reset();
}

/// What samples in each tile contribute at some viewpoints, squared: cos L V / p_0 as a mean over the wavelengths.
EnvironmentGuide::Squares look_at_tiles(const RenderProcess& process, const InfiniteObject& environment,
                                        const std::vector<Viewpoint>& all, std::span<const std::uint32_t> some,
                                        std::uint32_t region, Arena& arena) {
  constexpr int side = EnvironmentGuide::side;
  const Scene& scene = process.context.scene;
  const SampleKey key(0, 0, 0, 0);
  const Wavelengths wavelengths = process.context.wavelengths.sample(key, 0.5f);
  NumberStream numbers = NumberStream(*process.renderer.sampler, key).fork("environment tiles", region);
  std::uint64_t random = mix_bits(0x3c6ef372fe94f82bull + region);
  EnvironmentGuide::Squares squares{};
  for (int i = 0; i < EnvironmentGuide::tiles * rays_of_tile; ++i) {
    const int tile = i % EnvironmentGuide::tiles;
    const Viewpoint& from = all[some[(random = mix_bits(random + 1)) % some.size()]];
    const std::uint64_t bits = random = mix_bits(random + 1);
    const Point2 u{(float(tile % side) + to_unit_float(std::uint32_t(bits))) / side,
                   (float(tile / side) + to_unit_float(std::uint32_t(bits >> 32))) / side};
    const SurfaceSample seen = environment.sample_visible(from.position, u, from.time);
    if (!(seen.pdf > 0)) continue;
    const bool in_medium = from.side == Vector3{};
    const float cosine = in_medium ? 1 : dot(from.side, seen.direction);
    if (!(cosine > 0)) continue;
    Ray shadow;
    shadow.origin = from.origin;
    shadow.direction = seen.direction;
    shadow.maximum = infinity;
    shadow.time = from.time;
    const Spectrum light = environment.emission->radiance(seen.point, -seen.direction, wavelengths) *
                           shadow_transmittance(scene, shadow, nullptr, wavelengths, numbers, arena);
    arena.reset();
    squares[size_t(tile)] += square(cosine * light.average() / seen.pdf) / float(rays_of_tile);
  }
  return squares;
}

/// Averages over neighbours: few rays have seen each tile. In each dimension a tile counts twice, its neighbours once.
EnvironmentGuide::Squares smoothed(const EnvironmentGuide::Squares& squares) {
  constexpr int side = EnvironmentGuide::side;
  EnvironmentGuide::Squares smooth{};
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) {
          const int row = std::clamp(y + j, 0, side - 1), column = std::clamp(x + i, 0, side - 1);
          smooth[size_t(y * side + x)] += float((2 - i * i) * (2 - j * j)) / 16 * squares[size_t(row * side + column)];
        }
  return smooth;
}

}  // namespace

AdaptiveEnvironment::AdaptiveEnvironment(const LightSampler& lights, const Scene& scene) : lights_(lights) {
  for (const SceneObject* luminaire : scene.luminaires())
    if (luminaire->extent() == Extent::environment && !environment_)
      if (const auto* one = dynamic_cast<const InfiniteObject*>(luminaire); one && one->visible_place({0, 0, 1}, 0))
        environment_ = one;
}

void AdaptiveEnvironment::learn(Schedule& schedule, const RenderProcess& process) {
  if (guide_.regions() > 0) return;
  const ImageBuffer& image = process.context.image;
  const PixelArea picture{0, 0, image.width, image.height};
  const int depth = depth_for(double(image.width) * double(image.height));
  const std::uint64_t paths = std::uint64_t(places_of_region) << depth;  // of which each has some vertices
  const std::vector<Viewpoint> viewpoints = schedule.collect<Viewpoint>(
      (paths + paths_at_once - 1) / paths_at_once, [&](std::uint64_t item, std::vector<Viewpoint>& found, Arena& arena) {
        for (std::uint32_t i = 0; i < paths_at_once; ++i)
          look_around(process, picture, SampleKey(0, 0, 0, std::uint32_t(item) * paths_at_once + i), arena, found);
      });
  if (schedule.aborted()) return;

  std::vector<EnvironmentGuide::Place> places;
  for (const Viewpoint& v : viewpoints) places.push_back({v.position, v.normal});
  EnvironmentGuide guide;
  guide.divide(places, places_of_region, depth);
  std::vector<std::vector<std::uint32_t>> there(guide.regions());
  for (std::uint32_t i = 0; i < viewpoints.size(); ++i)
    there[guide.region(viewpoints[i].position, viewpoints[i].normal)].push_back(i);
  using Squares = EnvironmentGuide::Squares;
  const std::vector<Squares> seen =
      schedule.collect<Squares>(guide.regions(), [&](std::uint64_t region, std::vector<Squares>& all, Arena& arena) {
        const std::vector<std::uint32_t>& some = there[region];
        all.push_back(some.empty()
                          ? Squares{}
                          : smoothed(look_at_tiles(process, *environment_, viewpoints, some, std::uint32_t(region), arena)));
      });
  if (schedule.aborted()) return;
  for (std::uint32_t region = 0; region < guide.regions(); ++region) guide.learn(region, seen[region], defensive);
  guide_ = std::move(guide);
}

SurfaceSample AdaptiveEnvironment::sample(const SceneObject& luminaire, const Point3& from, const Normal3& normal, Point2 u,
                                          float time) const {
  if (&luminaire != environment_ || guide_.regions() == 0) return lights_.sample(luminaire, from, normal, u, time);
  const EnvironmentGuide::Guided guided = guide_.sample(guide_.region(from, normal), u);
  SurfaceSample sampled = environment_->sample_visible(from, guided.place, time);
  sampled.pdf *= guided.ratio;
  return sampled;
}

float AdaptiveEnvironment::pdf(const SceneObject& luminaire, const Point3& from, const Normal3& normal,
                               const Vector3& direction, const SurfacePoint& point) const {
  const float pdf = lights_.pdf(luminaire, from, normal, direction, point);
  if (&luminaire != environment_ || guide_.regions() == 0) return pdf;
  const std::optional<Point2> place = environment_->visible_place(direction, point.time);
  return place ? pdf * guide_.ratio(guide_.region(from, normal), *place) : pdf;
}

}  // namespace etendue
