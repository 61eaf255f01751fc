// The components of a document as JSON.

#include <fmt/format.h>

#include "describe/reflection_values.h"
#include "etendue/describe/color.h"
#include "language/writer.h"
#include "studio.h"
#include "studio/pixels/linear_srgb.h"

namespace etendue::studio {

using language::Node;
using language::NodeType;

namespace {

constexpr size_t most_numbers = 1000;      // in a list that is sent
constexpr size_t longest_text = 16 << 10;  // of a member that is sent [bytes]
constexpr size_t longest_part = 200;       // of a member whose components are sent separately

/// Whether a value is too large to be displayed.
bool large(const Value& value) {
  const auto* numbers = value.as<Numbers>();
  return numbers && numbers->values.size() > most_numbers;
}

Json color_json(const SpectralFunction& color, Meaning meaning) {
  const ColorUse use = meaning == Meaning::radiance                                   ? ColorUse::radiance
                       : meaning == Meaning::coefficient || meaning == Meaning::index ? ColorUse::coefficient
                                                                                      : ColorUse::reflectance;
  const Color white = illuminant_spectrum("D65");
  const Xyz xyz = to_xyz(color, use, use == ColorUse::radiance ? nullptr : white.get());
  Json wavelengths = Json::array(), values = Json::array();
  for (int nm = 360; nm <= 830; nm += 10) {
    wavelengths.push_back(nm);
    values.push_back(color.at(float(nm), use));
  }
  return {{"color",
           {{"text", color.expression()},
            {"srgb", LinearSrgb()(xyz.x, xyz.y, xyz.z)},
            {"xyz", {xyz.x, xyz.y, xyz.z}},
            {"wavelengths", wavelengths},
            {"values", values}}}};
}

Json data_json(const Document& document, const Value& value, const Member& member) {
  const auto part = [&](const Ref<Component>& c) { return c ? Json{{"component", document.id_of(*c)}} : Json(); };
  if (const auto* one = value.as<Ref<Component>>()) return part(*one);
  if (member.kind == Kind::component && value.none()) return nullptr;
  if (const auto* list = value.as<Value::List>(); list && member.kind == Kind::component) {
    Json all = Json::array();
    for (const Value& item : *list) all.push_back(item.as<Ref<Component>>() ? part(*item.as<Ref<Component>>()) : Json());
    return all;
  }
  if (large(value)) {
    const auto& numbers = *value.as<Numbers>();
    return {{"large", {{"rows", numbers.rows()}, {"width", numbers.width}}}};
  }
  if (const auto* color = value.as<Color>()) return *color ? color_json(**color, member.meaning) : Json();
  const auto matrix = [](const Transform& t) { return Json{{"transform", {{"matrix", t.exact()}}}}; };
  if (const auto* still = value.as<Transform>()) return matrix(*still);
  if (const auto* moving = value.as<AnimatedTransform>()) {
    if (!moving->animated()) return matrix(moving->keys().front().transform);
    return {{"transform", {{"text", value_text(value, member)}}}};
  }
  if (const auto* file = value.as<FilePath>()) return file->text;
  return value_json(value, member);
}

Json member_json(const Document& document, const Component& part, const Member& member, const Node* node) {
  const Value value = member.get(part, member);
  const Node* written = node ? Outline::member(*node, member.name) : nullptr;
  Json json = {{"written", written != nullptr}};
  if (written) {
    const std::string text = document.outline().text({written->begin, written->end});
    if (text.size() <= (member.kind == Kind::component ? longest_part : longest_text)) json["text"] = text;
    json["begin"] = document.places().units(written->begin);
    json["end"] = document.places().units(written->end);
  } else if (!large(value)) {
    std::string text = language::Writer(false, document.folder()).value(value, &member, 0, 0);
    if (text.size() <= longest_text) json["text"] = std::move(text);
  }
  json["value"] = data_json(document, value, member);
  json["matters"] = matters(part, member);
  return json;
}

/// The text of a component that is given by a plain value: this value, in the member that holds the component.
std::optional<Span> literal_span(const Document& document, const Component& part) {
  const auto& uses = document.uses(part);
  if (uses.size() != 1 || part.origin) return {};
  const Node* holder = document.written(*document.component(uses[0].holder));
  const Node* value = holder ? Outline::member(*holder, uses[0].member->name) : nullptr;
  if (!value) return {};
  if (!uses[0].index) return Span{value->begin, value->end};
  try {
    const Node* list = document.outline().resolve(*value);
    const Sequence all = list ? document.outline().entries(*list) : Sequence{};
    return *uses[0].index < all.items.size() ? std::optional(all.items[*uses[0].index]) : std::nullopt;
  } catch (const Error&) {
    return {};
  }
}

}  // namespace

Json component_json(const Document& document, const Component& part) {
  const Node* node = document.written(part);
  Json json = {{"id", document.id_of(part)}, {"class", part.class_info().name}};
  json["name"] = part.origin && !part.origin->name.empty() ? Json(part.origin->name) : Json();
  const std::optional<Span> literal = node ? std::nullopt : literal_span(document, part);
  const bool elsewhere = !node && part.origin && part.origin->location.known();
  json["written"] = node ? "text" : (elsewhere ? "elsewhere" : (literal ? "literal" : "default"));
  if (elsewhere) json["file"] = part.origin->location.file;
  if (node || literal) {
    json["begin"] = document.places().units(node ? node->begin : literal->begin);
    json["end"] = document.places().units(node ? node->end : literal->end);
  }
  Json uses = Json::array();
  for (const Document::Use& use : document.uses(part)) {
    Json one = {{"id", use.holder}, {"member", use.member->name}};
    if (use.index) one["index"] = *use.index;
    uses.push_back(std::move(one));
  }
  json["uses"] = std::move(uses);
  Json members = Json::object();
  for (const Member& member : part.class_info().members) members[member.name] = member_json(document, part, member, node);
  json["members"] = std::move(members);
  return json;
}

Json names_json(const Document& document) {
  Json list = Json::array();
  std::unordered_map<const Node*, int> written;
  for (const Ref<Component>& part : document.components())
    if (const Node* node = document.written(*part)) written.emplace(node, document.id_of(*part));
  for (const language::Definition& d : document.outline().syntax().definitions) {
    const auto found = written.find(document.outline().resolve(d.value));
    const int id = found == written.end() ? 0 : found->second;
    const std::string text = document.outline().text({d.value.begin, d.value.end});
    list.push_back({{"name", d.name.text},
                    {"begin", document.places().units(d.name.begin)},
                    {"end", document.places().units(d.name.begin + d.name.text.size())},
                    {"component", id ? Json(id) : Json()},
                    {"text", text.size() <= longest_text ? text : ""},
                    {"parameter", d.parameter},
                    {"used", !document.outline().uses(d.name.text).empty()}});
  }
  return list;
}

Json tree_json(const Document& document) {
  Json json = {{"event", "tree"}, {"revision", document.revision()}};
  if (!document.valid()) {
    json["root"] = nullptr;
    json["components"] = Json::object();
    json["names"] = Json::array();
    return json;
  }
  json["root"] = document.id_of(document.job());
  Json components = Json::object();
  for (const Ref<Component>& part : document.components())
    components[std::to_string(document.id_of(*part))] = component_json(document, *part);
  json["components"] = std::move(components);
  json["names"] = names_json(document);
  return json;
}

Json error_json(const Error& error, const Document* document) {
  Json json = {{"message", error.what()}};
  const Location& at = error.location;
  if (!at.known()) return json;
  json["file"] = at.file;
  json["line"] = at.line;
  json["column"] = at.column;
  json["shown"] = show(error);
  if (document && at.file == document->name() && at.line > 0) {
    // Marks a whole word, or otherwise one character.
    const std::string& text = document->draft() ? document->draft()->text : document->text();
    const Places places(text);
    const size_t begin = places.byte(at);
    size_t end = begin;
    while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) || text[end] == '_')) ++end;
    json["begin"] = places.units(begin);
    json["end"] = places.units(std::max(end, std::min(begin + 1, text.size())));
  }
  return json;
}

Json errors_json(const std::vector<Error>& errors, const Document* document) {
  Json list = Json::array();
  for (const Error& error : errors) list.push_back(error_json(error, document));
  return list;
}

}  // namespace etendue::studio
