#pragma once
// Walk: a random walk that traces a subpath vertex by vertex, from the camera or from a luminaire.
//
// At each vertex x_k a direction w is sampled with the pdf p(w) [1/sr], and a ray in that direction leads to the next vertex
// x_{k+1}, on a surface or at a scattering event in a medium. The walk carries the throughput T: the product of all factors of
// the subpath's contribution, over the pdf of the subpath (Veach 1997, section 8.2; alpha in section 10.1). Each factor is
// multiplied in one place:
//     T_0                        what the walk starts with: 1 from the camera, L_e |cos| / pdf from a luminaire
//                                (EmittedLight::throughput)
//     f |cos| / p                in `leave`, on a surface: ScatterSample::weight; 1 in a medium, where p is the phase function
//     s_s Tr / p(t)  or  Tr / P  in `come_to_vertex`, where a medium scatters at the distance t, or lets the walk through with
//                                probability P (transport/medium.h); s_s is the scattering coefficient, Tr the transmittance
//     Phi / (q p) or 1 / (1 - q)  at fluorescent surfaces, as a part of f, and at dyes in media (fluorescence.h)
//     n / q  or  1 / (1 - q)     in `passes`, at a null-scattering surface that lets the fraction n through
//     1 / q                      in Roulette, for a walk that survives with probability q (transport/roulette.h)
// So T_k times the radiance that x_k emits towards x_{k-1} is an estimate of radiance along the camera ray, and from a
// luminaire T_k is the flux [W/nm] that the subpath carries to x_k.
//
// Some events on the way are not vertices: media through which the walk passes, boundaries that are hidden because they lie
// inside an object of higher priority (boundaries.h), and null scattering. (With `collects_light` a null-scattering surface
// that has smooth lobes too is a vertex first, where light is gathered; null scattering is then one of its lobes, after which
// `pass_on` continues the segment.) Otherwise, at a surface with null scattering and other lobes,
// the walk passes with the probability q, the fraction n that is let through (or the ratio of n to the whole albedo, where n is
// 1 or more and light is scattered as well), and both outcomes are weighted by the inverse of their probability.

#include "etendue/transport/boundaries.h"
#include "etendue/transport/fluorescence.h"
#include "etendue/transport/path_vertex.h"
#include "etendue/transport/sample_context.h"

namespace etendue {

/// Events along the segments of a walk; by default they are ignored. A derived class hides the functions that it needs (calls
/// are resolved at compile time).
struct NoEvents {
  /// Media on the segment emit light towards its origin: an estimate of that radiance, times the throughput.
  void emitted(const Spectrum&) const {}
  /// The walk passes an emitter whose surface only scatters null: the vertex lies on it during the call.
  void crossed_luminaire() const {}
  /// The walk passes a surface by null scattering: the vertex lies on it during the call. Called after crossed_luminaire.
  void passed() const {}
  /// The walk enters a medium, along its ray from the origin and up to this distance [m] unless it is scattered before.
  void through(const Medium&, float) const {}
};

// All functions are inlined into each algorithm, so that the state of the walk stays in registers: measured, this saves a tenth
// of the time of simple scenes.
/// `unattenuated`: the scene has neither media nor null-scattering surfaces (Scene::has_interiors, has_null_surfaces), and the
/// code for them is left out. False is always correct.
template <bool unattenuated>
class Walk {
 public:
  /// `longest_`: the maximum length in segments. `initial_throughput_`: T_0.
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
        tracks_(!unattenuated && scene_.has_interiors()),
        null_surfaces_(!unattenuated && scene_.has_null_surfaces()) {}
  Walk(const Walk&) = delete;  // its vertex points to its media
  Walk& operator=(const Walk&) = delete;

  const Scene& scene;
  SampleContext& sample;
  NumberStream& numbers;  ///< those of `sample`
  Ray ray;                ///< of the next segment
  Spectrum throughput;    ///< T
  MediumStack media;      ///< the objects around the ray's origin; the code that starts the walk fills it (media_at)
  const int longest;
  const Transport transport;

  PathVertex vertex;               ///< the last vertex. Its `media` points to the walk's own stack, which `leave` changes; with
                                   ///< `stores_subpath`, to a copy in the arena
  int length = 0;                  ///< segments so far
  float direction_pdf = 0;         ///< [1/sr] of the last segment's direction; after a specular lobe a probability
  bool arrived_specularly = true;  ///< whether a specular lobe sampled that direction; true on the first segment, too
  Point3 from;                     ///< the vertex before, as the reference point of the pdf of next event estimation
  Normal3 from_normal;
  Spectrum segment_transmittance;   ///< of the last segment, for pdfs: of its null-scattering surfaces, and with
                                    ///< `stores_subpath` also of its media (weighting_transmittance)
  float null_crossed_distance = 0;  ///< distance from the start of the last segment to the last boundary it crossed [m]
  Hit hit;                          ///< the intersection with the last surface

  /// For a branch that follows one wavelength: the number of branches that the walk was split into. The throughput of each is
  /// smaller by this factor.
  float branches = 1;
  /// For a branch of a split walk (CameraWalk::split): a survival probability that Roulette has yet to apply; 1: none.
  float pending_survival = 1;

  /// The throughput relative to the initial one, for Russian roulette (of a camera walk that is 1). Excludes the factor eta^2
  /// of refraction, which the way out of the medium takes back, and the weight of splitting.
  float roulette_weight() const {
    if (transport == Transport::radiance) return throughput.maximum() * eta_squared_ * branches;
    float most = 0;
    for (int i = 0; i < spectrum_size; ++i)
      if (initial_throughput[i] > 0) most = std::max(most, throughput[i] / initial_throughput[i]);
    return most;
  }

  /// Follows the ray to the next vertex, and multiplies T by the weights of the media and null-scattering surfaces on the way.
  /// `found` is the result of Scene::nearest for the ray, which filled `hit`. False: the walk has ended.
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
          if (reradiates_in_media && (length < longest || stores_subpath)) [[unlikely]] {
            const DyeFlight flight = sample_dye(medium, ray, reach, throughput, sample, step());
            throughput *= flight.weight;
            if (throughput.black()) return false;
            if (flight.absorbed) {
              level = step().next();
              return scattered_in(emitting_dye(medium), ray(flight.distance));
            }
          }
          if (attenuates_only) {
            throughput *= transmittance(medium, ray, reach, sample.wavelengths, numbers);
            if (throughput.black()) return false;
          } else {
            const FreeFlight flight = sample_free_flight(medium, ray, reach, throughput, sample.wavelengths, numbers);
            if (!flight.emitted.black()) events.emitted(throughput * flight.emitted);
            // s_s Tr / p(t) if the medium scatters, Tr / P if not.
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
      // A surface at the end of the last segment contributes only if it is an emitter.
      if (unattenuated && length >= longest && !observed && hit.depth == 0 && !hit.object->luminaire()) return false;
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
      // Where light is gathered, null scattering becomes one of the lobes that are sampled after next event estimation
      // (pass_on).
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

  /// At a fluorescent surface chooses elastic scattering or reradiation, which changes the wavelengths of the sample. Call it
  /// once at each vertex, after its own emission was added and before its scattering is used.
  [[gnu::always_inline]] void choose_reradiation() {
    if (unattenuated || !reradiates) return;
    if (!vertex.on_surface() || vertex.subsurface_exit) return;
    const ChosenScatter chosen =
        etendue::choose_reradiation(vertex.point, vertex.out, vertex.scatter, throughput, sample, step());
    vertex.scatter = chosen.scatter;
    if (chosen.reradiates) level = step().next();
  }

  /// Samples the direction in which the walk leaves its last vertex: `choice` selects the lobe, `u` the direction within it.
  /// Empty: absorbed.
  [[gnu::always_inline]] std::optional<ScatterSample> sample_direction(float choice, Point2 u) const {
    if (vertex.in_medium()) {
      ScatterSample next;
      next.direction = vertex.medium.sample_phase(vertex.point.position, vertex.point.time, vertex.out, u, next.pdf);
      // phase / p = 1.
      next.weight = Spectrum(1.0f);
      return next;
    }
    if (!vertex.scatter) return std::nullopt;
    return vertex.scatter->sample(vertex.out, choice, u, {transport, vertex.lobes});
  }

  /// Leaves the last vertex in a sampled direction: T *= f |cos| / p, and the ray of the next segment starts there.
  [[gnu::always_inline]] void leave(const ScatterSample& next) {
    throughput *= next.weight;
    if (next.dispersive) throughput *= sample.wavelengths.drop_secondary();
    eta_squared_ *= next.eta * next.eta;
    direction_pdf = next.pdf;
    from = vertex.point.position;
    from_normal = vertex.normal();
    // Member by member: a copy of a ray that was just written would wait for the writes (a store-forwarding stall).
    ray.direction = next.direction;
    ray.maximum = infinity;
    ray.of_camera = false;
    if (!unattenuated && vertex.in_medium()) {
      arrived_specularly = false;
      ray.origin = from;
      return;
    }
    arrived_specularly = next.specular();
    if (tracks_ && next.transmitted()) cross_boundary(media, *vertex.point.object, vertex.point.normal, next.direction);
    ray.origin = vertex.point.exit(next.direction);
    ray.width = vertex.point.footprint;
  }

  /// Continues through the last vertex by null scattering. The surface is then not a vertex: the segment that led to it goes
  /// on, and direction_pdf, arrived_specularly and from stay those of its start.
  void pass_on(const ScatterSample& next) {
    throughput *= next.weight;
    segment_transmittance *= next.weight;
    cross();
    passing_ = true;
    ++crossings_;
  }

  /// For a sample that enters an object with subsurface scattering: moves the vertex to a sampled exit point
  /// (Shader::sample_exit). The way inside counts as one segment. False: there is no exit, or the path is too long.
  bool subsurface_exit_found(const ScatterSample& next) {
    throughput *= next.weight;
    if (next.dispersive) throughput *= sample.wavelengths.drop_secondary();
    const std::optional<SubsurfaceExit> exit =
        vertex.point.object->shader->sample_exit(vertex.point, scene, sample.wavelengths, numbers, sample.arena);
    if (!exit || !exit->scatter || ++length >= longest) return false;
    throughput *= exit->weight;
    // The path leaves on the side of the surface from which it entered.
    const bool front = dot(vertex.point.normal, vertex.out) > 0;
    vertex.point = exit->point;
    if (tracks_) vertex.point.media = vertex.media;
    vertex.scatter = exit->scatter;
    vertex.out = Vector3(front ? vertex.point.normal : -vertex.point.normal);
    vertex.subsurface_exit = true;
    return true;
  }

  /// Whether the vertices are stored with their pdfs (subpath.h): each then has a copy of the medium stack, and
  /// segment_transmittance includes the media.
  bool stores_subpath = false;
  /// Whether light is gathered at vertices, as by next event estimation: a null-scattering surface that also has smooth lobes
  /// is then always a vertex.
  bool collects_light = false;
  /// Whether media only attenuate the walk, which then scatters at surfaces alone: the algorithm gathers the light that media
  /// scatter along the segments (Events::through). Emission of media is ignored.
  bool attenuates_only = false;
  /// Whether the walk follows fluorescence: of surfaces (`choose_reradiation`), and of dyes in media. Without, it is elastic
  /// alone. A walk from a luminaire must have `levels`.
  bool reradiates = false, reradiates_in_media = false;
  /// The wavelengths that were drawn for all walks of a sample, and the level at which this one stands (fluorescence.h). Null:
  /// new wavelengths are sampled at each reradiation.
  const WavelengthLevels* levels = nullptr;
  int level = 0;
  /// Whether the end of the last segment is needed even if it is not an emitter, for the record of a path.
  bool observed = false;

 protected:
  /// A branch of a split walk: it starts at the last vertex of that walk.
  Walk(const Walk& walk, SampleContext& own)
      : scene(walk.scene),
        sample(own),
        numbers(own.numbers),
        ray(walk.ray),
        throughput(walk.throughput),
        media(walk.media),
        longest(walk.longest),
        transport(walk.transport),
        vertex(walk.vertex),
        length(walk.length),
        branches(walk.branches),
        stores_subpath(walk.stores_subpath),
        collects_light(walk.collects_light),
        attenuates_only(walk.attenuates_only),
        reradiates(walk.reradiates),
        reradiates_in_media(walk.reradiates_in_media),
        levels(walk.levels),
        level(walk.level),
        observed(walk.observed),
        initial_throughput(walk.initial_throughput),
        eta_squared_(walk.eta_squared_),
        tracks_(walk.tracks_),
        null_surfaces_(walk.null_surfaces_) {}

  /// roulette_weight with the mean over the wavelengths in place of the maximum.
  float mean_roulette_weight() const { return throughput.average() * eta_squared_ * branches; }

 private:
  WavelengthStep step() const { return {levels, level, transport}; }

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
    ray.maximum -= hit.distance;  // a camera ray may have a far clipping plane (Camera::Reach)
    ray.origin = vertex.point.exit(ray.direction);
    ray.width = vertex.point.footprint;
  }

  /// At a null-scattering surface: whether the walk passes it, with probability q. If not, the surface is the next vertex.
  /// Either way T is divided by the probability of the outcome.
  template <class Events>
  bool passes(const Events& events) {
    const Scatter& scatter = *vertex.scatter;
    const auto straight = scatter.sample(vertex.out, 0, {}, {transport, null_scattering});
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
    events.passed();
    cross();
    return true;
  }

  const Spectrum initial_throughput;
  float eta_squared_ = 1;
  int crossings_ = 0;     // boundaries crossed on the last segment
  bool passing_ = false;  // the last segment goes on (pass_on)
  const bool tracks_, null_surfaces_;
};

}  // namespace etendue
