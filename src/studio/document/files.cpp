// Document: reading from and writing to files.

#include <fmt/format.h>

#include <sys/stat.h>

#include <filesystem>

#include "describe/guard.h"
#include "document.h"
#include "etendue/language/language.h"
#include "files/regular_file.h"
#include "files/whole_file.h"
#include "language/json.h"
#include "language/source.h"

namespace etendue::studio {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t largest_text = std::uint64_t(256) << 20;

/// The values by which a change of a file is detected; nothing if the file does not exist.
std::optional<std::array<std::int64_t, 4>> state_of(const std::string& path) {
  struct stat s{};
  if (::stat(path.c_str(), &s) != 0) return {};
  return std::array{std::int64_t(s.st_dev), std::int64_t(s.st_ino), std::int64_t(s.st_size),
                    std::int64_t(s.st_mtim.tv_sec) * 1'000'000'000 + s.st_mtim.tv_nsec};
}

/// The smallest description that can be rendered, in the usual style.
constexpr const char* beginning = R"(# A new scene. Lengths are in metres unless a unit says otherwise.

Job {
    renderer: PathTracer { samples: 64 }
    camera:   PerspectiveCamera { from: [0, 1, -5], to: [0, 1, 0] }
    image:    ImageBuffer { width: 512, height: 512 }
    outputs:  [ PngOutput {} ]
    scene:    BvhScene { objects: [] }
}
)";

}  // namespace

Document::Source Document::read(const std::string& file) {
  std::string text;
  try {
    text = read_regular_file(file, largest_text);
  } catch (const Error& error) {
    throw Error(fmt::format("cannot read '{}': {}", file, error.what()));
  }
  if (!language::is_json(file)) return {file, text, text};
  // A JSON text is not edited itself: it is rewritten as an .etd.
  return {fs::path(file).replace_extension(".etd").string(),
          write_description(*load_job(file), false, fs::path(file).parent_path().string()), std::nullopt};
}

void Document::open(Source source) {
  const std::string folder = fs::path(source.file).parent_path().string();
  const std::string& text = source.text;
  Document next(settings_, *folders_);
  next.next_id_ = next_id_;
  next.revision_ = revision_;
  next.file_ = source.file;
  next.folder_ = folder;
  next.name_ = intern(source.file);
  language::remember_text(next.name_, text);
  next.trusts_all_ = true;
  try {
    next.follow(text, {});
    for (const NamedFile& named : files_loaded_by(next.outline(), folder)) next.trusted_.insert(canonical_path(named.path));
    for (const NamedFile& named : files_named_by(next.job())) next.trusted_.insert(canonical_path(named.path));
  } catch (...) {
    next.set_draft(text, thrown_errors());
    next.take_text(std::make_unique<Outline>("", next.name_));
  }
  if (source.disk) {
    next.saved_text_ = *source.disk;
    next.note_disk(std::move(*source.disk));
    next.saved_revision_ = next.revision_;
  }
  take(std::move(next));
}

void Document::create(const std::string& folder) {
  Document next(settings_, *folders_);
  next.next_id_ = next_id_;
  next.revision_ = revision_;
  next.folder_ = folder;
  next.name_ = intern("new.etd");
  next.follow(beginning, {});
  next.saved_text_ = beginning;  // nothing can be lost yet
  take(std::move(next));
}

void Document::take(Document&& next) {
  file_ = std::move(next.file_);
  folder_ = std::move(next.folder_);
  saved_text_ = std::move(next.saved_text_);
  disk_text_ = std::move(next.disk_text_);
  disk_state_ = next.disk_state_;
  name_ = next.name_;
  revision_ = next.revision_;
  saved_revision_ = next.saved_revision_;
  next_id_ = next.next_id_;
  outline_ = std::move(next.outline_);
  places_ = std::move(next.places_);
  draft_ = std::move(next.draft_);
  overrides_.clear();
  trusted_ = std::move(next.trusted_);
  components_ = std::move(next.components_);
  by_id_ = std::move(next.by_id_);
  ids_ = std::move(next.ids_);
  uses_ = std::move(next.uses_);
  undo_.clear();
  redo_.clear();
  const std::lock_guard lock(render_guard_);
  render_ = std::move(next.render_);
}

void Document::drop_draft() { draft_.reset(); }

void Document::note_disk(std::string text) {
  disk_text_ = std::move(text);
  disk_state_ = state_of(file_).value_or(std::array<std::int64_t, 4>{});
}

bool Document::changed_on_disk() const {
  if (file_.empty() || disk_text_.empty()) return false;
  const auto state = state_of(file_);
  if (state && *state == disk_state_) return false;
  try {
    const bool other = read_regular_file(file_, largest_text) != disk_text_;
    if (!other && state) disk_state_ = *state;  // only the time has changed
    return other;
  } catch (const Error&) {
    return true;
  }
}

void Document::save(const std::string& file) {
  const std::string& whole = text();
  write_whole_file(file, whole.data(), whole.size());
  const std::string folder = fs::path(file).parent_path().string();
  const bool moved = folder != folder_;
  file_ = file;
  saved_text_ = whole;
  note_disk(whole);
  saved_revision_ = revision_;
  if (!moved) return;
  // Relative paths in the text now refer to another folder; `save` requests check beforehand that the description still loads.
  folder_ = folder;
}

std::string Document::save_aside() const {
  fs::path stem = file_.empty() ? fs::path(folder_) / "new" : fs::path(file_);
  stem.replace_extension();
  std::string path;
  std::error_code error;
  for (int i = 1; path.empty() || fs::exists(path, error); ++i)
    path = fmt::format("{}.unsaved{}.etd", stem.string(), i == 1 ? "" : fmt::format("_{}", i));
  write_whole_file(path, draft_ ? draft_->text : text());
  return path;
}

void Document::reload() {
  Ref<Job> job = load(*outline_, overrides_);
  replace_render(std::move(job));
  number_parts();
}

}  // namespace etendue::studio
