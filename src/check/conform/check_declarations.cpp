// Checks what is declared of members. Where a member's conditions say that it has no effect, another value must not change a
// single bit of the result; and a colour must only be evaluated for the ColorUse that its declared Meaning allows.

#include <fmt/format.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "check/conform/fixtures/ray_bound.h"
#include "conformance.h"
#include "describe/guard.h"
#include "draw.h"
#include "etendue/language/language.h"
#include "etendue/object_map.h"
#include "etendue/phase_function.h"
#include "etendue/render/render.h"

namespace etendue::conform {
namespace {

/// A scene with objects that a component of any interface may affect, in front of a camera at the origin that looks along z.
constexpr const char* stage =
    "Job { camera: PerspectiveCamera { to: [0, 0, 1], fov: 60 }, image: ImageBuffer { width: 12, height: 12 }, "
    "renderer: PathTracer { samples: 4, max_depth: 6 }, scene: BruteForceScene { objects: [ "
    "Sphere { centre: [0.2, 0.1, 3], shader: Lambertian { color: 0.5 } }, "
    "Rectangle { corner: [-4, -1, 0], edge_u: [0, 0, 9], edge_v: [9, 0, 0], "
    "shader: Lambertian { color: CheckerMap { repeat: [7, 7, 7] } } }, "
    "Rectangle { corner: [-1, 2.5, 2], edge_u: [1, 0, 0], edge_v: [0, 0, 1], emission: DiffuseEmission { radiance: 4 } }, "
    "Environment { emission: EnvironmentEmission { radiance: 0.3 } } ] } }";

std::string bytes_of(const std::vector<double>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)};
}

/// The most rays that an image may take; a path tracer needs a hundredth of this. Components that take more are not compared.
constexpr std::uint64_t most_rays = 1'000'000;

std::string rendered(const Ref<Job>& job) {
  const RayBound bound(*job, most_rays);
  Render render(job, {.threads = 1});
  render.run();
  return bytes_of(render.film().develop().values);
}

Ref<Component> placed(const char* text, const char* member, const Ref<Component>& part) {
  const Ref<Component> holder = parse_component(text, "stage");
  set(*holder, member, Value(part));
  return holder;
}

/// Puts a component in its place in the scene; false: there is no place for its interface.
bool put(Job& job, const Ref<Component>& part) {
  std::vector<Ref<SceneObject>>& objects = job.scene->objects;
  SceneObject& ball = *objects.front();
  if (const auto shader = ref_cast<Shader>(part))
    ball.shader = shader;
  else if (const auto map = ref_cast<ObjectMap>(part))
    ball.shader = ref_cast<Shader>(placed("Lambertian {}", "color", part));
  else if (const auto volume = ref_cast<VolumeShader>(part))
    ball.shader = ref_cast<Shader>(parse_component("PassThrough {}", "stage")), ball.interior = volume;
  else if (const auto phase = ref_cast<PhaseFunction>(part))
    ball.shader = ref_cast<Shader>(parse_component("PassThrough {}", "stage")),
    ball.interior = ref_cast<VolumeShader>(placed("HomogeneousVolume { scattering: 2 }", "phase", part));
  else if (const auto emission = ref_cast<EmissionShader>(part); emission && emission->only_at_infinity())
    objects.back()->emission = emission;
  else if (emission)
    objects.push_back(ref_cast<SceneObject>(placed("Point { position: [1, 1, 2] }", "emission", part))),
        objects.push_back(ref_cast<SceneObject>(
            placed("Rectangle { corner: [-2, -0.5, 2], edge_u: [0, 1, 0], edge_v: [0, 0, 1] }", "emission", part)));
  else if (const auto object = ref_cast<SceneObject>(part))
    objects.push_back(object);
  else if (const auto camera = ref_cast<Camera>(part))
    job.camera = camera;
  else if (const auto renderer = ref_cast<Renderer>(part))
    job.renderer = renderer, renderer->samples = 4;
  else if (const auto sampler = ref_cast<Sampler>(part))
    job.renderer->sampler = sampler;
  else if (const auto lights = ref_cast<LightSampler>(part))
    job.renderer->light_sampler = lights;
  else if (const auto wavelengths = ref_cast<WavelengthSampler>(part))
    job.wavelengths = wavelengths;
  else if (const auto filter = ref_cast<Filter>(part))
    job.image->filter = filter;
  else
    return false;
  return true;
}

Image picture(const std::vector<std::string>& channels) {
  Image image(9, 7, channels);
  for (size_t i = 0; i < image.values.size(); ++i) image.values[i] = double(i * i % 97) / (channels[0] == "X" ? 20 : 100);
  image.metadata["color_space"] = channels[0] == "X" ? "xyz" : "srgb";
  return image;
}

std::string written(const Output& output, const Trial& trial) {
  const std::string path = trial.folder() + "/behaviour" + output.extension();
  output.write_image(
      picture(output.for_display() ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"X", "Y", "Z"}), path);
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return std::move(text).str();
}

/// All results of a component, as bytes; "" if its interface is not known here. Throws what the component throws.
std::string behaviour(const Ref<Component>& part, const Trial& trial) {
  if (const auto map = ref_cast<ToneMap>(part)) {
    prepare_tree(*map);
    return bytes_of(map->apply(picture({"X", "Y", "Z"})).values);
  }
  if (const auto output = ref_cast<Output>(part)) {
    prepare_tree(*output);
    return written(*output, trial);
  }
  const Ref<Job> job = load_job_text(stage, "stage");
  return put(*job, part) ? rendered(job) : "";
}

/// Values of another member: its present one and others, among which some should make a condition false.
std::vector<Value> candidates(Trial& trial, const ClassInfo& info, const Member& of) {
  std::vector<Value> all = {of.get(trial.part(), of)};
  if (of.list) all.emplace_back(Value::List());
  if (!of.list && of.kind == Kind::boolean) all.insert(all.end(), {Value(true), Value(false)});
  if (!of.list && (of.kind == Kind::number || of.kind == Kind::integer)) all.emplace_back(Number{0});
  if (of.kind == Kind::component) all.insert(all.end(), {Value(), Value(Number{0}), Value(Number{0.5})});
  if (of.kind == Kind::file) all.emplace_back(std::string());
  if (of.kind == Kind::color) all.insert(all.end(), {Value(flat_spectrum(0)), Value(flat_spectrum(0.4f))});
  for (const std::string& choice : of.choices) all.emplace_back(choice);
  for (int i = 0; i < 6; ++i)
    if (const Value v = draw_value(info, of, trial.fixtures(), trial.random); !v.none()) all.push_back(v);
  return all;
}

bool set_if_allowed(Component& c, const std::string& member, const Value& value) {
  try {
    set(c, member, value);
    return true;
  } catch (const Error&) {
    return false;
  }
}

class ConditionTrial {
 public:
  ConditionTrial(Trial& t, const Member& member) : trial(t), info_(t.part().class_info()), member_(member) {}

  void check() {
    for (const Condition& condition : member_.conditions)
      for (const Value& value : candidates(trial, info_, *info_.find(condition.member))) {
        const Ref<Component> part = copy(trial.part());
        if (!set_if_allowed(*part, condition.member, value) || condition.holds(*part)) continue;
        if (compare(part, condition)) break;
      }
  }

 private:
  /// Compares the component with copies that differ in the member alone. False: nothing could be compared.
  bool compare(const Ref<Component>& part, const Condition& condition) {
    std::string before;
    try {
      before = behaviour(copy(*part), trial);
    } catch (...) {
      return false;
    }
    if (before.empty()) return true;
    int compared = 0;
    for (int i = 0; i < 8 && compared < 2; ++i) {
      const Ref<Component> other = copy(*part);
      const Value value = draw_value(info_, member_, trial.fixtures(), trial.random);
      if (value.none() || !set_if_allowed(*other, member_.name, value)) continue;
      if (equal(member_.get(*other, member_), member_.get(*part, member_))) continue;
      const std::string text = write_description(*other);
      std::string after;
      try {
        after = behaviour(other, trial);
      } catch (...) {
        continue;  // an invalid value may be rejected even where the member has no effect
      }
      ++compared;
      trial.expect(after == before, "what does not matter changes nothing", [&] {
        return fmt::format("'{}' is said to matter only when {}, and does here:\n{}", member_.name, condition.text(info_),
                           text);
      });
    }
    return compared > 0;
  }

  Trial& trial;
  const ClassInfo& info_;
  const Member& member_;
};

/// A colour of 0.5 at all wavelengths that records the uses it is evaluated for.
class NotingColor final : public SpectralFunction {
 public:
  Spectrum evaluate(const Wavelengths&, ColorUse use) const override {
    asked |= 1u << unsigned(use);
    return Spectrum(value);
  }
  /// Called before rendering, for checks and sums of all kinds, so it is not recorded.
  float at(float, ColorUse) const override { return value; }
  std::string expression() const override { return fmt::format("{}", value); }
  bool varies() const override { return false; }

  float value = 0.5f;
  mutable std::atomic<unsigned> asked = 0;
};

/// The uses for which a colour of a Meaning may be evaluated: bits of ColorUse.
unsigned uses(Meaning meaning) {
  switch (meaning) {
    case Meaning::plain: return ~0u;
    case Meaning::number: return 0;
    case Meaning::reflectance: return 1u << unsigned(ColorUse::reflectance);
    case Meaning::radiance: return 1u << unsigned(ColorUse::radiance);
    case Meaning::coefficient:
    case Meaning::index: return 1u << unsigned(ColorUse::coefficient);
  }
  return 0;
}

void check_meaning(Trial& trial, const Member& m) {
  const auto probe = make<NotingColor>();
  if (m.meaning == Meaning::index) probe->value = 1.5f;
  const Ref<Component> part = copy(trial.part());
  try {
    if (m.kind == Kind::color) {
      set(*part, m.name, Value(Color(probe)));
    } else {
      const Ref<Component> map = Registry::instance().create("ConstantMap");
      set(*map, "value", Value(Color(probe)));
      set(*part, m.name, Value(map));
    }
    behaviour(part, trial);
  } catch (...) {
    return;  // some components reject some colours
  }
  trial.expect((probe->asked & ~uses(m.meaning)) == 0, "colours are asked for what they are said to be read as", [&] {
    constexpr const char* names[] = {"reflectance", "radiance", "coefficient"};
    std::string asked;
    for (unsigned i = 0; i < 3; ++i)
      if (probe->asked & (1u << i)) asked += std::string(asked.empty() ? "" : ", ") + names[i];
    return fmt::format("'{}', said to be read as {}, is asked as {}", m.name, name(m.meaning), asked);
  });
}

void check_declarations(Trial& trial) {
  load_job_text(stage, "stage");  // throws if the scene itself is wrong; errors of the component are ignored below
  for (const Member& m : trial.part().class_info().members) {
    if (!m.conditions.empty()) ConditionTrial(trial, m).check();
    if (m.meaning != Meaning::plain && !m.list) check_meaning(trial, m);
  }
}

const RegisterCheck<Component> registered(check_declarations);

}  // namespace
}  // namespace etendue::conform
