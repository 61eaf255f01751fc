#pragma once
// Edits of parts as edits of the text: several, one after the other, before the text is tried as a whole.

#include <memory>
#include <optional>
#include <string>
#include <unordered_map>

#include "document.h"

namespace etendue::studio {

/// Which value of a part: a member, or an entry of one that is a list.
struct Slot {
  Ref<Component> part;
  const Member* member = nullptr;
  std::optional<size_t> index;
};

/// Throws Error, with a suggestion, when the class has no such member.
Slot slot(const Ref<Component>& part, const std::string& member, std::optional<size_t> index = {});

/// Works on a copy of a document's text; Document::apply then makes it true. All throw Error when the text does not allow it.
class TextEditor {
 public:
  explicit TextEditor(const Document&);
  const std::string& text() const { return outline_->text(); }

  /// Writes a value, which must be an expression by itself.
  void set(const Slot&, const std::string& value);
  /// No longer written: has its default.
  void reset(const Slot&);
  /// An entry of a list, before `index` or at its end.
  void add(const Slot& list, std::optional<size_t> index, const std::string& value);
  void remove(const Slot& entry);
  /// The part as another class, with the members of the same name that fit.
  void replace_class(const Ref<Component>& part, const ClassInfo& now);
  /// A name for a part that has none, which it then goes by where it is used. The name it has.
  std::string name_of(const Ref<Component>& part);
  /// With all its uses; empty: none, for a part that is used once.
  void rename(const std::string& old, const std::string& now);

  /// What is written in a slot; what would be, when it is not.
  std::string written(const Slot&) const;
  /// A part written out in full, though it has a name.
  std::string written_out(const Component&) const;
  /// The name that a slot is written as; empty when it is no name alone.
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
  std::unordered_map<const Component*, size_t> begins_;  // where the class name of each written part is now
};

/// An instance of a class as text, with what must be written: values that are valid, where there are any.
std::string new_component_text(const ClassInfo&);

}  // namespace etendue::studio
