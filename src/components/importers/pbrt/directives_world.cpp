// Directives for materials, textures, shapes, lights and media.

#include "directives.h"

namespace etendue::pbrt {

void Directives::material() {
  Material m;
  m.type = text();
  m.parameters = parameters(m.type, 2);
  r.state.material = r.materials.size();
  r.state.named_material.clear();
  r.materials.push_back(std::move(m));
  if (r.version == 3) make_with_present_textures(r, r.state.material);
}

void Directives::make_named_material() {
  Material m;
  m.name = text();
  m.parameters = parameters(m.name, 2);
  m.type = m.parameters.text("type");
  if (m.type.empty()) throw Error(fmt::format("the material '{}' needs its \"string type\"", m.name), at_);
  const size_t index = r.named_materials[m.name] = r.materials.size();
  r.materials.push_back(std::move(m));
  if (r.version == 3) make_with_present_textures(r, index);
}

void Directives::named_material() {
  const std::string before = std::exchange(r.state.named_material, text());
  // In v3 the name may be given to another material later; in v4 the material may be defined later.
  if (const auto found = r.named_materials.find(r.state.named_material); found != r.named_materials.end()) {
    r.state.material = found->second;
    if (r.version == 3) r.state.named_material.clear();
  } else if (r.version == 3) {
    const std::string name = std::exchange(r.state.named_material, before);
    throw LeftOut(fmt::format("there is no material named '{}'", name), at_, "the one before stays");
  }
}

void Directives::texture() {
  const std::string name = text(), kind = text(), type = text();
  make_texture(r, name, kind, type, parameters(type, 4));
}

void Directives::shape() {
  need_world();
  const std::string type = text();
  r.shape(type, parameters(type, 0));
}

void Directives::light_source() {
  need_world();
  const std::string type = text();
  Parameters p = parameters(type, 1);
  make_light(r, type, std::move(p));
}

void Directives::area_light_source() {
  auto light = std::make_shared<AreaLight>();
  light->type = text();
  light->parameters = parameters(light->type, 1);
  r.state.light = nullptr;
  if (light->type != "diffuse" && light->type != "area")
    throw LeftOut(fmt::format("there is no area light '{}', but 'diffuse'", light->type), at_);
  r.state.light = std::move(light);
}

void Directives::make_named_medium() {
  const std::string name = text();
  make_medium(r, name, parameters(name, 3));
}

void Directives::medium_interface() {
  r.state.inside = r.state.outside = text();
  if (lexer().peek().is(Token::Kind::string)) r.state.outside = text();
}

}  // namespace etendue::pbrt
