#include "scene_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "etendue/describe/color.h"

namespace etendue::mitsuba {

namespace {

constexpr size_t deepest = 100;                    // nesting of plugins
constexpr size_t deepest_include = 16;             // nesting of included files
constexpr size_t most_includes = 10000;            // of one scene
constexpr size_t most_included = size_t(1) << 30;  // [bytes] of all files together

const std::vector<std::string> plugin_tags = {"integrator", "sensor", "film",   "sampler", "rfilter", "bsdf",      "texture",
                                              "emitter",    "shape",  "medium", "phase",   "volume",  "subsurface"};
const std::vector<std::string> value_tags = {"float",     "integer", "boolean", "string",   "vector",    "point",
                                             "rgb",       "srgb",    "xyz",     "spectrum", "blackbody", "transform",
                                             "animation", "ref",     "alias",   "include",  "default",   "path"};

bool is_one_of(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

/// The beginning of a text in quotation marks; characters outside ASCII, some of which are invisible, as code points.
std::string beginning(const std::string& text) {
  constexpr size_t most = 20;
  const size_t first = std::min(text.find_first_not_of(" \t\r\n"), text.size());
  std::string made;
  size_t shown = 0, i = first;
  while (i < text.size() && shown++ < most) {
    const auto lead = static_cast<unsigned char>(text[i++]);
    if (lead < 0x80) {
      made += lead < ' ' ? ' ' : char(lead);
      continue;
    }
    unsigned code = lead >= 0xf0 ? lead & 0x07u : (lead >= 0xe0 ? lead & 0x0fu : lead & 0x1fu);
    for (; i < text.size() && (static_cast<unsigned char>(text[i]) & 0xc0) == 0x80; ++i)
      code = code << 6 | (static_cast<unsigned char>(text[i]) & 0x3fu);
    made += fmt::format("U+{:04X}", code);
  }
  return "'" + made.substr(0, made.find_last_not_of(' ') + 1) + (i < text.size() ? "…'" : "'");
}

}  // namespace

const Element& SceneReader::read() {
  Element& scene = *elements_.emplace_back(std::make_unique<Element>());
  scene.tag = scene.type = "scene";
  scene.at = importing_.at(1, 1);
  read_file(importing_.path(), scene, importing_.at());
  resolve();
  return scene;
}

void SceneReader::read_file(const std::string& path, Element& into, Location from) {
  std::error_code none;
  const std::string real = std::filesystem::weakly_canonical(path, none).string();
  if (std::ranges::find(open_files_, real) != open_files_.end()) throw Error(fmt::format("'{}' includes itself", path), from);
  if (open_files_.size() >= deepest_include)
    throw Error(fmt::format("more than {} files that include one another", deepest_include), from);
  const XmlFile file(path, open_files_.empty() ? importing_.at().file : intern(path));
  if (file.entities().known())
    importing_.inexact("entities that the file declares are put in their places, which Mitsuba 3 does not do", file.entities());
  bytes_ += file.size();
  if (bytes_ > most_included)
    throw Error(fmt::format("the files that are included amount to more than {} MB", most_included >> 20), from);
  const XmlFile* const outer = std::exchange(file_, &file);
  const std::string outer_folder = std::exchange(folder_, std::filesystem::path(path).parent_path().string());
  const bool outer_old = old_;
  open_files_.push_back(real);
  const pugi::xml_node root = file.root();
  const std::string tag = root.name();
  if (tag == "scene") {
    read_scene_version(root);
    if (open_files_.size() == 1) into.old = old_;
    read_content(root, into);
  } else if (open_files_.size() > 1 && (is_one_of(plugin_tags, modern_tag(tag)) || is_one_of(value_tags, tag))) {
    read_child(root, into);
  } else {
    throw Error(fmt::format("this is no scene of Mitsuba: its outermost element is <{}>, not <scene>", tag), at(root));
  }
  open_files_.pop_back();
  old_ = outer_old;
  folder_ = outer_folder;
  file_ = outer;
}

void SceneReader::read_scene_version(const pugi::xml_node& root) {
  const auto version = attribute(root, "version");
  if (!version) {
    // Tags of version 0.3.
    old_ = root.child("camera") || root.child("luminaire");
    importing_.inexact(fmt::format("<scene> does not say which version of Mitsuba it is for: it is read as for version {}",
                                   old_ ? "0.3, whose tags it has" : "3"),
                       at(root));
    return;
  }
  int major = 0;
  if (std::sscanf(version->text.c_str(), "%d", &major) != 1 || major < 0 || major > 9)
    throw Error(fmt::format("a version such as '3.0.0' is expected, not '{}'", version->text), version->at);
  old_ = major < 2;
}

void SceneReader::read_content(const pugi::xml_node& node, Element& into) {
  for (const pugi::xml_node& child : node.children()) {
    if (child.type() == pugi::node_element)
      read_child(child, into);
    else if (child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata)
      importing_.inexact(fmt::format("text between elements says nothing to Mitsuba: {}", beginning(child.value())),
                         file_->at_text(child));
  }
}

void SceneReader::read_child(const pugi::xml_node& node, Element& into) {
  if (read_directive(node, into)) return;
  const std::string tag = modern_tag(node.name());
  if (is_one_of(plugin_tags, tag) || (tag == "spectrum" && node.attribute("type"))) {
    const auto name = attribute(node, "name");
    add(into, {modern_name(name ? name->text : ""), at(node), Nested{"", read_plugin(node, tag)}});
    return;
  }
  if (!is_one_of(value_tags, tag)) {
    std::vector<std::string> all = plugin_tags;
    all.insert(all.end(), value_tags.begin(), value_tags.end());
    throw Error(fmt::format("<{}> is unknown{}", node.name(), suggestion(tag, all)), at(node));
  }
  const std::string name = modern_name(required(node, "name").text);
  const auto set = [&](auto value) { add(into, {name, at(node), std::move(value)}); };
  if (tag == "float")
    set(parse_number(required(node, "value")));
  else if (tag == "integer")
    set(parse_integer(required(node, "value")));
  else if (tag == "boolean")
    set(parse_boolean(required(node, "value")));
  else if (tag == "string")
    set(required(node, "value").text);
  else if (tag == "vector" || tag == "point")
    set(parse_vector(node, attributes(), places(), 0));
  else if (tag == "rgb" || tag == "srgb")
    set(parse_rgb(required(node, "value"), tag == "srgb"));
  else if (tag == "xyz")
    set(parse_xyz(required(node, "value")));
  else if (tag == "transform")
    set(parse_transform(node, attributes(), places(), old_));
  else
    set(read_spectrum(node, into));
  if (tag != "transform") {
    expect_attributes(node, {"name", "value", "x", "y", "z", "filename", "temperature", "scale", "intent"});
    if (node.first_child()) throw Error(fmt::format("<{}> holds nothing", tag), at(node.first_child()));
  }
}

ColorValue SceneReader::read_spectrum(const pugi::xml_node& node, const Element& into) {
  if (std::string_view(node.name()) == "blackbody") {
    Text text = required(node, "temperature");
    while (!text.text.empty() && (std::isalpha(static_cast<unsigned char>(text.text.back())) || text.text.back() == ' '))
      text.text.pop_back();  // "5000K"
    const auto scale = attribute(node, "scale");
    ColorValue c;
    c.kind = ColorValue::Kind::blackbody;
    try {
      c.color = blackbody_spectrum(parse_number(text));
    } catch (const Error& error) {
      throw Error(error.what(), text.at);
    }
    if (scale) c.color = scaled_spectrum(parse_number(*scale), c.color);
    return c;
  }
  if (const auto file = attribute(node, "filename"))
    return file_spectrum_value(importing_.file(file->text, file->at, into.folder), file->at);
  return parse_spectrum(required(node, "value"));
}

bool SceneReader::read_directive(const pugi::xml_node& node, Element& into) {
  const std::string_view tag = node.name();
  if (tag == "default") {
    // A value from the command line or an earlier default takes precedence.
    const Text name = required(node, "name"), value = required(node, "value");
    if (name.text.empty()) throw Error("a parameter needs a name", name.at);
    defaults_.emplace(name.text, importing_.parameter(name.text).value_or(value.text));
  } else if (tag == "path") {
    const Text folder = required(node, "value");
    importing_.add_search_folder(folder.text, folder.at);
  } else if (tag == "include") {
    read_include(node, into);
  } else if (tag == "ref") {
    read_reference(node, into);
  } else if (tag == "alias") {
    const Text id = required(node, "id"), as = required(node, "as");
    const auto found = by_id_.find(id.text);
    if (found == by_id_.end()) throw Error(fmt::format("there is no '{}' before this alias", id.text), id.at);
    name_element(as.text, found->second, as.at);
  } else if (tag == "animation") {
    read_animation(node, into);
  } else {
    return false;
  }
  return true;
}

void SceneReader::read_include(const pugi::xml_node& node, Element& into) {
  const Text file = required(node, "filename");
  if (++includes_ > most_includes) throw Error(fmt::format("more than {} files are included", most_includes), at(node));
  const std::string path = importing_.file(file.text, file.at, folder_);
  read_file(path, into, file.at);
}

void SceneReader::read_reference(const pugi::xml_node& node, Element& into) {
  const Text id = required(node, "id");
  const auto name = attribute(node, "name");
  expect_attributes(node, {"id", "name"});
  add(into, {modern_name(name ? name->text : ""), id.at, Nested{id.text, nullptr}});
}

void SceneReader::read_animation(const pugi::xml_node& node, Element& into) {
  std::vector<AnimatedTransform::Key> keys;
  for (const pugi::xml_node& child : node.children()) {
    if (child.type() != pugi::node_element) continue;
    if (std::string_view(child.name()) != "transform") throw Error("<animation> holds transforms alone", at(child));
    const Text time = required(child, "time");
    keys.push_back({float(parse_number(time)), parse_transform(child, attributes(), places(), old_).transform.still()});
    if (!keys.back().transform.valid()) throw Error("this transform cannot be inverted: it makes things flat", at(child));
  }
  constexpr auto when = &AnimatedTransform::Key::time;
  std::ranges::sort(keys, {}, when);  // they may be in any order
  if (std::ranges::adjacent_find(keys, {}, when) != keys.end()) throw Error("two transforms have the same time", at(node));
  if (keys.empty()) throw Error("<animation> needs transforms", at(node));
  add(into, {modern_name(required(node, "name").text), at(node), TransformValue{AnimatedTransform(std::move(keys)), {}}});
}

Element* SceneReader::read_plugin(const pugi::xml_node& node, const std::string& tag) {
  if (++depth_ > deepest) throw Error(fmt::format("plugins nest more than {} deep", deepest), at(node));
  expect_attributes(node, {"type", "id", "name", "version"});
  Element* const element = elements_.emplace_back(std::make_unique<Element>()).get();
  element->tag = tag;
  element->type = modern_type(tag, required(node, "type").text);
  element->at = at(node);
  element->old = old_;
  element->folder = folder_;
  if (const auto id = attribute(node, "id")) {
    element->id = id->text;
    name_element(id->text, element, id->at);
  }
  read_content(node, *element);
  --depth_;
  return element;
}

void SceneReader::name_element(const std::string& id, Element* element, Location at) {
  const auto [known, is_new] = by_id_.emplace(id, element);
  if (!is_new)
    throw Error(fmt::format("there are two of the id '{}'; the first is in line {}", id, known->second->at.line), at);
}

void SceneReader::add(Element& into, Property property) {
  if (!property.name.empty() && !std::holds_alternative<Nested>(property.value)) {
    size_t values = 0;
    for (Property& p : into.properties) {
      if (p.name == property.name && old_ && !std::holds_alternative<Nested>(p.value)) {
        importing_.inexact(fmt::format("'{}' is given twice: the last counts, as in Mitsuba 0.x", p.name), property.at);
        p = std::move(property);
        return;
      }
      if (p.name == property.name)
        throw Error(fmt::format("'{}' is given twice; the first is in line {}", p.name, p.at.line), property.at);
      values += !std::holds_alternative<Nested>(p.value);
    }
    constexpr size_t most = 1000;  // the largest plugins have about 30
    if (values >= most) throw Error(fmt::format("a {} has more than {} values", into.tag, most), property.at);
  }
  into.properties.push_back(std::move(property));
}

}  // namespace etendue::mitsuba
