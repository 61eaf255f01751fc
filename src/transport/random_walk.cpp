#include "random_walk.h"

#include "media.h"
#include "medium_tracking.h"
#include "ray_steps.h"
#include "seeded_bug.h"

namespace etendue {
namespace {

class Walk {
 public:
  Walk(const Scene& scene, const WalkStart& start, MediumStack& media, Wavelengths& wavelengths, SampleStream& random,
       Arena& arena, std::vector<Vertex>& path)
      : scene_(scene),
        start_(start),
        media_(media),
        wavelengths_(wavelengths),
        random_(random),
        arena_(arena),
        path_(path),
        ray_(start.ray),
        density_(start.direction_density),
        front_(scene),
        track_(scene.has_interiors()) {}

  void run() {
    while (int(path_.size()) < start_.longest && step() && roulette())
      if (path_.size() % 64 == 0 && start_.sample && start_.sample->aborted()) return;
  }

 private:
  /// From one vertex to the next; false: the walk has ended.
  bool step() {
    Spectrum edge(1.0f);  // transmittance of the edge, for the strategies' densities
    for (int crossings = 0; crossings <= most_crossings && !carried_.black(); ++crossings) {
      Hit hit;
      const bool found = scene_.nearest(ray_, hit);
      if (const VolumeShader* volume = track_ ? volume_of(media_) : nullptr) {
        const float reach = found ? hit.distance : infinity;
        if (start_.emitted && volume->emits())
          (*start_.emitted)(int(path_.size()), throughput() * emitted_along(*volume, ray_, reach, wavelengths_));
        const FreeFlight flight = sample_free_flight(*volume, ray_, reach, throughput(), wavelengths_, random_);
        carried_ *= flight.weight;
        if (carried_.black()) return false;
        edge *= transmittance(*volume, ray_, flight.distance, wavelengths_);
        if (flight.scattered) return scatter_in_volume(*volume, flight.distance, edge.average());
      }
      if (!found) {
        if (start_.transport == Transport::radiance) add(Vertex::Kind::escape, edge.average());
        return false;
      }
      SurfacePoint point;
      scene_.locate(ray_, hit, point);
      if (track_) settle_coincident(scene_, ray_, hit, point, media_);
      if (track_ && hidden_by_priority(media_, *point.object)) {
        cross(point);
        continue;
      }
      const Vector3 out = -ray_.direction;
      const Arena::Mark before = arena_.mark();
      if (track_) point.media = arena_.make<MediumStack>(media_);
      const Scatter* scatter = scattering_at(point, out, wavelengths_, arena_);

      if (scatter && scatter->has(pass_through) && passes(*scatter, out, point, edge)) {
        arena_.rewind(before);  // no vertex was made that would need it
        continue;
      }
      std::optional<ScatterSample> next;
      if (scatter) {
        const float choice = scatter->has_choice() ? random_.next() : (random_.skip(), 0.0f);
        const Transport transport = seeded(SeededBug::no_squared_index) ? Transport::importance : start_.transport;
        next = scatter->sample(out, choice, random_.next_pair(), transport, vertex_lobes);
        if (next && enters_body(point, *next)) next.reset();
      }
      Vertex& v = add(Vertex::Kind::surface, edge.average(), &point);
      v.scatter = scatter;
      return next && scatter_on_surface(v, *next);
    }
    return false;
  }

  /// Whether the walk goes straight on, with a probability q that is the fraction of light that does, or of its sum with what
  /// is scattered where that is more than all. Both outcomes are made up for before a vertex is made of the other, so that what
  /// is connected to it is as well.
  bool passes(const Scatter& scatter, const Vector3& out, const SurfacePoint& point, Spectrum& edge) {
    const auto straight = scatter.sample(out, 0, {}, start_.transport, pass_through);
    const bool alone = scatter.lobes() == pass_through;
    const Spectrum fraction = straight ? straight->weight : Spectrum();
    const float through = fraction.average();
    const float q = alone         ? 1
                    : through < 1 ? std::max(through, 0.0f)
                                  : through / (through + scatter.albedo(out, vertex_lobes).average());
    if (q < 1 && random_.next() >= q) {
      carried_ /= 1 - q;
      return false;
    }
    if (start_.crossed && alone && point.object->luminaire()) {
      add(Vertex::Kind::surface, edge.average(), &point);
      (*start_.crossed)();
      path_.pop_back();
    }
    carried_ *= fraction / q;
    edge *= fraction;
    cross(point);
    return true;
  }

  void cross(const SurfacePoint& point) {
    if (track_) cross_boundary(media_, *point.object, point.normal, ray_.direction);
    ray_.origin = point.exit(ray_.direction);
    ray_.width = point.footprint;
  }

  Vertex& add(Vertex::Kind kind, float chance, const SurfacePoint* point = nullptr, float extinction = 0) {
    path_.emplace_back();
    Vertex& v = path_.back();
    v.kind = kind;
    v.infinite = kind == Vertex::Kind::escape;
    v.single = wavelengths_.single();
    v.out = -ray_.direction;
    v.throughput = throughput();
    v.extinction = extinction;
    if (point) v.point = *point;
    v.media = v.point.media;
    v.chance = chance;
    v.forward = vertex_density(density_, path_[path_.size() - 2], v, ray_.direction, chance, front_);
    return v;
  }

  bool scatter_on_surface(Vertex& v, const ScatterSample& next) {
    v.specular = next.specular();
    carried_ *= next.weight;
    if (next.dispersive) carried_ *= wavelengths_.drop_secondary();
    eta_squared_ *= next.eta * next.eta;
    density_ = next.density;
    float back = 1;
    if (v.specular)
      density_ = 1;
    else
      back = scattering_density(v, next.direction, v.out, adjoint(start_.transport));
    set_reverse(v, back);
    if (track_ && next.transmitted()) cross_boundary(media_, *v.point.object, v.point.normal, next.direction);
    ray_.origin = v.point.exit(next.direction);
    ray_.direction = next.direction;
    ray_.width = v.point.footprint;
    return true;
  }

  bool scatter_in_volume(const VolumeShader& volume, float distance, float chance) {
    SurfacePoint point;
    point.position = ray_(distance);
    point.time = ray_.time;
    point.media = arena_.make<MediumStack>(media_);
    Vertex& v = add(Vertex::Kind::volume, chance, &point,
                    volume.coefficients(point.position, ray_.time, wavelengths_).extinction().average());
    v.volume = &volume;
    Vector3 direction = volume.sample_phase(point.position, v.out, random_.next_pair(), density_);
    if (seeded(SeededBug::phase_density)) carried_ *= density_ * (4 * pi);
    set_reverse(v, volume.phase(point.position, direction, v.out));
    ray_.origin = point.position;
    ray_.direction = direction;
    ray_.maximum = infinity;
    return true;
  }

  /// The density of the vertex before, had the walk come the other way through v.
  void set_reverse(const Vertex& v, float density) {
    Vertex& before = path_[path_.size() - 2];
    before.reverse = vertex_density(density, v, before, v.out, v.chance, front_);
  }

  /// The factor undoes the change of radiance by refraction, which comes back when the path leaves the medium.
  bool roulette() {
    if (carried_.black()) return false;
    if (int(path_.size()) <= start_.roulette_depth) return true;
    const float scale = start_.transport == Transport::radiance ? eta_squared_ : 1;
    const float survival = std::min(1.0f, carried_.maximum() * scale);
    if (random_.next() >= survival) return false;
    if (!seeded(SeededBug::roulette_undivided)) carried_ /= survival;
    return true;
  }

  Spectrum throughput() const { return start_.throughput * carried_; }

  const Scene& scene_;
  const WalkStart& start_;
  MediumStack& media_;
  Wavelengths& wavelengths_;
  SampleStream& random_;
  Arena& arena_;
  std::vector<Vertex>& path_;
  Ray ray_;
  Spectrum carried_{1.0f};  // product of the weights of scattering, media and roulette
  float density_;           // [1/sr] of the ray's direction
  float eta_squared_ = 1;
  LightFront front_;
  bool track_;
};

}  // namespace

void random_walk(const Scene& scene, const WalkStart& start, MediumStack media, Wavelengths& wavelengths, SampleStream& random,
                 Arena& arena, std::vector<Vertex>& path) {
  Walk(scene, start, media, wavelengths, random, arena, path).run();
}

}  // namespace etendue
