// Integrators: which renderer computes the same.

#include <fmt/format.h>

#include <algorithm>

#include "converter.h"

namespace etendue::mitsuba {

namespace {

const std::vector<std::string> known_integrators = {"path",
                                                    "volpath",
                                                    "volpathmis",
                                                    "volpath_simple",
                                                    "direct",
                                                    "bdpt",
                                                    "ptracer",
                                                    "sppm",
                                                    "ppm",
                                                    "photonmapper",
                                                    "pssmlt",
                                                    "mlt",
                                                    "erpt",
                                                    "vpl",
                                                    "aov",
                                                    "moment",
                                                    "depth",
                                                    "ao",
                                                    "prb",
                                                    "prbvolpath",
                                                    "prb_basic",
                                                    "prb_projective",
                                                    "direct_projective",
                                                    "irrcache",
                                                    "adaptive",
                                                    "multichannel",
                                                    "field",
                                                    "stokes",
                                                    "guiding"};

constexpr int without_end = 100000;  // segments; Russian roulette ends paths long before

}  // namespace

Ref<Component> Converter::renderer(const Element* integrator, const Element* sampler) {
  Ref<Component> made;
  const Location at = integrator ? integrator->at : importing_.at();
  if (integrator) {
    made = light_transport(*integrator);
  } else {
    importing_.inexact("the scene has no integrator: paths are traced", at);
    made = importing_.make("PathTracer", at);
  }
  if (sampler) {
    const Reading reading(*sampler);
    static const std::vector<std::string> known = {"independent", "stratified", "multijitter", "orthogonal",
                                                   "ldsampler",   "halton",     "hammersley",  "sobol"};
    if (std::ranges::find(known, sampler->type) == known.end()) fail_unknown(*sampler, known);
    set_member(*made, "samples", double(sampler->integer("sample_count", 4)), sampler->location_of("sample_count"));
    if (sampler->type == "independent") set_member(*made, "sampler", make("IndependentSampler", *sampler), sampler->at);
    sampler->ignore({"scramble", "jitter", "strength", "dimension"});
  }
  return made;
}

void Converter::set_depths(Component& outer, const Element& e) {
  // A renderer around another has the other's depths.
  const Value inner = outer.class_info().find("inner") ? get(outer, "inner") : Value();
  const auto* within = inner.as<Ref<Component>>();
  Component& renderer = within && *within ? **within : outer;
  // Both count segments: 1 shows emitters alone, 2 adds direct light.
  const std::int64_t depth = e.integer("max_depth", -1);
  if (depth == 0) importing_.inexact("paths of no segment are a black picture: here they have one", e.location_of("max_depth"));
  const double longest = depth < 0 ? without_end : double(std::clamp<std::int64_t>(depth, 1, without_end));
  const auto set_or_tell = [&](const char* member, double value, const char* name) {
    if (renderer.class_info().find(member))
      set_member(renderer, member, value, e.location_of(name));
    else if (e.has(name))
      importing_.inexact(fmt::format("'{}' has no counterpart in {}", name, renderer.class_info().name), e.location_of(name));
  };
  set_or_tell("max_depth", longest, "max_depth");
  set_or_tell("roulette_depth", double(std::max<std::int64_t>(e.integer("rr_depth", 5), 1)), "rr_depth");
  note_hidden_emitters(e);
  if (e.boolean("strict_normals", false))
    e.ignore({"strict_normals"});  // light that interpolated normals would send through a surface never goes through here
}

Ref<Component> Converter::light_transport(const Element& e) {
  if (std::ranges::find(known_integrators, e.type) == known_integrators.end()) fail_unknown(e, known_integrators);
  const Reading reading(e);
  const std::vector<const Element*> inner = e.all("integrator");
  if (!inner.empty()) {  // what only measures, or adds channels, around another
    if (e.type == "aov") {
      inexact(e, "channels of an 'aov' are not written: ask for layers of the image");
      e.ignore({"aovs"});
    }
    if (inner.size() > 1) inexact(*inner[1], "one integrator is used: the first");
    e.ignore({"max_error", "p_value", "max_sample_factor", "resolution", "quality"});
    return light_transport(*inner.front());
  }
  const std::string& t = e.type;
  Ref<Component> made;
  if (t == "direct" || t == "direct_projective") {
    made = make("DirectRenderer", e);
    const std::int64_t both = e.integer("shading_samples", 1);
    const std::int64_t lights = e.integer("emitter_samples", both), bsdfs = e.integer("bsdf_samples", both);
    set_member(*made, "strategy", bsdfs == 0 ? "light" : (lights == 0 ? "shader" : "both"), e.location_of("bsdf_samples"));
    set_member(*made, "light_samples", double(std::max<std::int64_t>(lights, 1)), e.location_of("emitter_samples"));
    set_member(*made, "shader_samples", double(std::max<std::int64_t>(bsdfs, 1)), e.location_of("bsdf_samples"));
    note_hidden_emitters(e);
    e.ignore({"strict_normals"});
    return made;
  }
  if (t == "ao" || t == "depth") {
    made = make(t == "ao" ? "AmbientOcclusionRenderer" : "FeatureRenderer", e);
    if (t == "depth") set_member(*made, "feature", "depth", e.at);
    if (t == "ao") set_member(*made, "rays", double(e.integer("shading_samples", 1)), e.location_of("shading_samples"));
    if (t == "ao" && e.number("ray_length", -1) > 0) set_member(*made, "distance", e.number("ray_length", 0), e.at);
    return made;
  }
  const char* renderer = "PathTracer";
  if (t == "bdpt")
    renderer = "BidirectionalPathTracer";
  else if (t == "ptracer")
    renderer = "LightTracer";
  else if (t == "sppm" || t == "ppm")
    renderer = "ProgressivePhotonMapper";
  else if (t == "photonmapper")
    renderer = "PhotonMapper";
  else if (t == "pssmlt")
    renderer = "PrimarySampleMetropolis";
  else if (t == "mlt" || t == "erpt")
    renderer = "PathSpaceMetropolis";
  static const std::vector<std::string> plain = {"path",      "volpath",    "volpathmis",     "volpath_simple", "prb",
                                                 "prb_basic", "prbvolpath", "prb_projective", "bdpt",           "ptracer"};
  if (std::ranges::find(plain, t) == plain.end())
    inexact(e, fmt::format("integrator '{}' becomes {}, whose other settings are its defaults", t, renderer));
  made = make(renderer, e);
  set_depths(*made, e);
  e.ignore({"light_image", "sample_direct", "samples_per_pass", "block_size", "timeout", "guiding_samples"});
  return made;
}

}  // namespace etendue::mitsuba
