#include "loader.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "files/no_description.h"
#include "json.h"

namespace etendue::language {

namespace {

constexpr size_t include_limit = 64;

/// The position of a carriage return without a line feed. With such line ends the rest of the file could become part of a
/// comment.
std::optional<size_t> lone_carriage_return(const std::string& text) {
  for (size_t at = text.find('\r'); at != std::string::npos; at = text.find('\r', at + 1))
    if (at + 1 == text.size() || text[at + 1] != '\n') return at;
  return std::nullopt;
}

Location start_of(const std::string& path) { return {intern(path), 0, 0}; }

}  // namespace

std::string canonical_path(const std::string& path) {
  std::error_code error;
  const auto found = std::filesystem::weakly_canonical(path, error);
  return error ? path : found.string();
}

void Loader::add_file(const std::string& path) {
  main_ = intern(path);
  try {
    load(path, start_of(path), evaluator_.root(), false);
  } catch (const TooManyErrors&) {
    diagnostics_.raise();
  }
}

void Loader::add_text(const std::string& text, const std::string& name, const std::string& folder) {
  main_ = intern(name);
  remember_text(main_, text);
  try {
    add({main_, folder, text}, evaluator_.root());
  } catch (const TooManyErrors&) {
    diagnostics_.raise();
  }
}

// A file included under a name is read again for each name; any other file is read once for a namespace and its inner ones.
bool Loader::load(const std::string& path, Location named_at, Space& space, bool again) {
  const std::string spelling = canonical_path(path);
  const auto active = std::find_if(active_.begin(), active_.end(), [&](const auto& a) { return a.first == spelling; });
  if (active != active_.end()) {
    std::string chain;
    for (auto i = active; i != active_.end(); ++i) chain += i->second + " → ";
    diagnostics_.add(Error(fmt::format("the file includes itself: {}{}", chain, path), named_at));
    return false;
  }
  if (!again && included_at(spelling, space)) return false;
  if (active_.size() >= include_limit) {
    diagnostics_.add(Error("files are included too deeply: more than 64 levels", named_at));
    return false;
  }
  files_.emplace(std::pair(spelling, &space), named_at);
  Source source;
  try {
    source = {intern(path), std::filesystem::path(path).parent_path().string(), read_text_file(path, named_at)};
  } catch (const Error& e) {
    diagnostics_.add(e);
    whole_ = false;
    return false;
  }
  const auto others = [&] { return other_files_ ? other_files_->endings() : std::vector<std::string>(); };
  const std::string wrong = why_no_description(path, source.text, main_ == intern(path) && active_.empty(), others);
  if (!wrong.empty()) {
    diagnostics_.add(Error(wrong, named_at));
    whole_ = false;
    return false;
  }
  if (&space != &evaluator_.root() && !may_read_again(source.text.size(), named_at)) return false;
  active_.emplace_back(spelling, path);
  add(std::move(source), space);
  active_.pop_back();
  return true;
}

// The location where the file was included before, in this namespace or an enclosing one.
const Location* Loader::included_at(const std::string& spelling, Space& space) const {
  for (Space* outer = &space; outer; outer = evaluator_.around(*outer))
    if (const auto found = files_.find({spelling, outer}); found != files_.end()) return &found->second;
  return nullptr;
}

// Limits repeated reading: files that include other files under several names could double the work with each level.
bool Loader::may_read_again(size_t size, Location named_at) {
  constexpr size_t most = 1000, most_bytes = size_t(256) << 20;
  bytes_again_ += size;
  if (++again_ <= most && bytes_again_ <= most_bytes) return true;
  diagnostics_.add(Error(
      fmt::format("too much is included under names: at most {} files, and {} bytes in all", most, most_bytes), named_at));
  throw TooManyErrors{};
}

void Loader::include(Inclusion& inclusion, const std::string& folder, Space& space) {
  const Label& file = inclusion.path;
  if (!options_.allow_files) return diagnostics_.add(Error("files are not allowed here", file.at));
  if (file.text.empty()) return diagnostics_.add(Error("the file name is empty", file.at));
  const std::string path = FilePath{file.text, folder}.resolved();
  const bool named = !inclusion.name.text.empty();
  Space* made = named ? evaluator_.make_space(space, inclusion.name) : &space;
  if (!made) return;
  Space& target = *made;
  const Location* before = named ? nullptr : included_at(canonical_path(path), space);
  if (before && !inclusion.replaced.empty()) {
    diagnostics_.add(
        Error(fmt::format("'{}' is included already, at {}: include it as a name of its own to give it other params: "
                          "… }} as name",
                          file.text, place(*before, file.at)),
              file.at));
    return;
  }
  if (other_files_ && other_files_->are_read(path)) {
    if (before || include_other(inclusion, path, target, space)) return;
    whole_ = false;
    return;
  }
  const bool whole_before = std::exchange(whole_, true);
  load(path, file.at, target, named);
  for (Definition& definition : inclusion.replaced)
    if (whole_) evaluator_.replace(std::move(definition), target, space, file.text);
  whole_ = whole_ && whole_before;
}

void Loader::add(Source source, Space& space) {
  if (const auto wrong = invalid_utf8(source.text)) {
    const std::string_view before = std::string_view(source.text).substr(0, *wrong);
    const size_t line_begin = before.rfind('\n') + 1;  // npos + 1 is 0
    const auto begins_character = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; };
    const int line = 1 + int(std::count(before.begin(), before.end(), '\n'));
    size_t first = line_begin;
    if (first == 0 && before.starts_with("\xEF\xBB\xBF")) first = 3;
    const int column = 1 + int(std::count_if(before.begin() + long(first), before.end(), begins_character));
    const auto byte = static_cast<unsigned char>(source.text[*wrong]);
    const bool wide = source.text.starts_with("\xFF\xFE") || source.text.starts_with("\xFE\xFF");
    diagnostics_.add(
        Error(fmt::format("the text is not valid UTF-8: byte 0x{:02X}{}", byte, wide ? "; it seems to be UTF-16" : ""),
              {source.name, line, column}));
    whole_ = false;
    return;
  }
  if (const auto lone = lone_carriage_return(source.text)) {
    const int line = 1 + int(std::count(source.text.begin(), source.text.begin() + long(*lone), '\n'));
    diagnostics_.add(
        Error("a line ends with a carriage return alone: lines end with a line feed, or with both", {source.name, line, 1}));
    whole_ = false;
    return;
  }
  const std::string folder = source.folder;
  evaluator_.set_folder(source.name, folder);
  Document document = is_json(source.name) ? parse_json(source, diagnostics_) : parse_document(source, diagnostics_);
  source.text = {};  // frees memory: the text may be as large as its syntax tree
  whole_ = whole_ && document.whole;
  for (const Label& plugin : document.plugins) open_plugin(plugin, folder);
  for (Definition& definition : document.definitions) evaluator_.define(std::move(definition), space);
  for (Node& component : document.components) components_.emplace_back(std::move(component), &space);
  // Includes without a name come first, since files included under a name use their names.
  for (const bool named : {false, true})
    for (Inclusion& inclusion : document.includes)
      if (inclusion.name.text.empty() != named) include(inclusion, folder, space);
}

void Loader::open_plugin(const Label& plugin, const std::string& folder) {
  if (!options_.allow_files) {
    diagnostics_.add(Error("plugins are not allowed here", plugin.at));
    return;
  }
  try {
    Registry::instance().load_plugin(FilePath{plugin.text, folder}.resolved());
  } catch (const Error& e) {
    diagnostics_.add(Error(e.what(), plugin.at));
    whole_ = false;  // otherwise each use of its classes would be reported as well
  }
}

void Loader::replace_params() {
  for (size_t i = 0; i < options_.defines.size(); ++i) {
    const auto& [name, text] = options_.defines[i];
    const auto same = [&](const auto& d) { return d.first == name; };
    if (std::any_of(options_.defines.begin(), options_.defines.begin() + long(i), same))
      diagnostics_.add(Error(fmt::format("'{}' is given a value twice", name), {intern("-D " + name), 0, 0}));
    else if (evaluator_.knows(name) || others_.empty())
      evaluator_.redefine(name, text);
    else
      left_defines_.emplace_back(name, text);
  }
}

void Loader::refuse_unknown_params() {
  for (const auto& [name, text] : left_defines_)
    if (!used_defines_.contains(name)) evaluator_.redefine(name, text);  // reports that there is no such param
}

Node* Loader::root(bool job) {
  const Location nowhere = {main_, 0, 0};
  Node* found = nullptr;
  for (auto& [node, space] : components_) {
    if (job && node.text != "Job") {
      const std::string near = suggestion(node.text, {"Job"});
      diagnostics_.add(Error(
          fmt::format("only the Job needs no name{}; give this component one: name = {} {{ … }}", near, node.text), node.at));
    } else if (found) {
      diagnostics_.add(
          Error(fmt::format("there is {} already, at {}", job ? "a Job" : "a component", place(found->at, node.at)), node.at));
    } else {
      found = &node;
    }
  }
  if (found || !diagnostics_.empty()) return found;
  diagnostics_.add(Error(job ? "there is no Job: a render description needs one Job { … }" : "there is no component", nowhere));
  return nullptr;
}

Ref<Component> Loader::result(bool job) {
  std::optional<Value> value;
  try {
    if (whole_) {
      replace_params();
      read_others(job);
      if (diagnostics_.empty()) refuse_unknown_params();
    }
    Node* node = job_ ? nullptr : root(job);
    if (!whole_) evaluator_.set_incomplete();
    for (auto& [other, space] : components_)
      if (&other == node) value = evaluator_.evaluate_in(*space, other);
    for (auto& [other, space] : components_)  // components that should not be there may have other errors, too
      if (&other != node) evaluator_.evaluate_in(*space, other);
    evaluator_.check_unused(main_);
  } catch (const TooManyErrors&) {
  }
  diagnostics_.raise();
  warn_of_unused_others();
  if (job_) return job_;
  if (options_.animated && !evaluator_.moment_used() && others_.empty())
    warn("nothing in it depends on frame or time: all its frames show the same", {main_, 0, 0});
  return value && value->as<Ref<Component>>() ? *value->as<Ref<Component>>() : nullptr;
}

}  // namespace etendue::language

namespace etendue {

Ref<Component> parse_component(const std::string& text, const std::string& name, const std::string& folder) {
  const LoadOptions options;
  language::Loader loader(options);
  loader.add_text(text, name, folder);
  return loader.result(false);
}

Value parse_value(const std::string& text, const std::string& name, const std::string& folder) {
  using namespace language;
  Diagnostics diagnostics;
  Evaluator evaluator(diagnostics, true);
  const Source source{intern(name), folder, text};
  remember_text(source.name, text);
  if (invalid_utf8(text)) throw Errors({Error("the text is not valid UTF-8", {source.name, 1, 1})});
  evaluator.set_folder(source.name, folder);
  std::optional<Value> value;
  try {
    const auto node = parse_expression(source, diagnostics);
    if (node) value = evaluator.evaluate(*node, {});
  } catch (const TooManyErrors&) {
  }
  diagnostics.raise();
  return value ? std::move(*value) : Value();
}

}  // namespace etendue
