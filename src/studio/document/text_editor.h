#pragma once
// TextEditor: edits of components as edits of the text. Several edits may be made before the text is evaluated.

#include <memory>
#include <optional>
#include <string>
#include <unordered_map>

#include "document.h"

namespace etendue::studio {

/// The location of a value: a member of a component, or an entry of a list member.
struct Slot {
  Ref<Component> part;
  const Member* member = nullptr;
  std::optional<size_t> index;
};

/// Throws Error, with a suggestion, if the class has no such member.
Slot slot(const Ref<Component>& part, const std::string& member, std::optional<size_t> index = {});

/// Works on a copy of a document's text, which Document::apply then makes current. All functions throw Error if the text does
/// not allow the edit.
class TextEditor {
 public:
  explicit TextEditor(const Document&);
  const std::string& text() const { return outline_->text(); }

  /// Writes a value, which must be a complete expression.
  void set(const Slot&, const std::string& value);
  /// Removes a member from the text, so that it has its default.
  void reset(const Slot&);
  /// Adds an entry to a list, before `index` or at its end.
  void add(const Slot& list, std::optional<size_t> index, const std::string& value);
  void remove(const Slot& entry);
  /// Changes the class of a component, and keeps members with the same name whose values fit.
  void replace_class(const Ref<Component>& part, const ClassInfo& now);
  /// Returns the name of a component. If it has none, it gets one, by which its use then refers to it.
  std::string name_of(const Ref<Component>& part);
  /// Renames a component and its uses. Empty: removes the name, for a component that is used once.
  void rename(const std::string& old, const std::string& now);

  /// The text in a slot; if there is none, the text that would be equivalent.
  std::string written(const Slot&) const;
  /// The complete text of a component, even if it has a name.
  std::string written_out(const Component&) const;
  /// The name in a slot; empty if the slot contains anything else.
  std::string name_in(const Slot&) const;

 private:
  const language::Node* node(const Component&) const;
  const language::Node* value_node(const Slot&) const;
  Slot use_of(const Component&) const;
  void set_text(std::string text);
  void set_value(const Slot&, const std::string& value);
  std::string default_text(const Slot&) const;
  std::string free_name(const std::string& stem) const;

  const Document& document_;
  std::unique_ptr<Outline> outline_;
  std::unordered_map<const Component*, size_t> begins_;  // where the class name of each written component now begins
};

/// The text of an instance of a class with its required members; the values are valid if valid ones are found.
std::string new_component_text(const ClassInfo&);

}  // namespace etendue::studio
