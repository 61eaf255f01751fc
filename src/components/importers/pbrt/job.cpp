// Converts the sampler, and sets the renderer of the job.

#include <fmt/format.h>

#include <algorithm>

#include "reader.h"

namespace etendue::pbrt {

namespace {

/// Samples per pixel.
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
  const bool independent = s.type == "independent" || s.type == "random";
  const char* known[] = {"",           "zsobol",      "sobol",      "paddedsobol",    "halton",     "pmj02bn",        "random",
                         "stratified", "independent", "02sequence", "lowdiscrepancy", "maxmindist", "zerotwosequence"};
  if (std::ranges::none_of(known, [&](const char* k) { return s.type == k; }))
    reader.importing.inexact(fmt::format("the sampler '{}' is not known: Sobol points are taken", s.type), s.parameters.at);
  if (s.parameters.has("seed")) reader.seed = s.parameters.integer("seed", 0);
  // The choice of points does not change the image that rendering converges to.
  s.parameters.ignore({"randomization", "dimensions", "samplepixelcenter"});
  const Location& at = s.parameters.at;
  const auto count = [&](const char* name, int otherwise, int most) {
    return double(std::clamp(s.parameters.integer(name, otherwise), 1, most));
  };
  if (s.type == "stratified") {
    const Ref<Component> made = reader.make("StratifiedSampler", at);
    set_member(*made, "x", count("xsamples", 4, 4096), at);
    set_member(*made, "y", count("ysamples", 4, 4096), at);
    return made;
  }
  if (s.type == "zsobol") {
    const Ref<Component> made = reader.make("ZSobolSampler", at);
    set_member(*made, "samples", count("pixelsamples", 16, 1 << 20), at);
    return made;
  }
  if (s.type == "pmj02bn") {
    const Ref<Component> made = reader.make("Pmj02Sampler", at);
    set_member(*made, "blue_noise", true, at);
    return made;
  }
  if (s.type == "halton") return reader.make("HaltonSampler", at);
  return reader.make(independent ? "IndependentSampler" : "SobolSampler", at);
}

}  // namespace

void set_renderer(Reader& reader, Component& job) {
  const Integrator made = make_integrator(reader, samples(reader));
  const Location at = reader.integrator.parameters.at;
  set_member(*made.renderer, "samples", std::clamp(made.samples, 1, 1073741824), at);
  set_member(*made.renderer, "sampler", sampler(reader), at);
  if (reader.integrator.given) reader.integrator.parameters.tell_unused(reader.importing);
  if (reader.sampler.given) reader.sampler.parameters.tell_unused(reader.importing);
  set_member(job, "renderer", made.renderer, at);
}

}  // namespace etendue::pbrt
