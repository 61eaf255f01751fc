// Document: the text, and the render that is updated after each edit.

#include "document.h"

#include <fmt/format.h>

#include <filesystem>

#include "etendue/language/language.h"

namespace etendue::studio {

namespace {

/// The message of Render::edit for a cyclic component graph, which may arise between several edits applied one by one.
constexpr std::string_view cannot_contain_itself = "a component cannot contain itself";

}  // namespace

std::shared_ptr<Render> Document::render() const {
  const std::lock_guard lock(render_guard_);
  return render_;
}

void Document::take_text(std::unique_ptr<Outline> outline) {
  outline_ = std::move(outline);
  places_ = std::make_unique<Places>(outline_->text());
  ++revision_;
}

Ref<Job> Document::load(const Outline& outline, const std::map<std::string, std::string>& overrides) const {
  if (!trusts_all_) require_allowed(files_loaded_by(outline, folder_));
  for (const auto& [path, expression] : overrides)
    require_allowed(files_loaded_by(Outline("x = " + expression, intern("--set")), folder_));
  Ref<Job> job = load_job_text(outline.text(), name_, folder_);
  if (!trusts_all_) require_allowed(files_named_by(*job));
  for (const auto& [path, expression] : overrides) set_path(*job, path, expression);
  job->metadata["file"] = file_;
  return job;
}

void Document::require_allowed(const std::vector<NamedFile>& files) const {
  std::vector<Error> errors;
  for (const NamedFile& file : files) {
    if (folders_->contains(file.path) || trusted_.contains(canonical_path(file.path))) continue;
    try {
      static_cast<void>(folders_->inside(file.path));
    } catch (const Error& error) {
      errors.emplace_back(error.what(), file.at);
    }
  }
  if (!errors.empty()) throw Errors(std::move(errors));
}

// ---- components ------------------------------------------------------------------------------------------------------------

int Document::id_of(const Component& part) const {
  const auto found = ids_.find(&part);
  return found == ids_.end() ? 0 : found->second;
}

Ref<Component> Document::component(int id) const {
  const auto found = by_id_.find(id);
  if (found == by_id_.end()) throw Error(fmt::format("there is no component {}; was it removed?", id));
  return found->second;
}

const language::Node* Document::written(const Component& part) const {
  return part.origin ? outline_->component(part.origin->location) : nullptr;
}

const std::vector<Document::Use>& Document::uses(const Component& part) const {
  static const std::vector<Use> none;
  const auto found = uses_.find(&part);
  return found == uses_.end() ? none : found->second;
}

// Components keep their ids for their lifetime; no id is used twice.
void Document::number_parts() {
  components_ = components_of(job());
  std::unordered_map<const Component*, int> ids;
  by_id_.clear();
  uses_.clear();
  for (const Ref<Component>& part : components_) {
    const auto known = ids_.find(part.get());
    const int id = known == ids_.end() ? next_id_++ : known->second;
    ids.emplace(part.get(), id);
    by_id_.emplace(id, part);
  }
  ids_ = std::move(ids);
  for (const Ref<Component>& part : components_)
    for (const Member& member : part->class_info().members) {
      if (member.kind != Kind::component) continue;
      const Value value = member.get(*part, member);
      if (const auto* one = value.as<Ref<Component>>(); one && *one) uses_[one->get()].push_back({id_of(*part), &member, {}});
      if (const auto* list = value.as<Value::List>())
        for (size_t i = 0; i < list->size(); ++i)
          if (const auto* item = (*list)[i].as<Ref<Component>>(); item && *item)
            uses_[item->get()].push_back({id_of(*part), &member, i});
    }
}

// ---- updating the render ---------------------------------------------------------------------------------------------------

/// Replaces the render by one of a job none of whose components were rendered before.
void Document::replace_render(Ref<Job> job) {
  auto made = std::make_shared<Render>(std::move(job), settings_);
  const std::lock_guard lock(render_guard_);
  render_ = std::move(made);
}

/// Applies the edits of a merge to the render. The components get their locations in the new text first, because errors refer
/// to that text.
void Document::edit_render(Merge& merge) {
  const auto exchange_origins = [&] {
    for (const auto& [now, old] : merge.old_of) std::swap(const_cast<Component*>(now)->origin, old->origin);
  };
  exchange_origins();
  try {
    if (!merge.edits.empty()) render()->edit(merge.edits);
  } catch (...) {
    exchange_origins();
    throw;
  }
  old_origins_.clear();
  for (const auto& [now, old] : merge.old_of) old_origins_.push_back(std::move(const_cast<Component*>(now)->origin));
}

/// The ids of components whose values were edited, or whose text was changed.
std::vector<int> Document::concerned(const Merge& merge, const TextChange& change) const {
  std::vector<int> list;
  for (const Edit& edit : merge.edits) list.push_back(id_of(*edit.component));
  const size_t end = change.begin + change.insert.size();
  for (const Ref<Component>& part : components_)
    if (const language::Node* node = written(*part); node && node->begin <= end && change.begin <= node->end)
      list.push_back(id_of(*part));
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

Applied Document::follow(const std::string& text, const std::map<std::string, std::string>& overrides) {
  Applied result;
  result.change = outline_ ? difference(outline_->text(), text) : TextChange{0, 0, text};
  auto next = std::make_unique<Outline>(text, name_);
  Ref<Job> now = load(*next, overrides);
  if (!valid()) {
    replace_render(now);
    take_text(std::move(next));
    number_parts();
    result.structure = true;
    return result;
  }

  // Finds the old component that a new one corresponds to, by its location before the change; locations in other files are
  // unchanged.
  const Outline& fresh = *next;
  std::unordered_map<size_t, Component*> by_begin;
  std::map<std::tuple<std::string_view, int, int>, Component*> elsewhere;
  for (const Ref<Component>& part : components_) {
    if (const language::Node* node = written(*part))
      by_begin.emplace(node->begin, part.get());
    else if (part->origin && part->origin->location.file != name_) {
      const Location& at = part->origin->location;
      elsewhere.emplace(std::tuple(std::string_view(at.file), at.line, at.column), part.get());
    }
  }
  const TextChange& change = result.change;
  const auto counterpart = [&](const Component& part) -> Component* {
    if (!part.origin) return nullptr;
    const Location& at = part.origin->location;
    if (at.file != name_) {
      const auto found = elsewhere.find(std::tuple(std::string_view(at.file), at.line, at.column));
      return found == elsewhere.end() ? nullptr : found->second;
    }
    const language::Node* node = fresh.component(at);
    if (!node) return nullptr;
    size_t begin = node->begin;
    const size_t changed_end = change.begin + change.insert.size();
    if (begin >= changed_end)
      begin = begin - changed_end + change.end;
    else if (begin >= change.begin)
      return nullptr;
    const auto found = by_begin.find(begin);
    return found == by_begin.end() ? nullptr : found->second;
  };
  Merge merge = studio::merge(job(), *now, counterpart);
  bool anew = false;
  try {
    edit_render(merge);
  } catch (const Error& error) {
    // Edits that exchange a component with its own holder cannot be applied one by one: then a new render is made.
    anew = std::string_view(error.what()).ends_with(cannot_contain_itself);
    if (!anew) throw;
  }
  if (anew) {
    now = load(*next, overrides);
    const Pairs pairs = pairs_of(job(), *now, counterpart);
    replace_render(now);
    for (const auto& [part, old] : pairs)
      if (const int id = id_of(*old)) ids_.emplace(part, id);
  }
  take_text(std::move(next));
  result.structure = merge.structure;
  if (result.structure)
    number_parts();
  else
    result.components = concerned(merge, change);
  return result;
}

TextChange Document::backward(const Step& step) {
  return {step.forward.begin, step.forward.begin + step.forward.insert.size(), step.removed};
}

Applied Document::apply(const std::string& text, const EditNote& note) {
  std::string before = outline_->text();
  Applied applied = follow(text, overrides_);
  draft_.reset();
  redo_.clear();
  const TextChange& change = applied.change;
  Step step{change, before.substr(change.begin, change.end - change.begin), note.label, note.merge};
  if (!note.merge.empty() && !undo_.empty() && undo_.back().merge == note.merge) {
    // Both edits become one step, from the text before the first to the text after the second.
    const Step& first = undo_.back();
    before = applied_to(before, backward(first));
    const TextChange whole = difference(before, text);
    step.forward = whole;
    step.removed = before.substr(whole.begin, whole.end - whole.begin);
    undo_.back() = std::move(step);
  } else if (!(change.begin == change.end && change.insert.empty())) {
    undo_.push_back(std::move(step));
  }
  return applied;
}

Applied Document::step(std::vector<Step>& from, std::vector<Step>& to, bool back) {
  if (from.empty()) throw Error(back ? "there is nothing to undo" : "there is nothing to redo");
  Step step = from.back();
  step.merge.clear();
  const TextChange change = back ? backward(step) : step.forward;
  Applied result = follow(applied_to(text(), change), overrides_);
  draft_.reset();
  from.pop_back();
  to.push_back(std::move(step));
  return result;
}

Applied Document::undo() { return step(undo_, redo_, true); }
Applied Document::redo() { return step(redo_, undo_, false); }

std::optional<std::string> Document::undo_label() const {
  return undo_.empty() ? std::nullopt : std::optional(undo_.back().label);
}
std::optional<std::string> Document::redo_label() const {
  return redo_.empty() ? std::nullopt : std::optional(redo_.back().label);
}

Applied Document::set_overrides(const std::map<std::string, std::string>& overrides) {
  std::map<std::string, std::string> all;
  for (const auto& [path, value] : overrides)
    if (!value.empty()) all.emplace(path, value);
  if (all == overrides_ || !valid()) {
    overrides_ = std::move(all);
    return {};
  }
  const int revision = revision_;
  Applied applied = follow(text(), all);
  revision_ = revision;  // the text has not changed
  overrides_ = std::move(all);
  return applied;
}

bool Document::follow(const Document& leader, const std::string& text, const std::map<std::string, std::string>& overrides) {
  name_ = leader.name_;
  file_ = leader.file_;
  folder_ = leader.folder_;
  trusted_ = leader.trusted_;
  if (valid() && text == this->text() && overrides == overrides_) return false;
  static_cast<void>(follow(text, overrides));
  overrides_ = overrides;
  return true;
}

}  // namespace etendue::studio
