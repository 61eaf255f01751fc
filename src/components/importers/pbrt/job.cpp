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
  const bool independent = s.type == "independent" || s.type == "random" || s.type == "stratified";
  const char* known[] = {"",           "zsobol",      "sobol",      "paddedsobol",    "halton",     "pmj02bn",        "random",
                         "stratified", "independent", "02sequence", "lowdiscrepancy", "maxmindist", "zerotwosequence"};
  if (std::ranges::none_of(known, [&](const char* k) { return s.type == k; }))
    reader.importing.inexact(fmt::format("the sampler '{}' is not known: Sobol points are taken", s.type), s.parameters.at);
  if (s.parameters.has("seed")) reader.seed = s.parameters.integer("seed", 0);
  // The choice of points does not change the image that rendering converges to.
  s.parameters.ignore({"randomization", "dimensions", "samplepixelcenter"});
  return reader.make(independent ? "IndependentSampler" : "SobolSampler", s.parameters.at);
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
