// Makes classes of shaders: parameters become members, metadata their texts, ranges and choices.

#include "osl_class.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <set>

#include "etendue/describe/color.h"
#include "etendue/describe/description.h"
#include "etendue/object_map.h"
#include "osl_part.h"
#include "osl_volume.h"
#include "parameter_values.h"

namespace etendue::osl {

namespace {

const std::string* text_of(const Symbol& s, std::string_view name) {
  const Metadatum* m = s.find(name);
  return m && m->value.type.is_string() ? &m->value.at<const String*>()->text() : nullptr;
}
std::optional<double> number_of(const Symbol& s, std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names)
    if (const Metadatum* m = s.find(name)) {
      if (m->value.type.is_float()) return double(m->value.at<float>());
      if (m->value.type.is_int()) return double(m->value.at<int>());
    }
  return std::nullopt;
}
std::string text_of(const std::vector<Metadatum>& metadata, std::string_view name) {
  for (const Metadatum& m : metadata)
    if (m.name == name && m.value.type.is_string()) return m.value.at<const String*>()->text();
  return {};
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == at)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

/// The constant that is the default of a parameter; null: the shader computes it.
const Constant* default_of(const Symbol& s) {
  return s.initial && s.initial->kind == Expression::Kind::constant ? &s.initial->constant : nullptr;
}

/// The kind of a member for a parameter's type; false: there is none. A number or a color is a map: it may vary.
bool set_kind(Member& m, const Symbol& s) {
  const Type& t = s.type;
  if (t.closure || t.is_structure() || t.base == Base::void_ || t.base == Base::spectrum) return false;
  m.list = t.is_array();
  const std::string* widget = text_of(s, "widget");
  switch (t.base) {
    case Base::int_:
      m.kind = !m.list && widget && (*widget == "checkBox" || *widget == "boolean") ? Kind::boolean : Kind::integer;
      return true;
    case Base::float_:
      m.kind = m.list ? Kind::number : Kind::component;
      m.meaning = m.list ? Meaning::plain : Meaning::number;
      break;
    case Base::string: m.kind = widget && *widget == "filename" ? Kind::file : Kind::string; return true;
    case Base::color:
      m.kind = default_of(s) && !is_color(*default_of(s)) ? Kind::vector3 : m.list ? Kind::color : Kind::component;
      break;
    case Base::point: m.kind = Kind::point3; return true;
    case Base::vector: m.kind = Kind::vector3; return true;
    case Base::normal: m.kind = Kind::vector3; return true;
    case Base::matrix: m.kind = Kind::transform; return !m.list;
    default: return false;
  }
  if (m.kind == Kind::component) m.component_class = "ObjectMap";
  return true;
}

/// The metadata of the language's specification: help, label, page, min, max, widget, options.
void read_metadata(Member& m, const Symbol& s) {
  const std::string *help = text_of(s, "help"), *label = text_of(s, "label"), *page = text_of(s, "page"),
                    *options = text_of(s, "options"), *units = text_of(s, "units");
  m.text = help && !help->empty() ? *help : label && !label->empty() ? *label : "the shader's parameter " + s.name;
  if (units && !units->empty()) m.text += " [" + *units + "]";
  if (!default_of(s)) m.text += "; by default computed by the shader";
  if (page) m.group = *page;
  const bool numeric = m.kind == Kind::number || m.kind == Kind::integer || m.meaning == Meaning::number;
  if (m.kind != Kind::integer && m.kind != Kind::string && m.kind != Kind::boolean && m.kind != Kind::file) m.unit = "1";
  if (numeric) {
    const auto low = number_of(s, {"min"}), high = number_of(s, {"max"});
    if (low || high) m.range = Range{low.value_or(-INFINITY), high.value_or(INFINITY), false};
    const auto soft_low = number_of(s, {"slidermin", "UImin", "uimin"}),
               soft_high = number_of(s, {"slidermax", "UImax", "uimax"});
    if (soft_low && soft_high && *soft_low < *soft_high)
      m.soft = SoftRange{*soft_low, *soft_high};
    else if (low && high && *low < *high)
      m.soft = SoftRange{*low, *high};
    if (m.soft && m.range && !(m.range->contains(m.soft->low) && m.range->contains(m.soft->high))) m.soft.reset();
  }
  if (options && m.kind == Kind::string && text_of(s, "widget") && *text_of(s, "widget") == "popup") {
    m.choices = split(*options, '|');
    std::set<std::string> once(m.choices.begin(), m.choices.end());
    const Constant* d = default_of(s);
    // A default that is no option is kept as one.
    if (d && !m.list && !once.contains(d->at<const String*>()->text())) m.choices.push_back(d->at<const String*>()->text());
    if (once.size() + 1 < m.choices.size()) m.choices.clear();
  }
}

/// Words that the description reads as something else.
bool reserved(const std::string& name) {
  static const std::set<std::string> words = {"true", "false", "none", "pi",  "param", "include", "plugin", "if",
                                              "then", "else",  "for",  "not", "and",   "or",      "in",     "output"};
  return words.contains(name);
}

/// "brushed_metal" as BrushedMetal.
std::string class_name(const std::string& shader) {
  std::string name;
  bool capital = true;
  for (const char c : shader)
    if (c == '_')
      capital = true;
    else if (std::isalnum(static_cast<unsigned char>(c))) {
      name += capital ? char(std::toupper(static_cast<unsigned char>(c))) : c;
      capital = false;
    }
  if (name.empty() || !std::isalpha(static_cast<unsigned char>(name[0]))) name = "Osl" + name;
  return name;
}

/// Holds a default while it is converted.
class Scratch final : public Component, public DeclaredMembers {};

/// Stores a map that is a number, within the member's range.
void store_number(Component& c, const Member& m, const etendue::Value& v) {
  if (const auto* n = v.as<Number>(); n && m.range && n->dimension == Dimension::none && !m.range->contains(n->value))
    throw Error(fmt::format("is {:.9g}, and must be {}", n->value, m.range->text()), v.location);
  Member plain;
  plain.kind = m.kind;
  plain.component_class = m.component_class;
  keep_as_value(plain);
  plain.store(c, m, v);
}

void add_members(ClassInfo& info, OslClass& of) {
  for (const Symbol* s : of.own->parameters) {
    if (s->role != Symbol::Role::parameter) continue;
    Member m;
    if (!set_kind(m, *s)) continue;
    m.name = s->name;
    while (reserved(m.name) || info.find(m.name)) m.name += '_';
    read_metadata(m, *s);
    keep_as_value(m);
    if (m.meaning == Meaning::number) m.store = store_number;
    const Constant* given = default_of(*s);
    Member unlimited = m;
    unlimited.range.reset();
    if (given && m.range && m.meaning == Meaning::number && !m.range->contains(double(given->at<float>()))) m.range.reset();
    if (given && m.range && m.kind == Kind::integer && !m.list && !m.range->contains(double(given->at<int>()))) m.range.reset();
    if (m.soft && !m.range) m.soft.reset();
    try {
      const auto scratch = etendue::make<Scratch>();
      const etendue::Value value = given ? value_of(*given, m) : empty_value(m);
      unlimited.store(*scratch, unlimited, value);
      m.default_value = scratch->declared_values.at(m.name);
      if (!given) m.range.reset(), m.soft.reset();
    } catch (const Error& e) {
      throw Error(fmt::format("{}: its default {}", s->name, e.what()), s->place);
    }
    m.owner = &info;
    info.members.push_back(m);
    of.parameters.push_back({of.shader->find_parameter(s->name), m.name});
  }
}

void add_output(ClassInfo& info, const OslClass& of) {
  if (of.outputs.size() < 2) return;
  Member m;
  m.name = "output";
  m.kind = Kind::choice;
  m.choices = of.outputs;
  m.text = "which of the shader's outputs is the map's value";
  keep_as_value(m);
  m.default_value = etendue::Value(of.outputs.front());
  m.owner = &info;
  info.members.push_back(m);
}

void add_bound(ClassInfo& info) {
  Member m;
  m.name = bound_name;
  m.kind = Kind::number;
  m.unit = "1/m";
  m.text = bound_text;
  m.range = Range{0, INFINITY, false};
  keep_as_value(m);
  m.default_value = etendue::Value(Number{});
  m.owner = &info;
  info.members.push_back(m);
}

/// The settings of the metadatum etendue_opaque by which a surface lets no light through, by members' names.
std::vector<std::pair<std::string, float>> opaque_settings(const OslClass& of) {
  std::vector<std::pair<std::string, float>> settings;
  const std::string text = text_of(of.own->metadata, "etendue_opaque");
  for (const std::string& word : text.empty() ? std::vector<std::string>() : split(text, ' ')) {
    const size_t equals = word.find('=');
    const auto named = [&](const OslClass::Parameter& p) { return p.symbol->name == word.substr(0, equals); };
    const auto found = std::ranges::find_if(of.parameters, named);
    if (equals == word.npos || found == of.parameters.end()) return {};
    settings.emplace_back(found->member, std::strtof(word.c_str() + equals + 1, nullptr));
  }
  return settings;
}

}  // namespace

std::vector<std::unique_ptr<ClassInfo>> make_classes(std::shared_ptr<const Shader> shader, const std::string& file,
                                                     std::shared_ptr<const Shader> own) {
  if (!own) own = shader;
  using Role = OslClass::Role;
  const ClosureUses uses = uses_of(*shader);
  std::vector<std::string> outputs, others;
  bool takes_closures = false;
  for (const Symbol* s : shader->parameters) {
    takes_closures |= s->role == Symbol::Role::parameter && s->type.closure;
    if (s->role != Symbol::Role::output) continue;
    const bool value = !s->type.is_array() && (s->type.is_float() || s->type.is_int() || s->type.is_triple());
    (value ? outputs : others).push_back(s->name);
  }
  // Outputs that are no value of a map can be connected in an OslGroup.
  if (outputs.empty()) outputs = others;
  if (shader->kind == Shader::Kind::displacement) outputs.insert(outputs.begin(), "displacement");
  if (calls(*shader, "int raytype("))
    warn(shader->name + ": raytype() is 0 for all kinds: paths from lights and from the camera meet the same surface",
         shader->place);
  const bool volume = shader->kind == Shader::Kind::volume;
  if (volume && uses.lobes) warn(shader->name + ": closures of surfaces have no effect in a volume shader", shader->place);

  struct Wanted {
    Role role;
    const char *interface, *suffix;
  };
  std::vector<Wanted> wanted;
  const Symbol* result = shader->globals[size_t(Global::Ci)];
  // A closure that another layer makes may be anything.
  const bool has_result = result && result->written, passes_on = takes_closures && has_result;
  const bool black = shader->kind == Shader::Kind::surface && !(uses.emits && has_result) && outputs.empty();
  if (volume)
    wanted.push_back({Role::volume, "VolumeShader", ""});
  else if ((uses.scatters && has_result) || passes_on || black)
    wanted.push_back({Role::surface, "Shader", ""});
  if (!volume && ((uses.emits && has_result) || passes_on)) wanted.push_back({Role::emission, "EmissionShader", "Emission"});
  if (!outputs.empty()) wanted.push_back({Role::map, "ObjectMap", "Map"});
  if (wanted.empty())
    throw Error(
        fmt::format(
            "the shader '{}' has neither closures nor outputs that are numbers or colors, so nothing of it can be rendered",
            shader->name),
        shader->place);

  std::vector<std::unique_ptr<ClassInfo>> classes;
  for (const Wanted& w : wanted) {
    auto of = std::make_shared<OslClass>();
    of->shader = shader;
    of->own = own;
    of->file = file;
    of->role = w.role;
    of->uses = uses;
    of->outputs = outputs;
    auto info = std::make_unique<ClassInfo>();
    info->name = class_name(own->name) + (classes.empty() ? "" : w.suffix);
    info->parent = Registry::instance().find(w.interface);
    info->provider = file;
    const std::string help = text_of(own->metadata, "help"), label = text_of(own->metadata, "label");
    info->summary = !help.empty()    ? help
                    : !label.empty() ? label
                                     : fmt::format("The shader {} in the Open Shading Language.", own->name);
    info->members = info->parent->members;
    info->absent = info->parent->absent;
    if (w.role == Role::volume) add_bound(*info);
    add_members(*info, *of);
    of->opaque = opaque_settings(*of);
    if (w.role == Role::map) add_output(*info, *of);
    info->make = w.role == Role::surface    ? make_surface
                 : w.role == Role::emission ? make_emission
                 : w.role == Role::volume   ? make_volume
                                            : make_map;
    info->declared = of;
    classes.push_back(std::move(info));
  }
  return classes;
}

// A default that is a map is one object of the class's description, so each object has a copy of its own.
OslPart::OslPart(const ClassInfo& info) : info_(info), of_(*static_cast<const OslClass*>(info.declared.get())) {
  for (const Member& m : info.members) {
    if (m.kind != Kind::component || m.list) continue;
    const auto* map = m.default_value.as<Ref<Component>>();
    if (map && *map) declared_values.emplace(m.name, etendue::Value(copy(**map)));
  }
}

bool OslPart::lets_in() const {
  if (!of_.uses.interior || of_.opaque.empty()) return of_.uses.interior;
  const auto is = [this](const std::pair<std::string, float>& setting) {
    const auto given = declared_values.find(setting.first);
    const auto* part = given == declared_values.end() ? nullptr : given->second.as<Ref<Component>>();
    const auto* map = part ? dynamic_cast<const ObjectMap*>(part->get()) : nullptr;
    const Color all = map ? map->constant() : nullptr;
    if (!all) return false;
    const bool number = info_.find(setting.first)->meaning == Meaning::number;
    return number ? map->scalar({}) == setting.second : rgb_of(*all) == Triple(setting.second);
  };
  return !std::ranges::all_of(of_.opaque, is);
}

}  // namespace etendue::osl
