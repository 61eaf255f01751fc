// Converts integrators to the renderers that estimate the same light, with their settings.

#include <fmt/format.h>

#include <algorithm>

#include "reader.h"

namespace etendue::pbrt {

namespace {

struct Algorithm {
  const char *type, *renderer;
  bool media;  ///< whether pbrt's integrator handles participating media
};
constexpr Algorithm algorithms[] = {
    {"path", "PathTracer", false},
    {"volpath", "PathTracer", true},
    {"simplepath", "PathTracer", false},
    {"simplevolpath", "PathTracer", true},
    {"randomwalk", "PathTracer", false},
    {"bdpt", "BidirectionalPathTracer", true},
    {"lightpath", "LightTracer", false},
    {"mlt", "MultiplexedMetropolis", true},
    {"sppm", "ProgressivePhotonMapper", false},
    // Direct light and what specular chains show: version 3 has two such integrators, one without multiple importance sampling.
    {"directlighting", "DirectRenderer", false},
    {"whitted", "DirectRenderer", false},
    {"ao", "AmbientOcclusionRenderer", false},
    {"ambientocclusion", "AmbientOcclusionRenderer", false},
};

constexpr double pi = 3.14159265358979323846;

void set_depth(Reader& reader, Component& renderer, const Parameters& p) {
  const bool direct = renderer.class_info().name == "DirectRenderer";
  if (!direct && !renderer.class_info().find("max_depth")) return;
  const int bounces = p.integer("maxdepth", 5);
  if (bounces < 0) throw Error(fmt::format("'maxdepth' must not be negative"), p.place("maxdepth"));
  if (!direct)  // pbrt counts scattering events, this program segments, one more
    return set_member(renderer, "max_depth", std::min(bounces, 99'999) + 1, p.at);
  // Version 3 counts the surfaces along the camera's specular chains; at each of them all luminaires are sampled.
  constexpr int deepest = 64;
  if (bounces > deepest) reader.importing.inexact(fmt::format("'maxdepth' is at most {} here", deepest), p.place("maxdepth"));
  set_member(renderer, "mirrors", "surfaces", p.at);
  set_member(renderer, "view_depth", std::clamp(bounces, 1, deepest), p.at);
}

void set_light_sampler(Reader& reader, Component& renderer, const Parameters& p) {
  const Parameter* given = p.first_of({"lightsampler", "lightsamplestrategy"});
  if (!given || !renderer.class_info().find("light_sampler")) return;
  const std::string type = p.text(given->name);
  const char* name = type == "uniform"                                            ? "UniformLightSampler"
                     : type == "power"                                            ? "PowerLightSampler"
                     : type == "bvh" || type == "exhaustive" || type == "spatial" ? "TreeLightSampler"
                                                                                  : nullptr;
  if (name)
    set_member(renderer, "light_sampler", reader.make(name, given->at), given->at);
  else
    reader.importing.inexact(fmt::format("the light sampler '{}' is not known", type), given->at);
}

/// Sets a member to pbrt's value, clamped to the member's range; warns if the value changes.
void set_within(Reader& reader, Component& renderer, const char* member, const Parameters& p, const char* name) {
  if (!p.has(name)) return;
  const Range range = renderer.class_info().find(member)->range.value_or(Range{});
  const double given = p.number(name, 0), value = std::clamp(given, range.low, range.high);
  if (value != given) reader.importing.inexact(fmt::format("'{}' becomes {}, not {}", name, value, given), p.place(name));
  set_member(renderer, member, value, p.place(name));
}

/// The Markov chains of "mlt", which is Hachisuka's multiplexed Metropolis light transport in both versions (pbrt-v3,
/// MLTIntegrator). Returns the samples per pixel that give the requested number of mutations.
int set_chains(Reader& reader, Component& renderer, const Parameters& p) {
  set_within(reader, renderer, "large_steps", p, "largestepprobability");
  set_within(reader, renderer, "deviation", p, "sigma");
  set_within(reader, renderer, "chains", p, "chains");
  p.ignore({"bootstrapsamples"});  // a fraction of all samples here
  const int each = int(get(renderer, "mutations_per_sample").as<Number>()->value);
  return (std::clamp(p.integer("mutationsperpixel", 100), 1, 1 << 30) + each - 1) / each;
}

/// pbrt's ambient occlusion is black where no surface is seen, and uses geometric normals. Version 3 does not divide by pi.
void set_openness(Reader& reader, Component& renderer, const Parameters& p) {
  if (const double distance = p.number("maxdistance", 0); distance > 0 && distance < 1e30)
    set_member(renderer, "distance", distance, p.at);
  set_member(renderer, "background", 0, p.at);
  set_member(renderer, "shading_normals", false, p.at);
  const double open = (reader.version == 3 ? pi : 1) * reader.exposure;
  if (open != 1) set_member(renderer, "open", open, p.at);
  p.ignore({"cossample", "nsamples"});
}

/// Whether a material may have only delta lobes, judging by its parameters.
bool may_be_smooth(const Material& m) {
  for (const char* smooth : {"mirror", "thindielectric"})
    if (m.type == smooth) return true;
  for (const char* either : {"glass", "dielectric", "conductor", "metal", "coateddiffuse", "coatedconductor", "uber"}) {
    if (m.type != either) continue;
    return std::ranges::none_of(m.parameters.own, [](const Parameter& p) {
      return p.name.find("roughness") != p.name.npos && p.name != "remaproughness" &&
             !(p.numbers.size() == 1 && p.numbers[0] == 0);
    });
  }
  return false;
}

/// Warns when directions are sampled independently of the BSDF: pbrt then finds no light by mirrors and smooth glass.
void tell_blind_walks(Reader& reader, const Parameters& p) {
  if (std::ranges::any_of(reader.materials, may_be_smooth))
    reader.importing.inexact(
        fmt::format("the integrator '{}' tries all directions alike, so that mirrors and smooth glass are black in pbrt; here "
                    "they are not",
                    reader.integrator.type),
        p.at);
}

/// The scene's integrator; null: it is unknown.
const Algorithm* algorithm_of(const Reader& reader) {
  std::string_view type = reader.integrator.type;
  if (type.empty()) type = reader.version == 4 ? "volpath" : "path";
  const auto* const found = std::ranges::find_if(algorithms, [&](const Algorithm& a) { return type == a.type; });
  return found == std::end(algorithms) ? nullptr : found;
}

}  // namespace

bool knows_media(const Reader& reader) {
  const Algorithm* const found = algorithm_of(reader);
  return found && found->media;
}

Integrator make_integrator(Reader& reader, int samples) {
  const Setting& s = reader.integrator;
  const Parameters& p = s.parameters;
  const Algorithm* const found = algorithm_of(reader);
  if (!found) reader.importing.inexact(fmt::format("the integrator '{}' is not known: path tracing is taken", s.type), p.at);
  const Ref<Component> renderer = reader.make(found ? found->renderer : "PathTracer", p.at);
  const bool light = renderer->class_info().name != "AmbientOcclusionRenderer";
  if (found && !found->media && light && !reader.media.empty())
    reader.importing.inexact(
        fmt::format("the integrator '{}' leaves media out in pbrt; those within objects are there here", found->type), p.at);
  set_depth(reader, *renderer, p);
  set_light_sampler(reader, *renderer, p);
  int count = samples;
  if (s.type == "mlt") {
    count = set_chains(reader, *renderer, p);
  } else if (s.type == "sppm") {
    count = p.integer(p.has("numiterations") ? "numiterations" : "iterations", reader.version == 3 ? 64 : count);
    if (p.has("radius"))
      reader.importing.inexact("the radius of photons is found from the picture, not the one given", p.place("radius"));
    if (const int walks = p.integer("photonsperiteration", -1); walks > 0) set_member(*renderer, "photon_walks", walks, p.at);
    p.ignore({"imagewritefrequency"});
    if (p.has("seed")) reader.seed = p.integer("seed", 0);
  } else if (!light) {
    set_openness(reader, *renderer, p);
  } else if (s.type == "directlighting") {
    const std::string strategy = p.text("strategy", "all");  // sampling one luminaire or each has the same mean
    if (strategy != "all" && strategy != "one")
      reader.importing.inexact(fmt::format("there is no strategy '{}'", strategy), p.place("strategy"));
  } else if (s.type == "randomwalk" || s.type == "simplevolpath" ||
             (s.type == "simplepath" && !p.boolean("samplelights", true))) {
    set_member(*renderer, "next_event", false, p.at);
  }
  if (s.type == "randomwalk" || (s.type == "simplepath" && !p.boolean("samplebsdf", true))) tell_blind_walks(reader, p);
  if (p.boolean("regularize", false))
    reader.importing.inexact("'regularize' is left out: nothing is made rougher than it is", p.place("regularize"));
  p.ignore({"rrthreshold", "samplebsdf", "visualizestrategies", "visualizeweights"});
  if (p.has("pixelbounds")) reader.importing.inexact("'pixelbounds' of an integrator are left out", p.place("pixelbounds"));
  return {renderer, count};
}

}  // namespace etendue::pbrt
