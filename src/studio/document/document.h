#pragma once
// A description that is edited: its text, which is the truth, the job that was made of it, and the job's render. Every edit is
// one of the text; the render follows by the edits that lead from its job to that of the new text (merge.h).

#include <array>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "etendue/render/render.h"
#include "folders.h"
#include "merge.h"
#include "studio/text/outline.h"
#include "studio/text/places.h"
#include "studio/text/text_edits.h"

namespace etendue::studio {

/// How an edit is to be remembered.
struct EditNote {
  std::string label;  ///< "edit radius"
  std::string merge;  ///< edits that follow one another with the same text here, which is not empty, are one step of undo
};

/// What an edit came to.
struct Applied {
  TextChange change;            ///< of the text before, in bytes
  bool structure = false;       ///< parts came, went or were put elsewhere
  std::vector<int> components;  ///< otherwise: those whose members differ, or are written otherwise
};

/// Used by one thread at a time; only `render` may be asked by any.
class Document {
 public:
  /// What edits bring into the text may name files of these folders alone, and those that it named when it was opened.
  Document(RenderSettings settings, const Folders& folders) : settings_(std::move(settings)), folders_(&folders) {}

  /// A file's text, as a document begins with it.
  struct Source {
    std::string file, text;           ///< a .json is rewritten as an .etd, which is not saved yet
    std::optional<std::string> disk;  ///< what the file holds; none for one that was rewritten
  };
  /// Throws Error, or Errors for a .json, when it cannot be read.
  static Source read(const std::string& file);
  /// Reads what the text names, too, and prepares the render. What is wrong with it leaves a draft and no render.
  void open(Source);
  void open(const std::string& file) { open(read(file)); }
  /// The smallest description that can be rendered, in a folder.
  void create(const std::string& folder);
  /// Whether its file holds something else than was read or written there last, or is gone.
  bool changed_on_disk() const;
  void save(const std::string& file);
  /// Writes the text, or what was typed last, beside its file under a name that is free; that name.
  std::string save_aside() const;
  /// Reads all files that it names anew.
  void reload();

  /// Whether it holds a document at all: not before it was opened or created.
  bool begun() const { return bool(outline_); }
  const std::string& file() const { return file_; }
  const std::string& folder() const { return folder_; }
  /// What messages call the text.
  const char* name() const { return name_; }
  bool valid() const { return bool(render()); }
  bool changed() const { return text() != saved_text_ || draft_.has_value(); }
  int revision() const { return revision_; }
  int saved_revision() const { return saved_revision_; }

  const std::string& text() const { return outline_->text(); }
  const Outline& outline() const { return *outline_; }
  const Places& places() const { return *places_; }
  std::shared_ptr<Render> render() const;
  const Job& job() const { return render()->job(); }

  /// A text that was typed and is not valid.
  struct Draft {
    std::string text;
    std::vector<Error> errors;
  };
  const std::optional<Draft>& draft() const { return draft_; }
  void set_draft(std::string text, std::vector<Error> errors) { draft_ = Draft{std::move(text), std::move(errors)}; }
  void drop_draft();

  // ---- parts ----------------------------------------------------------------------------------------------------------------

  int id_of(const Component&) const;
  /// Throws Error when there is none.
  Ref<Component> component(int id) const;
  /// All, holders before what they hold.
  const std::vector<Ref<Component>>& components() const { return components_; }
  /// What is written in this text for a part; null for what is not.
  const language::Node* written(const Component&) const;
  struct Use {
    int holder = 0;
    const Member* member = nullptr;
    std::optional<size_t> index;
  };
  const std::vector<Use>& uses(const Component&) const;

  // ---- editing --------------------------------------------------------------------------------------------------------------

  /// Makes the text another one. Throws Error or Errors, with all as it was, when it is not valid.
  Applied apply(const std::string& text, const EditNote&);
  Applied undo();
  Applied redo();
  std::optional<std::string> undo_label() const;
  std::optional<std::string> redo_label() const;
  size_t undo_count() const { return undo_.size(); }
  size_t redo_count() const { return redo_.size(); }

  /// Members that are set for this session only, by paths as of `--set`; an empty value takes one back. All or none.
  Applied set_overrides(const std::map<std::string, std::string>& overrides);
  const std::map<std::string, std::string>& overrides() const { return overrides_; }
  /// Becomes another document with other text and overrides, without steps to undo. Throws as `apply`. Whether anything is
  /// different now.
  bool follow(const Document& leader, const std::string& text, const std::map<std::string, std::string>& overrides);

 private:
  struct Step {
    TextChange forward;
    std::string removed, label, merge;
  };
  void take(Document&&);
  static TextChange backward(const Step&);
  void require_allowed(const std::vector<NamedFile>&) const;
  Ref<Job> load(const Outline&, const std::map<std::string, std::string>& overrides) const;
  Applied follow(const std::string& text, const std::map<std::string, std::string>& overrides);
  void replace_render(Ref<Job>);
  void edit_render(Merge&);
  void take_text(std::unique_ptr<Outline>);
  void note_disk(std::string text);
  void number_parts();
  std::vector<int> concerned(const Merge&, const TextChange&) const;
  Applied step(std::vector<Step>& from, std::vector<Step>& to, bool back);

  RenderSettings settings_;
  const Folders* folders_;
  std::set<std::string> trusted_;  ///< files it named when it was opened
  bool trusts_all_ = false;        ///< while it is opened
  std::string file_, folder_, saved_text_, disk_text_;
  mutable std::array<std::int64_t, 4> disk_state_{};  ///< device, number, size and time of the file when it held that text
  const char* name_ = "";
  int revision_ = 0, saved_revision_ = 0, next_id_ = 1;
  std::unique_ptr<Outline> outline_;
  std::unique_ptr<Places> places_;
  std::optional<Draft> draft_;
  std::map<std::string, std::string> overrides_;
  mutable std::mutex render_guard_;
  std::shared_ptr<Render> render_;

  std::vector<Ref<Component>> components_;
  std::map<int, Ref<Component>> by_id_;
  std::unordered_map<const Component*, int> ids_;
  std::unordered_map<const Component*, std::vector<Use>> uses_;
  std::vector<Step> undo_, redo_;
  std::vector<std::unique_ptr<Component::Origin>> old_origins_;  // of the last edit: who renders may look at them
};

}  // namespace etendue::studio
