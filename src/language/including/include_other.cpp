// Loader: include of another program's file, with its names, its parameters, and its Job.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "language/loader.h"
#include "language/writer.h"

namespace etendue::language {

namespace {

/// The part of a trail that names the include, for errors in a file of another program.
class OtherTrail : public Trail {
 public:
  explicit OtherTrail(const Label& file) : Trail(nullptr), file_(file) {}
  std::string words(const Location& seen_from) const override {
    return seen_from.file == file_.at.file ? std::string() : "included at " + place(file_.at, seen_from);
  }

 private:
  const Label& file_;
};

/// The text of a value as a parameter of another program's file; nothing: the value is of a type that cannot be one, such as a
/// colour.
std::optional<std::string> parameter_text(const Value& value) {
  const auto number = [](double x) { return number_text(x, 1, false, true); };
  if (const auto* text = value.as<std::string>()) return *text;
  if (const auto* is = value.as<bool>()) return *is ? "true" : "false";
  const auto* one = value.as<Number>();
  if (one && one->dimension == Dimension::none) return number(one->value);
  const auto* several = value.as<Numbers>();
  if (!several || several->dimension != Dimension::none) return std::nullopt;
  std::string all;
  for (const double x : several->values) all += (all.empty() ? "" : ", ") + number(x);
  return all;
}

}  // namespace

bool Loader::include_other(Inclusion& inclusion, const std::string& path, Space& target, Space& written_in) {
  const Label& file = inclusion.path;
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error) {
    diagnostics_.add(Error(fmt::format("cannot open '{}': {}", path, error.message()), file.at));
    return false;
  }
  files_.emplace(std::pair(canonical_path(path), &target), file.at);
  if (&target != &evaluator_.root() && !may_read_again(size, file.at)) return false;
  others_.push_back({path, file, std::move(inclusion.replaced), &target, &written_in, !inclusion.name.text.empty()});
  return true;
}

// The parameters of an included file, from `with` and from those -D options that are not params of descriptions.
std::vector<std::pair<std::string, std::string>> Loader::parameters_of(Other& other) {
  std::vector<std::pair<std::string, std::string>> all;
  for (Definition& given : other.replaced) {
    const std::optional<Value> value = evaluator_.evaluate_in(*other.written_in, given.value);
    if (!value) continue;  // already reported
    const std::optional<std::string> text = parameter_text(*value);
    if (text)
      all.emplace_back(given.name.text, *text);
    else
      diagnostics_.add(
          Error(fmt::format("a parameter of '{}' is a number without a unit, a list of such numbers, a boolean or a string",
                            other.file.text),
                given.name.at));
  }
  const std::string prefix = evaluator_.prefix(*other.space);
  for (const auto& [name, text] : left_defines_) {
    if (!name.starts_with(prefix) || name.find('.', prefix.size()) != std::string::npos) continue;
    const std::string own = name.substr(prefix.size());
    std::erase_if(all, [&](const auto& given) { return given.first == own; });
    all.emplace_back(own, text);
  }
  return all;
}

void Loader::read_other(Other& other, bool stands_for_itself) {
  const auto parameters = parameters_of(other);
  if (!diagnostics_.empty()) return evaluator_.set_incomplete();  // its names are missing, but that is not another error
  const OtherTrail trail(other.file);
  const Trail* outer = std::exchange(diagnostics_.trail, &trail);
  const auto failed = [&](const Error& e) { diagnostics_.add(located(e, other.file.at)); };
  try {
    other.read = other_files_->read(other.path, options_.import, parameters);
    if (stands_for_itself) job_ = other.read->job();
    for (auto& [name, value] : other.read->names(other.named)) {
      const auto* part = value.as<Ref<Component>>();
      const Location at = part && *part ? (*part)->location_of() : Location{};
      // The location is not the include: names of that file that nothing uses need no warning.
      const Label label{name, at.known() ? at : Location{intern(other.path), 0, 0}};
      if (const bool* used = evaluator_.define_part(label, std::move(value), *other.space)) other.used.push_back(used);
    }
    const std::vector<std::string> unused = other.read->unused_parameters();
    for (const Definition& given : other.replaced)
      if (std::ranges::count(unused, given.name.text))
        diagnostics_.add(Error(fmt::format("'{}' has no parameter '{}'", other.file.text, given.name.text), given.name.at));
    for (const auto& [name, text] : parameters)
      if (!std::ranges::count(unused, name)) used_defines_.insert(evaluator_.prefix(*other.space) + name);
    for (const Error& note : other.read->notes())
      if (options_.import.strict)
        failed(note);
      else
        warn(note.what(), note.location);
  } catch (const Errors& several) {
    for (const Error& e : several.errors) failed(e);
  } catch (const Error& e) {
    failed(e);
  }
  diagnostics_.trail = outer;
  if (!other.read) evaluator_.set_incomplete();
}

void Loader::read_others(bool job) {
  const bool written = !components_.empty();
  const Other* first = nullptr;
  for (Other& other : others_) {
    const bool stands = job && !written && !other.named;
    if (stands && first)
      diagnostics_.add(
          Error(fmt::format("'{}', included at {}, is the whole description already: include one of them as a name "
                            "of its own, or write a Job of their parts",
                            first->file.text, place(first->file.at, other.file.at)),
                other.file.at));
    else
      read_other(other, stands);
    if (stands && !first) first = &other;
  }
}

void Loader::warn_of_unused_others() const {
  for (const Other& other : others_)
    if (other.read && !other.named && !job_ && std::ranges::none_of(other.used, [](const bool* used) { return *used; }))
      warn(
          fmt::format(
              "nothing uses what is in '{}': its Job is not used, as the including file has its own; include it as a name, and "
              "its parts are name.scene, name.objects, name.camera …",
              other.file.text),
          other.file.at);
}

}  // namespace etendue::language
