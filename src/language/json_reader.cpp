// Reads JSON into the same syntax as the language's own parser, so that evaluation is the same for both.

#include <fmt/format.h>

#include <map>

#include "json.h"
#include "json_tokens.h"
#include "lexer.h"

namespace etendue::language {

namespace {

constexpr size_t depth_limit = 256;

/// Builds nodes from the events of the JSON parser.
class Builder : public nlohmann::json_sax<nlohmann::json> {
 public:
  Builder(const Source& source, Diagnostics& diagnostics) : source_(source), diagnostics_(diagnostics), places_(source) {}

  bool null() override { return put(token(NodeType::none)); }
  bool boolean(bool value) override {
    Node node = token(NodeType::boolean);
    node.number = value;
    return put(std::move(node));
  }
  bool number_integer(number_integer_t value) override { return number(double(value)); }
  bool number_unsigned(number_unsigned_t value) override { return number(double(value)); }
  bool number_float(number_float_t value, const string_t&) override { return number(value); }
  bool binary(binary_t&) override { return false; }
  bool string(string_t& text) override {
    Node node = token(NodeType::json_text);
    node.text = std::move(text);
    std::string_view written = places_.written();
    if (written.find('\\') != std::string_view::npos)
      node.labels.push_back({std::string(written.substr(1, written.size() - 2)), node.at});
    return put(std::move(node));
  }
  bool start_object(size_t) override { return open(NodeType::component); }
  bool start_array(size_t) override { return open(NodeType::list); }
  bool key(string_t& name) override {
    Frame& frame = frames_.back();
    frame.key = {name, places_.next()};
    const auto [first, fresh] = frame.seen.emplace(name, frame.key.at);
    if (!fresh)
      diagnostics_.add(
          Error(fmt::format("\"{}\" is already set at {}", name, place(first->second, frame.key.at)), frame.key.at));
    return true;
  }
  bool end_object() override {
    places_.next();
    Frame frame = std::move(frames_.back());
    frames_.pop_back();
    // The root object may have no class, and its tables of names are not components.
    const bool table = !frames_.empty() &&
                       (frames_[0].key.text == "$include" || (frames_.size() == 1 && frames_[0].key.text.starts_with("$")));
    if (frame.node.text.empty() && !frames_.empty() && !table) {
      diagnostics_.add(Error("an object must name its class: \"class\": \"…\"", frame.node.at));
      frame.node.type = NodeType::bad;
    }
    return put(std::move(frame.node));
  }
  bool end_array() override {
    places_.next();
    Frame frame = std::move(frames_.back());
    frames_.pop_back();
    if (frame.packed) {
      frame.node.type = NodeType::numbers;
      frame.node.numbers = std::move(frame.packed);
    }
    return put(std::move(frame.node));
  }
  bool parse_error(size_t byte, const std::string&, const nlohmann::json::exception& e) override {
    std::string text = e.what();
    // "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error while parsing …"
    if (const size_t behind = text.find(": "); behind != std::string::npos) text.erase(0, behind + 2);
    for (const char* start : {"syntax error while parsing ", "syntax error "})
      if (text.starts_with(start)) text.erase(0, std::string_view(start).size());
    diagnostics_.add(Error("invalid JSON: " + text, JsonPlaces::place(source_, byte == 0 ? 0 : byte - 1)));
    failed = true;
    return false;
  }

  Node root;
  bool failed = false;

 private:
  struct Frame {
    Node node;
    Label key;
    std::map<std::string, Location> seen;
    std::unique_ptr<Numbers> packed;  // a list of numbers only, or of rows of the same width
  };

  Node token(NodeType type) {
    Node node;
    node.type = type;
    node.at = places_.next();
    return node;
  }
  bool number(double value) {
    Node node = token(NodeType::number);
    node.number = value;
    return put(std::move(node));
  }
  bool open(NodeType type) {
    Frame frame;
    frame.node = token(type);
    frame.node.json = true;
    if (frames_.size() >= depth_limit) {
      diagnostics_.add(Error(fmt::format("too deeply nested: more than {} levels of brackets", depth_limit), frame.node.at));
      failed = true;
      return false;
    }
    frames_.push_back(std::move(frame));
    return true;
  }

  bool put(Node node) {
    if (frames_.empty()) {
      root = std::move(node);
      return true;
    }
    Frame& frame = frames_.back();
    if (frame.node.type == NodeType::list) {
      put_item(frame, std::move(node));
    } else if (frame.key.text == "class") {
      set_class(frame.node, node);
    } else if (frame.seen.at(frame.key.text) == frame.key.at) {
      frame.node.labels.push_back(frame.key);
      frame.node.children.push_back(std::move(node));
    }
    return true;
  }
  void set_class(Node& component, const Node& name) {
    component.text = name.type == NodeType::json_text ? name.text : std::string();
    if (component.text.empty()) diagnostics_.add(Error("\"class\" must be the name of a class, in quotes", name.at));
  }
  /// Numbers and rows of numbers are packed until an item of another kind is added.
  void put_item(Frame& frame, Node node) {
    const bool plain = node.type == NodeType::number;
    const size_t width = plain                                                        ? 1
                         : node.type == NodeType::numbers && node.numbers->width == 1 ? node.numbers->values.size()
                                                                                      : 0;
    const bool row = plain || (width >= 2 && width <= 4);
    if (row && frame.node.children.empty() && (!frame.packed || size_t(frame.packed->width) == width)) {
      if (!frame.packed) frame.packed = std::make_unique<Numbers>(Numbers{{}, int(width), Dimension::none});
      if (plain)
        frame.packed->values.push_back(node.number);
      else
        frame.packed->values.insert(frame.packed->values.end(), node.numbers->values.begin(), node.numbers->values.end());
      return;
    }
    if (frame.packed) unpack(frame);
    frame.node.children.push_back(std::move(node));
  }
  static void unpack(Frame& frame) {
    const std::unique_ptr<Numbers> numbers = std::move(frame.packed);
    const auto width = size_t(numbers->width);
    for (size_t i = 0; i < numbers->rows(); ++i) {
      Node& node = frame.node.children.emplace_back();
      node.at = frame.node.at;
      node.type = width == 1 ? NodeType::number : NodeType::numbers;
      node.number = numbers->values[i * width];
      if (width == 1) continue;
      node.json = true;
      const auto begin = numbers->values.begin() + long(i * width);
      node.numbers = std::make_unique<Numbers>(Numbers{{begin, begin + long(width)}, 1, Dimension::none});
    }
  }

  const Source& source_;
  Diagnostics& diagnostics_;
  JsonPlaces places_;
  std::vector<Frame> frames_;
};

void read_paths(const Node& value, const std::string& key, std::vector<Label>& out, Diagnostics& diagnostics) {
  const auto add = [&](const Node& node) {
    if (node.type == NodeType::json_text)
      out.push_back({node.text, node.at});
    else
      diagnostics.add(Error(fmt::format("\"{}\" expects files in quotes", key), node.at));
  };
  if (value.type == NodeType::list)
    for (const Node& child : value.children) add(child);
  else
    add(value);
}

/// Reads "file", or { "file": …, "with": { param: value }, "as": name }.
void read_include(Node& value, Document& document, Diagnostics& diagnostics) {
  Inclusion made;
  const auto wrong = [&](const std::string& message, Location at) { diagnostics.add(Error(message, at)); };
  const auto text = [&](const Node& node, const std::string& key) {
    if (node.type != NodeType::json_text) wrong(fmt::format("\"{}\" expects a text", key), node.at);
    return Label{node.text, node.at};
  };
  if (value.type != NodeType::component || !value.text.empty()) {
    if (value.type != NodeType::json_text)
      return wrong("\"$include\" expects files in quotes, or { \"file\": \"…\", … }", value.at);
    made.path = {value.text, value.at};
  }
  for (size_t i = 0; i < value.children.size(); ++i) {
    const Label& key = value.labels[i];
    Node& child = value.children[i];
    if (key.text == "file") {
      made.path = text(child, key.text);
    } else if (key.text == "as") {
      made.name = text(child, key.text);
      if (!is_name(made.name.text)) wrong(fmt::format("'{}' cannot be a name", made.name.text), child.at);
    } else if (key.text == "with" && child.type == NodeType::component && child.text.empty()) {
      for (size_t k = 0; k < child.children.size(); ++k)
        made.replaced.push_back({child.labels[k], true, std::move(child.children[k])});
    } else if (key.text == "with") {
      wrong("\"with\" expects an object of params and what they are to be", child.at);
    } else {
      wrong(fmt::format("there is no key \"{}\"{}", key.text, suggestion(key.text, {"file", "with", "as"})), key.at);
    }
  }
  if (!made.path.at.known()) return wrong("an include in braces needs its \"file\"", value.at);
  document.includes.push_back(std::move(made));
}

void read_includes(Node& value, Document& document, Diagnostics& diagnostics) {
  if (value.type != NodeType::list) return read_include(value, document, diagnostics);
  for (Node& child : value.children) read_include(child, document, diagnostics);
}

std::vector<int> columns_of(const std::string& written, int column);

/// A name such as "tree(height, radius = 1 m)" defines a function.
bool read_function(const Label& name, Node& body, Document& document, Diagnostics& diagnostics) {
  Source source{name.at.file, {}, name.text + " = none"};
  source.line = name.at.line;
  source.columns = columns_of(source.text, name.at.column + 1);
  source.columns.resize(source.text.size() + 1, source.columns.back());
  Document head = parse_document(source, diagnostics);
  if (head.definitions.size() != 1 || !head.definitions[0].function) return false;
  Definition& made = document.definitions.emplace_back(std::move(head.definitions[0]));
  if (made.value.type != NodeType::bad) made.value = std::move(body);
  return true;
}

void read_definitions(Node& table, const std::string& key, bool parameters, Document& document, Diagnostics& diagnostics) {
  if (table.type != NodeType::component || !table.text.empty()) {
    diagnostics.add(Error(fmt::format("\"{}\" expects an object of names and what they stand for", key), table.at));
    return;
  }
  for (size_t i = 0; i < table.children.size(); ++i) {
    const Label& name = table.labels[i];
    const std::string& text = name.text;
    const bool function = !parameters && is_name(text.substr(0, text.find('('))) && text.find('(') != std::string::npos;
    if (function && read_function(name, table.children[i], document, diagnostics)) continue;
    if (!is_name(text) || text == "true" || text == "false" || text == "none" || text == "pi")
      diagnostics.add(Error(fmt::format("'{}' cannot be a name: names are letters, digits and '_'", text), name.at));
    else
      document.definitions.push_back({name, parameters, std::move(table.children[i])});
  }
}

}  // namespace

Document parse_json(const Source& source, Diagnostics& diagnostics) {
  Builder builder(source, diagnostics);
  const std::string_view text = source.text;
  nlohmann::json::sax_parse(text.begin(), text.end(), &builder);
  Document document;
  document.whole = !builder.failed;
  Node& root = builder.root;
  if (builder.failed) return document;
  if (root.type != NodeType::component) {
    diagnostics.add(Error("a render description in JSON is an object: { \"class\": \"Job\", … }", root.at));
    document.whole = false;
    return document;
  }
  Node job;
  job.type = NodeType::component;
  job.at = root.at;
  job.text = root.text;
  for (size_t i = 0; i < root.children.size(); ++i) {
    const std::string& key = root.labels[i].text;
    Node& value = root.children[i];
    if (key == "$include") {
      read_includes(value, document, diagnostics);
    } else if (key == "$plugin") {
      read_paths(value, key, document.plugins, diagnostics);
    } else if (key == "$params" || key == "$names") {
      read_definitions(value, key, key == "$params", document, diagnostics);
    } else if (key.starts_with("$") && key != "$schema") {
      const std::string near = suggestion(key, {"$include", "$plugin", "$params", "$names", "$schema"});
      diagnostics.add(Error(fmt::format("there is no key \"{}\"{}", key, near), root.labels[i].at));
    } else if (key != "$schema") {
      job.labels.push_back(root.labels[i]);
      job.children.push_back(std::move(value));
    }
  }
  if (!job.text.empty())
    document.components.push_back(std::move(job));
  else if (!job.labels.empty())
    diagnostics.add(Error("an object must name its class: \"class\": \"…\"", job.at));
  return document;
}

namespace {

/// The columns, in the JSON text, of each byte of an unescaped JSON string and of its end.
std::vector<int> columns_of(const std::string& written, int column) {
  const auto hexadecimal = [&](size_t at) { return std::stoul(written.substr(at, 4), nullptr, 16); };
  std::vector<int> columns;
  for (size_t i = 0; i < written.size();) {
    size_t length = 1, bytes = 1;  // bytes of the escaped and of the unescaped text
    if (written[i] == '\\' && i + 1 < written.size()) {
      length = 2;
      if (written[i + 1] == 'u' && i + 6 <= written.size()) {
        const unsigned long code = hexadecimal(i + 2);
        const bool pair = code >= 0xD800 && code < 0xDC00;
        length = pair ? 12 : 6;
        bytes = pair ? 4 : code < 0x80 ? 1 : code < 0x800 ? 2 : 3;
      }
    }
    const bool within = (static_cast<unsigned char>(written[i]) & 0xC0) == 0x80;
    if (within) --column;
    columns.insert(columns.end(), bytes, column);
    column += int(length);
    i += length;
  }
  columns.push_back(column);
  return columns;
}

}  // namespace

std::unique_ptr<Node> parse_json_string(const Node& node, Diagnostics& diagnostics) {
  Source source{node.at.file, {}, node.text};
  source.line = node.at.line;
  source.columns = columns_of(node.labels.empty() ? node.text : node.labels[0].text, node.at.column + 1);
  source.columns.resize(node.text.size() + 1, source.columns.back());
  return parse_expression(source, diagnostics);
}

}  // namespace etendue::language
