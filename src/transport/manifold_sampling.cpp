#include "etendue/transport/manifold_sampling.h"

#include <algorithm>

#include "etendue/core/warp.h"
#include "etendue/transport/metropolis.h"
#include "etendue/transport/projection_map.h"

namespace etendue {
namespace {

/// Stands for the probability that a seed of the right lobes leads to a chain, in weights.
constexpr float usual_probability = 0.25f;
/// Of weights below this nothing is sampled: the emitter hits have all.
constexpr float least_weight = 0.01f;

/// The probability with which seeds choose reflection where a surface refracts as well.
constexpr float reflection_chosen = 0.2f;

constexpr bool single(Lobes lobes) { return (lobes & (lobes - 1)) == 0; }

/// Trials must be independent of each other, so that a hash of two primary samples is continued.
std::uint64_t seed_of(NumberStream& numbers) {
  const auto first = std::uint64_t(double(numbers.next()) * 0x1p24), second = std::uint64_t(double(numbers.next()) * 0x1p24);
  return mix_bits(first << 32 | second);
}

/// Whether the pdf with which directions to a luminaire at infinity are sampled tells where its light is. Light that comes from
/// everywhere is found better by scattered rays. The light of the luminaire, if it came evenly from some solid angle, would
/// come from (mean of L / p)^2 / mean of L^2 / p [sr].
bool comes_from_everywhere(const SceneObject& luminaire, const Scene& scene) {
  constexpr int samples = 256;
  constexpr double most = 1;  // [sr]
  std::array<float, spectrum_size> lambda{}, pdf{};
  for (int i = 0; i < spectrum_size; ++i) {
    lambda[size_t(i)] = lerp((float(i) + 0.5f) / spectrum_size, 430.0f, 650.0f);
    pdf[size_t(i)] = 1.0f / 220;
  }
  const Wavelengths wavelengths(lambda, pdf);
  double sum = 0, squares = 0;
  for (int i = 0; i < samples; ++i) {
    // The R2 sequence (Roberts 2018).
    const Point2 u{float(std::fmod(0.5 + i * 0.7548776662466927, 1.0)), float(std::fmod(0.5 + i * 0.5698402909980532, 1.0))};
    const SurfaceSample s =
        luminaire.sample_visible(scene.centre(), {std::min(u.x, one_minus_epsilon), std::min(u.y, one_minus_epsilon)}, 0);
    if (!(s.pdf > 0)) continue;
    const auto light = double(luminaire.emission->radiance(s.point, -s.direction, wavelengths).average());
    sum += light / double(s.pdf);
    squares += light * light / double(s.pdf);
  }
  return !(squares > 0) || sum * sum / samples > most * squares;
}

}  // namespace

/// What the seeds of one sample share.
struct ManifoldSampler::Trial {
  const PathVertex& receiver;
  const Wavelengths& wavelengths;
  int longest;
  NumberStream& numbers;  ///< of heterogeneous media
  ChoiceNumbers& random;
  Arena& arena;
  const SceneObject* luminaire;
  SurfaceSample sampled;
  ChainTarget target;
  double density;  ///< P p(a)

  float uniform() const { return std::min(float(random.next()), one_minus_epsilon); }
};

ManifoldSampler::ManifoldSampler(const Scene& scene, const LightSampler& lights, const ManifoldSettings& settings)
    : scene_(scene), settings_(settings), by_index_(scene.luminaires().size(), 0.0) {
  for (const Ref<SceneObject>& object : scene.objects) {
    if (object->infinite() || object->delta() || !casts_caustics(*object)) continue;
    if (object->unbounded())
      endless_casters_ = true;
    else if (const Bounds3 box = object->bounds(); !box.empty())
      casters_.push_back(box);
  }
  double sum = 0;
  for (const SceneObject* luminaire : scene.luminaires()) {
    if (luminaire->infinite() && !luminaire->delta() && comes_from_everywhere(*luminaire, scene)) continue;
    const auto p = double(lights.probability(*luminaire));
    if (!(p > 0)) continue;
    luminaires_.push_back(luminaire);
    up_to_.push_back(sum += p);
  }
  double before = 0;
  for (size_t i = 0; i < luminaires_.size(); ++i) {
    by_index_[size_t(luminaires_[i]->luminaire_index())] = (up_to_[i] - before) / sum;
    before = up_to_[i];
  }
}

const SceneObject* ManifoldSampler::choose(float u) const {
  const auto found = std::ranges::upper_bound(up_to_, double(u) * up_to_.back());
  return luminaires_[std::min(size_t(found - up_to_.begin()), luminaires_.size() - 1)];
}

double ManifoldSampler::probability(const SceneObject& luminaire) const {
  const int i = luminaire.luminaire_index();
  return i < 0 ? 0 : by_index_[size_t(i)];
}

Vector3 ManifoldSampler::seed_direction(const Trial& t) const {
  const Point3& b = t.receiver.point.position;
  const float which = t.uniform();
  const Point2 u{t.uniform(), t.uniform()};
  if (which < 0.5f) {
    const Vector3 straight = t.target.infinite ? t.target.direction : normalize(t.target.position - b);
    const float angle = std::pow(1e-3f, u.x);  // [rad], as many of each order of magnitude
    const Frame across{Normal3(straight)};
    return normalize(straight + angle * (std::cos(2 * pi * u.y) * across.s + std::sin(2 * pi * u.y) * across.t));
  }
  const size_t kinds = casters_.size() + (endless_casters_ ? 1 : 0);
  const size_t k = std::min(size_t((2 * which - 1) * float(kinds)), kinds - 1);
  if (k == casters_.size()) return warp::sphere(u);
  const Vector3 size = casters_[k].diagonal();
  const Point3 there = casters_[k].low + Vector3{size.x * u.x, size.y * u.y, size.z * t.uniform()};
  const Vector3 way = there - b;
  return length_squared(way) > 0 ? normalize(way) : warp::sphere(u);
}

/// A chain at the start of Newton's method, or its lobes.
struct ManifoldSampler::Seed {
  Vector3 direction;
  ChainLobes lobes;
  std::uint32_t chosen = 0;  ///< bit i: the i-th vertex has both lobes, so that one was chosen

  /// The probability of the choices.
  float probability() const {
    float p = 1;
    for (int i = 0; i < lobes.count; ++i)
      if (chosen >> i & 1) p *= lobes.at[size_t(i)] == specular_reflection ? reflection_chosen : 1 - reflection_chosen;
    return p;
  }
};

/// Traces a seed; with the lobes and choices of `wanted`, if given. False: there is none.
bool ManifoldSampler::seed(const Trial& t, const Seed* wanted, Seed& seed) const {
  const ArenaScope memory(t.arena);
  seed.direction = seed_direction(t);
  seed.lobes.count = 0;
  seed.chosen = 0;
  ChainTracer chain(scene_, t.wavelengths, t.numbers, t.arena);
  chain.begin(t.receiver, seed.direction);
  while (seed.lobes.count < t.longest && chain.meet()) {
    const int i = seed.lobes.count;
    const Lobes here = chain.lobes_here();
    if (here == no_lobes) break;
    // Inside a body few chains end: they need a luminaire in there.
    if (i > 0 && t.uniform() < (chain.inside() ? 0.05f : 0.5f)) break;
    auto lobe = Lobe(here);
    if (!single(here)) {
      seed.chosen |= 1u << i;
      lobe = wanted                            ? wanted->lobes.at[size_t(i)]
             : t.uniform() < reflection_chosen ? specular_reflection
                                               : specular_transmission;
    }
    if (wanted && (i == wanted->lobes.count || lobe != wanted->lobes.at[size_t(i)] ||
                   (seed.chosen >> i & 1) != (wanted->chosen >> i & 1)))
      return false;
    if (!chain.scatter_by(lobe)) return false;
    seed.lobes.add(lobe);
  }
  return seed.lobes.count > 0 && (!wanted || seed.lobes.count == wanted->lobes.count);
}

/// The choices (Seed::chosen) of a seed that would start in this direction. Empty: the chain cannot be followed.
std::optional<std::uint32_t> ManifoldSampler::choices(const Trial& t, const ChainLobes& lobes, const Vector3& direction) const {
  const ArenaScope memory(t.arena);
  ChainTracer chain(scene_, t.wavelengths, t.numbers, t.arena);
  chain.begin(t.receiver, direction);
  std::uint32_t chosen = 0;
  for (int i = 0; i < lobes.count; ++i) {
    if (!chain.meet()) return {};
    if (!single(chain.lobes_here())) chosen |= 1u << i;
    if (!chain.scatter_by(lobes.at[size_t(i)])) return {};
  }
  return chosen;
}

/// Whether one more seed, with the lobes and choices of another, leads to the same chain.
bool ManifoldSampler::found_again(const Trial& t, const Seed& wanted, const ChainSolution& solution) const {
  Seed next;
  if (!seed(t, &wanted, next)) return false;
  const std::optional<ChainSolution> again = solve_chain(scene_, t.receiver, t.wavelengths, t.numbers, t.arena, next.direction,
                                                         next.lobes, t.target, ChainTracer::Derivatives::approximate);
  return again && solution.same(*again);
}

/// M.
int ManifoldSampler::most_trials(float p_m, float p_b) {
  // A chain of a delta light that is not found again by then has a probability below 1e-6, or was found by a rounding error.
  constexpr float most = 1 << 20;
  return int(p_m < most * p_b ? std::max(p_m / p_b, 8.0f) : most);
}

/// p_m [1/sr at the receiver], where `density` is P p(a), and `to` the direction from the last vertex to the luminaire.
float ManifoldSampler::weighting_pdf(double density, const ChainSolution& solution, const Seed& seed,
                                     const SurfacePoint& luminaire, const Vector3& to, bool infinite) const {
  double p = density * double(seed.probability() * usual_probability) * std::abs(solution.determinant);
  if (!infinite) p *= double(square(solution.distance));
  if (!infinite && luminaire.normal != Normal3{}) p /= std::abs(double(dot(luminaire.normal, to)));
  return std::isfinite(p) ? float(p) : 0;
}

/// The light of a chain that the seed led to, without 1 / p_k.
std::optional<ChainLight> ManifoldSampler::light_of(const Trial& t, const Seed& seed, const ChainSolution& solution) const {
  const ArenaScope memory(t.arena);
  const ScatterValue f = scattering(t.receiver, t.receiver.out, solution.direction, Transport::radiance);
  if (f.value.black()) return {};
  ChainTracer chain(scene_, t.wavelengths, t.numbers, t.arena);
  chain.attenuates = true;
  chain.begin(t.receiver, solution.direction);
  if (!chain.follow(solution.lobes)) return {};
  const Vector3 to = t.target.infinite ? t.target.direction : normalize(t.target.position - chain.from);
  SurfacePoint a = t.sampled.point;
  const Spectrum emitted = t.luminaire->emission->radiance(a, -to, chain.wavelengths);
  if (emitted.black() || !scene_.in_front(a, -to) || !chain.reaches(a, t.target)) return {};

  const float p_m = weighting_pdf(t.density, solution, seed, a, to, t.target.infinite);
  if (!(p_m > 0)) return {};
  const float p_b = t.sampled.delta ? 0 : f.pdf * chain.share;
  ChainLight light;
  light.weight = heuristic_weight(settings_.heuristic, p_m, p_b);
  light.trials = most_trials(p_m, p_b);
  if (light.weight < least_weight) return {};
  light.vertices = solution.lobes.count;
  light.light = f.value * chain.weight * emitted *
                (weight_over_pdf(settings_.heuristic, p_m, p_b) * seed.probability() * usual_probability);
  if (light.light.black()) return {};
  light.luminaire = t.luminaire;
  light.in = solution.direction;
  if (PathStates* const states = PathStates::current()) [[unlikely]] {
    light.path = states->begun(t.luminaire);
    for (int i = solution.lobes.count - 1; i >= 0; --i) {
      PathVertex v;
      v.point.object = chain.objects[size_t(i)];
      light.path = states->scattered_before(light.path, v, {}, solution.lobes.at[size_t(i)]);
    }
  }
  return light;
}

void ManifoldSampler::sample(const PathVertex& receiver, const Wavelengths& wavelengths, int longest, NumberStream numbers,
                             Arena& arena, const std::function<bool()>& aborted,
                             const std::function<void(const ChainLight&)>& add) const {
  const SceneObject* const luminaire = choose(numbers.next());
  const Point2 u = numbers.next_pair();
  ChoiceNumbers random(seed_of(numbers));
  const float time = receiver.point.time;
  Trial t{receiver, wavelengths, std::min(longest, settings_.longest), numbers, random, arena, luminaire, {}, {}, 0};
  t.sampled =
      luminaire->infinite() ? luminaire->sample_visible(receiver.point.position, u, time) : luminaire->sample_area(u, time);
  if (!(t.sampled.pdf > 0)) return;
  t.sampled.delta |= luminaire->delta();
  t.target = {t.sampled.point.position, t.sampled.direction, luminaire->infinite()};
  t.density = probability(*luminaire) * double(t.sampled.pdf);

  const auto solve = [&](const Seed& from) {
    return solve_chain(scene_, receiver, wavelengths, t.numbers, arena, from.direction, from.lobes, t.target,
                       ChainTracer::Derivatives::exact);
  };
  Seed first;
  if (!settings_.unbiased) {
    std::vector<ChainSolution> found;
    for (int i = 0; i < settings_.seeds; ++i) {
      if (!seed(t, nullptr, first)) continue;
      const std::optional<ChainSolution> solution = solve(first);
      if (!solution || std::ranges::any_of(found, [&](const ChainSolution& old) { return old.same(*solution); })) continue;
      const std::optional<std::uint32_t> chosen = choices(t, first.lobes, solution->direction);
      if (!chosen) continue;
      first.chosen = *chosen;
      found.push_back(*solution);
      if (const std::optional<ChainLight> light = light_of(t, first, *solution)) add(*light);
    }
    return;
  }
  if (!seed(t, nullptr, first)) return;
  const std::optional<ChainSolution> solution = solve(first);
  if (!solution || choices(t, first.lobes, solution->direction) != first.chosen) return;
  std::optional<ChainLight> light = light_of(t, first, *solution);
  if (!light) return;
  int trials = 1;  // min(N, M)
  while (trials < light->trials && !found_again(t, first, *solution))
    if ((++trials & 255) == 0 && aborted()) return;
  light->light *= float(trials) / first.probability();
  add(*light);
}

float ManifoldSampler::hit_weight(const PathVertex& receiver, const Ray& start, const MediumStack& media, float pdf,
                                  const ChainLobes& lobes, int longest, const SurfacePoint& luminaire, const Vector3& hit,
                                  const Wavelengths& wavelengths, NumberStream numbers, Arena& arena) const {
  const SceneObject& object = *luminaire.object;
  const double chosen = probability(object);
  longest = std::min(longest, settings_.longest);
  if (!(chosen > 0) || lobes.count > longest) return 1;
  const ArenaScope memory(arena);
  ChainTracer chain(scene_, wavelengths, numbers, arena);
  chain.derivatives = ChainTracer::Derivatives::exact;
  chain.begin(start, media);
  if (!chain.follow(lobes)) return 1;
  ChoiceNumbers random(seed_of(numbers));
  Trial t{receiver, wavelengths, longest, numbers, random, arena, &object, {}, {luminaire.position, hit, object.infinite()}, 0};
  ChainSolution solution;
  double r[2];
  chain_residual(chain, t.target, solution, r);
  if (!chain.reaches(luminaire, t.target)) return 1;
  solution.direction = start.direction;
  solution.lobes = lobes;
  Seed seed;
  seed.lobes = lobes;
  const std::optional<std::uint32_t> choice = choices(t, lobes, start.direction);
  if (!choice) return 1;
  seed.chosen = *choice;

  t.density =
      chosen * double(t.target.infinite ? object.visible_pdf(start.origin, hit, luminaire) : object.area_pdf(luminaire));
  const float p_m = weighting_pdf(t.density, solution, seed, luminaire, hit, t.target.infinite), p_b = pdf * chain.share;
  if (!(p_m > 0) || heuristic_weight(settings_.heuristic, p_m, p_b) < least_weight) return 1;
  const float weight = heuristic_weight(settings_.heuristic, p_b, p_m);
  if (!settings_.unbiased) return weight;
  for (int i = most_trials(p_m, p_b); i > 0; --i)
    if (found_again(t, seed, solution)) return weight;
  return 1;
}

}  // namespace etendue
