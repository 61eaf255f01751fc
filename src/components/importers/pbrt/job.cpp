// Integrator, sampler and light sampler.

#include <fmt/format.h>

#include <algorithm>

#include "reader.h"

namespace etendue::pbrt {

namespace {

/// Samples of each pixel.
int samples(Reader& reader) {
  const Parameters& p = reader.sampler.parameters;
  const std::string& type = reader.sampler.type;
  if (type == "stratified") {
    const double count = double(p.integer("xsamples", 4)) * p.integer("ysamples", 4);
    p.ignore({"jitter"});
    return int(std::clamp(count, 1.0, 1073741824.0));
  }
  const int otherwise = type == "independent" || type == "random" ? 4 : 16;
  return std::clamp(p.integer("pixelsamples", otherwise), 1, 1073741824);
}

Ref<Component> sampler(Reader& reader) {
  const Setting& s = reader.sampler;
  const bool independent = s.type == "independent" || s.type == "random" || s.type == "stratified";
  const char* known[] = {"",           "zsobol",      "sobol",      "paddedsobol",    "halton",     "pmj02bn",        "random",
                         "stratified", "independent", "02sequence", "lowdiscrepancy", "maxmindist", "zerotwosequence"};
  if (std::ranges::none_of(known, [&](const char* k) { return s.type == k; }))
    reader.importing.inexact(fmt::format("the sampler '{}' is not known: Sobol points are taken", s.type), s.parameters.at);
  if (s.parameters.has("seed")) reader.seed = s.parameters.integer("seed", 0);
  // Which points they are makes no difference to the picture that is converged to.
  s.parameters.ignore({"randomization", "dimensions", "samplepixelcenter"});
  return reader.make(independent ? "IndependentSampler" : "SobolSampler", s.parameters.at);
}

struct Algorithm {
  const char *type, *renderer;
  const char* difference;  ///< null: the same
};
constexpr Algorithm algorithms[] = {
    {"path", "PathTracer", nullptr},
    {"volpath", "PathTracer", nullptr},
    {"simplepath", "PathTracer", nullptr},
    {"simplevolpath", "PathTracer", nullptr},
    {"randomwalk", "PathTracer", nullptr},
    {"bdpt", "BidirectionalPathTracer", nullptr},
    {"lightpath", "LightTracer", nullptr},
    {"mlt", "PathSpaceMetropolis", "Metropolis light transport by mutations of paths, where pbrt mutates their numbers"},
    {"sppm", "ProgressivePhotonMapper", nullptr},
    {"directlighting", "DirectRenderer", "the direct lighting integrator follows no mirrors here"},
    {"whitted", "WhittedRenderer", nullptr},
    {"ao", "AmbientOcclusionRenderer", nullptr},
    {"ambientocclusion", "AmbientOcclusionRenderer", nullptr},
};

void set_depth(Component& renderer, const Parameters& p) {
  if (!renderer.class_info().find("max_depth")) return;
  const int bounces = p.integer("maxdepth", 5);
  if (bounces < 0) throw Error(fmt::format("'maxdepth' must not be negative"), p.place("maxdepth"));
  // pbrt counts where light is scattered, here the segments between: one more.
  const bool whitted = renderer.class_info().name == "WhittedRenderer";
  set_member(renderer, "max_depth", std::min(bounces, whitted ? 63 : 99'999) + 1, p.at);
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

}  // namespace

void set_renderer(Reader& reader, Component& job) {
  Setting& s = reader.integrator;
  const Parameters& p = s.parameters;
  if (s.type.empty()) s.type = reader.version == 4 ? "volpath" : "path";
  const Algorithm* found = nullptr;
  for (const Algorithm& a : algorithms)
    if (s.type == a.type) found = &a;
  if (!found)
    reader.importing.inexact(fmt::format("the integrator '{}' is not known: path tracing is taken", s.type), p.at);
  else if (found->difference)
    reader.importing.inexact(found->difference, p.at);
  const Ref<Component> renderer = reader.make(found ? found->renderer : "PathTracer", p.at);
  set_depth(*renderer, p);
  set_light_sampler(reader, *renderer, p);
  int count = samples(reader);
  if (s.type == "mlt") {
    count = p.integer("mutationsperpixel", 100);
    p.ignore({"bootstrapsamples", "chains", "largestepprobability", "sigma"});
  } else if (s.type == "sppm") {
    count = p.integer(p.has("numiterations") ? "numiterations" : "iterations", reader.version == 3 ? 64 : count);
    if (p.has("radius"))
      reader.importing.inexact("the radius of photons is found from the picture, not the one given", p.place("radius"));
    if (const int walks = p.integer("photonsperiteration", -1); walks > 0) set_member(*renderer, "photon_walks", walks, p.at);
    p.ignore({"imagewritefrequency"});
    if (p.has("seed")) reader.seed = p.integer("seed", 0);
  } else if (found && std::string_view(found->renderer) == "AmbientOcclusionRenderer") {
    if (const double distance = p.number("maxdistance", 0); distance > 0 && distance < 1e30)
      set_member(*renderer, "distance", distance, p.at);
    p.ignore({"cossample", "nsamples"});
  } else if (s.type == "directlighting") {
    p.ignore({"strategy"});
  } else if (s.type == "randomwalk" || (s.type.starts_with("simple") && !p.boolean("samplelights", true))) {
    set_member(*renderer, "next_event", false, p.at);
  }
  if (p.boolean("regularize", false))
    reader.importing.inexact("'regularize' is left out: nothing is made rougher than it is", p.place("regularize"));
  p.ignore({"rrthreshold", "samplebsdf", "visualizestrategies", "visualizeweights"});
  if (p.has("pixelbounds")) reader.importing.inexact("'pixelbounds' of an integrator are left out", p.place("pixelbounds"));
  set_member(*renderer, "samples", std::clamp(count, 1, 1073741824), p.at);
  set_member(*renderer, "sampler", sampler(reader), p.at);
  if (s.given) p.tell_unused(reader.importing);
  if (reader.sampler.given) reader.sampler.parameters.tell_unused(reader.importing);
  set_member(job, "renderer", renderer, p.at);
}

}  // namespace etendue::pbrt
