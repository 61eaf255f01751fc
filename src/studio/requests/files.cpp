// Requests about files: those of the document, and the folders that may be used.

#include <fmt/format.h>

#include <filesystem>

#include "requests.h"

namespace etendue::studio {

namespace {

namespace fs = std::filesystem;

Json save(const Call& call) {
  Document& document = call.studio.document();
  require_no_draft(document);
  const bool elsewhere = call.has("file");
  if (!elsewhere && document.file().empty()) throw RequestError("bad_request", "it has no file yet: say which");
  const std::string path = elsewhere ? allowed_path(call, call.text("file")) : document.file();
  if (elsewhere && path != document.file()) {
    if (!path.ends_with(".etd")) throw Error("a description is saved as an .etd");
    require_free(call, path);
    // Relative paths in the text start from its folder: checks that it loads in the new one.
    const std::string folder = fs::path(path).parent_path().string();
    if (folder != document.folder()) static_cast<void>(load_job_text(document.text(), path, folder));
  } else if (!call.flag("over") && document.changed_on_disk()) {
    throw RequestError("changed_on_disk", fmt::format("'{}' was changed by somebody else since it was read", path));
  } else if (document.saved_revision() == 0) {
    require_free(call, path);
  }
  document.save(path);
  call.studio.tell_document();
  return {{"file", path}, {"revision", document.revision()}};
}

void begin_anew(const Call& call) {
  call.studio.overrides.clear();
  call.studio.coarse = false;
  call.studio.fine_at.reset();
  call.studio.sides().clear();
  call.studio.tell_all();
}

Json open(const Call& call) {
  require_saved(call);
  call.studio.document().open(allowed_path(call, call.text("file")));
  begin_anew(call);
  call.studio.runner().start();
  return {{"revision", call.studio.document().revision()}};
}

Json create(const Call& call) {
  require_saved(call);
  call.studio.document().create(call.studio.folders().all().front());
  begin_anew(call);
  return {{"revision", call.studio.document().revision()}};
}

Json reload(const Call& call) {
  static_cast<void>(call.studio.valid_render());
  call.studio.document().reload();
  call.studio.tell_all();
  return {{"revision", call.studio.document().revision()}};
}

Json files(const Call& call) {
  const std::string folder = call.has("folder") ? allowed_path(call, call.text("folder"))
                                                : call.studio.folders().inside(call.studio.document().folder());
  std::vector<std::string> endings;
  if (call.has("endings")) {
    if (!call.request["endings"].is_array()) throw RequestError("bad_request", "'endings' must be a list of texts");
    for (const Json& e : call.request["endings"])
      if (e.is_string()) endings.push_back(e.get<std::string>());
  }
  constexpr size_t most = 10000;
  Json entries = Json::array();
  std::error_code error;
  bool whole = true;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    if (entries.size() >= most) {
      whole = false;
      break;
    }
    const std::string name = at->path().filename().string();
    std::error_code ignored;
    const bool is_folder = at->is_directory(ignored);
    if (!is_folder && !at->is_regular_file(ignored)) continue;
    if (at->is_symlink(ignored) && !call.studio.folders().contains(at->path().string())) continue;
    const bool wanted = is_folder || endings.empty() ||
                        std::any_of(endings.begin(), endings.end(), [&](const std::string& e) { return name.ends_with(e); });
    if (!wanted || name.starts_with('.')) continue;
    const auto time = at->last_write_time(ignored);
    const auto system = std::chrono::file_clock::to_sys(time);
    entries.push_back({{"name", name},
                       {"folder", is_folder},
                       {"size", is_folder ? 0 : at->file_size(ignored)},
                       {"modified", std::chrono::duration_cast<std::chrono::seconds>(system.time_since_epoch()).count()}});
  }
  if (error) throw Error(fmt::format("'{}': {}", folder, error.message()));
  const std::string parent = fs::path(folder).parent_path().string();
  return {{"folder", folder},
          {"parent", call.studio.folders().contains(parent) ? Json(parent) : Json()},
          {"entries", std::move(entries)},
          {"whole", whole}};
}

const RegisterRequests registered{
    {"save", false, save}, {"open", false, open}, {"new", false, create}, {"reload", false, reload}, {"files", false, files},
};

}  // namespace

}  // namespace etendue::studio
