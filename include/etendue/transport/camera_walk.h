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
// Light of add_direct waits for its shadow ray, which is asked together with the next segment: next_vertex must be called once
// more (after `end`, too) before `radiance` is whole.

#include "etendue/transport/direct_light.h"
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
    this->gathers = true;
    this->watched = sample.observe.features || sample.observe.record;
    if (!clear && scene.has_interiors()) media_at(scene, ray.origin, ray.time, this->media);
  }

  Spectrum radiance;  ///< L, as far as it is gathered
  Spectrum earlier;   ///< of it, what has not come along the last segment: once the walk has ended, the rest tells what a
                      ///< direction brought

  /// Goes to the next vertex and adds the light of luminaires it meets, each with `weight(its point)`. False: the walk has
  /// ended, and all that was added has arrived (light of one vertex is settled on the way to the next).
  template <class Weight>
  [[gnu::always_inline]] bool next_vertex(const Weight& weight) {
    if (!goes_on_ || moved_) {
      settle(awaits_ && !(clear && scene.any(direct_.shadow)));
      earlier = radiance;
      if (!moved_) return false;
      moved_ = goes_on_ = false;  // it came to the vertex through a body
      sample.observe.surface(vertex.point, throughput);
      return true;
    }
    if ((length & 31) == 31 && sample.aborted()) return false;
    sample.arena.rewind(memory_);  // of earlier vertices nothing is needed any more
    const auto [blocked, found] = scene.any_and_nearest(clear && awaits_ ? &direct_.shadow : nullptr, ray, this->hit);
    settle(!blocked);
    earlier = radiance;
    goes_on_ = false;
    if (!this->come_to_vertex(found, Listener<Weight>{*this, weight})) return false;
    if (vertex.in_medium()) {
      sample.observe.medium(vertex.point.position, throughput);
    } else if (vertex.on_surface()) {
      sample.observe.surface(vertex.point, throughput);
      if (length == 1)
        sample.observe.first_surface(scene, vertex.point, this->hit, vertex.scatter, vertex.out, sample.wavelengths,
                                     this->crossed);
      if (vertex.point.object->luminaire()) add_luminaire(weight);
    } else {
      for (const SceneObject* far : scene.infinite_luminaires()) {
        far->surface_point(ray, this->hit, vertex.point);
        sample.observe.escape(*far, ray, throughput);
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
    if (!vertex.scatters_smoothly() || !propose_direct_light(lights, vertex, ray.time, sample.wavelengths, u.light_choice,
                                                             u.light_point, heuristic, direct_, scattering))
      return;
    direct_.light *= throughput;
    if constexpr (!clear) {
      MediumStack scratch;
      NumberStream way = numbers.fork("shadow", std::uint32_t(length));
      direct_.light *= visible_fraction(scene, direct_.shadow, media_towards(vertex, direct_.shadow.direction, scratch),
                                        sample.wavelengths, way, sample.arena);
      if (direct_.light.black()) return;
    }
    awaits_ = true;
    direct_length_ = length + 1;
  }

  /// The same where the surface itself, or the medium, chooses the direction.
  [[gnu::always_inline]] void add_direct(const LightSampler& lights, const NumberStream::Bounce& u, Heuristic heuristic) {
    add_direct(lights, u, heuristic, ScatteringOf{vertex});
  }

  /// Goes on from the last vertex; false: it is absorbed there.
  [[gnu::always_inline]] bool scatter(const NumberStream::Bounce& u) {
    const std::optional<ScatterSample> next = this->sample_direction(u.lobe_choice, u.direction);
    return next && go_on(*next);
  }
  /// The same in a direction that was chosen already: by `sample_direction`, or by somebody else (scattered_towards).
  [[gnu::always_inline]] bool go_on(const ScatterSample& next) {
    sample.observe.scattered(next);
    if (!clear && next.lobe == pass_through) {
      this->pass_on(next);
      return goes_on_ = true;
    }
    if (vertex.on_surface() && !vertex.moved && enters_body(vertex.point, next))
      return moved_ = goes_on_ = this->leave_body(next);
    this->leave(next);
    return goes_on_ = true;
  }

  /// Lets it end after all.
  void end() { goes_on_ = moved_ = false; }

 private:
  template <class Weight>
  struct Listener {
    CameraWalk& walk;
    const Weight& weight;
    void emitted(const Spectrum& light) const { walk.add(walk.length, light); }
    void crossed_luminaire() const {
      walk.sample.observe.surface(walk.vertex.point, walk.throughput);
      walk.add_luminaire(weight);
    }
  };

  [[gnu::always_inline]] void add(int segments, const Spectrum& light) {
    radiance += light;
    sample.observe.light(segments, light);
  }

  template <class Weight>
  void add_luminaire(const Weight& weight) {
    const Spectrum light =
        throughput * vertex.point.object->emission->radiance(vertex.point, -ray.direction, sample.wavelengths);
    if (light.black()) return;
    const float w = weight(vertex.point);
    add(length, light * w);
    sample.observe.met(light * w, length, w);
  }

  /// Adds the light that waited for its shadow ray. Whether it comes cannot be guessed, so nothing hangs on it.
  [[gnu::always_inline]] void settle(bool lit) {
    if (!awaits_) return;
    awaits_ = false;
    add(direct_length_, lit ? direct_.light : Spectrum());
    if (lit) sample.observe.sampled(direct_.light, direct_length_, direct_.weight);
  }

  bool goes_on_ = true, moved_ = false, awaits_ = false;
  int direct_length_ = 0;
  DirectLight direct_;
  const Arena::Mark memory_;
  const bool one_luminaire_;
};

}  // namespace etendue
