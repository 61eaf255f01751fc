#pragma once
// PolarizedWalk: a walk from the camera that gathers polarized light.
//
// The Stokes vector of the light along a camera ray is a sum over the vertices x_k of the walk,
//     L = sum_k M_1 M_2 ... M_k [ w_k E(x_k) + direct(x_k) ],
// where M_i is the Mueller matrix of vertex x_i times |cos| / p of the sampled direction, in the order in which the path meets
// the vertices, which is opposite to that of the light. Luminaires emit unpolarized light: E = (L_e, 0, 0, 0), so only the
// first column of the product counts in the end. The walk stores the product as
//     T P,    P_00 = 1,
// with the throughput T of unpolarized light (Walk::throughput), and P in MuellerProduct. At each vertex T is multiplied by
// f |cos| / p, as in every walk, and by the factor (P M / f)_00 that polarization contributes: it is 0 between crossed
// polarizers, and 2 between parallel ones. Directions, distances, luminaires and weights of multiple importance sampling are
// those of CameraWalk, so with surfaces that depolarize both estimate the same with the same noise.
//
// Plates that light passes straight on (null scattering), such as polarizing filters, take part on segments and shadow rays.

#include "etendue/polarizing_scatter.h"
#include "etendue/transport/direct_light.h"
#include "etendue/transport/light_groups.h"
#include "etendue/transport/visibility.h"
#include "etendue/transport/walk.h"

namespace etendue {

class PolarizedWalk : public Walk<false> {
 public:
  /// `x`: the camera's reference direction, perpendicular to the ray.
  PolarizedWalk(const Scene& scene_, SampleContext& sample_, const Ray& ray_, int longest_, const Vector3& x)
      : Walk(scene_, sample_, ray_, longest_),
        product_(x),
        memory_(sample_.arena.mark()),
        one_luminaire_(scene_.luminaires().size() == 1) {
    collects_light = true;
    observed = sample.sink.record;
    if (scene.has_interiors()) media_at(scene, ray.origin, ray.time, media);
  }

  Spectrum radiance;  ///< S0 of what is gathered; S1 to S3 are reported to the film (LightParts::add_stokes)

  /// Moves to the next vertex and adds emitter hits, each with the weight `weight(point on the emitter)`. False: the walk has
  /// ended.
  template <class Weight>
  bool next_vertex(const Weight& weight) {
    if (exits_subsurface_) {  // the vertex is a subsurface exit, to which no ray leads
      exits_subsurface_ = goes_on_ = false;
      sample.sink.surface(vertex.point, throughput);
      return true;
    }
    if (!goes_on_ || ((length & 31) == 31 && sample.aborted())) return false;
    sample.arena.rewind(memory_);
    goes_on_ = false;
    if (!come_to_vertex(scene.nearest(ray, hit), Events<Weight>{{}, *this, weight})) return false;
    if (vertex.in_medium()) {
      sample.sink.medium(vertex.point.position, throughput);
    } else if (vertex.on_surface()) {
      sample.sink.surface(vertex.point, throughput);
      if (vertex.point.object->luminaire()) add_luminaire(weight);
    } else {
      for (const SceneObject* far : scene.infinite_luminaires(ray)) {
        far->surface_point(ray, hit, vertex.point);
        sample.sink.escape(*far, ray, throughput);
        add_luminaire(weight);
      }
      return false;
    }
    return true;
  }

  /// Whether the path has its maximum length.
  bool at_end() const { return length >= longest; }
  /// Ends the walk at its last vertex.
  void end() { goes_on_ = exits_subsurface_ = false; }
  /// The primary samples for the last vertex.
  NumberStream::Bounce next_bounce() {
    return numbers.next_bounce(!one_luminaire_, !vertex.scatter || vertex.scatter->has_choice());
  }

  /// Next event estimation: samples a point on a luminaire and adds its light unless the shadow ray is occluded.
  void add_direct(const LightSampler& lights, const NumberStream::Bounce& u, Heuristic heuristic) {
    DirectLight direct;
    if (!vertex.scatters_smoothly() || !sample_next_event(scene, lights, vertex, ray.time, sample.wavelengths, u.light_choice,
                                                          u.light_point, heuristic, direct, ScatteringOf{vertex}))
      return;
    const Vector3 in = normalize(direct.shadow.direction);
    Beyond plates(in);
    MediumStack scratch;
    NumberStream way = numbers.fork("shadow", std::uint32_t(length));
    Spectrum light = throughput * direct.light;
    const MediumStack* const around = media_towards(vertex, direct.shadow.direction, scratch);
    light *= scene.has_null_surfaces()
                 ? shadow_transmittance_slowly(scene, direct.shadow, around, sample.wavelengths, way, sample.arena, plates)
                 : shadow_transmittance(scene, direct.shadow, around, sample.wavelengths, way, sample.arena);
    if (light.black()) return;
    MuellerProduct product = product_;
    light *= append_vertex(product, in, smooth_lobes);
    if (plates.any) light *= plates.factor * product.append(plates.product.whole(), -in);
    const PathState matches = follows_paths() ? PathStates::current()->ended(path_after(in), direct.luminaire) : PathState{};
    add(length + 1, light, product, direct.luminaire, matches);
    sample.sink.next_event(light, length + 1, direct.weight);
  }

  /// The multiple importance sampling weight of an emitter hit against next event estimation at the vertex before.
  float emitter_hit_weight(const LightSampler& lights, Heuristic heuristic, const SurfacePoint& luminaire) const {
    if (arrived_specularly) return 1;
    return heuristic_weight(heuristic, direction_pdf,
                            next_event_direction_pdf(lights, from, from_normal, ray.direction, luminaire));
  }

  /// Samples the direction in which the walk leaves its last vertex: T P *= M |cos| / p. False: the walk is absorbed.
  bool scatter(const NumberStream::Bounce& u) {
    const std::optional<ScatterSample> next = sample_direction(u.lobe_choice, u.direction);
    if (!next) return false;
    sample.sink.scattered(*next);
    const Lobes lobes = next->specular() ? Lobes(next->lobe) : smooth_lobes;
    if (next->lobe == null_scattering) {
      const Spectrum factor = append_vertex(product_, next->direction, lobes);
      pass_on(*next);
      throughput *= factor;
      return goes_on_ = true;
    }
    if (follows_paths()) [[unlikely]]
      path_ = path_after(next->direction, next->lobe);
    if (vertex.on_surface() && !vertex.subsurface_exit && enters_subsurface(vertex.point, *next)) {
      throughput *= append_vertex(product_, next->direction, lobes);
      if (!subsurface_exit_found(*next)) return false;
      product_.append_depolarizer(vertex.out);
      return exits_subsurface_ = goes_on_ = true;
    }
    const Spectrum factor = append_vertex(product_, next->direction, lobes);
    leave(*next);
    throughput *= factor;
    return goes_on_ = true;
  }

 private:
  /// The plates that a shadow ray passes, as one event that light leaves to the vertex.
  struct Beyond final : NullCrossings {
    explicit Beyond(const Vector3& in) : product(any_perpendicular(in)) {}
    void crossed(const Scatter& scatter, const Vector3& out) override {
      factor *= append(product, scatter, out, -out, null_scattering);
      any = true;
    }
    MuellerProduct product;
    Spectrum factor{1.0f};
    bool any = false;
  };

  template <class Weight>
  struct Events : NoEvents {
    PolarizedWalk& walk;
    const Weight& weight;
    void emitted(const Spectrum& light) const {
      const PathState matches =
          walk.follows_paths() ? PathStates::current()->ended(walk.path_, nullptr, walk.media.current()) : PathState{};
      walk.add(walk.length, light, walk.product_, nullptr, matches);
    }
    void crossed_luminaire() const {
      walk.sample.sink.surface(walk.vertex.point, walk.throughput);
      walk.add_luminaire(weight);
    }
    void passed() const {
      walk.throughput *= append(walk.product_, *walk.vertex.scatter, walk.vertex.out, -walk.vertex.out, null_scattering);
    }
  };

  /// Appends the event of a surface. Returns the factor of the throughput.
  static Spectrum append(MuellerProduct& product, const Scatter& scatter, const Vector3& out, const Vector3& in, Lobes lobes) {
    Polarization event;
    if (polarization_of(scatter, out, in, lobes, event)) return product.append(event, out);
    product.append_depolarizer(in);
    return Spectrum(1.0f);
  }
  /// The same at the last vertex.
  Spectrum append_vertex(MuellerProduct& product, const Vector3& in, Lobes lobes) const {
    if (!vertex.in_medium()) return append(product, *vertex.scatter, vertex.out, in, lobes);
    Polarization event;
    const auto* polarizing = dynamic_cast<const PolarizingVolume*>(vertex.medium.volume);
    if (polarizing && polarizing->polarization(vertex.out, in, event)) return product.append(event, vertex.out);
    product.append_depolarizer(in);
    return Spectrum(1.0f);
  }

  void add(int segments, const Spectrum& light, const MuellerProduct& product, const SceneObject* luminaire,
           PathState matches) {
    radiance += light;
    report_light(sample.sink, segments, light, luminaire, matches);
    if (!sample.sink.lengths.empty())
      LightParts::add_stokes(light * product.stokes(1), light * product.stokes(2), light * product.stokes(3));
  }
  template <class Weight>
  void add_luminaire(const Weight& weight) {
    const SceneObject& luminaire = *vertex.point.object;
    const Spectrum light = throughput * luminaire.emission->radiance(vertex.point, -ray.direction, sample.wavelengths);
    if (light.black()) return;
    const float mis_weight = weight(vertex.point);
    const PathState matches = follows_paths() ? PathStates::current()->ended(path_, &luminaire, nullptr) : PathState{};
    add(length, light * mis_weight, product_, &luminaire, matches);
    sample.sink.emitter_hit(light * mis_weight, length, mis_weight);
  }

  /// Whether there are light path expressions.
  bool follows_paths() const { return !sample.sink.lengths.empty() && PathStates::current(); }
  PathState path_after(const Vector3& in, Lobe lobe = diffuse_reflection) const {
    return PathStates::current()->scattered(path_, vertex, in, lobe);
  }

  MuellerProduct product_;  ///< P
  bool goes_on_ = true, exits_subsurface_ = false;
  PathState path_ = path_after_camera;  ///< used with light path expressions alone
  const Arena::Mark memory_;
  const bool one_luminaire_;
};

}  // namespace etendue
