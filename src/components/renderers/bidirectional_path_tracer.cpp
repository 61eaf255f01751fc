// Bidirectional path tracing (Lafortune & Willems 1993; Veach & Guibas 1994; Veach 1997, chapter 10).
//
// For each sample one walk x_0, x_1, … begins at a luminaire and one z_0, z_1, … at the lens. Every vertex of the one
// is connected to every vertex of the other: s vertices of the first and t of the second make a path of s + t - 1 segments,
// whose estimate is
//     C_{s,t} = w_{s,t} alpha_s c_{s,t} alpha_t,
// with alpha the walks' throughputs, c the light that passes the connection (f |cos| V |cos| f / d^2 between two surfaces;
// cosines are absent in media, and V includes what media let through) and w the multiple-importance weight of the
// strategy among all that could have made the same path (transport/bidirectional_weight.h).
//   s = 0: the camera walk meets a luminaire.        s = 1: a luminaire is sampled as seen from z_{t-1}.
//   t = 1: a light walk goes to the lens, and the light falls on the film where it does.

#include "etendue/render/renderer.h"
#include "etendue/transport/bidirectional_weight.h"
#include "etendue/transport/connection.h"
#include "etendue/transport/renderer_members.h"

namespace etendue {

class BidirectionalPathTracer final : public Renderer {
  int max_depth = 64;
  int roulette_depth = 5;
  Heuristic heuristic = Heuristic::power;
  int light_vertices = -1, camera_vertices = -1;
  bool weighted = true;

 public:
  static void describe(Description<BidirectionalPathTracer>& d) {
    d.summary("Paths from the luminaires and from the camera, connected in all ways and weighted by how well each does.",
              "Lafortune & Willems 1993; Veach & Guibas 1994; Veach 1997, chapter 10");
    d.group("Paths");
    describe_max_depth<&BidirectionalPathTracer::max_depth>(d, kept_walk_depth, range(1, longest_kept_walk));
    describe_roulette_depth<&BidirectionalPathTracer::roulette_depth>(d);
    describe_heuristic<&BidirectionalPathTracer::heuristic>(d, when("weighted"));
    d.group("Strategies")
        .member<&BidirectionalPathTracer::light_vertices>(
            "light_vertices", "1", "shows the strategies with this many vertices from the luminaire alone; -1: all",
            at_least(-1))
        .member<&BidirectionalPathTracer::camera_vertices>(
            "camera_vertices", "1", "shows the strategies with this many vertices from the camera alone; -1: all", at_least(-1))
        .member<&BidirectionalPathTracer::weighted>("weighted", "",
                                                    "whether strategies are weighted; without, each shows all light it finds");
  }

  bool splats() const override { return true; }
  PathClasses finds() const override {
    const bool all = light_vertices < 0 && camera_vertices < 0 && weighted;
    return all ? all_paths & ~(delta_caustics_in_mirrors | subsurface_light) : no_paths;
  }

  Spectrum radiance(const RenderContext& context, const Ray& camera_ray, SampleContext& sample) const override {
    if (sample.observe.features) note_first_surface(context.scene, camera_ray, sample);
    static thread_local std::vector<KeptVertex> camera, light;
    Wavelengths light_wavelengths = sample.wavelengths;
    Sample s{*this, context, sample, camera, light, light_wavelengths};
    walk_from_camera(context, camera_ray, {max_depth, roulette_depth}, sample, camera, s);
    SampleContext light_sample{light_wavelengths, sample.numbers.fork("light"), sample.arena, {}, nullptr, sample.abort};
    EmittedLight emitted_light;
    walk_from_luminaire(context.scene, *light_sampler, camera_ray.time, {max_depth - 1, roulette_depth}, light_sample, light,
                        emitted_light);
    if (light.size() > 1) s.direct = sampled_density(*light_sampler, light[1], light[0], light[1].out);

    for (int t = 2; t <= int(camera.size()) && !sample.aborted(); ++t) {
      const KeptVertex& z = camera[size_t(t - 1)];
      meet(s, t);
      if (!z.connectable()) continue;
      if (t <= max_depth) sample_luminaire(s, t);
      for (int n = 2; n <= int(light.size()) && n + t - 1 <= max_depth && !sample.aborted(); ++n)
        if (light[size_t(n - 1)].connectable()) connect(s, n, t);
    }
    for (int n = 2; n <= int(light.size()) && n <= max_depth && !sample.aborted(); ++n)
      if (light[size_t(n - 1)].connectable()) connect_to_lens(s, n);

    if (PathRecord* record = sample.observe.record) {
      record_walk(record->vertices, std::span<const KeptVertex>(camera).subspan(1));
      record_walk(record->light_vertices, light);
    }
    return s.radiance;
  }

 private:
  /// One sample: both walks, and what was found. It listens to the camera's.
  struct Sample final : WalkListener {
    const BidirectionalPathTracer& self;
    const RenderContext& context;
    SampleContext& at;
    std::vector<KeptVertex>& camera;
    std::vector<KeptVertex>& light;
    Wavelengths& light_wavelengths;
    const LightFront front;
    Spectrum radiance;
    float direct = 0;  ///< density of light[0] when sampled as seen from light[1]

    Sample(const BidirectionalPathTracer& renderer, const RenderContext& c, SampleContext& sample,
           std::vector<KeptVertex>& camera_walk, std::vector<KeptVertex>& light_walk, Wavelengths& w)
        : self(renderer),
          context(c),
          at(sample),
          camera(camera_walk),
          light(light_walk),
          light_wavelengths(w),
          front(c.scene) {}

    void emitted(int length, const Spectrum& value) override {
      if (self.shows(0, length + 1)) self.add(*this, length, 0, length + 1, 1, value);
    }
    void crossed_luminaire() override { self.meet(*this, int(camera.size())); }
    const Scene& scene() const { return context.scene; }
  };

  /// s = 0: the camera walk's last vertex lies on a luminaire.
  void meet(Sample& s, int t) const {
    const KeptVertex& z = s.camera[size_t(t - 1)];
    const int length = t - 1;
    if (!shows(0, t)) return;
    const auto met = [&](const SurfacePoint& point) {
      const Spectrum light = z.throughput * point.object->emission->radiance(point, z.out, s.at.wavelengths);
      if (light.black()) return;
      float weight = 1;
      if (length > 1 && weighted) {
        const KeptVertex& x1 = s.camera[size_t(t - 2)];
        KeptVertex x0 = z;
        x0.point = point;
        ConnectedPath path{nullptr, 0, s.camera.data(), t, 0, 0, 0, 0, 0, 0, true};
        path.begun = path.camera_last_from_light = begun_density(*light_sampler, x1, x0, -z.out);
        path.direct = sampled_density(*light_sampler, x1, x0, -z.out);
        path.camera_before_from_light =
            vertex_density(x0.infinite ? 1 : point.object->emission->density(point, z.out), x0, x1, z.out, z.chance, s.front);
        if (path.begun > 0) weight = bidirectional_weight(path, heuristic);
      }
      add(s, length, 0, t, weight, light);
    };
    if (z.kind == Vertex::Kind::escape) {
      SurfacePoint point;
      Ray ray;
      ray.origin = s.camera[size_t(t - 2)].point.position;
      ray.direction = -z.out;
      ray.time = s.camera[0].point.time;
      for (const SceneObject* far : s.scene().infinite_luminaires()) {
        far->surface_point(ray, {}, point);
        met(point);
      }
    } else if (z.on_surface() && z.point.object->luminaire()) {
      met(z.point);
    }
  }

  /// s = 1.
  void sample_luminaire(Sample& s, int t) const {
    if (!shows(1, t)) return;
    const KeptVertex& z = s.camera[size_t(t - 1)];
    NumberStream numbers = s.at.numbers.fork("luminaire", std::uint32_t(t));
    const auto c = etendue::connect_to_luminaire(s.scene(), *light_sampler, z, s.at.wavelengths, numbers, s.at.arena);
    if (!c) return;
    float weight = 1;
    if (weighted) {
      const KeptVertex& x0 = c->luminaire;
      ConnectedPath path{&x0, 1, s.camera.data(), t, 0, 0, 0, 0, 0, 0, !c->delta};
      path.begun = begun_density(*light_sampler, z, x0, c->direction);
      path.direct = sampled_density(*light_sampler, z, x0, c->direction);
      path.light_last_from_camera = vertex_density(c->density_at_z, z, x0, c->direction, c->chance, s.front);
      path.camera_last_from_light = vertex_density(c->density_at_luminaire, x0, z, -c->direction, c->chance, s.front);
      path.camera_before_from_light = before_from(s.camera, t, c->direction, Transport::importance, s.front);
      if (path.begun > 0 && path.direct > 0) weight = bidirectional_weight(path, heuristic);
    }
    add(s, t, 1, t, weight, c->light);
  }

  /// s > 1, t > 1.
  void connect(Sample& s, int n, int t) const {
    if (!shows(n, t)) return;
    const KeptVertex &y = s.light[size_t(n - 1)], &z = s.camera[size_t(t - 1)];
    NumberStream numbers = s.at.numbers.fork("connection", std::uint32_t(n * 0x10000 + t));
    const auto c = etendue::connect(s.scene(), y, z, s.at.wavelengths, numbers, s.at.arena);
    if (!c) return;
    float weight = 1;
    if (weighted) {
      ConnectedPath path{s.light.data(),        n, s.camera.data(), t, 0, 0, 0, 0, s.direct, s.light[0].forward,
                         can_be_met(s.light[0])};
      path.light_last_from_camera = vertex_density(c->density_at_z, z, y, c->direction, c->chance, s.front);
      path.light_before_from_camera = before_from(s.light, n, -c->direction, Transport::radiance, s.front);
      path.camera_last_from_light = vertex_density(c->density_at_y, y, z, -c->direction, c->chance, s.front);
      path.camera_before_from_light = before_from(s.camera, t, c->direction, Transport::importance, s.front);
      weight = bidirectional_weight(path, heuristic);
    }
    add(s, n + t - 1, n, t, weight, c->light);
  }

  /// t = 1.
  void connect_to_lens(Sample& s, int n) const {
    if (!shows(n, 1)) return;
    const KeptVertex& y = s.light[size_t(n - 1)];
    NumberStream numbers = s.at.numbers.fork("lens", std::uint32_t(n));
    const auto c = etendue::connect_to_lens(s.context, y, s.light_wavelengths, numbers, s.at.arena);
    if (!c) return;
    float weight = 1;
    if (weighted) {
      const Vector3& direction = c->lens.direction;
      ConnectedPath path{s.light.data(), n, &c->camera, 1, 0, 0, 0, 0, s.direct, s.light[0].forward, can_be_met(s.light[0])};
      path.light_last_from_camera = vertex_density(c->density_at_lens, c->camera, y, -direction, c->chance, s.front);
      path.light_before_from_camera = before_from(s.light, n, direction, Transport::radiance, s.front);
      weight = bidirectional_weight(path, heuristic);
    }
    const Spectrum light = c->light * weight;
    s.at.splat(c->lens.film, light, s.light_wavelengths, n);
    note(s, n, n, 1, weight, light, c->lens.film, true);
  }

  bool shows(int s, int t) const {
    return (light_vertices < 0 || s == light_vertices) && (camera_vertices < 0 || t == camera_vertices);
  }

  void add(Sample& s, int length, int n, int t, float weight, Spectrum light) const {
    light *= weight;
    s.radiance += light;
    s.at.observe.light(length, light);
    note(s, length, n, t, weight, light, {}, false);
  }
  void note(Sample& s, int length, int n, int t, float weight, const Spectrum& light, Point2 film, bool splat) const {
    if (!s.at.observe.record) [[likely]]
      return;
    s.at.observe.record->contribute({std::to_string(n) + " from the luminaire, " + std::to_string(t) + " from the camera",
                                     length, weight, light, film, splat});
  }

  /// The density of a walk's vertex before its last, `count` vertices long, had a walk come from `from` through the last.
  static float before_from(const std::vector<KeptVertex>& walk, int count, const Vector3& from, Transport transport,
                           const LightFront& front) {
    if (count < 2) return 0;
    const KeptVertex &last = walk[size_t(count - 1)], &before = walk[size_t(count - 2)];
    return vertex_density(scattering_density(last, from, last.out, transport), last, before, last.out, last.chance, front);
  }

  static bool can_be_met(const KeptVertex& luminaire) { return !luminaire.point.object->delta(); }
};

static const Register<BidirectionalPathTracer> registered;

}  // namespace etendue
