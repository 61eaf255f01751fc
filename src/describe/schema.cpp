// Class descriptions as JSON, and the JSON Schema of render descriptions.

#include <cctype>
#include <cmath>

#include "etendue/describe/reflection.h"
#include "reflection_values.h"
#include "words.h"

namespace etendue {

namespace {

using Json = nlohmann::ordered_json;

/// A condition as JSON: the member, and the values it has or has not, or whether it is set at all.
Json condition_json(const Condition& condition) {
  Json json;
  json["member"] = condition.member;
  if (condition.values.empty()) {
    json["given"] = !condition.unless;
    return json;
  }
  Json& values = json[condition.unless ? "is_not" : "is"] = Json::array();
  for (const Condition::Wanted& wanted : condition.values) std::visit([&](const auto& x) { values.push_back(x); }, wanted);
  return json;
}

/// Adds what a user interface needs in addition to type and range; `prefix` is for keywords outside of the JSON Schema
/// standard.
void add_panel_facts(Json& json, const Member& member, const std::string& prefix) {
  if (!member.group.empty()) json[prefix + "group"] = member.group;
  if (member.meaning != Meaning::plain) json[prefix + "meaning"] = std::string(name(member.meaning));
  if (member.soft) json[prefix + "slider"] = {member.soft->low, member.soft->high};
  if (member.logarithmic) json[prefix + "logarithmic"] = true;
  for (const Condition& condition : member.conditions) json[prefix + "when"].push_back(condition_json(condition));
}

Json member_json(const Member& member) {
  Json json;
  json["name"] = member.name;
  json["type"] = std::string(name(member.kind));
  if (member.list) json["list"] = true;
  if (member.kind == Kind::component) json["class"] = member.component_class;
  if (!unit_text(member).empty()) json["unit"] = member.unit;
  if (member.required) json["required"] = true;
  json["default"] = value_json(member.default_value, member);
  if (member.range) {
    if (std::isfinite(member.range->low)) json["range"][member.range->open_low ? "more_than" : "low"] = member.range->low;
    if (std::isfinite(member.range->high)) json["range"]["high"] = member.range->high;
  }
  if (!member.choices.empty()) json["choices"] = member.choices;
  add_panel_facts(json, member, "");
  json["effect"] = std::string(name(member.effect));
  if (member.owner) json["declared_by"] = member.owner->name;
  json["text"] = member.text;
  return json;
}

Json as_json(const ClassInfo& info) {
  Json json;
  json["name"] = info.name;
  if (const ClassInfo* parent = parent_of(info)) json["parent"] = parent->name;
  json["abstract"] = info.abstract();
  json["summary"] = info.summary;
  if (!info.source.empty()) json["source"] = info.source;
  if (!info.provider.empty()) json["provider"] = info.provider;
  if (!info.literal.empty()) json["literal"] = info.literal;
  json["members"] = Json::array();
  for (const Member& member : info.members) json["members"].push_back(member_json(member));
  json["subclasses"] = Json::array();
  for (const ClassInfo* other : makeable(info))
    if (other != &info) json["subclasses"].push_back(other->name);
  return json;
}

// ---- schema ---------------------------------------------------------------------------------------------------------

Json reference(const std::string& definition) { return {{"$ref", "#/$defs/" + definition}}; }

Json either(const Json& one, const Json& other) { return {{"anyOf", Json::array({one, other})}}; }

/// A number within the member's range; integers that a double cannot represent exactly are excluded.
Json number_schema(const Member& member) {
  const bool whole = member.kind == Kind::integer;
  Json json;
  json["type"] = whole ? "integer" : "number";
  constexpr std::int64_t largest = (std::int64_t(1) << 53) - 1;
  if (member.range && std::isfinite(member.range->low))
    json[member.range->open_low ? "exclusiveMinimum" : "minimum"] = member.range->low;
  else if (whole)
    json["minimum"] = -largest;
  if (member.range && std::isfinite(member.range->high))
    json["maximum"] = member.range->high;
  else if (whole)
    json["maximum"] = largest;
  return json;
}

/// Adds the choices of a string; open choices ("…") become a pattern with their prefix.
void add_choices(Json& json, const std::vector<std::string>& choices) {
  Json closed = Json::array(), all = Json::array();
  for (const std::string& choice : choices) {
    const std::string begin = beginning_of_choice(choice);
    if (begin.empty()) {
      closed.push_back(choice);
      continue;
    }
    std::string pattern = "^";
    for (const char c : begin) {
      if (!std::isalnum(static_cast<unsigned char>(c))) pattern += '\\';
      pattern += c;
    }
    all.push_back({{"pattern", pattern}});
  }
  if (all.empty()) {
    if (!closed.empty()) json["enum"] = closed;
    return;
  }
  all.push_back({{"enum", closed}});
  json["anyOf"] = all;
}

/// The schema of a value itself, without expressions.
Json plain_item_schema(const Member& member) {
  Json json;
  switch (member.kind) {
    case Kind::boolean: json["type"] = "boolean"; break;
    case Kind::integer:
    case Kind::number: return number_schema(member);
    case Kind::string:
      json["type"] = "string";
      add_choices(json, member.choices);
      break;
    case Kind::file: json["type"] = "string"; break;
    case Kind::choice: json["enum"] = member.choices; break;
    case Kind::vector2:
    case Kind::vector3:
    case Kind::point3:
    case Kind::normal3: {
      const int size = member.kind == Kind::vector2 ? 2 : 3;
      json = {{"type", "array"},
              {"items", either(number_schema(member), reference("expression"))},
              {"minItems", size},
              {"maxItems", size}};
      break;
    }
    case Kind::color: return reference("color");
    case Kind::transform: return reference("transform");
    case Kind::component: return reference(member.component_class + ".any");
  }
  return json;
}

/// The schema of a single value of the member, or of one entry of a list: the value, or an expression for it, unless a string
/// is the value itself.
Json item_schema(const Member& member) {
  const Json json = plain_item_schema(member);
  switch (member.kind) {
    case Kind::string:
    case Kind::file:
    case Kind::color:
    case Kind::transform:
    case Kind::component: return json;  // strings are texts, or the referenced schema includes expressions
    case Kind::choice: return either(json, {{"type", "string"}, {"description", "The name of a param."}});
    default: return either(json, reference("expression"));
  }
}

/// Whether the entries are rows of numbers, which may also be written as a flat list.
bool is_row(const Member& member) {
  return member.kind == Kind::vector2 || member.kind == Kind::vector3 || member.kind == Kind::point3 ||
         member.kind == Kind::normal3;
}

Json member_schema(const Member& member) {
  Json json = item_schema(member);
  if (member.list) {
    if (is_row(member)) json = either(json, number_schema(member));
    // Vertex indices and the like may be grouped by threes.
    if (member.kind == Kind::integer)
      json = either(json, {{"type", "array"}, {"items", number_schema(member)}, {"minItems", 3}, {"maxItems", 3}});
    json = {{"type", "array"}, {"items", json}};
    if (member.kind != Kind::string && member.kind != Kind::file) json = either(json, reference("expression"));
  } else if (member.kind == Kind::component || member.kind == Kind::color) {
    json = either(json, {{"type", "null"}});
  }
  json["description"] = member.text;
  if (!unit_text(member).empty()) json["x-unit"] = member.unit;
  add_panel_facts(json, member, "x-");
  json["x-effect"] = std::string(name(member.effect));
  if (!member.required) json["default"] = value_json(member.default_value, member);
  return json;
}

Json class_schema(const ClassInfo& info) {
  Json json;
  json["type"] = "object";
  json["description"] = info.source.empty() ? info.summary : info.summary + " Source: " + info.source;
  json["properties"]["class"] = {{"const", info.name}};
  Json required = Json::array({"class"});
  for (const Member& member : info.members) {
    json["properties"][member.name] = member_schema(member);
    if (member.required) required.push_back(member.name);
  }
  json["required"] = required;
  json["additionalProperties"] = false;
  return json;
}

/// The schema of everything allowed where the class is expected.
Json any_schema(const ClassInfo& info) {
  Json any = Json::array();
  for (const ClassInfo* other : makeable(info)) {
    any.push_back(reference(other->name));
    // For a class with a literal, a plain value is allowed, too.
    if (other->literal.empty()) continue;
    if (const Member* member = other->find(other->literal)) any.push_back(member_schema(*member));
  }
  if (any.empty()) return {{"not", Json::object()}, {"description", "No class of this interface is known."}};
  any.push_back(reference("expression"));
  return {{"description", info.summary}, {"anyOf", any}};
}

/// The schema of the root: a Job, and the other keys of a file.
Json root_schema() {
  const ClassInfo* job = Registry::instance().find("Job");
  Json root = job ? class_schema(*job) : Json{{"type", "object"}};
  root.erase("description");
  const Json texts = {{"type", "array"}, {"items", {{"type", "string"}}}};
  const auto table = [](const std::string& description) {
    Json anything = Json::array(
        {reference("expression"), {{"type", "number"}}, {{"type", "boolean"}}, {{"type", "array"}}, {{"type", "null"}}});
    for (const ClassInfo* info : described_classes())
      if (!info->abstract()) anything.push_back(reference(info->name));
    return Json{{"type", "object"},
                {"description", description},
                {"propertyNames", {{"pattern", "^[A-Za-z_][A-Za-z0-9_]*$"}}},
                {"additionalProperties", {{"anyOf", anything}}}};
  };
  Json& properties = root["properties"];
  properties["$schema"] = {{"type", "string"}};
  const Json parameters = table("Values of the file's params.");
  const Json inclusion = {
      {"type", "object"},
      {"required", Json::array({"file"})},
      {"additionalProperties", false},
      {"properties",
       {{"file", {{"type", "string"}}},
        {"with", parameters},
        {"as", {{"type", "string"}, {"pattern", "^[A-Za-z_][A-Za-z0-9_]*$"}, {"description", "Prefix of its names."}}}}}};
  properties["$include"] = {{"type", "array"}, {"items", {{"anyOf", Json::array({{{"type", "string"}}, inclusion})}}}};
  properties["$include"]["description"] = "Descriptions whose names become known here.";
  properties["$plugin"] = texts;
  properties["$plugin"]["description"] = "Shared libraries whose classes become known here.";
  properties["$params"] = table("Names that -D replaces.");
  properties["$names"] = table(
      "Names for components and values, shared by reference wherever an expression says the name; and "
      "functions, with their parameters behind the name: \"ball(x, r = 1 m)\".");
  properties["$names"]["propertyNames"]["pattern"] = "^[A-Za-z_][A-Za-z0-9_]*(\\(.*\\))?$";
  return root;
}

}  // namespace

std::string class_json(const ClassInfo& info) { return as_json(info).dump(2); }

std::string classes_json() {
  Json all = Json::array();
  for (const ClassInfo* info : described_classes()) all.push_back(as_json(*info));
  return all.dump(2);
}

std::string json_schema() {
  Json definitions;
  definitions["expression"] = {
      {"type", "string"},
      {"minLength", 1},
      {"description",
       "An expression of the render description language: a name of \"$names\" or \"$params\", a number with its unit such as "
       "\"10 cm\", a call such as \"blackbody(2856 K)\", arithmetic, a condition, a list such as \"[ball(i) for i in "
       "0..9]\"."}};
  const auto numbers = [](int count) {
    return Json{{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", count}, {"maxItems", count}};
  };
  definitions["color"] = {
      {"description", "A number for all wavelengths, linear sRGB, or an expression such as blackbody(2856 K)."},
      {"anyOf", Json::array({{{"type", "number"}}, numbers(3), reference("expression")})}};
  definitions["transform"] = {
      {"description", "A matrix of 3 or 4 rows of 4, row by row, or an expression such as translate(0, 1 m, 0)."},
      {"anyOf", Json::array({numbers(12), numbers(16), reference("expression")})}};
  for (const ClassInfo* info : described_classes()) {
    if (!info->abstract()) definitions[info->name] = class_schema(*info);
    definitions[info->name + ".any"] = any_schema(*info);
  }
  Json schema;
  schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  schema["$id"] = "urn:etendue:scene:" ETENDUE_VERSION;
  schema["title"] = "Étendue " ETENDUE_VERSION " render description (JSON)";
  schema["description"] =
      "A scene as JSON, which etendue check, render, verify and save read from files that end in .json, and which etendue save "
      "-o "
      "FILE.json writes. The root is the Job. Numbers without a unit are in the unit of \"x-unit\". What a schema cannot say "
      "is "
      "checked when the scene is read: that files are there, names known, and expressions right. For panels: members of one "
      "\"x-group\" stand together; \"x-slider\" has the ends of a slider, in the member's unit, by ratios if "
      "\"x-logarithmic\"; \"x-meaning\" is what a colour or map is read as; and a member matters only when all of \"x-when\" "
      "hold.";
  schema.update(root_schema());
  schema["$defs"] = std::move(definitions);
  return schema.dump(2);
}

}  // namespace etendue
