#pragma once
// Document: a description that is edited, its job, and the job's render. Its text is the primary data: every edit is a change
// of the text, and the render is updated by the edits that lead from its job to the job of the new text (merge.h).

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

/// How an edit is stored in the undo list.
struct EditNote {
  std::string label;  ///< "edit radius"
  std::string merge;  ///< consecutive edits with the same nonempty text here are merged into one undo step
};

/// The effects of an edit.
struct Applied {
  TextChange change;            ///< relative to the text before, in bytes
  bool structure = false;       ///< components were added, removed or moved
  std::vector<int> components;  ///< otherwise: the components whose members or text changed
};

/// Used by one thread at a time, except `render`, which any thread may call.
class Document {
 public:
  /// Texts brought in by edits may name files only in these folders; files named when the document was opened stay allowed.
  Document(RenderSettings settings, const Folders& folders) : settings_(std::move(settings)), folders_(&folders) {}

  /// The initial text of a document, from a file.
  struct Source {
    std::string file, text;           ///< a .json is rewritten as an .etd, which is not saved yet
    std::optional<std::string> disk;  ///< contents of the file; none for a .json that was rewritten
  };
  /// Throws Error, or Errors for a .json, if the file cannot be read.
  static Source read(const std::string& file);
  /// Also reads the files that the text names, and prepares the render. If the text has errors, it becomes a draft without a
  /// render.
  void open(Source);
  void open(const std::string& file) { open(read(file)); }
  /// Starts with the smallest description that can be rendered, in a folder.
  void create(const std::string& folder);
  /// Whether the file no longer has the contents last read or written, or was deleted.
  bool changed_on_disk() const;
  void save(const std::string& file);
  /// Writes the text, or the draft, to a new file next to its file; returns the path.
  std::string save_aside() const;
  /// Loads all files that the description names again.
  void reload();

  /// Whether it has a document: false before `open` or `create`.
  bool begun() const { return bool(outline_); }
  const std::string& file() const { return file_; }
  const std::string& folder() const { return folder_; }
  /// The name of the text in messages.
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

  /// A text that was typed and has errors.
  struct Draft {
    std::string text;
    std::vector<Error> errors;
  };
  const std::optional<Draft>& draft() const { return draft_; }
  void set_draft(std::string text, std::vector<Error> errors) { draft_ = Draft{std::move(text), std::move(errors)}; }
  void drop_draft();

  // ---- components ----------------------------------------------------------------------------------------------------------

  int id_of(const Component&) const;
  /// Throws Error if there is no such component.
  Ref<Component> component(int id) const;
  /// All components, holders before the components they hold.
  const std::vector<Ref<Component>>& components() const { return components_; }
  /// The syntax node of a component in this text; null if it is not written here.
  const language::Node* written(const Component&) const;
  struct Use {
    int holder = 0;
    const Member* member = nullptr;
    std::optional<size_t> index;
  };
  const std::vector<Use>& uses(const Component&) const;

  // ---- editing --------------------------------------------------------------------------------------------------------------

  /// Replaces the text. Throws Error or Errors, with everything unchanged, if the new text has errors.
  Applied apply(const std::string& text, const EditNote&);
  Applied undo();
  Applied redo();
  std::optional<std::string> undo_label() const;
  std::optional<std::string> redo_label() const;
  size_t undo_count() const { return undo_.size(); }
  size_t redo_count() const { return redo_.size(); }

  /// Sets members for this session only, by paths as for `--set`; an empty value removes an override. All or none.
  Applied set_overrides(const std::map<std::string, std::string>& overrides);
  const std::map<std::string, std::string>& overrides() const { return overrides_; }
  /// Becomes a copy of another document with a different text and overrides, without undo steps. Throws as `apply`. Returns
  /// whether anything changed.
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
  std::set<std::string> trusted_;  ///< files named in the text when it was opened
  bool trusts_all_ = false;        ///< true while a file is being opened
  std::string file_, folder_, saved_text_, disk_text_;
  mutable std::array<std::int64_t, 4> disk_state_{};  ///< device, inode, size, time of the file with `disk_text_`
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
  std::vector<std::unique_ptr<Component::Origin>> old_origins_;  // of the last edit: rendering threads may still read them
};

}  // namespace etendue::studio
