// Checks of every shader. See also check_shader_values.cpp (evaluation), check_shader_reversal.cpp (reciprocity, adjoint),
// check_shader_sampling.cpp (samples, pdfs, energy).

#include <fmt/format.h>

#include "etendue/core/warp.h"
#include "etendue/scene_object.h"
#include "shader_trial.h"

namespace etendue::conform {

Wavelengths spread_wavelengths(float hero) {
  constexpr float range = wavelength_high - wavelength_low;
  Wavelengths w;
  for (int i = 0; i < spectrum_size; ++i) {
    float lambda = hero + float(i) * range / spectrum_size;
    if (lambda > wavelength_high) lambda -= range;
    w.place(i, lambda, 1 / range);
  }
  return w;
}

std::string lobe_names(Lobes lobes) {
  static constexpr const char* names[] = {"diffuse_reflection",  "diffuse_transmission", "glossy_reflection",
                                          "glossy_transmission", "specular_reflection",  "specular_transmission",
                                          "null_scattering"};
  std::string all;
  for (int i = 0; i < 7; ++i)
    if (lobes & (1 << i)) all += (all.empty() ? "" : "|") + std::string(names[i]);
  return all.empty() ? "none" : all;
}

std::vector<Lobes> subsets_of(Lobes lobes) {
  std::vector<Lobes> list;
  for (Lobes s = lobes; s != 0; s = Lobes((s - 1) & lobes)) list.push_back(s);
  return list;
}

Ref<SceneObject> carrier_of(Shader& shader) {
  Ref<SceneObject> sphere = ref_cast<SceneObject>(Registry::instance().create("Sphere"));
  sphere->prepare();  // the shader is prepared already
  sphere->shader = Ref<Shader>(&shader);
  return sphere;
}

namespace {

/// Whether the shader has shading normals of its own: only then do radiance and importance have different weights of
/// reflection.
bool turns_normals(const Scatter& scatter, const SurfacePoint& p) {
  if (dot(Vector3(scatter.frame().n), p.normal) < 0.999999f) return true;
  std::mt19937 random(1);
  const auto uniform = [&] { return to_unit_float(std::uint32_t(random())); };
  for (int i = 0; i < 300; ++i) {
    const float x = uniform(), choice = uniform(), u = uniform();
    const Vector3 out = warp::sphere({x, uniform()});
    const Point2 at{u, uniform()};
    const auto a = scatter.sample(out, choice, at, {.lobes = reflection_lobes}),
               b = scatter.sample(out, choice, at, {Transport::importance, reflection_lobes});
    if (a && b && std::abs(a->weight[0] - b->weight[0]) > 1e-3f * a->weight[0]) return true;
  }
  return false;
}

}  // namespace

BoundShader::BoundShader(const Shader& shader, const Ref<SceneObject>& carrier, Point2 u, float hero, float tilt, float azimuth)
    : point_(carrier->sample_area(u, 0).point), wavelengths_(spread_wavelengths(hero)) {
  carrier->tangents(point_);
  if (tilt != 0)
    point_.shading_normal = normalize(
        Normal3(Frame(point_.normal)
                    .to_world({std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)})));
  scatter_ = shader.bind(point_, wavelengths_, arena_);
  turned_ = tilt != 0 || (scatter_ && turns_normals(*scatter_, point_));
}

Vector3 BoundShader::at_angle(double angle, double azimuth) const {
  const double t = angle * M_PI / 180;
  return scatter_->frame().to_world(
      {float(std::sin(t) * std::cos(azimuth)), float(std::sin(t) * std::sin(azimuth)), float(std::cos(t))});
}

double BoundShader::angle(const Vector3& v) const {
  return std::acos(std::clamp(double(dot(scatter_->frame().n, v)), -1.0, 1.0)) * 180 / M_PI;
}

std::string BoundShader::name(const Vector3& v) const {
  const Vector3 local = scatter_->frame().to_local(v);
  return fmt::format("({:.6g}, {:.6g}, {:.6g}) at {:.4g} deg", local.x, local.y, local.z, angle(v));
}

double BoundShader::specular_fraction(const Vector3& out, Lobes specular) const {
  double sum = 0;
  for (Lobes rest = specular & specular_lobes; rest != 0; rest &= Lobes(rest - 1)) {
    const Lobes lobe = rest & Lobes(-rest);
    constexpr int steps = 32;
    for (int i = 0; i < steps; ++i) {
      const float u = (float(i) + 0.5f) / steps;
      if (const auto s = scatter_->sample(out, u, {u, float(i * 19 % steps) / steps}, {.lobes = lobe}))
        sum += double(s->weight[0] * square(s->eta)) / steps;
    }
  }
  return sum;
}

RelativeIndex::RelativeIndex(Trial& trial, const BoundShader& bound, Lobes lobes) {
  known_[0] = known_[1] = true;
  for (int hero = 0; hero < spectrum_size; ++hero) {
    Wavelengths turned = bound.wavelengths();
    for (int i = 0; i < spectrum_size; ++i) {
      const int from = (hero + i) % spectrum_size;
      turned.place(i, bound.wavelengths()[from], bound.wavelengths().pdf(from));
    }
    Arena arena;
    const Scatter* scatter = trial.part<Shader>().bind(bound.point(), turned, arena);
    float found[2] = {0, 0};
    for (int i = 0; scatter && i < 200; ++i) {
      const Vector3 out = trial.direction();
      const bool front = dot(bound.point().normal, out) > 0;
      const auto s = scatter->sample(out, trial.uniform(), trial.pair(), {.lobes = lobes});
      if (!s || !s->transmitted()) continue;
      dispersive_ |= s->dispersive;
      if (found[front] == 0) found[front] = s->eta;
      known_[front] &= std::abs(s->eta - found[front]) < 1e-4f * found[front];
    }
    for (const bool front : {false, true}) {
      known_[front] &= found[front] > 0;
      index_[front].set(hero, found[front]);
    }
  }
}

namespace {

/// Checks what is independent of directions: the lobes, and that binding is a pure function of its arguments.
void check_binding(Trial& trial, const Shader& shader, const BoundShader& bound) {
  const Lobes possible = shader.possible_lobes();
  if (!bound.scatter()) return;
  const Scatter& scatter = *bound.scatter();
  trial.expect((scatter.lobes() & ~possible) == 0, "lobes are among the possible ones", [&] {
    return fmt::format("lobes() is {}, possible_lobes() {}", lobe_names(scatter.lobes()), lobe_names(possible));
  });
  trial.expect(scatter.lobes() != no_lobes, "what scatters nothing binds to null");

  Arena arena;
  const Scatter* again = shader.bind(bound.point(), bound.wavelengths(), arena);
  const std::string same = "binding twice gives the same";
  if (!trial.expect(again && again->lobes() == scatter.lobes(), same)) return;
  for (int i = 0; i < 40; ++i) {
    const Vector3 a = trial.direction(), b = trial.direction();
    const float choice = trial.uniform();
    const Point2 u = trial.pair();
    const ScatterValue one = scatter.value_and_pdf(a, b), two = again->value_and_pdf(a, b);
    const auto s1 = scatter.sample(a, choice, u), s2 = again->sample(a, choice, u);
    bool equal = (one.value - two.value).black() && one.pdf == two.pdf && s1.has_value() == s2.has_value();
    if (equal && s1) equal = s1->direction == s2->direction && (s1->weight - s2->weight).black() && s1->pdf == s2->pdf;
    trial.expect(equal, same, [&] { return fmt::format("out {}, in {}", bound.name(a), bound.name(b)); });
    if (scatter.has_choice()) continue;
    const auto other = scatter.sample(a, 1 - choice, u);
    trial.expect(other.has_value() == s1.has_value() && (!s1 || other->direction == s1->direction),
                 "a shader that says it makes no choice makes none", [&] { return "out " + bound.name(a); });
  }
}

/// An index that depends on wavelength refracts each wavelength in another direction: a path can follow only one, so such
/// samples must be marked as dispersive.
void check_dispersion(Trial& trial, const Shader& shader, const BoundShader& bound) {
  const Spectrum index = shader.interior_index(bound.wavelengths());
  trial.expect(index.finite() && index.minimum() > 0, "the index inside is finite and positive",
               [&] { return fmt::format("{} .. {}", index.minimum(), index.maximum()); });
  if (!bound.scatter() || !bound.scatter()->has(specular_transmission)) return;
  Wavelengths single = bound.wavelengths();
  single.drop_secondary();
  Arena arena;
  const Scatter* alone = shader.bind(bound.point(), single, arena);
  const bool named = bound.scatter()->dispersed_lobes() & specular_transmission;
  trial.expect(!alone || alone->dispersed_lobes() == no_lobes, "of one wavelength no lobe is named as dispersed",
               [&] { return fmt::format("lobes {}", alone->dispersed_lobes()); });
  const RelativeIndex by(trial, bound, specular_transmission);
  for (int i = 0; i < 100; ++i) {
    const Vector3 out = trial.direction();
    const Point2 u = trial.pair();
    const auto s = bound.scatter()->sample(out, trial.uniform(), u, {.lobes = specular_transmission});
    // Whether the sample refracts by the interior index: in a mixture it may refract by another one.
    const bool by_inside = s && (std::abs(s->eta - index[0]) < 1e-4f || std::abs(s->eta * index[0] - 1) < 1e-4f);
    const Spectrum* known = by.from(dot(bound.point().normal, out) > 0);
    const bool varies = (by_inside && s->eta != 1 && index.minimum() != index.maximum()) ||
                        (known && known->maximum() > 1.0001f * known->minimum());
    if (s && varies)
      trial.expect(s->dispersive, "refraction by an index that varies is marked as dispersive",
                   [&] { return "out " + bound.name(out); });
    if (s && named)
      trial.expect(s->dispersive, "whatever a lobe gives that is named as dispersed is dispersive",
                   [&] { return "out " + bound.name(out); });
    const auto t = alone ? alone->sample(out, trial.uniform(), u) : std::nullopt;
    trial.expect(!t || !t->dispersive, "a path of one wavelength has nothing to drop",
                 [&] { return "out " + bound.name(out); });
  }
}

/// An albedo with a larger relative error is useless for choosing lobes.
constexpr float largest_albedo_error = 0.5f;

void check_shader(Trial& trial) {
  Shader& shader = trial.part<Shader>();
  const Ref<SceneObject> carrier = carrier_of(shader);
  const auto hero = [&] { return lerp(trial.uniform(), 400, 700); };
  const BoundShader plain(shader, carrier, trial.pair(), hero(), 0, 0);
  const BoundShader tilted(shader, carrier, trial.pair(), hero(), lerp(trial.uniform(), 0.1f, 0.4f), 2 * pi * trial.uniform());
  trial.expect(shader.albedo_error() >= 0 && shader.albedo_error() <= largest_albedo_error,
               "the error of the albedo is bounded",
               [&] { return fmt::format("it is said to be up to {} of the albedo", shader.albedo_error()); });
  check_binding(trial, shader, plain);
  check_binding(trial, shader, tilted);
  check_dispersion(trial, shader, plain);
  if (!plain.scatter() || !tilted.scatter()) return;
  check_shader_values(trial, plain, tilted);
  if (shader.stochastic()) {
    check_shader_estimates(trial, plain);
  } else {
    check_shader_reversal(trial, plain, tilted);
    check_shader_sampling(trial, plain, tilted);
  }
}

const RegisterCheck<Shader> registered(check_shader);

}  // namespace
}  // namespace etendue::conform
