#pragma once
// A walk from the camera that gathers light.
//
// Radiance along a camera ray is the sum over the vertices x_k of its walk
//     L = sum_k T_k [ L_e(x_k) + direct(x_k) ],
// L_e being what x_k sends to x_{k-1} by itself, and direct(x_k) what it scatters there of light that comes straight from
// luminaires (Kajiya 1986). This class goes from vertex to vertex and adds what it is given; which part of the two to take, by
// what weights, and when to stop is the algorithm's:
//
//     CameraWalk walk(scene, sample, ray, longest);
//     while (walk.next_vertex(weight) && !walk.at_end()) {
//       const NumberStream::Bounce u = walk.next_bounce();
//       walk.add_direct(lights, u, heuristic);
//       if (walk.scatter(u) && enough) walk.end();
//     }
//     return walk.radiance;
//
// Where perfectly smooth glass is met, a walk may be divided into branches (`divide`), each a walk of its own.
//
// Light of add_direct waits for its shadow ray, which is asked together with the next segment: next_vertex must be called once
// more (after `end`, too) before `radiance` is whole.

#include <limits>

#include "etendue/transport/direct_light.h"
#include "etendue/transport/light_groups.h"
#include "etendue/transport/splitting.h"
#include "etendue/transport/visibility.h"
#include "etendue/transport/walk.h"

namespace etendue {

template <bool clear = false>
class CameraWalk : public Walk<clear> {
  using Base = Walk<clear>;

 public:
  using Base::length, Base::longest, Base::numbers, Base::ray, Base::sample, Base::scene, Base::throughput, Base::vertex;

  CameraWalk(const Scene& scene_, SampleContext& sample_, const Ray& ray_, int longest_)
      : Base(scene_, sample_, ray_, longest_), memory_(sample_.arena.mark()), one_luminaire_(scene_.luminaires().size() == 1) {
    this->collects_light = true;
    this->observed = sample.sink.features || sample.sink.record;
    if (!clear && scene.has_interiors()) media_at(scene, ray.origin, ray.time, this->media);
  }

  Spectrum radiance;  ///< L, as far as it is gathered
  Spectrum earlier;   ///< of it, what has not come along the last segment: once the walk has ended, the rest tells what a
                      ///< direction brought

  /// Goes to the next vertex and adds the light of luminaires it meets, each with `weight(its point)`. False: the walk has
  /// ended, and all that was added has arrived (light of one vertex is settled on the way to the next).
  template <class Weight>
  [[gnu::always_inline]] bool next_vertex(const Weight& weight) {
    if (!goes_on_ || exits_subsurface_) {
      settle(awaits_ && !(clear && scene.any(direct_.shadow)));
      earlier = radiance;
      if (!exits_subsurface_) return false;
      exits_subsurface_ = goes_on_ = false;  // it came to the vertex through a body
      sample.sink.surface(vertex.point, placed(throughput));
      return true;
    }
    if ((length & 31) == 31 && sample.aborted()) return false;
    sample.arena.rewind(memory_);  // of earlier vertices nothing is needed any more
    const auto [blocked, found] = scene.any_and_nearest(clear && awaits_ ? &direct_.shadow : nullptr, ray, this->hit);
    settle(!blocked);
    earlier = radiance;
    goes_on_ = false;
    if (!this->come_to_vertex(found, Events<Weight>{{}, *this, weight})) return false;
    if (vertex.in_medium()) {
      sample.sink.medium(vertex.point.position, placed(throughput));
    } else if (vertex.on_surface()) {
      sample.sink.surface(vertex.point, placed(throughput));
      if (length == 1)
        sample.sink.first_surface(scene, vertex.point, this->hit, vertex.scatter, vertex.out, sample.wavelengths,
                                  this->null_crossed_distance);
      if (vertex.point.object->luminaire()) add_luminaire(weight);
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

  /// Whether nothing may follow the last vertex.
  bool at_end() const { return length >= longest; }

  /// The numbers of the last vertex.
  [[gnu::always_inline]] NumberStream::Bounce next_bounce() {
    return numbers.next_bounce(!one_luminaire_, !vertex.scatter || vertex.scatter->has_choice());
  }

  /// Samples light that comes straight from luminaires and adds it, unless something turns out to lie between. `scattering(in)`
  /// gives f |cos| and the density [1/sr] with which the walk will go on there: a guide's, where one chooses directions.
  template <class Scattering>
  [[gnu::always_inline]] void add_direct(const LightSampler& lights, const NumberStream::Bounce& u, Heuristic heuristic,
                                         const Scattering& scattering) {
    if (!vertex.scatters_smoothly() || !sample_next_event(scene, lights, vertex, ray.time, sample.wavelengths, u.light_choice,
                                                          u.light_point, heuristic, direct_, scattering))
      return;
    direct_.light *= throughput;
    if constexpr (!clear) {
      MediumStack scratch;
      NumberStream way = numbers.fork("shadow", std::uint32_t(length));
      direct_.light *= shadow_transmittance(scene, direct_.shadow, media_towards(vertex, direct_.shadow.direction, scratch),
                                            sample.wavelengths, way, sample.arena);
      if (direct_.light.black()) return;
    }
    direct_.light = placed(direct_.light);
    awaits_ = true;
    direct_length_ = length + 1;
  }

  /// The same where the surface itself, or the medium, chooses the direction.
  [[gnu::always_inline]] void add_direct(const LightSampler& lights, const NumberStream::Bounce& u, Heuristic heuristic) {
    add_direct(lights, u, heuristic, ScatteringOf{vertex});
  }

  /// The weight of a luminaire that the walk meets, which `add_direct` could have sampled at the vertex before; behind a mirror
  /// it could not.
  [[gnu::always_inline]] float emitter_hit_weight(const LightSampler& lights, Heuristic heuristic,
                                                  const SurfacePoint& luminaire) const {
    if (this->specular) return 1;
    return heuristic_weight(heuristic, this->direction_pdf,
                            next_event_pdf(lights, this->from, this->from_normal, ray.direction, luminaire));
  }

  /// Goes on from the last vertex; false: it is absorbed there.
  [[gnu::always_inline]] bool scatter(const NumberStream::Bounce& u) {
    const std::optional<ScatterSample> next = this->sample_direction(u.lobe_choice, u.direction);
    return next && go_on(*next);
  }
  /// The same in a direction that was chosen already: by `sample_direction`, or by somebody else (scattered_towards).
  [[gnu::always_inline]] bool go_on(const ScatterSample& next) {
    sample.sink.scattered(next);
    if (!clear && next.lobe == null_scattering) {
      this->pass_on(next);
      return goes_on_ = true;
    }
    if (vertex.on_surface() && !vertex.subsurface_exit && enters_subsurface(vertex.point, next))
      return exits_subsurface_ = goes_on_ = this->subsurface_exit_found(next);
    if (whole_ > 0) [[unlikely]]
      come_together(next);
    this->leave(next);
    if (!this->specular) bends_ = std::numeric_limits<int>::max();
    return goes_on_ = true;
  }

  /// Adds light that somebody else gathered at the last vertex, whose way from the luminaire has so many segments: photons.
  void add_light(int segments_before, const Spectrum& light, const SceneObject* luminaire) {
    add(length + segments_before, placed(throughput * light), luminaire);
  }
  /// The same where it is not known which luminaires it comes from: there are no light groups then.
  void add_light(int segments_before, const Spectrum& light) {
    const Spectrum here = placed(throughput * light);
    radiance += here;
    sample.sink.light(length + segments_before, here);
  }
  /// The place among the path's wavelengths of the only one that a branch follows; -1: it follows no single one.
  int lane() const { return lane_; }

  /// Whether the walk is to be divided at its last vertex.
  [[gnu::always_inline]] bool splits(const Splitting& splitting) const {
    if (!vertex.on_surface() || !vertex.scatter || vertex.subsurface_exit) return false;
    const Lobes ways = ways_on();
    if (ways == no_lobes || (ways & ~reflect_and_refract)) return false;
    return (vertex.scatter->dispersed() && splitting.wavelengths > 1) || splits_reflection_and_refraction(splitting);
  }

  /// Goes on from such a vertex. Light that is refracted is followed by branches where it is one part of several:
  /// `follow(branch)` returns what a walk gathers. Reflected light is the walk's own way.
  template <class Follow>
  void split(const Splitting& splitting, const NumberStream::Bounce& u, const Follow& follow) {
    const Scatter& scatter = *vertex.scatter;
    Lobes ways = ways_on();
    float choice = u.lobe_choice;
    NumberStream refracted = numbers;
    if (splits_reflection_and_refraction(splitting)) {
      ++bends_;
      if (!(whole_ > 0)) whole_ = this->mean_roulette_weight();
      refracted = numbers.fork("refracted", std::uint32_t(length));
    } else if (ways == reflect_and_refract) {
      ways = choose_way(scatter, choice);
    }
    const auto sampled = [&](Lobe lobe) {
      return ways & lobe ? scatter.sample(vertex.out, choice, u.direction, Transport::radiance, lobe) : std::nullopt;
    };
    std::optional<ScatterSample> own = sampled(specular_reflection);
    if (const int n = ways & scatter.dispersed() ? splitting.wavelengths : 1; n > 1)
      for (int i = 0; i < n; ++i) follow_wavelength(i * spectrum_size / n, n, choice, u.direction, refracted, follow);
    else if (own)
      follow_refracted(sampled(specular_transmission), refracted, follow);
    else
      own = sampled(specular_transmission);
    if (own)
      go_on(*own);
    else
      end();
  }

  /// Lets it end after all.
  void end() { goes_on_ = exits_subsurface_ = false; }

 private:
  static constexpr Lobes reflect_and_refract = specular_reflection | specular_transmission;

  CameraWalk(const CameraWalk& walk, SampleContext& own)
      : Base(walk, own),
        bends_(walk.bends_),
        whole_(walk.whole_),
        lane_(walk.lane_),
        memory_(own.arena.mark()),
        one_luminaire_(walk.one_luminaire_) {}

  Lobes ways_on() const { return Lobes(vertex.scatter->lobes() & vertex.lobes); }
  bool splits_reflection_and_refraction(const Splitting& splitting) const {
    return bends_ < splitting.reflect_and_refract && ways_on() == reflect_and_refract;
  }

  /// One of both ways, with the probability of what the walk's wavelengths together carry there: the hero may have nothing
  /// left, or be reflected as a whole where others are refracted. `choice` becomes what is left of it.
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

  /// The context of a branch, which has its own numbers and wavelengths.
  SampleContext context_of(Wavelengths& wavelengths, const NumberStream& branch_numbers) const {
    const SampleContext& s = sample;
    return {wavelengths, branch_numbers, s.arena, s.sink};
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
  void follow_wavelength(int lane, int n, float choice, Point2 u, const NumberStream& refracted, const Follow& follow) {
    if (!(throughput[lane] > 0)) return;
    const ArenaScope memory(sample.arena);
    Wavelengths wavelengths = sample.wavelengths.alone(lane);
    SampleContext own = context_of(wavelengths, refracted);
    CameraWalk branch(*this, own);
    branch.throughput = Spectrum();
    branch.throughput.set(0, throughput[lane] * float(spectrum_size) / float(n));
    branch.branches = float(n);
    branch.lane_ = lane;
    const Scatter* scatter = scattering_at(vertex.point, vertex.out, wavelengths, sample.arena);
    if (!scatter) return;
    std::optional<ScatterSample> next = scatter->sample(vertex.out, choice, u, Transport::radiance, specular_transmission);
    if (!next) return;
    next->dispersive = true;  // for who looks on: the branch has nothing left to drop
    follow_from_here(branch, *next, follow);
  }

  template <class Follow>
  void follow_from_here(CameraWalk& branch, const ScatterSample& next, const Follow& follow) {
    if (branch.go_on(next)) radiance += follow(branch);
    sample.sink.surface(vertex.point, placed(throughput));  // what follows is told from here on
  }

  /// Of what a walk had where it was first sent both ways, its branches go on together, in the mean, as one where they have
  /// been scattered without a mirror: each with the probability of its part, once the light that they meet next, which is half
  /// of all direct light there (multiple importance sampling), has been taken.
  void come_together(const ScatterSample& next) {
    if (!this->specular) {
      this->pending_survival = part_;
      whole_ = 0;
    } else if (!next.specular()) {
      part_ = std::min(1.0f, this->mean_roulette_weight() / whole_);
    }
  }

  /// The light of a branch of one wavelength in the place that has on the path.
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
    void emitted(const Spectrum& light) const { walk.add(walk.length, walk.placed(light), nullptr); }
    void crossed_luminaire() const {
      walk.sample.sink.surface(walk.vertex.point, walk.placed(walk.throughput));
      walk.add_luminaire(weight);
    }
    void through(const Medium& medium, float reach) const {
      if constexpr (requires { weight.through(medium, reach); }) weight.through(medium, reach);
    }
  };

  [[gnu::always_inline]] void add(int segments, const Spectrum& light, const SceneObject* luminaire) {
    radiance += light;
    report_light(sample.sink, segments, light, luminaire);
  }

  template <class Weight>
  void add_luminaire(const Weight& weight) {
    const Spectrum light =
        placed(throughput * vertex.point.object->emission->radiance(vertex.point, -ray.direction, sample.wavelengths));
    if (light.black()) return;
    const float w = weight(vertex.point);
    add(length, light * w, vertex.point.object);
    sample.sink.emitter_hit(light * w, length, w);
  }

  /// Adds the light that waited for its shadow ray. Whether it comes cannot be guessed, so nothing hangs on it.
  [[gnu::always_inline]] void settle(bool lit) {
    if (!awaits_) return;
    awaits_ = false;
    add(direct_length_, lit ? direct_.light : Spectrum(), direct_.luminaire);
    if (lit) sample.sink.next_event(direct_.light, direct_length_, direct_.weight);
  }

  bool goes_on_ = true, exits_subsurface_ = false, awaits_ = false;
  int direct_length_ = 0;
  int bends_ = 0;               ///< how often it was sent both ways; as often as can be: it met something else
  float whole_ = 0, part_ = 1;  ///< see come_together
  int lane_ = -1;               ///< the place of a branch's only wavelength among the path's; -1: it has all
  DirectLight direct_;
  const Arena::Mark memory_;
  const bool one_luminaire_;
};

}  // namespace etendue
