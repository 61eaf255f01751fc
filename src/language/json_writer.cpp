// JsonWriter: components as JSON.

#include <fmt/format.h>

#include <charconv>
#include <nlohmann/json.hpp>

#include "json.h"
#include "writer.h"

namespace etendue::language {

namespace {

constexpr size_t line_width = 120;
constexpr int step = 2;

std::string quoted_json(const std::string& text) { return nlohmann::json(text).dump(); }

/// Whether a text is a number in JSON syntax.
bool is_number(const std::string& text) { return nlohmann::json::accept(text) && nlohmann::json::parse(text).is_number(); }

class JsonWriter : public Writer {
 public:
  using Writer::Writer;

  std::string description(const Component& root) {
    collect(root);
    choose_names();
    std::vector<std::string> head;
    if (!plugins_.empty()) {
      std::vector<std::string> files;
      for (const std::string& plugin : plugins_) files.push_back(quoted_json(path_text({plugin, {}}, folder_)));
      head.push_back("\"$plugin\": " + bracketed(files, '[', step));
    }
    std::vector<std::string> names;
    for (const Component* c : order_)
      if (const std::string& name = parts_[c].name; !name.empty())
        names.push_back(quoted_json(name) + ": " + object(*c, 2 * step, {}));
    if (!names.empty()) head.push_back("\"$names\": " + bracketed(names, '{', step, true));
    return object(root, 0, std::move(head)) + "\n";
  }

 private:
  /// Joins items between brackets: on one line if that is short, otherwise one item per line.
  static std::string bracketed(const std::vector<std::string>& items, char open, int indent, bool lines = false) {
    const char close = open == '[' ? ']' : '}';
    if (items.empty()) return {open, close};
    size_t width = size_t(indent);
    for (const std::string& item : items) {
      width += item.size() + 2;
      lines = lines || item.find('\n') != std::string::npos;
    }
    if (!lines && width + 20 <= line_width) return fmt::format("{}{}{}", open, fmt::join(items, ", "), close);
    const std::string margin(size_t(indent) + step, ' ');
    return fmt::format("{}\n{}{}\n{}{}", open, margin, fmt::join(items, ",\n" + margin), std::string(size_t(indent), ' '),
                       close);
  }

  std::string object(const Component& c, int indent, std::vector<std::string> head) {
    const ClassInfo& info = c.class_info();
    std::vector<std::string> items = std::move(head);
    const bool lines = !items.empty();
    items.push_back("\"class\": " + quoted_json(info.name));
    for (const Member& member : info.members) {
      const Value v = member.get(c, member);
      if (written(v, member)) items.push_back(quoted_json(member.name) + ": " + json(v, member, indent + step));
    }
    return bracketed(items, '{', indent, lines);
  }

  /// Long lists of numbers are written in filled lines.
  std::string numbers(const Numbers& n, const Member& member, int indent) const {
    double factor = 1;
    unit_suffix(n.dimension, &member, factor);
    const auto width = size_t(n.width);
    const std::string margin(size_t(indent) + step, ' ');
    std::string text = "[", line;
    for (size_t row = 0; row < n.rows(); ++row) {
      std::string item = width > 1 ? "[" : "";
      for (size_t k = 0; k < width; ++k)
        item += (k > 0 ? ", " : "") +
                number_text(n.values[row * width + k], factor, member.kind == Kind::integer, member.in_double);
      if (width > 1) item += ']';
      if (row + 1 < n.rows()) item += ',';
      if (!line.empty() && margin.size() + line.size() + item.size() > line_width) {
        text += "\n" + margin + line;
        line.clear();
      }
      line += (line.empty() ? "" : " ") + item;
    }
    return text == "[" ? text + line + "]" : text + "\n" + margin + line + "\n" + std::string(size_t(indent), ' ') + "]";
  }

  std::string json(const Value& v, const Member& member, int indent) {
    if (const auto* flag = v.as<bool>()) return *flag ? "true" : "false";
    if (const auto* number = v.as<Number>()) {
      double factor = 1;
      unit_suffix(number->dimension, &member, factor);
      return number_text(number->value, factor, member.kind == Kind::integer, member.in_double);
    }
    if (const auto* text = v.as<std::string>()) return quoted_json(*text);
    if (const auto* n = v.as<Numbers>()) return numbers(*n, member, indent);
    if (const auto* file = v.as<FilePath>()) return quoted_json(path_text(*file, folder_));
    if (const auto* color = v.as<Color>()) {
      if (!*color) return "null";
      const std::string text = color_text(**color, folder_);
      return is_number(text) ? text : quoted_json(text);
    }
    if (const auto* still = v.as<Transform>()) {
      std::vector<std::string> entries;
      for (const double x : still->exact()) entries.push_back(number_text(x, 1, false, true));
      return bracketed(entries, '[', indent);
    }
    if (v.as<AnimatedTransform>()) {
      std::string text = value(v, nullptr, 0, 0);
      for (size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n'))
        text.replace(at, text.find_first_not_of(" \n", at) - at, " ");
      return quoted_json(text);
    }
    if (const auto* c = v.as<Ref<Component>>()) {
      if (!*c) return "null";
      const auto known = parts_.find(c->get());
      if (known != parts_.end() && !known->second.name.empty()) return quoted_json(known->second.name);
      const Member* only = literal(**c, &member);
      return only ? json(only->get(**c, *only), *only, indent) : object(**c, indent, {});
    }
    const auto* list = v.as<Value::List>();
    if (!list) return "null";
    std::vector<std::string> items;
    for (const Value& item : *list) items.push_back(json(item, member, indent + step));
    return bracketed(items, '[', indent);
  }
};

}  // namespace

}  // namespace etendue::language

namespace etendue {

std::string write_json(const Component& component, bool all, const std::string& folder) {
  return language::JsonWriter(all, folder).description(component);
}

}  // namespace etendue
