#include "etendue/transport/bidirectional_subpaths.h"

#include "etendue/transport/light_groups.h"
#include "etendue/transport/photons.h"

namespace etendue {
namespace {

bool emitter_can_be_hit(const SubpathVertex& luminaire) { return !luminaire.point.object->delta(); }

/// Memory of this thread that every sample reuses, so that the rendering loop allocates nothing.
template <class T>
std::vector<T>& reused(int which) {
  static thread_local std::vector<T> memory[2];
  memory[which].clear();
  return memory[which];
}

}  // namespace

BidirectionalSubpaths::BidirectionalSubpaths(const RenderContext& context, const LightSampler& lights, SampleContext& sample,
                                             const StrategyWeights& weights)
    : context_(context),
      lights_(lights),
      sample_(sample),
      weights_(weights),
      camera_(reused<SubpathVertex>(0)),
      light_(reused<SubpathVertex>(1)),
      segment_emission_(reused<PathContribution>(0)),
      hits_(reused<PathContribution>(1)),
      light_wavelengths_(sample.wavelengths),
      front_(context.scene) {}

void BidirectionalSubpaths::follow_fluorescence(int most, bool dyes) {
  levels_.emplace(sample_.wavelengths, most, sample_.numbers.fork("fluorescence"), sample_.arena);
  light_wavelengths_ = (*levels_)[levels_->count()];
  dyes_ = dyes;
}

void BidirectionalSubpaths::from_camera(const Ray& ray, const SubpathLimits& limits) {
  struct Emission final : SegmentEvents {
    BidirectionalSubpaths& paths;
    explicit Emission(BidirectionalSubpaths& p) : paths(p) {}
    void emitted(int length, const Spectrum& light) override {
      if (!paths.at_last_level(paths.camera_.back())) return;
      PathContribution found{0, length + 1, false, light};
      if (PathStates* const states = PathStates::current())
        found.matches = states->ended(paths.camera_.back().path, nullptr, paths.emitting_.object);
      paths.segment_emission_.push_back(found);
    }
    void through(const Medium& medium, const Ray&, float, const Spectrum&) override { paths.emitting_ = medium; }
    void crossed_luminaire() override { paths.add_emitter_hits(paths.camera_vertices(), paths.segment_emission_); }
  } emission(*this);
  directions_ = limits.directions;
  SubpathLimits own = limits;
  own.reverse_pdfs = weights_.weighted;
  own.levels = levels_ ? &*levels_ : nullptr;
  own.dyes = dyes_;
  generate_camera_subpath(context_, ray, own, sample_, camera_, emission);
}

void BidirectionalSubpaths::from_luminaire(float time, const SubpathLimits& limits) {
  SampleContext light{light_wavelengths_, sample_.numbers.fork("light"), sample_.arena, {.abort = sample_.sink.abort}};
  EmittedLight emitted;
  SubpathLimits own = limits;
  own.directions = directions_;
  own.reverse_pdfs = weights_.weighted;
  own.levels = levels_ ? &*levels_ : nullptr;
  own.dyes = dyes_;
  generate_light_subpath(context_.scene, lights_, time, own, light, light_, emitted);
  if (weights_.weighted && light_.size() > 1)
    y0_next_event_point_pdf_ = next_event_point_pdf(lights_, light_[1], light_[0], light_[1].out);
}

bool BidirectionalSubpaths::has_specular_prefix(int t) const {
  for (int i = 2; i < t; ++i)
    if (!camera_vertex(i).leaves_specularly) return false;
  return true;
}

PathState BidirectionalSubpaths::path_from_camera(int t, const Vector3& in) const {
  return PathStates::current()->scattered(camera_vertex(t - 1).path, camera_vertex(t), in);
}

PathState BidirectionalSubpaths::path_from_luminaire(int s, const Vector3& on) const {
  return PathStates::current()->scattered_before(light_vertex(s - 1).path, light_vertex(s), on);
}

std::span<const PathContribution> BidirectionalSubpaths::emitter_hits(int t) const {
  hits_.clear();
  add_emitter_hits(t, hits_);
  return hits_;
}

void BidirectionalSubpaths::add_emitter_hits(int t, std::vector<PathContribution>& hits) const {
  const SubpathVertex& z = camera_vertex(t);
  if (!at_last_level(camera_vertex(t - 1))) return;
  if (z.kind == PathVertex::Kind::escape) {
    SurfacePoint point;
    Ray ray;
    ray.origin = camera_vertex(t - 1).point.position;
    ray.direction = -z.out;
    ray.time = camera_[0].point.time;
    ray.of_camera = t == 2;
    for (const SceneObject* far : context_.scene.infinite_luminaires(ray)) {
      far->surface_point(ray, {}, point);
      add_emitter_hit(z, point, t, hits);
    }
  } else if (z.on_surface() && z.point.object->luminaire()) {
    add_emitter_hit(z, z.point, t, hits);
  }
}

void BidirectionalSubpaths::add_emitter_hit(const SubpathVertex& z, const SurfacePoint& point, int t,
                                            std::vector<PathContribution>& hits) const {
  PathContribution found{
      0, t, false, z.throughput * point.object->emission->radiance(point, z.out, wavelengths_beyond(camera_vertex(t - 1))),
      point.object};
  if (found.light.black()) return;
  if (t > 2 && weights_.weighted) {
    const SubpathVertex& x1 = camera_vertex(t - 1);
    SubpathVertex x0 = z;
    x0.point = point;
    ConnectedPath path{nullptr, 0, camera_.data(), t, 0, 0, 0, 0, 0, 0, true, weights_.merging};
    path.pdf_emission_origin = path.camera_last_from_light = pdf_emission_origin(lights_, x1, x0, -z.out);
    path.next_event_point_pdf = next_event_point_pdf(lights_, x1, x0, -z.out);
    path.camera_before_from_light =
        vertex_pdf(x0.infinite ? 1 : point.object->emission->pdf(point, z.out), x0, x1, z.out, z.mean_transmittance, front_);
    if (path.pdf_emission_origin > 0) weigh(found, path);
  }
  if (PathStates* const states = PathStates::current()) [[unlikely]]
    found.matches = states->ended(camera_vertex(t - 1).path, point.object);
  hits.push_back(found);
}

std::optional<PathContribution> BidirectionalSubpaths::next_event(int t) const {
  const SubpathVertex& z = camera_vertex(t);
  if (!at_last_level(z)) return {};
  NumberStream numbers = sample_.numbers.fork("luminaire", std::uint32_t(t));
  const auto c = connect_to_luminaire(context_.scene, lights_, z, wavelengths_beyond(z), numbers, sample_.arena);
  if (!c) return {};
  PathContribution found{1, t, false, c->light, c->luminaire.point.object};
  if (PathStates* const states = PathStates::current()) [[unlikely]]
    found.matches = states->ended(path_from_camera(t, c->direction), found.luminaire);
  if (weights_.weighted) {
    const SubpathVertex& x0 = c->luminaire;
    ConnectedPath path{&x0, 1, camera_.data(), t, 0, 0, 0, 0, 0, 0, !c->delta, weights_.merging};
    path.pdf_emission_origin = pdf_emission_origin(lights_, z, x0, c->direction);
    path.next_event_point_pdf = next_event_point_pdf(lights_, z, x0, c->direction);
    const float at_z = camera_pdf(directions_, z, z.out, c->direction, c->pdf_at_z);
    path.light_last_from_camera = vertex_pdf(at_z, z, x0, c->direction, c->mean_transmittance, front_);
    path.camera_last_from_light = vertex_pdf(c->pdf_at_luminaire, x0, z, -c->direction, c->mean_transmittance, front_);
    path.camera_before_from_light = before_from(camera_, t, c->direction, Transport::importance);
    if (path.pdf_emission_origin > 0 && path.next_event_point_pdf > 0) weigh(found, path);
  }
  return found;
}

std::optional<PathContribution> BidirectionalSubpaths::connect(int s, int t) const {
  const SubpathVertex &y = light_vertex(s), &z = camera_vertex(t);
  if (y.level != z.level) return {};
  NumberStream numbers = sample_.numbers.fork("connection", std::uint32_t(s * 0x10000 + t));
  const auto c = etendue::connect(context_.scene, y, z, wavelengths_beyond(z), numbers, sample_.arena);
  if (!c) return {};
  PathContribution found{s, t, false, c->light, light_[0].point.object};
  if (PathStates* const states = PathStates::current()) [[unlikely]]
    found.matches = states->joined(path_from_camera(t, c->direction), path_from_luminaire(s, -c->direction));
  if (weights_.weighted) {
    ConnectedPath path{light_.data(),
                       s,
                       camera_.data(),
                       t,
                       0,
                       0,
                       0,
                       0,
                       y0_next_event_point_pdf_,
                       light_[0].pdf_forward,
                       emitter_can_be_hit(light_[0]),
                       weights_.merging};
    const float at_z = camera_pdf(directions_, z, z.out, c->direction, c->pdf_at_z);
    path.light_last_from_camera = vertex_pdf(at_z, z, y, c->direction, c->mean_transmittance, front_);
    path.light_before_from_camera = before_from(light_, s, -c->direction, Transport::radiance);
    path.camera_last_from_light = vertex_pdf(c->pdf_at_y, y, z, -c->direction, c->mean_transmittance, front_);
    path.camera_before_from_light = before_from(camera_, t, c->direction, Transport::importance);
    weigh(found, path);
  }
  return found;
}

std::optional<PathContribution> BidirectionalSubpaths::connect_to_lens(int s) const {
  const SubpathVertex& y = light_vertex(s);
  if (y.level != 0) return {};
  NumberStream numbers = sample_.numbers.fork("lens", std::uint32_t(s));
  const auto c = etendue::connect_to_lens(context_, y, light_wavelengths(), numbers, sample_.arena);
  if (!c) return {};
  PathContribution found{s, 1, false, c->light, light_[0].point.object, 1, c->lens.film};
  if (PathStates* const states = PathStates::current()) [[unlikely]]
    found.matches = states->joined(path_after_camera, s == 1 ? y.path : path_from_luminaire(s, c->lens.direction));
  if (weights_.weighted) {
    const SubpathVertex lens = lens_vertex(context_.camera, c->lens.lens, y.point.time);
    weigh(found, path_to_lens(s, *c, lens));
  }
  return found;
}

ConnectedPath BidirectionalSubpaths::path_to_lens(int s, const LensConnection& c, const SubpathVertex& lens) const {
  const SubpathVertex& y = light_vertex(s);
  Ray to_y;
  to_y.origin = c.lens.lens;
  to_y.direction = -c.lens.direction;
  to_y.time = y.point.time;
  return {.light = light_.data(),
          .s = s,
          .camera = &lens,
          .t = 1,
          .light_last_from_camera =
              vertex_pdf(camera_direction_pdf(context_.camera, to_y), lens, y, to_y.direction, c.mean_transmittance, front_),
          .light_before_from_camera = before_from(light_, s, c.lens.direction, Transport::radiance),
          .next_event_point_pdf = y0_next_event_point_pdf_,
          .pdf_emission_origin = light_[0].pdf_forward,
          .emitter_can_be_hit = emitter_can_be_hit(light_[0]),
          .merging = weights_.merging};
}

void BidirectionalSubpaths::weigh(PathContribution& found, const ConnectedPath& path) const {
  found.weight = bidirectional_weight(path, weights_.heuristic);
  if (sample_.sink.records) [[unlikely]]
    found.path_tracing_moment = etendue::path_tracing_moment(path, weights_.heuristic);
}

std::optional<PathContribution> BidirectionalSubpaths::merge(const Photon& photon, int t) const {
  const SubpathVertex& z = camera_vertex(t);
  const double merging = z.in_medium() ? weights_.merging.medium : weights_.merging.surface;
  const Spectrum scattered = scattered_from_photon(z, photon, {sample_.wavelengths, z.hero_only});
  if (scattered.black()) return {};
  PathContribution found{int(photon.vertices), t, true, z.throughput * scattered / float(merging), photon.from(context_.scene)};
  if (PathStates* const states = PathStates::current()) [[unlikely]]
    found.matches = states->joined(path_from_camera(t, photon.out), photon.path());
  if (weights_.weighted) {
    ConnectedPath path{nullptr, int(photon.vertices), camera_.data(), t, 0, 0, photon.weight.pdf_forward, 0, 0, 0,
                       true,    weights_.merging};
    path.camera_before_from_light = before_from(camera_, t, photon.out, Transport::importance);
    const float back = camera_pdf(directions_, z, z.out, photon.out, scattering_pdf(z, z.out, photon.out, Transport::radiance));
    found.weight = merging_weight(path, photon.weight, back, weights_.heuristic);
  }
  return found;
}

float BidirectionalSubpaths::before_from(const std::vector<SubpathVertex>& walk, int count, const Vector3& from,
                                         Transport transport) const {
  if (count < 2) return 0;
  const SubpathVertex &last = walk[size_t(count - 1)], &before = walk[size_t(count - 2)];
  float pdf = scattering_pdf(last, from, last.out, transport);
  if (transport == Transport::radiance) pdf = camera_pdf(directions_, last, from, last.out, pdf);
  return vertex_pdf(pdf, last, before, last.out, last.mean_transmittance, front_);
}

void BidirectionalSubpaths::record() const {
  PathRecord* record = sample_.sink.record;
  if (!record) return;
  if (!camera_.empty()) record_subpath(record->vertices, std::span<const SubpathVertex>(camera_).subspan(1));
  record_subpath(record->light_vertices, light_);
}

void add_contribution(SampleContext& sample, const Wavelengths& of_light, const PathContribution& found, Spectrum& radiance) {
  const Spectrum light = found.light * found.weight;
  const bool splat = found.t == 1;
  if (splat) {
    splat_light(sample, found.film, light, of_light, found.length(), found.luminaire, found.matches);
  } else {
    radiance += light;
    report_light(sample.sink, found.length(), light, found.luminaire, found.matches);
  }
  if (sample.sink.records) [[unlikely]] {
    const double y = to_xyz(found.light, of_light).y;
    sample.sink.records.add(PathTracingExcess{found.weight * y * y * (found.path_tracing_moment - found.weight),
                                              splat ? std::optional(found.film) : std::nullopt});
  }
  if (PathRecord* record = sample.sink.record) [[unlikely]]
    record->contribute({std::to_string(found.s) + " from the luminaire, " + std::to_string(found.t) + " from the camera" +
                            (found.merged ? ", merged" : ""),
                        found.length(), found.weight, light, found.film, splat});
}

}  // namespace etendue
