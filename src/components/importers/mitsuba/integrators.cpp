// Converts integrators to the renderers that compute the same.

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

constexpr int without_end = 100000;  // segments; Russian roulette terminates paths long before

}  // namespace

Ref<Component> Converter::renderer(const Element& scene, const Element* integrator, const Element* sampler) {
  Ref<Component> made;
  if (integrator) {
    made = light_transport(*integrator);
  } else {
    importing_.inexact(scene.old ? "the scene has no integrator: direct light alone is shown, as in Mitsuba 0.x"
                                 : "the scene has no integrator: paths are traced",
                       scene.at);
    Element none;
    none.tag = "integrator";
    none.type = scene.old ? "direct" : "path";
    none.at = scene.at;
    none.old = scene.old;
    made = light_transport(none);
  }
  if (sampler) {
    const Reading reading(*sampler);
    static const std::vector<std::string> known = {"independent", "stratified", "multijitter", "orthogonal",
                                                   "ldsampler",   "halton",     "hammersley",  "sobol"};
    if (std::ranges::find(known, sampler->type) == known.end()) stand_in(*sampler, known, "the usual one stands for it");
    set_member(*made, "samples", double(sampler->integer("sample_count", 4)), sampler->location_of("sample_count"));
    if (sampler->type == "independent") set_member(*made, "sampler", make("IndependentSampler", *sampler), sampler->at);
    if (sampler->type == "halton") set_member(*made, "sampler", make("HaltonSampler", *sampler), sampler->at);
    if (sampler->type == "stratified") {
      // A square grid of at least as many cells.
      const Ref<Component> grid = make("StratifiedSampler", *sampler);
      const double side = std::ceil(std::sqrt(std::clamp(double(sampler->integer("sample_count", 4)), 1.0, 4096.0 * 4096)));
      for (const char* along : {"x", "y"}) set_member(*grid, along, side, sampler->at);
      set_member(*made, "sampler", grid, sampler->at);
    }
    sampler->ignore({"scramble", "jitter", "strength", "dimension"});
  }
  return made;
}

void Converter::set_depths(Component& outer, const Element& e) {
  // The depths belong to the inner renderer if there is one.
  const Value inner = outer.class_info().find("inner") ? get(outer, "inner") : Value();
  const auto* within = inner.as<Ref<Component>>();
  Component& renderer = within && *within ? **within : outer;
  // In both programs the depth counts segments: 1 shows emitters alone, 2 adds direct light.
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
    e.ignore({"strict_normals"});  // here a shading normal never sends light through a surface
}

// Integrators around another one that only measure or add channels.
Ref<Component> Converter::around(const Element& e, const std::vector<const Element*>& inner) {
  const std::string& t = e.type;
  if (inner.size() > 1) inexact(*inner[1], "one integrator is used: the first");
  if (t == "aov")
    note_channels(e);
  else if (t == "moment" || t == "stokes")
    inexact(e, fmt::format("the channels that '{}' adds are not written", t));
  else if (t == "irrcache")
    inexact(e, inner.front()->type == "direct"
                   ? "light that 'irrcache' adds to 'direct' is left out: 'path' has it"
                   : "'irrcache' is left out: irradiance is computed for each point by itself, without its bias");
  else if (t != "adaptive" && t != "multichannel")
    inexact(e, fmt::format("'{}' around another integrator is left out", t));
  Ref<Component> made = light_transport(*inner.front());
  if (t == "adaptive") {
    // Other renderers splat a sample to many pixels, which adaptive sampling excludes.
    if (const std::string& of = made->class_info().name; of == "PathTracer" || of == "DirectRenderer") {
      inexact(e, "'adaptive' becomes AdaptiveSampling: samples are the mean over all pixels, whatever the error");
      Ref<Component> outer = make("AdaptiveSampling", e);
      set_member(*outer, "inner", made, e.at);
      made = outer;
    } else {
      inexact(e, "'adaptive' is left out: all pixels have the same samples");
    }
  }
  e.dismiss();
  return made;
}

void Converter::note_channels(const Element& e) {
  static constexpr std::pair<const char*, const char*> known[] = {
      {"albedo", "albedo"},        {"depth", "depth"},
      {"position", "position"},    {"uv", "uv"},
      {"sh_normal", "normal"},     {"geo_normal", "geometric_normal"},
      {"prim_index", "primitive"}, {"shape_index", "object"},
  };
  const std::string all = e.string("aovs", "");
  for (size_t begin = 0; begin < all.size();) {
    const size_t end = std::min(all.find(',', begin), all.size());
    std::string asked = all.substr(begin, end - begin);
    begin = end + 1;
    if (const size_t colon = asked.find(':'); colon != std::string::npos) asked.erase(0, colon + 1);
    std::erase(asked, ' ');
    const auto* const found = std::ranges::find(known, asked, [](const auto& k) { return std::string(k.first); });
    if (found == std::end(known)) {
      importing_.inexact(fmt::format("'{}' is no layer of an image here, and is left out", asked), e.location_of("aovs"));
      continue;
    }
    if (asked == "sh_normal" || asked == "geo_normal")
      importing_.inexact("normals of layers are on the side of the camera", e.location_of("aovs"));
    if (asked == "prim_index" || asked == "shape_index")
      importing_.inexact("numbers of layers count from 1", e.location_of("aovs"));
    const bool twice = std::ranges::any_of(layers_, [&](const Value& v) {
      const auto* const text = v.as<std::string>();
      return text && *text == found->second;
    });
    if (!twice) layers_.emplace_back(std::string(found->second), e.location_of("aovs"));
  }
}

// The renderer of a geometric feature: 'field' of version 0.x, or the first channel of an 'aov' without an inner integrator.
Ref<Component> Converter::features(const Element& e) {
  Ref<Component> made = make("FeatureRenderer", e);
  std::string asked = "depth";
  const char* const name = e.type == "field" ? "field" : "aovs";
  if (e.type != "depth") {
    asked = e.string(name, "");
    if (e.type == "aov") note_channels(e);
    asked.resize(std::min(asked.find(','), asked.size()));
    if (const size_t colon = asked.find(':'); colon != std::string::npos) asked.erase(0, colon + 1);
    std::erase(asked, ' ');
  }
  static constexpr std::pair<const char*, const char*> known[] = {
      {"depth", "depth"},
      {"distance", "depth"},
      {"position", "position"},
      {"relPosition", "position"},
      {"geoNormal", "normal"},
      {"geo_normal", "normal"},
      {"shNormal", "shading_normal"},
      {"sh_normal", "shading_normal"},
      {"uv", "uv"},
      {"albedo", "albedo"},
      {"shapeIndex", "object"},
      {"shape_index", "object"},
      {"primIndex", "primitive"},
      {"prim_index", "primitive"},
  };
  const auto found = std::ranges::find(known, asked, [](const auto& k) { return std::string(k.first); });
  const char* const feature = found == std::end(known) ? "depth" : found->second;
  if (found == std::end(known))
    importing_.inexact(fmt::format("'{}' is not shown: depth stands for it", asked), e.location_of(name));
  else if (std::string_view(feature) != "depth")
    importing_.inexact(fmt::format("'{}' is shown as FeatureRenderer's '{}', in colours of its own", asked, feature),
                       e.location_of(name));
  set_member(*made, "feature", feature, e.location_of(name));
  return made;
}

Ref<Component> Converter::light_transport(const Element& e) {
  const Reading reading(e);
  const std::vector<const Element*> inner = e.all("integrator");
  if (!inner.empty()) return around(e, inner);
  const std::string& t = e.type;
  if (t == "depth" || t == "field" || t == "aov") return features(e);
  Ref<Component> made;
  if (t == "direct" || t == "direct_projective") {
    made = make("DirectRenderer", e);
    const std::int64_t both = e.integer("shading_samples", 1);
    const std::int64_t lights = e.integer("emitter_samples", e.integer("luminaire_samples", both)),
                       bsdfs = e.integer("bsdf_samples", both);
    set_member(*made, "strategy", bsdfs == 0 ? "light" : (lights == 0 ? "shader" : "both"), e.location_of("bsdf_samples"));
    set_member(*made, "light_samples", double(std::max<std::int64_t>(lights, 1)), e.location_of("emitter_samples"));
    set_member(*made, "shader_samples", double(std::max<std::int64_t>(bsdfs, 1)), e.location_of("bsdf_samples"));
    note_hidden_emitters(e);
    e.ignore({"strict_normals"});
    return made;
  }
  if (t == "ao") {
    made = make("AmbientOcclusionRenderer", e);
    set_member(*made, "rays", double(e.integer("shading_samples", 1)), e.location_of("shading_samples"));
    if (e.number("ray_length", -1) > 0) set_member(*made, "distance", e.number("ray_length", 0), e.at);
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
  if (std::ranges::find(known_integrators, t) == known_integrators.end()) {
    stand_in(e, known_integrators, "paths are traced");
  } else if (std::ranges::find(plain, t) == plain.end()) {
    inexact(e, fmt::format("integrator '{}' becomes {}, whose other settings are its defaults", t, renderer));
    e.dismiss();
  }
  made = make(renderer, e);
  set_depths(*made, e);
  e.ignore({"light_image", "sample_direct", "samples_per_pass", "block_size", "timeout", "guiding_samples"});
  return made;
}

}  // namespace etendue::mitsuba
