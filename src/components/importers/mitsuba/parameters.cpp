// Substitution of the scene's parameters ("$spp") in attributes, and resolution of references by id.

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "scene_reader.h"

namespace etendue::mitsuba {

std::optional<Text> SceneReader::attribute(const pugi::xml_node& node, const char* name) {
  const pugi::xml_attribute a = node.attribute(name);
  if (!a) return std::nullopt;
  const Location place = file_->at(a, node);
  return Text{with_parameters(a.value(), place), place};
}

Text SceneReader::required(const pugi::xml_node& node, const char* name) {
  if (auto text = attribute(node, name)) return *text;
  throw Error(fmt::format("<{}> needs the attribute '{}'", node.name(), name), at(node));
}

void SceneReader::expect_attributes(const pugi::xml_node& node, std::initializer_list<const char*> names) {
  const std::vector<std::string> known(names.begin(), names.end());
  for (const pugi::xml_attribute& a : node.attributes())
    if (std::ranges::find(known, a.name()) == known.end())
      throw Error(fmt::format("<{}> has no attribute '{}'{}", node.name(), a.name(), suggestion(a.name(), known)),
                  file_->at(a, node));
}

std::string SceneReader::with_parameters(const std::string& text, Location at) {
  size_t dollar = text.find('$');
  if (dollar == std::string::npos) return text;
  std::string result = text.substr(0, dollar);
  while (dollar != std::string::npos) {
    size_t end = dollar + 1;
    while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) || text[end] == '_')) ++end;
    const std::string word = text.substr(dollar + 1, std::min(end - dollar - 1, size_t(200)));
    // "$resolution_x" may be the parameter "resolution" followed by text: the longest known name is substituted.
    std::optional<std::string> value;
    size_t length = word.size();
    for (; length > 0 && !value; --length) {
      const std::string name = word.substr(0, length);
      if (const auto found = defaults_.find(name); found != defaults_.end())
        value = found->second;
      else
        value = importing_.parameter(name);
      if (value) break;
    }
    if (!value) {
      std::vector<std::string> names;
      for (const auto& [name, unused] : defaults_) names.push_back(name);
      throw Error(
          fmt::format("the parameter '${}' has no value: neither <default> nor -D gives one{}", word, suggestion(word, names)),
          at);
    }
    result += *value;
    const size_t rest = dollar + 1 + length;
    dollar = text.find('$', rest);
    result += text.substr(rest, dollar == std::string::npos ? dollar : dollar - rest);
    if (result.size() > 1'000'000) throw Error("a value with its parameters is longer than 1000000 characters", at);
  }
  return result;
}

namespace {

/// Computes how deep plugins nest by containment and reference; cycles are reported when they are converted. The depth is
/// limited because components are created and destroyed recursively.
class Depths {
 public:
  static constexpr size_t most = 100;

  size_t of(const Element& e, size_t above = 0) {
    if (const auto [known, is_new] = depths_.emplace(&e, 0); !is_new) return check(e, above, known->second);
    size_t deepest = 0;
    for (const Property& p : e.properties)
      if (const auto* nested = std::get_if<Nested>(&p.value)) {
        check(*nested->element, above, 1);
        deepest = std::max(deepest, of(*nested->element, above + 1));
      }
    return depths_[&e] = deepest + 1;
  }

 private:
  static size_t check(const Element& e, size_t above, size_t depth) {
    if (above + depth >= most) throw Error(fmt::format("plugins that refer to plugins nest more than {} deep", most), e.at);
    return depth;
  }
  std::map<const Element*, size_t> depths_;  // 0: being computed
};

}  // namespace

void SceneReader::resolve() {
  std::vector<std::string> ids;
  for (const auto& [id, element] : by_id_) ids.push_back(id);
  for (const auto& element : elements_)
    for (Property& p : element->properties) {
      auto* nested = std::get_if<Nested>(&p.value);
      if (!nested || nested->element) continue;
      const auto found = by_id_.find(nested->reference);
      if (found == by_id_.end())
        throw Error(fmt::format("there is nothing of the id '{}'{}", nested->reference, suggestion(nested->reference, ids)),
                    p.at);
      nested->element = found->second;
    }
  Depths depths;
  for (const auto& element : elements_) depths.of(*element);
}

}  // namespace etendue::mitsuba
