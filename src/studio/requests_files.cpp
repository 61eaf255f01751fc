// Requests about files, the program and its classes.

#include <fmt/format.h>

#include <filesystem>

#include "etendue/describe/color.h"
#include "etendue/describe/reflection.h"
#include "language/calls.h"
#include "requests.h"

namespace etendue::studio {

namespace fs = std::filesystem;

std::string allowed_path(const Call& call, const std::string& path) {
  if (path.empty()) throw RequestError("bad_request", "the name of a file is missing");
  const std::string whole = path.front() == '/' ? path : call.studio.document().folder() + "/" + path;
  try {
    return call.studio.folders().inside(whole);
  } catch (const Error& error) {
    throw RequestError("not_allowed", error.what());
  }
}

void require_free(const Call& call, const std::string& path) {
  std::error_code error;
  if (!call.flag("over") && fs::exists(path, error))
    throw RequestError("changed_on_disk", fmt::format("'{}' exists already", path));
}

namespace {

/// The descriptions of all classes. They change only when plugins are loaded, which are never unloaded, so the number of
/// classes identifies the version.
const Json& known_classes() {
  static std::mutex guard;
  static std::map<size_t, Json> by_count;
  const std::lock_guard lock(guard);
  const auto [place, is_new] = by_count.try_emplace(Registry::instance().all().size());
  if (is_new) place->second = Json::parse(classes_json());
  return place->second;
}

}  // namespace

Json vocabulary_json() {
  Json all_units = Json::array(), functions = Json::array();
  for (const Unit& unit : units())
    all_units.push_back({{"name", unit.name}, {"dimension", name(unit.dimension)}, {"factor", unit.factor}});
  for (const auto list : {language::color_functions(), language::transform_functions(), language::math_functions()})
    for (const language::Function& f : list) functions.push_back({{"name", f.name}, {"usage", f.usage}});
  return {{"version", ETENDUE_VERSION},
          {"classes", known_classes()},
          {"units", all_units},
          {"functions", functions},
          {"names",
           {{"illuminants", illuminant_names()},
            {"glasses", glass_names()},
            {"metals", metal_names()},
            {"rgb_spaces", rgb_space_names()}}}};
}

std::string Studio::manual_page(const std::string& class_name) {
  const ClassInfo* info = Registry::instance().find(class_name);
  return info ? "# " + info->name + "\n\n```\n" + class_text(*info) + "```\n" : std::string();
}

namespace {

Json hello(const Call& call) {
  Studio& studio = call.studio;
  const auto protocol = call.integer("protocol", 1, 1'000'000);
  if (protocol != 1) throw RequestError("bad_request", "this studio speaks protocol 1; reload the page");
  Json reply = {{"protocol", 1}, {"read_only", studio.settings().read_only}, {"browser", call.browser.number}};
  reply["viewing"] = studio.settings().viewing;
  reply["pictures"] = studio.pictures_json();
  const Json vocabulary = vocabulary_json();
  for (const auto& [key, value] : vocabulary.items()) reply[key] = value;
  reply["folders"] = studio.folders().all();
  reply["document"] = studio.document_json();
  reply["text"] = studio.text_json();
  reply["tree"] = tree_json(studio.document());
  reply["progress"] = studio.progress_json();
  reply["renders"] = studio.sides_json()["renders"];
  reply["queue"] = studio.queue().json();
  return reply;
}

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

void require_saved(const Call& call) {
  if (call.studio.document().changed() && !call.flag("discard"))
    throw RequestError("busy", "there are changes that are not saved");
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

Json manual(const Call& call) {
  const std::string name = call.text("class"), page = Studio::manual_page(name);
  if (page.empty()) static_cast<void>(Registry::instance().create(name));  // throws Error with suggestions
  return {{"markdown", page}};
}

Json queue(const Call& call) {
  Queue& queue = call.studio.queue();
  if (call.has("add")) {
    if (!call.request["add"].is_array()) throw RequestError("bad_request", "'add' must be a list of files");
    std::vector<std::string> paths;
    for (const Json& file : call.request["add"]) {
      if (!file.is_string()) throw RequestError("bad_request", "'add' must be a list of files");
      paths.push_back(allowed_path(call, file.get<std::string>()));
      // The file is rendered as it is on disk; its output files must be in folders that this studio may use.
      for (const NamedFile& named : files_named_by(*load_job(paths.back())))
        if (!call.studio.folders().contains(named.path))
          throw RequestError("not_allowed", fmt::format("'{}' names '{}', outside of the folders that this studio may use",
                                                        paths.back(), named.path));
    }
    for (const std::string& path : paths) queue.add(path);
  }
  if (call.has("remove")) queue.remove(int(call.integer("remove", 0, 2'000'000'000)));
  if (call.flag("start")) queue.start();
  if (call.flag("stop")) queue.stop();
  Json json = queue.json();
  call.studio.broadcast(json);
  return {{"queue", json}};
}

/// Ends the program for all pages.
Json shutdown(const Call& call) {
  require_saved(call);
  call.studio.shutdown(call.flag("discard"));
  return {};
}

}  // namespace

std::span<const Request> file_requests() {
  static constexpr Request all[] = {
      {"hello", true, hello},   {"save", false, save},     {"open", false, open},
      {"new", false, create},   {"reload", false, reload}, {"files", false, files},
      {"manual", true, manual}, {"queue", false, queue},   {"shutdown", false, shutdown},
  };
  return all;
}

}  // namespace etendue::studio
