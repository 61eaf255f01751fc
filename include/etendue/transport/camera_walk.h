#pragma once
// CameraWalk: a walk from the camera that gathers light, the core of path tracers.
//
// The radiance along a camera ray is estimated by a sum over the vertices x_k of the walk (Kajiya 1986),
//     L = sum_k T_k [ w_k L_e(x_k) + direct(x_k) ]
// with the throughput T_k up to x_k (walk.h shows where its factors f |cos| / p are multiplied). The first term is the emitter
// hit: the radiance L_e that x_k emits towards x_{k-1}. The second is next event estimation: the light that comes to x_k
// directly from a sampled point of a luminaire and is scattered towards x_{k-1},
//     direct = w' f |cos| L_e V / (P p_light)     (direct_light.h)
// with the probability P of the luminaire, the pdf p_light [1/sr] of the direction to its point, and the visibility V. Both
// terms sample the same paths, and the weights w and w' combine them (multiple_importance.h). This class traces the walk and
// adds the terms. The algorithm decides which terms are used, with which weights, and when the walk ends:
//
//     CameraWalk walk(scene, sample, ray, longest);
//     while (walk.next_vertex(weight) && !walk.at_end()) {   // emitter hits
//       const NumberStream::Bounce u = walk.next_bounce();
//       walk.add_direct(lights, u, heuristic);               // next event estimation
//       if (walk.scatter(u) && enough) walk.end();           // T *= f |cos| / p; roulette.survives(walk)
//     }
//     return walk.radiance;
//
// At specular glass a walk may be split into branches (`split`), each of which is a CameraWalk.
//
// SimplePathTracer (src/components/renderers/simple_path_tracer.cpp) is the same sum written plainly, without w. This class is
// its fused form: the shadow ray of add_direct is traced together with the next segment, and its light is added then, without a
// conditional jump; code for media is left out of scenes that have none; all of it is inlined into the algorithm. So
// next_vertex must be called once more, after `end` too, before `radiance` is complete. Processor time of SimplePathTracer over
// that of PathTracer, which computes the pdfs for w and w' as well, at the same depth and without roulette: 1.11 in the Cornell
// box, 1.02 with glossy plates before spheres (scenes/verify/mis_plates.etd), 1.01 with metals (scenes/metals.etd). Weights are
// free.

#include <limits>

#include "etendue/transport/direct_light.h"
#include "etendue/transport/light_groups.h"
#include "etendue/transport/splitting.h"
#include "etendue/transport/visibility.h"
#include "etendue/transport/walk.h"

namespace etendue {

template <bool unattenuated = false>
class CameraWalk : public Walk<unattenuated> {
  using Base = Walk<unattenuated>;

 public:
  using Base::length, Base::longest, Base::numbers, Base::ray, Base::sample, Base::scene, Base::throughput, Base::vertex;

  CameraWalk(const Scene& scene_, SampleContext& sample_, const Ray& ray_, int longest_)
      : Base(scene_, sample_, ray_, longest_), memory_(sample_.arena.mark()), one_luminaire_(scene_.luminaires().size() == 1) {
    this->collects_light = true;
    this->observed = sample.sink.record;
    if (!unattenuated && scene.has_interiors()) media_at(scene, ray.origin, ray.time, this->media);
  }

  Spectrum radiance;  ///< the part of L that is gathered so far
  Spectrum earlier;   ///< `radiance` without the light that arrives along the last segment. When the walk has ended, radiance
                      ///< minus this value is the light that a sampled direction brought

  /// Moves to the next vertex and adds emitter hits, each with the weight `weight(point on the emitter)`. A member
  /// `weight.through(medium, reach)`, if present, is called for media (NoEvents::through). False: the walk has ended, and all
  /// its light is added (the direct light of a vertex is added on the way to the next). If `reradiates` is set, the scattering
  /// of a fluorescent vertex is then chosen (Walk::choose_reradiation).
  template <class Weight>
  [[gnu::always_inline]] bool next_vertex(const Weight& weight) {
    if (!goes_on_ || exits_subsurface_) {
      settle(awaits_ && !(unattenuated && scene.any(direct_.shadow)));
      earlier = radiance;
      if (!exits_subsurface_) return false;
      exits_subsurface_ = goes_on_ = false;  // the vertex is a subsurface exit, to which no ray leads
      sample.sink.surface(vertex.point, placed(throughput));
      return true;
    }
    if ((length & 31) == 31 && sample.aborted()) return false;
    sample.arena.rewind(memory_);  // the scattering of earlier vertices is no longer needed
    const auto [blocked, found] = scene.any_and_nearest(unattenuated && awaits_ ? &direct_.shadow : nullptr, ray, this->hit);
    settle(!blocked);
    earlier = radiance;
    goes_on_ = false;
    if (!this->come_to_vertex(found, Events<Weight>{{}, *this, weight})) return false;
    if (vertex.in_medium()) {
      sample.sink.medium(vertex.point.position, placed(throughput));
    } else if (vertex.on_surface()) {
      sample.sink.surface(vertex.point, placed(throughput));
      if (vertex.point.object->luminaire()) add_luminaire(weight);
      if (length < longest) this->choose_reradiation();
    } else {
      for (const SceneObject* far : scene.infinite_luminaires(ray)) {
        far->surface_point(ray, this->hit, vertex.point);
        sample.sink.escape(*far, ray, placed(throughput));
        add_luminaire(weight);
      }
      return false;
    }
    return true;
  }

  /// Whether the path has its maximum length, so that the last vertex is the end.
  bool at_end() const { return length >= longest; }

  /// The primary samples for the last vertex.
  [[gnu::always_inline]] NumberStream::Bounce next_bounce() {
    return numbers.next_bounce(!one_luminaire_, !vertex.scatter || vertex.scatter->has_choice());
  }

  /// Next event estimation: samples a point on a luminaire and adds its light unless the shadow ray is occluded.
  /// `scattering(in)` returns f |cos| and the pdf [1/sr] with which the walk samples `in` at this vertex, which is that of a
  /// mixture if a guide samples directions too.
  template <class Scattering>
  [[gnu::always_inline]] void add_direct(const LightSampler& lights, const NumberStream::Bounce& u, Heuristic heuristic,
                                         const Scattering& scattering) {
    if (!vertex.scatters_smoothly() || !sample_next_event(scene, lights, vertex, ray.time, sample.wavelengths, u.light_choice,
                                                          u.light_point, heuristic, direct_, scattering))
      return;
    direct_.light *= throughput;
    if constexpr (!unattenuated) {
      MediumStack scratch;
      NumberStream way = numbers.fork("shadow", std::uint32_t(length));
      direct_.light *= shadow_transmittance(scene, direct_.shadow, media_towards(vertex, direct_.shadow.direction, scratch),
                                            sample.wavelengths, way, sample.arena);
      if (direct_.light.black()) return;
    }
    direct_.light = placed(direct_.light);
    if (follows_paths()) [[unlikely]]
      direct_matches_ = direct_matches();
    awaits_ = true;
    direct_length_ = length + 1;
  }

  /// The same for a walk whose directions are sampled by the BSDF or the phase function alone.
  [[gnu::always_inline]] void add_direct(const LightSampler& lights, const NumberStream::Bounce& u, Heuristic heuristic) {
    add_direct(lights, u, heuristic, ScatteringOf{vertex});
  }

  /// The multiple importance sampling weight of an emitter hit against next event estimation at the vertex before. It is 1
  /// after a specular lobe, where next event estimation finds nothing.
  [[gnu::always_inline]] float emitter_hit_weight(const LightSampler& lights, Heuristic heuristic,
                                                  const SurfacePoint& luminaire) const {
    if (this->arrived_specularly) return 1;
    return heuristic_weight(heuristic, this->direction_pdf,
                            next_event_direction_pdf(lights, this->from, this->from_normal, ray.direction, luminaire));
  }

  /// Samples the direction in which the walk leaves its last vertex: T *= f |cos| / p. False: the walk is absorbed.
  [[gnu::always_inline]] bool scatter(const NumberStream::Bounce& u) {
    const std::optional<ScatterSample> next = this->sample_direction(u.lobe_choice, u.direction);
    return next && go_on(*next);
  }
  /// The same with a direction that was already sampled, by `sample_direction` or by another distribution (scattered_towards).
  [[gnu::always_inline]] bool go_on(const ScatterSample& next) {
    sample.sink.scattered(next);
    if (!unattenuated && next.lobe == null_scattering) {
      this->pass_on(next);
      return goes_on_ = true;
    }
    if (follows_paths()) [[unlikely]]
      path_ = path_after(next.direction, next.lobe);
    if (vertex.on_surface() && !vertex.subsurface_exit && enters_subsurface(vertex.point, next))
      return exits_subsurface_ = goes_on_ = this->subsurface_exit_found(next);
    if (weight_at_split_ > 0) [[unlikely]]
      reduce_branches(next);
    this->leave(next);
    if (!this->arrived_specularly) bends_ = std::numeric_limits<int>::max();
    return goes_on_ = true;
  }

  /// Adds light that the algorithm gathered at the last vertex in another way, such as from photons: the radiance scattered
  /// there, and the number of segments from the luminaire to the vertex. `rest`: the backward state of the path up to the
  /// vertex, and `in` the direction from which it comes, for layers by light path expressions.
  void add_light(int segments_before, const Spectrum& light, const SceneObject* luminaire, PathState rest = {},
                 const Vector3& in = {}) {
    PathState matches;
    if (follows_paths()) [[unlikely]]
      matches = PathStates::current()->joined(path_after(in), rest);
    add(length + segments_before, placed(throughput * light), luminaire, matches);
  }
  /// The same for light that a medium scatters along the last segment.
  void add_light_in(const Medium& medium, int segments_before, const Spectrum& light, const SceneObject* luminaire,
                    PathState rest) {
    PathState matches;
    if (follows_paths()) [[unlikely]]
      matches = PathStates::current()->joined(PathStates::current()->scattered_in(path_, medium.object), rest);
    add(length + segments_before, placed(throughput * light), luminaire, matches);
  }
  /// The same where the luminaires are unknown: no light group receives the light.
  void add_light(int segments_before, const Spectrum& light) {
    const Spectrum here = placed(throughput * light);
    radiance += here;
    sample.sink.light(length + segments_before, here);
  }
  /// For a branch that follows one wavelength: the index of that among the path's wavelengths; -1: the walk follows all of
  /// them.
  int lane() const { return lane_; }

  /// Whether the walk is to be split at its last vertex, which must have no lobes but specular reflection and refraction.
  [[gnu::always_inline]] bool splits(const Splitting& splitting) const {
    if (!vertex.on_surface() || !vertex.scatter || vertex.subsurface_exit) return false;
    const Lobes ways = ways_on();
    if (ways == no_lobes || (ways & ~reflect_and_refract)) return false;
    return (vertex.scatter->dispersed_lobes() && splitting.wavelengths > 1) || splits_reflection_and_refraction(splitting);
  }

  /// Continues from such a vertex. If there are several parts to follow, refracted light is followed by branches:
  /// `follow(branch)` traces one and returns its radiance. This walk itself follows the reflection.
  template <class Follow>
  void split(const Splitting& splitting, const NumberStream::Bounce& u, const Follow& follow) {
    const Scatter& scatter = *vertex.scatter;
    Lobes ways = ways_on();
    float choice = u.lobe_choice;
    NumberStream refracted = numbers;
    if (splits_reflection_and_refraction(splitting)) {
      ++bends_;
      if (!(weight_at_split_ > 0)) weight_at_split_ = this->mean_roulette_weight();
      refracted = numbers.fork("refracted", std::uint32_t(length));
    } else if (ways == reflect_and_refract) {
      ways = choose_way(scatter, choice);
    }
    const auto sampled = [&](Lobe lobe) {
      return ways & lobe ? scatter.sample(vertex.out, choice, u.direction, {.lobes = lobe}) : std::nullopt;
    };
    std::optional<ScatterSample> own = sampled(specular_reflection);
    if (const int count = ways & scatter.dispersed_lobes() ? splitting.wavelengths : 1; count > 1)
      for (int i = 0; i < count; ++i)
        follow_wavelength(i * spectrum_size / count, count, choice, u.direction, refracted, follow);
    else if (own)
      follow_refracted(sampled(specular_transmission), refracted, follow);
    else
      own = sampled(specular_transmission);
    if (own)
      go_on(*own);
    else
      end();
  }

  /// Ends the walk at its last vertex, although a direction was sampled.
  void end() { goes_on_ = exits_subsurface_ = false; }

 private:
  static constexpr Lobes reflect_and_refract = specular_reflection | specular_transmission;

  CameraWalk(const CameraWalk& walk, SampleContext& own)
      : Base(walk, own),
        bends_(walk.bends_),
        weight_at_split_(walk.weight_at_split_),
        lane_(walk.lane_),
        path_(walk.path_),
        memory_(own.arena.mark()),
        one_luminaire_(walk.one_luminaire_) {}

  /// Whether there are light path expressions: the same test as for all parts of the light.
  bool follows_paths() const { return !sample.sink.lengths.empty() && PathStates::current(); }
  /// The expressions that the path of next event estimation matches.
  [[gnu::noinline]] PathState direct_matches() const {
    return PathStates::current()->ended(path_after(normalize(direct_.shadow.direction)), direct_.luminaire);
  }
  /// The state after the last vertex, which scatters light from `in`.
  [[gnu::noinline]] PathState path_after(const Vector3& in, Lobe lobe = diffuse_reflection) const {
    PathStates& states = *PathStates::current();
    const PathState after = states.scattered(path_, vertex, in, lobe);
    return lane_ < 0 ? after : states.alone(after, 0);
  }
  /// Those that the path matches which ends at a luminaire (null: in a medium that emits).
  PathState ended_at(const SceneObject* luminaire) const {
    if (!follows_paths()) [[likely]]
      return {};
    return PathStates::current()->ended(path_, luminaire, luminaire ? nullptr : this->media.current());
  }

  Lobes ways_on() const { return Lobes(vertex.scatter->lobes() & vertex.lobes); }
  bool splits_reflection_and_refraction(const Splitting& splitting) const {
    return bends_ < splitting.reflect_and_refract && ways_on() == reflect_and_refract;
  }

  /// Chooses reflection or refraction, with probabilities in proportion to what all wavelengths together carry there: the
  /// throughput of the hero alone may be 0, or it may be totally reflected where others are refracted. `choice` is rescaled to
  /// [0, 1).
  Lobes choose_way(const Scatter& scatter, float& choice) {
    const float reflected = (throughput * scatter.albedo(vertex.out, specular_reflection)).average(),
                refracted = (throughput * scatter.albedo(vertex.out, specular_transmission)).average();
    constexpr float least = 1.0f / 64;  // albedos may be estimates
    const float sum = reflected + refracted, p = sum > 0 ? clamp(reflected / sum, least, 1 - least) : 0.5f;
    const bool reflects = choice < p;
    choice = std::min(reflects ? choice / p : (choice - p) / (1 - p), one_minus_epsilon);
    throughput /= reflects ? p : 1 - p;
    return reflects ? specular_reflection : specular_transmission;
  }

  /// The context of a branch, with its own primary samples and wavelengths.
  SampleContext context_of(Wavelengths& wavelengths, const NumberStream& branch_numbers) const {
    return {wavelengths, branch_numbers, sample.arena, sample.sink};
  }

  template <class Follow>
  void follow_refracted(const std::optional<ScatterSample>& next, const NumberStream& refracted, const Follow& follow) {
    if (!next) return;
    const ArenaScope memory(sample.arena);
    Wavelengths wavelengths = sample.wavelengths;
    SampleContext own = context_of(wavelengths, refracted);
    CameraWalk branch(*this, own);
    follow_from_here(branch, *next, follow);
  }

  template <class Follow>
  void follow_wavelength(int lane, int count, float choice, Point2 u, const NumberStream& refracted, const Follow& follow) {
    if (!(throughput[lane] > 0)) return;
    const ArenaScope memory(sample.arena);
    Wavelengths wavelengths = sample.wavelengths.alone(lane);
    SampleContext own = context_of(wavelengths, refracted);
    CameraWalk branch(*this, own);
    branch.throughput = Spectrum();
    branch.throughput.set(0, throughput[lane] * float(spectrum_size) / float(count));
    branch.branches = float(count);
    branch.lane_ = lane;
    if (follows_paths()) branch.path_ = PathStates::current()->alone(path_, lane_ < 0 ? lane : 0);
    const Scatter* scatter = scattering_at(vertex.point, vertex.out, wavelengths, sample.arena);
    if (!scatter) return;
    std::optional<ScatterSample> next = scatter->sample(vertex.out, choice, u, {.lobes = specular_transmission});
    if (!next) return;
    next->dispersive = true;  // for the record only: the branch has no secondary wavelengths left to drop
    follow_from_here(branch, *next, follow);
  }

  template <class Follow>
  void follow_from_here(CameraWalk& branch, const ScatterSample& next, const Follow& follow) {
    if (branch.go_on(next)) radiance += follow(branch);
    sample.sink.surface(vertex.point, placed(throughput));  // the record of the path continues from this vertex
  }

  /// Reduces the branches of reflect/refract splitting to one on average. At its first smooth vertex each branch gets the
  /// survival probability branch_survival_, its part of the throughput that the walk had at the first split. The roulette is
  /// applied one vertex later, after the emitter hit at the end of the next segment was added: with multiple importance
  /// sampling that hit is half of the direct light of the smooth vertex.
  void reduce_branches(const ScatterSample& next) {
    if (!this->arrived_specularly) {
      this->pending_survival = branch_survival_;
      weight_at_split_ = 0;
    } else if (!next.specular()) {
      branch_survival_ = std::min(1.0f, this->mean_roulette_weight() / weight_at_split_);
    }
  }

  /// The light of a branch of one wavelength, moved to the index of that wavelength on the path.
  [[gnu::always_inline]] Spectrum placed(const Spectrum& light) const {
    if (lane_ < 0) [[likely]]
      return light;
    Spectrum all;
    all.set(lane_, light[0]);
    return all;
  }

  template <class Weight>
  struct Events : NoEvents {
    CameraWalk& walk;
    const Weight& weight;
    void emitted(const Spectrum& light) const { walk.add(walk.length, walk.placed(light), nullptr, walk.ended_at(nullptr)); }
    void crossed_luminaire() const {
      walk.sample.sink.surface(walk.vertex.point, walk.placed(walk.throughput));
      walk.add_luminaire(weight);
    }
    void through(const Medium& medium, float reach) const {
      if constexpr (requires { weight.through(medium, reach); }) weight.through(medium, reach);
    }
  };

  [[gnu::always_inline]] void add(int segments, const Spectrum& light, const SceneObject* luminaire, PathState matches) {
    radiance += light;
    report_light(sample.sink, segments, light, luminaire, matches);
  }

  template <class Weight>
  void add_luminaire(const Weight& weight) {
    const Spectrum light =
        placed(throughput * vertex.point.object->emission->radiance(vertex.point, -ray.direction, sample.wavelengths));
    if (light.black()) return;
    const float mis_weight = weight(vertex.point);
    add(length, light * mis_weight, vertex.point.object, ended_at(vertex.point.object));
    sample.sink.emitter_hit(light * mis_weight, length, mis_weight);
  }

  /// Adds the light of next event estimation, given the result of its shadow ray. The processor cannot predict that result, so
  /// the light is selected without a conditional jump.
  [[gnu::always_inline]] void settle(bool lit) {
    if (!awaits_) return;
    awaits_ = false;
    add(direct_length_, lit ? direct_.light : Spectrum(), direct_.luminaire, direct_matches_);
    if (lit) sample.sink.next_event(direct_.light, direct_length_, direct_.weight);
  }

  bool goes_on_ = true, exits_subsurface_ = false, awaits_ = false;
  int direct_length_ = 0;
  int bends_ = 0;  ///< how often the walk was split into reflection and refraction; the largest int after a smooth
                   ///< vertex: no more splits
  float weight_at_split_ = 0, branch_survival_ = 1;  ///< see reduce_branches
  int lane_ = -1;  ///< the index of a branch's only wavelength among the path's; -1: the walk has all
  PathState path_ = path_after_camera, direct_matches_;  ///< used with light path expressions alone
  DirectLight direct_;
  const Arena::Mark memory_;
  const bool one_luminaire_;
};

}  // namespace etendue
