// The common base of all renderers.

#include "etendue/render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <unordered_set>

#include "describe/guard.h"
#include "etendue/polarizing_scatter.h"
#include "etendue/render/follows_polarization.h"

namespace etendue {

void Renderer::describe(Description<Renderer>& d) {
  d.summary(
       "An image synthesis algorithm. The length of paths (`max_depth`, `roulette_depth`) is counted in segments, from camera "
       "to "
       "luminaire: light seen directly has come by 1, light that was scattered n times by n + 1. Reflection, refraction and "
       "scattering in a medium count, and the way inside a body that scatters light beneath its surface counts as one segment; "
       "what goes straight on (through holes, thin panes, the bounds of media, bodies within others of higher priority) does "
       "not.")
      .group("Sampling")
      .member<&Renderer::samples>("samples", "1", "samples per pixel", range(1, 1 << 30), Effect::none, soft(1, 4096),
                                  logarithmic)
      .member<&Renderer::sampler>("sampler", "", "where random numbers come from")
      .member<&Renderer::light_sampler>("light_sampler", "", "how luminaires are chosen")
      .member<&Renderer::map_filter>(
          "map_filter", "1",
          "width over which maps are averaged where paths from the camera meet them [pixels]; 0: maps as they are. Averages "
          "make less noise, and large images quicker, but they are a bias: what a surface does to light is not the mean of "
          "what its parts do, the pixel's own filter blurs once more, and paths from luminaires do not average",
          range(0, 64), soft(0, 4));
}
static const Register<Renderer> registered;

Renderer::Renderer()
    : sampler(ref_cast<Sampler>(Registry::instance().create("SobolSampler"))),
      light_sampler(ref_cast<LightSampler>(Registry::instance().create("TreeLightSampler"))) {}

std::unique_ptr<RenderProcess> Renderer::start(const RenderContext& context) const {
  if (!sampler) fail("sampler", "a renderer needs a sampler");
  if (!light_sampler) fail("light_sampler", "a renderer needs a light sampler");
  light_sampler->build(context.scene);
  return begin(context);
}

std::unique_ptr<RenderProcess> Renderer::begin(const RenderContext& context) const {
  return std::make_unique<RenderProcess>(*this, context);
}

void Renderer::refuse_samples_of(const Renderer& inner) const {
  if (!inner.origin) return;
  for (const char* name : {"samples", "sampler"})  // even if set to the value it would have anyway
    if (std::ranges::any_of(inner.origin->members, [&](const auto& m) { return m.first == name; }))
      inner.fail(name, "has no effect here: set it on the enclosing " + class_info().name + "");
}

std::string Renderer::limits() const {
  const PathClasses found = finds();
  if (found == no_paths) return "all light: it shows something else, or a part of it";
  std::string text;
  for (const PathClassInfo& c : path_classes())
    if (!(found & c.bit)) text += (text.empty() ? "" : "; ") + std::string(c.what);
  return text;
}

namespace {

/// The registered renderers, also those of plugins, that with default settings find all light of a kind.
std::vector<std::string> renderers_for(PathClass kind) {
  std::vector<std::string> names;
  for (const ClassInfo* info : Registry::instance().subclasses(*Registry::instance().find("Renderer")))
    if (ref_cast<Renderer>(create(*info))->finds() & kind) names.push_back(info->name);
  return names;
}

}  // namespace

std::vector<Advice> Renderer::misses(const SceneTraits& traits) const {
  std::vector<Advice> advice;
  const PathClasses found = finds();
  for (const PathClassInfo& c : path_classes())
    if (!(found & c.bit))
      if (std::string lost = c.in(traits); !lost.empty()) advice.push_back({c.bit, std::move(lost), renderers_for(c.bit)});
  return advice;
}

std::string Renderer::bias() const {
  std::string algorithm;
  if (expectation() == Expectation::consistent) algorithm = "exact only in the limit of many samples";
  if (expectation() == Expectation::biased) algorithm = "an approximation, however many samples are taken";
  if (!(map_filter > 0)) return algorithm;
  return algorithm + (algorithm.empty() ? "" : "; ") + fmt::format("maps are averaged over {} pixels (map_filter)", map_filter);
}

Spectrum Renderer::radiance(const RenderContext&, const Ray&, SampleContext&) const {
  fail({}, "has neither a process of its own nor follows single rays");
}

// ---- polarization
// ------------------------------------------------------------------------------------------------------------

bool follows_polarization(const Renderer& renderer) {
  const auto* following = dynamic_cast<const FollowsPolarization*>(&renderer);
  return following && following->follows_polarization();
}

bool keeps_stokes(const Renderer& renderer) {
  const auto* following = dynamic_cast<const FollowsPolarization*>(&renderer);
  return following && following->keeps_stokes();
}

std::vector<std::string> polarization_followers() {
  std::vector<std::string> names;
  for (const ClassInfo* info : Registry::instance().subclasses(*Registry::instance().find("Renderer")))
    if (const auto renderer = ref_cast<Renderer>(create(*info)); keeps_stokes(*renderer) && follows_polarization(*renderer))
      names.push_back(info->name);
  return names;
}

std::vector<std::string> polarizing_plates(const Scene& scene) {
  std::vector<std::string> plates;
  std::unordered_set<const Component*> seen;
  std::vector<const Component*> left = {&scene};
  const auto look_at = [&](const Value& value) {
    if (const auto* part = value.as<Ref<Component>>(); part && *part) left.push_back(part->get());
  };
  while (!left.empty()) {
    const Component* next = left.back();
    left.pop_back();
    if (!seen.insert(next).second) continue;
    if (const auto* plate = dynamic_cast<const PolarizingPlate*>(next)) {
      const bool named = next->origin && !next->origin->name.empty();
      plates.push_back((named ? "'" + next->origin->name + "'" : "a " + next->class_info().name) + " " + plate->deed());
    }
    for (const Member& m : next->class_info().members) {
      if (m.kind != Kind::component) continue;
      const Value value = m.get(*next, m);
      look_at(value);
      if (const auto* list = value.as<Value::List>())
        for (const Value& item : *list) look_at(item);
    }
  }
  return plates;
}

}  // namespace etendue
