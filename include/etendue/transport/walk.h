#pragma once
// A walk: a path that grows vertex by vertex, from the camera or from a luminaire.
//
// From a vertex x_k a walk leaves in a direction w chosen with density p(w), and comes to x_{k+1} where the ray meets matter
// that scatters. With T_0 what it begins with,
//     T_{k+1} = T_k f |cos| / p       on a surface,
//     T_{k+1} = T_k (phase / p)       in a medium, whose part of getting there is in T already (transport/medium.h),
// is radiance (from the camera) or importance (from a luminaire) over the density of the whole walk (Veach 1997, section 8.2).
//
// One walk goes through everything that is no vertex: media, which may scatter it on the way; boundaries that mean nothing
// since they lie within something of higher priority; surfaces that let it pass straight on. There the walk goes on with a
// probability q, the part of light that does (or its share of all, where more light than came is scattered as well), and both
// outcomes are made up for: a walk that passes has T changed by (the fraction that passes) / q, and one that stays by 1 / (1 -
// q).

#include "etendue/transport/boundaries.h"
#include "etendue/transport/path_vertex.h"
#include "etendue/transport/sample_context.h"

namespace etendue {

/// Who listens to a walk: nothing happens unless it is overridden, by hiding the function.
struct NoEvents {
  /// Light that media send from the next segment to its origin, as the walk brings it.
  void emitted(const Spectrum&) const {}
  /// A luminaire that the walk passes straight through is the vertex, for a moment.
  void crossed_luminaire() const {}
  /// It goes into a medium, along its ray from the origin and as far as this distance [m], unless it is scattered before.
  void through(const Medium&, float) const {}
};

// Its functions are inlined where they are called, once in each algorithm, so that its state stays in registers: measured, a
// tenth of the time of simple scenes.
/// `clear`: the scene has neither media nor boundaries that light passes through (Scene::has_interiors, has_null_surfaces);
/// what deals with them is left out. False is always right.
template <bool clear>
class Walk {
 public:
  /// `longest`: the segments after which it ends. `throughput`: T_0.
  Walk(const Scene& scene_, SampleContext& sample_, const Ray& ray_, int longest_, Transport transport_ = Transport::radiance,
       const Spectrum& initial_throughput_ = Spectrum(1.0f))
      : scene(scene_),
        sample(sample_),
        numbers(sample_.numbers),
        ray(ray_),
        throughput(initial_throughput_),
        longest(longest_),
        transport(transport_),
        initial_throughput(initial_throughput_),
        tracks_(!clear && scene_.has_interiors()),
        null_surfaces_(!clear && scene_.has_null_surfaces()) {}
  Walk(const Walk&) = delete;  // its vertex points to its media
  Walk& operator=(const Walk&) = delete;

  const Scene& scene;
  SampleContext& sample;
  NumberStream& numbers;  ///< the sample's
  Ray ray;                ///< along which it goes next
  Spectrum throughput;    ///< T
  MediumStack media;      ///< around the ray's origin; where a walk begins, its maker fills it (media_at)
  const int longest;
  const Transport transport;

  PathVertex vertex;        ///< the last. Its `media` are the walk's own, unless it `keeps`: theirs until `leave`
  int length = 0;           ///< segments so far
  float direction_pdf = 0;  ///< [1/sr] of the last segment's direction, as scattering chose it
  bool specular = true;     ///< whether a specular lobe chose it, or nobody: it is the first
  Point3 from;              ///< the vertex before, for densities as seen from there
  Normal3 from_normal;
  Spectrum segment_transmittance;   ///< what surfaces on the last segment let through, and if it `keeps`, media, likely: for
                                    ///< densities
  float null_crossed_distance = 0;  ///< distance to the last boundary passed straight on [m], of the last segment
  Hit hit;                          ///< of the last surface

  /// A branch that follows one wavelength: among how many of them the walk was divided. Each carries so much less.
  float branches = 1;
  /// Of a branch (CameraWalk::divide): the probability by which Roulette has yet to let it go on; 1: none.
  float pending_survival = 1;

  /// What is left of what it began with, without the change of radiance by refraction, which comes back, and by division.
  float roulette_weight() const {
    if (transport == Transport::radiance) return throughput.maximum() * eta_squared_ * branches;
    float most = 0;
    for (int i = 0; i < spectrum_size; ++i)
      if (initial_throughput[i] > 0) most = std::max(most, throughput[i] / initial_throughput[i]);
    return most;
  }

  /// Goes along the ray to the next vertex; `found` is what the scene said of it, with `hit` filled. False: the walk has ended.
  template <class Events>
  [[gnu::always_inline]] bool come_to_vertex(bool found, const Events& events) {
    if (!passing_) {
      ++length;
      segment_transmittance = Spectrum(1.0f);
      null_crossed_distance = 0;
      crossings_ = 0;
    }
    passing_ = false;
    for (; crossings_ <= most_crossings; found = scene.nearest(ray, hit), ++crossings_) {
      if (tracks_)
        if (const Medium medium = medium_in(media)) {
          const float reach = found ? hit.distance : std::min(ray.maximum, within_object(medium, ray));
          events.through(medium, reach);
          if (attenuates_only) {
            throughput *= transmittance(medium, ray, reach, sample.wavelengths, numbers);
            if (throughput.black()) return false;
          } else {
            const FreeFlight flight = sample_free_flight(medium, ray, reach, throughput, sample.wavelengths, numbers);
            if (!flight.emitted.black()) events.emitted(throughput * flight.emitted);
            throughput *= flight.weight;
            if (throughput.black()) return false;
            if (stores_subpath)
              segment_transmittance *= weighting_transmittance(medium, ray, flight.distance, sample.wavelengths);
            if (flight.scattered) return scattered_in(medium, ray(flight.distance));
          }
        }
      vertex.out = -ray.direction;
      if (!found) {
        vertex.kind = PathVertex::Kind::escape;
        return true;
      }
      // What the last segment meets matters only if it shines.
      if (clear && length >= longest && !observed && hit.depth == 0 && !hit.object->luminaire()) return false;
      vertex.kind = PathVertex::Kind::surface;
      vertex.subsurface_exit = false;
      vertex.scatter = nullptr;
      scene.locate(ray, hit, vertex.point);
      if (tracks_) {
        resolve_coincident(scene, ray, hit, vertex.point, media);
        if (hidden_by_priority(media, *vertex.point.object)) {
          cross();
          continue;
        }
        vertex.point.media = vertex.media = stores_subpath ? sample.arena.make<MediumStack>(media) : &media;
      }
      if (length < longest || observed || null_surfaces_)
        vertex.scatter = scattering_at(vertex.point, vertex.out, sample.wavelengths, sample.arena);
      vertex.lobes = vertex_lobes;
      if (!null_surfaces_ || !vertex.scatter || !vertex.scatter->has(null_scattering)) return true;
      if (collects_light && length < longest && vertex.scatter->has(smooth_lobes)) {
        vertex.lobes = all_lobes;
        return true;
      }
      if (!passes(events)) return true;
    }
    return false;
  }
  template <class Events = NoEvents>
  bool next_vertex(const Events& events = {}) {
    return come_to_vertex(scene.nearest(ray, hit), events);
  }

  /// Chooses where the walk goes on from its last vertex: by `choice` among lobes, by `u` among directions. Empty: absorbed.
  [[gnu::always_inline]] std::optional<ScatterSample> sample_direction(float choice, Point2 u) const {
    if (vertex.in_medium()) {
      ScatterSample s;
      s.direction = vertex.medium.sample_phase(vertex.point.position, vertex.point.time, vertex.out, u, s.pdf);
      s.weight = Spectrum(1.0f);
      return s;
    }
    if (!vertex.scatter) return std::nullopt;
    return vertex.scatter->sample(vertex.out, choice, u, transport, vertex.lobes);
  }

  /// Goes on in such a direction.
  [[gnu::always_inline]] void leave(const ScatterSample& next) {
    throughput *= next.weight;
    if (next.dispersive) throughput *= sample.wavelengths.drop_secondary();
    eta_squared_ *= next.eta * next.eta;
    direction_pdf = next.pdf;
    from = vertex.point.position;
    from_normal = vertex.normal();
    // Member by member: copying a ray just written stalls for its parts to reach memory.
    ray.direction = next.direction;
    ray.maximum = infinity;
    ray.of_camera = false;
    if (!clear && vertex.in_medium()) {
      specular = false;
      ray.origin = from;
      return;
    }
    specular = next.specular();
    if (tracks_ && next.transmitted()) cross_boundary(media, *vertex.point.object, vertex.point.normal, next.direction);
    ray.origin = vertex.point.exit(next.direction);
    ray.width = vertex.point.footprint;
  }

  /// Goes straight on through the surface of the last vertex, which is then none: the last direction stays the one that was
  /// chosen.
  void pass_on(const ScatterSample& next) {
    throughput *= next.weight;
    segment_transmittance *= next.weight;
    cross();
    passing_ = true;
    ++crossings_;
  }

  /// Of light that goes into a body which scatters it: comes to where it leaves again. The way inside is one segment. False: it
  /// does not.
  bool subsurface_exit_found(const ScatterSample& next) {
    throughput *= next.weight;
    if (next.dispersive) throughput *= sample.wavelengths.drop_secondary();
    const std::optional<SubsurfaceExit> exit =
        vertex.point.object->shader->sample_exit(vertex.point, scene, sample.wavelengths, numbers, sample.arena);
    if (!exit || !exit->scatter || ++length >= longest) return false;
    throughput *= exit->weight;
    // It leaves on the side it came in on.
    const bool front = dot(vertex.point.normal, vertex.out) > 0;
    vertex.point = exit->point;
    if (tracks_) vertex.point.media = vertex.media;
    vertex.scatter = exit->scatter;
    vertex.out = Vector3(front ? vertex.point.normal : -vertex.point.normal);
    vertex.subsurface_exit = true;
    return true;
  }

  /// Whether vertices are kept, with densities: what lies around them is then, too, and what media let through is asked for.
  bool stores_subpath = false;
  /// Whether light is gathered at vertices.
  bool collects_light = false;
  /// Whether media only weaken it, and it scatters at surfaces alone: someone gathers along the way what media scatter.
  bool attenuates_only = false;
  /// Whether someone wants to know of the last segment's end although it does not shine.
  bool observed = false;

 protected:
  /// A branch that begins at the last vertex of another walk.
  Walk(const Walk& w, SampleContext& own)
      : scene(w.scene),
        sample(own),
        numbers(own.numbers),
        ray(w.ray),
        throughput(w.throughput),
        media(w.media),
        longest(w.longest),
        transport(w.transport),
        vertex(w.vertex),
        length(w.length),
        branches(w.branches),
        stores_subpath(w.stores_subpath),
        collects_light(w.collects_light),
        attenuates_only(w.attenuates_only),
        observed(w.observed),
        initial_throughput(w.initial_throughput),
        eta_squared_(w.eta_squared_),
        tracks_(w.tracks_),
        null_surfaces_(w.null_surfaces_) {}

  /// `left` in the mean over wavelengths.
  float mean_roulette_weight() const { return throughput.average() * eta_squared_ * branches; }

 private:
  bool scattered_in(const Medium& medium, const Point3& at) {
    vertex.kind = PathVertex::Kind::medium;
    vertex.subsurface_exit = false;
    vertex.out = -ray.direction;
    vertex.medium = medium;
    vertex.scatter = nullptr;
    vertex.point.position = at;
    vertex.point.time = ray.time;
    vertex.point.media = vertex.media = stores_subpath ? sample.arena.make<MediumStack>(media) : &media;
    return true;
  }

  void cross() {
    if (tracks_) cross_boundary(media, *vertex.point.object, vertex.point.normal, ray.direction);
    null_crossed_distance += hit.distance;
    ray.maximum -= hit.distance;  // that of a camera may end (Camera::Reach)
    ray.origin = vertex.point.exit(ray.direction);
    ray.width = vertex.point.footprint;
  }

  template <class Events>
  bool passes(const Events& events) {
    const Scatter& scatter = *vertex.scatter;
    const auto straight = scatter.sample(vertex.out, 0, {}, transport, null_scattering);
    const bool alone = scatter.lobes() == null_scattering;
    const Spectrum fraction = straight ? straight->weight : Spectrum();
    const float through = fraction.average();
    const float q = alone         ? 1
                    : through < 1 ? std::max(through, 0.0f)
                                  : through / (through + scatter.albedo(vertex.out, vertex_lobes).average());
    if (q < 1 && numbers.next() >= q) {
      throughput /= 1 - q;
      return false;
    }
    if (alone && vertex.point.object->luminaire()) events.crossed_luminaire();
    throughput *= fraction / q;
    segment_transmittance *= fraction;
    cross();
    return true;
  }

  const Spectrum initial_throughput;
  float eta_squared_ = 1;
  int crossings_ = 0;  // of the last segment
  bool passing_ = false;
  const bool tracks_, null_surfaces_;
};

}  // namespace etendue
