#include "etendue/render/adaptive_lights.h"

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
constexpr int rays_of_turn = 64;
constexpr int rays_of_luminaire = 64;     // of each, and of all together
constexpr int rays_for_light = 256;       // at least: a region without light is one that these have not met
constexpr double worth_it = 0.25;         // the part of the places at which shadow rays are spared, from which on it pays
constexpr float by_others = 0.25f;        // d
constexpr float greatest_square = 1e36f;  // sums of a table's entries, and their roots, stay finite
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

/// One region's viewpoints, and its own random numbers.
class Lookout {
 public:
  Lookout(const RenderProcess& process, const std::vector<Viewpoint>& all, std::span<const std::uint32_t> some,
          std::uint32_t region, Arena& arena)
      : scene_(process.context.scene),
        all_(all),
        some_(some),
        arena_(arena),
        wavelengths_(process.context.wavelengths.sample(SampleKey(0, 0, 0, 0), 0.5f)),
        numbers_(NumberStream(*process.renderer.sampler, SampleKey(0, 0, 0, 0)).fork("adaptive lights", region)),
        random_(mix_bits(0x3c6ef372fe94f82bull + region)) {}

  Point2 pair() {
    const std::uint64_t bits = next();
    return {to_unit_float(std::uint32_t(bits)), to_unit_float(std::uint32_t(bits >> 32))};
  }
  /// Goes to one of the viewpoints, for the rays of the i-th of several turns. Rays of one turn begin at one place, which takes
  /// less time than if each began elsewhere.
  void stand(int i, int turns) {
    const double at = (double(i) + double(pair().x)) / turns;
    from_ = &all_[some_[std::min(size_t(at * double(some_.size())), some_.size() - 1)]];
  }
  /// What the sample `u` of a luminaire contributes there, cos L V / p, squared; as a mean over the wavelengths.
  float square_of(const SceneObject& luminaire, Point2 u) {
    const Viewpoint& from = *from_;
    const SurfaceSample seen = luminaire.sample_visible(from.position, u, from.time);
    if (!(seen.pdf > 0)) return 0;
    const float cosine = from.side == Vector3{} ? 1 : dot(from.side, seen.direction);
    if (!(cosine > 0)) return 0;
    Ray shadow;
    shadow.origin = from.origin;
    shadow.direction = seen.direction;
    shadow.maximum = infinity;
    shadow.time = from.time;
    if (!seen.infinite) SurfacePoint::end_at(seen.point, shadow);
    // Most rays are occluded, and radiances may be far away in memory: visibility first.
    const Spectrum visible = shadow_transmittance(scene_, shadow, nullptr, wavelengths_, numbers_, arena_);
    arena_.reset();
    if (visible.black()) return 0;
    const Spectrum light = visible * luminaire.emission->radiance(seen.point, -seen.direction, wavelengths_);
    const float found = square(cosine * light.average() / seen.pdf);
    return found > 0 ? std::min(found, greatest_square) : 0;  // nothing is learned from what is not a number
  }

 private:
  std::uint64_t next() { return random_ = mix_bits(random_ + 1); }

  const Scene& scene_;
  const std::vector<Viewpoint>& all_;
  const std::span<const std::uint32_t> some_;
  Arena& arena_;
  const Wavelengths wavelengths_;
  NumberStream numbers_;
  std::uint64_t random_;
  const Viewpoint* from_ = nullptr;
};

/// The mean squares of what samples in each tile contribute.
EnvironmentGuide::Squares look_at_tiles(Lookout& lookout, const SceneObject& environment) {
  constexpr int side = EnvironmentGuide::side;
  EnvironmentGuide::Squares squares{};
  for (int i = 0; i < EnvironmentGuide::tiles * rays_of_tile; ++i) {
    const int tile = i % EnvironmentGuide::tiles;
    if (i % rays_of_turn == 0) lookout.stand(i / rays_of_turn, EnvironmentGuide::tiles * rays_of_tile / rays_of_turn);
    const Point2 within = lookout.pair();
    const Point2 u{(float(tile % side) + within.x) / side, (float(tile / side) + within.y) / side};
    squares[size_t(tile)] += lookout.square_of(environment, u) / float(rays_of_tile);
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

AdaptiveLights::AdaptiveLights(const LightSampler& lights, const Scene& scene)
    : lights_(lights),
      luminaires_(scene.luminaires()),
      few_(!luminaires_.empty() && luminaires_.size() <= most_luminaires),
      chooses_(few_ && luminaires_.size() > 1) {
  for (const SceneObject* luminaire : luminaires_)
    if (luminaire->extent() == Extent::environment && !environment_)
      if (const auto* one = dynamic_cast<const InfiniteObject*>(luminaire); one && one->most_visible_places() > 0)
        environment_ = one;
  one_place_ = environment_ && environment_->most_visible_places() == 1;
}

void AdaptiveLights::learn(Schedule& schedule, const RenderProcess& process) {
  if (!applies() || guide_.regions() > 0) return;
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

  struct Seen {
    EnvironmentGuide::Squares tiles{};
    std::array<float, most_luminaires> roots{};  // of the mean squares of each luminaire
  };
  const std::vector<Seen> all =
      schedule.collect<Seen>(guide.regions(), [&](std::uint64_t region, std::vector<Seen>& results, Arena& arena) {
        Seen& seen = results.emplace_back();
        if (there[region].empty()) return;
        Lookout lookout(process, viewpoints, there[region], std::uint32_t(region), arena);
        if (environment_) seen.tiles = smoothed(look_at_tiles(lookout, *environment_));
        const int rays = std::max(rays_of_luminaire, rays_for_light / int(std::max<size_t>(luminaires_.size(), 1)));
        for (size_t k = 0; few_ && k < luminaires_.size(); ++k) {
          double sum = 0;
          if (luminaires_[k] == environment_) {
            for (const float s : seen.tiles) sum += std::sqrt(double(s));
            seen.roots[k] = float(sum / EnvironmentGuide::tiles);
          } else {
            for (int i = 0; i < rays; ++i) {
              lookout.stand(i, rays);
              sum += double(lookout.square_of(*luminaires_[k], lookout.pair())) / rays;
            }
            seen.roots[k] = float(std::sqrt(sum));
          }
        }
      });
  if (schedule.aborted()) return;
  std::vector<bool> dark;
  size_t places_in_the_dark = 0;
  for (const Seen& seen : all) {
    const auto region = size_t(&seen - all.data());
    const auto zero = [](float x) { return x == 0; };
    dark.push_back(few_ && !there[region].empty() && std::ranges::all_of(seen.roots, zero));
    if (dark.back()) places_in_the_dark += there[region].size();
    if (environment_) guide.learn(std::uint32_t(region), seen.tiles);
    if (!chooses_) continue;
    double whole = 0, below = 0;
    for (const float root : seen.roots) whole += double(root);
    for (size_t k = 0; k < luminaires_.size(); ++k)
      chances_.push_back(whole > 0 ? k + 1 == luminaires_.size() ? 1 : float((below += double(seen.roots[k])) / whole) : 0);
  }
  if (double(places_in_the_dark) >= worth_it * double(viewpoints.size())) dark_ = std::move(dark);
  guide_ = std::move(guide);
}

const float* AdaptiveLights::chances(const Point3& position, const Normal3& normal) const {
  if (chances_.empty()) return nullptr;
  const float* const here = chances_.data() + luminaires_.size() * guide_.region(position, normal);
  return here[luminaires_.size() - 1] > 0 ? here : nullptr;
}

LightChoice AdaptiveLights::choose(const Point3& p, const Normal3& n, float u) const {
  const float* const here = chances(p, n);
  if (!here) return lights_.choose(p, n, u);
  if (u < by_others) {
    LightChoice choice = lights_.choose(p, n, std::min(u / by_others, one_minus_epsilon));
    if (choice.luminaire) choice.probability = mixed(choice.probability, here, *choice.luminaire);
    return choice;
  }
  u = (u - by_others) / (1 - by_others);
  const auto k = size_t(std::upper_bound(here, here + luminaires_.size() - 1, u) - here);
  return {luminaires_[k], mixed(lights_.probability(p, n, *luminaires_[k]), here, *luminaires_[k])};
}

float AdaptiveLights::probability(const Point3& p, const Normal3& n, const SceneObject& luminaire) const {
  const float others = lights_.probability(p, n, luminaire);
  const float* const here = chances(p, n);
  return here ? mixed(others, here, luminaire) : others;
}

float AdaptiveLights::mixed(float others, const float* here, const SceneObject& luminaire) const {
  const auto k = size_t(luminaire.luminaire_index());
  if (k >= luminaires_.size() || luminaires_[k] != &luminaire) return 0;  // it is not one of the scene's
  return by_others * others + (1 - by_others) * (here[k] - (k == 0 ? 0 : here[k - 1]));
}

SurfaceSample AdaptiveLights::sample(const SceneObject& luminaire, const Point3& from, const Normal3& normal, Point2 u,
                                     float time) const {
  const bool guided = &luminaire == environment_ && guide_.regions() > 0;
  if (!guided && dark_.empty()) return lights_.sample(luminaire, from, normal, u, time);
  const std::uint32_t region = guide_.region(from, normal);
  const float a = asked(region);
  if (u.x >= a) return {};
  u.x = std::min(u.x / a, one_minus_epsilon);
  SurfaceSample sampled;
  if (!guided) {
    sampled = lights_.sample(luminaire, from, normal, u, time);
  } else {
    const EnvironmentGuide::Guided place = guide_.sample(region, u);
    sampled = environment_->sample_visible(from, place.place, time);
    if (one_place_)
      sampled.pdf *= place.ratio;
    else if (sampled.pdf > 0)
      sampled.pdf = guided_pdf(region, sampled.direction, time);
  }
  sampled.pdf *= a;
  return sampled;
}

float AdaptiveLights::pdf(const SceneObject& luminaire, const Point3& from, const Normal3& normal, const Vector3& direction,
                          const SurfacePoint& point) const {
  const bool guided = &luminaire == environment_ && guide_.regions() > 0;
  if (!guided && dark_.empty()) return lights_.pdf(luminaire, from, normal, direction, point);
  const std::uint32_t region = guide_.region(from, normal);
  return asked(region) *
         (guided ? guided_pdf(region, direction, point.time) : lights_.pdf(luminaire, from, normal, direction, point));
}

float AdaptiveLights::guided_pdf(std::uint32_t region, const Vector3& direction, float time) const {
  const IncidentPlaces places = environment_->visible_places(direction, time);
  float pdf = 0;
  for (int i = 0; i < places.count; ++i) pdf += places.pdf[i] * guide_.ratio(region, places.at[i]);
  return pdf;
}

}  // namespace etendue
