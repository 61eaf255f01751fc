#include "network.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <set>

#include "osl/language/compile.h"
#include "osl/running/places.h"
#include "osl_part.h"

namespace etendue::osl {

namespace {

/// The shader that gives a map's value, as a number or as a color: the attribute that MapInputs names.
std::shared_ptr<const Shader> map_shader(bool number) {
  const auto compiled = [](const char* type) {
    const std::string text = fmt::format(
        "shader map_of_the_description(string map = \"\", output {} value = 0) {{ getattribute(map, value); }}", type);
    const Compiled c = compile_text(text, "map");
    if (c.failed()) throw Error(to_text(c.diagnostics));
    return c.shader;
  };
  static const std::shared_ptr<const Shader> of_numbers = compiled("float"), of_colors = compiled("color");
  return number ? of_numbers : of_colors;
}

/// Whether a connection from an output of a type gives a parameter of another its value.
bool may_connect(const Type& from, const Type& to) {
  if (from.is_array() || to.is_array() || from.closure || to.closure) return false;
  return from.base == to.base || (from.triple_based() && to.triple_based()) || (from.is_float() && to.is_triple()) ||
         (from.is_int() && (to.is_float() || to.is_triple()));
}

bool has_constant_default(const Shader& shader, const std::string& name) {
  const Symbol* s = shader.find_parameter(name);
  return s && s->initial && s->initial->kind == Expression::Kind::constant;
}

std::string trimmed(std::string text) {
  const auto blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!text.empty() && blank(text.back())) text.pop_back();
  while (!text.empty() && blank(text.front())) text.erase(0, 1);
  return text;
}

/// "layer.parameter"
std::pair<std::string, std::string> end_of(const std::string& written, const std::string& connection, Location at) {
  const std::string text = trimmed(written);
  const size_t dot = text.find('.');
  if (dot == std::string::npos || dot == 0 || dot + 1 == text.size())
    throw Error(fmt::format("the connection '{}' is not a layer and its output, an arrow, and a layer and its parameter, as in "
                            "\"noise.out -> paint.color\"",
                            connection),
                at);
  return {text.substr(0, dot), text.substr(dot + 1)};
}

}  // namespace

std::shared_ptr<const Shader> Network::shader_of(const std::string& layer) const {
  const auto found = shaders_.find(layer);
  return found == shaders_.end() ? nullptr : found->second;
}

std::string Network::free_name(const std::string& wanted) const {
  std::string name = wanted;
  for (int i = 2; shaders_.contains(name); ++i) name = fmt::format("{}_{}", wanted, i);
  return name;
}

void Network::add_layer(LayerText layer, std::shared_ptr<const Shader> shader) {
  uses_ |= uses_of(*shader);
  depends_on_view_ |= shader->globals[size_t(Global::I)] != nullptr;
  for (const Symbol* global : shader->globals) varies_ |= global && global->global != Global::Ci;
  varies_ |= calls(*shader, "int getattribute(");
  needs_wavelengths_ |= calls(*shader, "spectrum wavelength(");
  shaders_[layer.name] = std::move(shader);
  description_.layers.push_back(std::move(layer));
}

// A map that is an output of a shader is connected; one that is the same everywhere is a constant, so that the shader may be
// specialised for it; all others are asked for their values.
void Network::add_map(const OslPart& part, const std::string& member, const Symbol& parameter, const Ref<ObjectMap>& map,
                      LayerText& layer, std::vector<ConnectionText>& connections) {
  const Location at = part.component().location_of(member);
  const bool number = parameter.type.is_float();
  if (const auto* other = dynamic_cast<const OslPart*>(map.get())) {
    const std::string output = other->map_output();
    const Symbol* symbol = output.empty() ? nullptr : other->osl_class().shader->find_parameter(output);
    if (symbol && may_connect(symbol->type, parameter.type)) {
      connections.push_back({add(*other), output, layer.name, parameter.name, at});
      return;
    }
  }
  if (const Color all = map->constant()) {
    ParameterText text;
    text.name = parameter.name;
    text.type = parameter.type.name();
    text.at = at;
    text.value = number ? constant_number(parameter.type, map->scalar({})) : constant_color(parameter.type, *all);
    layer.parameters.push_back(std::move(text));
    return;
  }
  const auto [made, is_new] = map_layers_.try_emplace({map.get(), number});
  if (is_new) {
    LayerText above;
    above.shader = above.name = made->second = free_name(fmt::format("map_{}", map_layers_.size()));
    Constant name;
    name.type = Type(Base::string);
    name.bytes.resize(sizeof(const String*));
    *reinterpret_cast<const String**>(name.bytes.data()) = maps_.add(map);
    above.parameters.push_back({"map", "string", {}, false, at, name});
    add_layer(std::move(above), map_shader(number));
  }
  connections.push_back({made->second, "value", layer.name, parameter.name, at});
}

std::string Network::add(const OslPart& part) {
  if (const auto known = parts_.find(&part); known != parts_.end()) return known->second;
  const OslClass& of = part.osl_class();
  const Component& self = part.component();
  LayerText layer;
  const std::string written = self.origin ? self.origin->name : std::string();
  layer.shader = layer.name = free_name(written.empty() ? of.own->name : written);
  layer.at = self.location_of();
  shaders_[layer.name] = of.shader;  // the name is taken
  parts_[&part] = layer.name;
  std::vector<ConnectionText> connections;
  for (const OslClass::Parameter& parameter : of.parameters) {
    const auto found = part.declared_values.find(parameter.member);
    const Member& m = *part.info().find(parameter.member);
    const etendue::Value* given = found != part.declared_values.end() ? &found->second : nullptr;
    // A shader that several classes share has the defaults of one of them.
    if (!given && of.own != of.shader && has_constant_default(*of.own, parameter.symbol->name)) given = &m.default_value;
    if (!given) continue;
    if (m.kind == Kind::component) {
      if (const auto* map = given->as<Ref<Component>>(); map && *map)
        add_map(part, parameter.member, *parameter.symbol, ref_cast<ObjectMap>(*map), layer, connections);
      continue;
    }
    ParameterText text;
    text.name = parameter.symbol->name;
    text.at = self.location_of(parameter.member);
    try {
      text.value = constant_of(parameter.symbol->type, m, *given);
    } catch (const Error& e) {
      self.fail(parameter.member, e.what());
    }
    text.type = text.value->type.name();
    layer.parameters.push_back(std::move(text));
  }
  const std::string name = layer.name;
  add_layer(std::move(layer), of.shader);
  lets_in_ |= part.lets_in();
  for (ConnectionText& c : connections) description_.connections.push_back(std::move(c));
  return name;
}

std::string Network::add(std::shared_ptr<const Shader> shader) {
  LayerText layer;
  layer.shader = layer.name = free_name(shader->name);
  const std::string name = layer.name;
  add_layer(std::move(layer), std::move(shader));
  lets_in_ = uses_.interior;
  return name;
}

void Network::add_text(std::string_view text, const std::string& file, const std::vector<std::string>& folders) {
  GroupDescription added = parse_group(text, file);
  for (LayerText& layer : added.layers) {
    if (shaders_.contains(layer.name)) throw Error(fmt::format("there are two layers named '{}'", layer.name), layer.at);
    std::shared_ptr<const Shader> shader = declared_shader(layer.shader, folders, layer.at);
    layer.shader = layer.name;
    add_layer(std::move(layer), std::move(shader));
    lets_in_ = uses_.interior;
  }
  for (ConnectionText& c : added.connections) description_.connections.push_back(std::move(c));
}

void Network::connect(const std::string& text, Location at) {
  const size_t arrow = text.find("->");
  const std::string to = arrow == std::string::npos ? std::string() : text.substr(arrow + 2);
  ConnectionText c;
  std::tie(c.from_layer, c.from) = end_of(text.substr(0, arrow), text, at);
  std::tie(c.to_layer, c.to) = end_of(to, text, at);
  c.at = at;
  for (const std::string& layer : {c.from_layer, c.to_layer}) {
    if (shaders_.contains(layer)) continue;
    std::string known;
    for (const LayerText& l : description_.layers) known += (known.empty() ? "" : ", ") + l.name;
    throw Error(fmt::format("the connection '{}' names no layer '{}'; there are {}", text, layer, known), at);
  }
  description_.connections.push_back(std::move(c));
  lets_in_ = uses_.interior;  // the connection may replace what excluded it
}

/// Brings the layers into an order in which each stands behind those that it is connected to, `last` being the last one; of
/// layers that it does not need, in the order in which they were added.
void Network::sort(const std::string& last) {
  std::vector<LayerText> sorted;
  std::set<std::string> begun, done;
  const std::function<void(const std::string&)> take = [&](const std::string& name) {
    if (done.contains(name)) return;
    const auto layer = std::ranges::find(description_.layers, name, &LayerText::name);
    if (layer == description_.layers.end()) return;  // the group's builder says so
    begun.insert(name);
    for (const ConnectionText& c : description_.connections) {
      if (c.to_layer != name) continue;
      if (begun.contains(c.from_layer) && !done.contains(c.from_layer))
        throw Error(fmt::format("the layers '{}' and '{}' are connected in a circle", c.from_layer, name), c.at);
      take(c.from_layer);
    }
    done.insert(name);
    sorted.push_back(*layer);
  };
  for (const LayerText& layer : description_.layers)
    if (layer.name != last) take(layer.name);
  if (done.contains(last)) {
    const auto user = std::ranges::find(description_.connections, last, &ConnectionText::from_layer);
    throw Error(fmt::format("the layer '{}' gives the result, so that no other layer can be connected to its outputs", last),
                user == description_.connections.end() ? Location{} : user->at);
  }
  take(last);
  description_.layers = std::move(sorted);
}

std::shared_ptr<const ShaderGroup> Network::build(const std::string& name, const std::string& last, GroupOptions options) {
  description_.name = name;
  sort(last);
  options.load = [this](const std::string& layer, Location) { return shader_of(layer); };
  std::vector<GroupProblem> problems;
  std::shared_ptr<const ShaderGroup> group = ShaderGroup::build(description_, options, problems);
  std::string faults;
  Location first;
  // A value that would be ignored is an error here.
  for (const GroupProblem& problem : problems) {
    if (!first.known()) first = problem.at;
    const std::string place = faults.empty() || !problem.at.known() ? "" : place_text(problem.at) + ": ";
    faults += (faults.empty() ? "" : "\n") + place + problem.text;
  }
  if (!faults.empty() || !group) throw Error(faults.empty() ? "the shader cannot be run" : faults, first);
  return group;
}

}  // namespace etendue::osl
