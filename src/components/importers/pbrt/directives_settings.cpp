// Directives before WorldBegin.

#include "directives.h"

namespace etendue::pbrt {

void Directives::set(Setting& setting) {
  need_options();
  if (setting.given) r.importing.inexact(fmt::format("{} is given again: the last one counts", token_.text), at_);
  setting.type = text();
  setting.parameters = parameters(setting.type);
  setting.given = true;
}

void Directives::camera() {
  set(r.camera);
  std::array<Transform, 2> inverse;
  if (!r.state.ctm[0].valid() || !r.state.ctm[1].valid())
    throw Error("the camera cannot be placed: its transform cannot be inverted", at_);
  for (size_t i = 0; i < 2; ++i) inverse[i] = r.state.ctm[i].inverse();
  named_systems_["camera"] = inverse;
  std::swap(r.state.ctm, inverse);
  r.camera_to_world = r.to_world(Transform());
  std::swap(r.state.ctm, inverse);
  r.around_camera = r.state.outside;
  r.around_camera_at = at_;
}

void Directives::film() { set(r.film); }

void Directives::filter() { set(r.filter); }

void Directives::sampler() { set(r.sampler); }

void Directives::integrator() { set(r.integrator); }

void Directives::without_effect() {
  // Accelerators: they do not change the image.
  const std::string type = text();
  parameters(type).forget();
}

void Directives::left_out() {
  const std::string type = text();
  parameters(type).forget();
  r.importing.inexact(fmt::format("{} \"{}\" is of an older pbrt, and left out", token_.text, type), at_);
}

void Directives::option() {
  need_options();
  const Parameters p = Parameters::read(lexer(), "Option", at_);
  for (const Parameter& o : p.own)
    if (o.name == "seed")
      r.seed = p.integer("seed", 0);
    else if (o.name != "rendercoordsys" && o.name != "msereferenceimage" && o.name != "msereferenceout")
      r.importing.inexact(fmt::format("the option '{}' is left out", o.name), o.at);
}

void Directives::color_space() {
  const std::string name = text();
  const std::pair<const char*, const char*> spaces[] = {
      {"srgb", "srgb"}, {"rec2020", "rec2020"}, {"aces2065-1", "aces2065-1"}, {"dci-p3", "display_p3"}};
  for (const auto& [pbrt, ours] : spaces)
    if (name == pbrt) {
      r.state.space = &rgb_space(ours);
      return;
    }
  throw Error(
      fmt::format("there is no colour space '{}'{}", name, suggestion(name, {"srgb", "rec2020", "aces2065-1", "dci-p3"})), at_);
}

void Directives::world_begin() {
  need_options();
  world_ = true;
  r.state.ctm = {};
  r.state.active = 3;
  named_systems_["world"] = r.state.ctm;
  r.exposure = imaging_ratio(r);
}

void Directives::world_end() {
  need_world();
  // The rest is ignored: v3 would read it as another scene.
  while (!lexer().peek().end()) {
    const Token t = lexer().next();
    if (!told_rest_) r.importing.inexact("what stands after WorldEnd is left out", lexer().place(t));
    told_rest_ = true;
  }
}

}  // namespace etendue::pbrt
