// Directives that save and restore the state: attributes, objects, included files.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "directives.h"

namespace etendue::pbrt {

namespace {
constexpr size_t most_nested = 100'000, most_included = 10'000, most_deep = 64;
}  // namespace

void Directives::keep(const char* what) {
  if (kept_.size() >= most_nested) throw Error(fmt::format("states nest more than {} deep", most_nested), at_);
  kept_.push_back({r.state, what, at_});
}

void Directives::give_back(const char* what, bool transform_only) {
  if (kept_.empty() || (sources_.size() > 1 && sources_.back().import && kept_.size() <= sources_.back().nested + 1))
    throw LeftOut(fmt::format("{}End without {}Begin", what, what), at_);
  if (std::string_view(kept_.back().what) != what)
    throw Error(fmt::format("{}End ends the {}Begin of line {}", what, kept_.back().what, kept_.back().at.line), at_);
  if (transform_only) {
    r.state.ctm = kept_.back().state.ctm;
    r.state.active = kept_.back().state.active;
  } else {
    r.state = std::move(kept_.back().state);
  }
  kept_.pop_back();
}

void Directives::attribute_begin() { keep("Attribute"); }

void Directives::attribute_end() { give_back("Attribute", false); }

void Directives::transform_begin() { keep("Transform"); }

void Directives::transform_end() { give_back("Transform", true); }

void Directives::object_begin() {
  need_world();
  r.begin_object(text(), at_);
  keep("Object");
}

void Directives::object_end() {
  give_back("Object", false);
  r.end_object(at_);
}

void Directives::object_instance() {
  need_world();
  r.instance(text(), at_);
}

void Directives::reverse_orientation() { r.state.reversed = !r.state.reversed; }

void Directives::attribute() {
  const std::string target = text();
  const auto found = std::ranges::find(attribute_targets, target);
  if (found == attribute_targets.end())
    throw Error(fmt::format("Attribute is of shape, light, material, medium or texture, not '{}'", target), at_);
  Parameters p = parameters(target);
  auto& list = r.state.defaults[size_t(found - attribute_targets.begin())];
  // Newest first, because lookups return the first match; older parameters of the same name and type are dropped.
  if (list) {
    const size_t fresh = p.own.size();
    for (const Parameter& old : *list)
      if (std::ranges::none_of(p.own.begin(), p.own.begin() + std::ptrdiff_t(fresh),
                               [&](const Parameter& q) { return q.name == old.name && q.type == old.type; }))
        p.own.push_back(old);
  }
  constexpr size_t most = 200;  // each following shape, light, … searches the list
  if (p.own.size() > most) throw Error(fmt::format("more than {} attributes are given to every {}", most, target), at_);
  list = std::make_shared<const std::vector<Parameter>>(std::move(p.own));
}

void Directives::include_file(bool import) {
  const Token named = lexer().peek();
  const std::string name = text();
  const Location at = lexer().place(named);
  if (sources_.size() >= most_deep) throw Error(fmt::format("files include each other more than {} deep", most_deep), at);
  if (++included_ > most_included) throw Error(fmt::format("more than {} files are included", most_included), at);
  Source source;
  source.path = r.importing.file(name, at, sources_.back().folder);
  std::error_code error;
  for (const Source& outer : sources_)
    if (std::filesystem::equivalent(outer.path, source.path, error)) throw Error(fmt::format("'{}' includes itself", name), at);
  source.folder = std::filesystem::path(source.path).parent_path().string();
  try {
    source.contents = std::make_shared<FileContents>(source.path);
  } catch (const Error& e) {
    throw Error(fmt::format("cannot read '{}': {}", name, e.what()), at);
  }
  source.lexer = lexer_of(source.contents->text(), source.path);
  source.import = import;
  source.nested = kept_.size();
  if (import) keep("Import");
  sources_.push_back(std::move(source));
}

void Directives::include() { include_file(false); }

void Directives::import() {
  need_world();
  include_file(true);
}

}  // namespace etendue::pbrt
