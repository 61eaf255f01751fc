// The options of all commands that read a render description.

#include "scene_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>
#include <filesystem>

#include "check/naming/named_renderer.h"
#include "common_options.h"
#include "etendue/language/language.h"
#include "etendue/render/job.h"
#include "files/gzip.h"
#include "formats/permissions.h"
#include "python_plugins.h"

namespace etendue {

namespace {

constexpr const char* rgb_wavelengths = "RgbWavelengths";

std::pair<std::string, std::string> split(const std::string& option, const std::string& text, const char* what) {
  const size_t at = text.find('=');
  if (at == std::string::npos || at == 0) throw Error("'" + text + "' is not of the form " + what, {intern(option), 0, 0});
  return {text.substr(0, at), text.substr(at + 1)};
}

}  // namespace

void SceneOptions::add_to(Command& command) {
  command.argument("FILE", file, "The render description (.etd, or .json), or a file of another program").required();
  add_overrides_to(command);
}

void SceneOptions::add_overrides_to(Command& command) {
  command.option("-D,--define NAME=VALUE", defines, "Replace the value of a param of the file; may be repeated");
  command.option("--set PATH=VALUE", sets,
                 "Set any member of any part, such as renderer.max_depth=4 or scene.objects[2].radius=\"1 cm\"");
  command.flag(
      "--rgb", rgb,
      "Paths carry red, green and blue in place of wavelengths, as in RGB renderers: the Job's wavelengths are RgbWavelengths");
  add_plugin_option(command, plugins);
  command.flag("--strict", import.strict, "Imported files: what cannot be expressed exactly is an error");
  command.option("--allow-path FOLDER", import.allowed_folders,
                 "Imported files may also read files in this folder, besides their own folder; may be repeated");
  command.option("--frame N", frame, "Value of 'frame' in the file, and of 'time', which is frame / fps [0]")
      .range(0, most_frames);
  command.option("--fps F", fps, "Frames per second, for 'time' [24]");
}

double SceneOptions::frames_per_second() const {
  if (fps.empty()) return default_fps;
  double value = 0;
  const auto [end, error] = std::from_chars(fps.data(), fps.data() + fps.size(), value);
  if (error == std::errc() && end == fps.data() + fps.size() && value > 0 && std::isfinite(value)) return value;
  throw Error(fmt::format("'{}' is not a frame rate: give a number above 0, such as 24 or 29.97", fps),
              {intern("--fps"), 0, 0});
}

LoadOptions SceneOptions::load_options() const {
  if (!fps.empty() && !frame)
    throw Error("there are no frames whose time depends on it: give --frame or --frames as well", {intern("--fps"), 0, 0});
  load_plugins(plugins);
  LoadOptions options;
  options.frame = frame.value_or(0);
  options.time = options.frame / frames_per_second();
  options.animated = animated;
  for (const std::string& define : defines) options.defines.push_back(split("-D", define, "name=value"));
  for (const std::string& folder : import.allowed_folders) {
    std::error_code ignored;
    if (!std::filesystem::is_directory(folder, ignored))
      throw Error(fmt::format("'{}' is not a folder", folder), {intern("--allow-path"), 0, 0});
  }
  options.import = import;
  options.import.time = options.time;
  set_import_permissions(options.import);
  set_imports_for_rgb(rgb);
  return options;
}

Ref<Job> SceneOptions::load() const {
  Ref<Job> job = load_job(file, load_options());
  refuse_restarts();  // a second file may be read when the picture of the first was written
  apply_sets(*job);
  return job;
}

ImportedJob SceneOptions::load_imported() const {
  const LoadOptions options = load_options();
  const Ref<Importer> importer = importer_of(file);
  if (!importer) {
    const std::string ending = ending_of_contents(file);
    throw Error(fmt::format("{} are not imported; these are: .{}",
                            ending.empty() ? "files without an ending" : "files ending in ." + ending,
                            fmt::join(imported_extensions(), ", .")),
                {intern(file), 0, 0});
  }
  ImportedJob imported = import_job(*importer, file, options);
  apply_sets(*imported.job);
  return imported;
}

namespace {

/// Whether setting `later` overwrites what was set at `path`: the same member, or one that contains it.
bool replaces(const std::string& later, const std::string& path) {
  return path.starts_with(later) && (path.size() == later.size() || path[later.size()] == '.' || path[later.size()] == '[');
}

}  // namespace

void require_kept(const std::vector<SetOption>& sets) {
  for (size_t i = 0; i < sets.size(); ++i)
    for (size_t k = i + 1; k < sets.size(); ++k)
      if (replaces(sets[k].path, sets[i].path))
        throw Error(sets[k].path == sets[i].path
                        ? fmt::format("'{}' is set already, by {}: leave out one of the two", sets[k].path, sets[i].option)
                        : fmt::format("'{}' would overwrite what {} sets in '{}': give it first", sets[k].path, sets[i].option,
                                      sets[i].path),
                    {intern(sets[k].option), 0, 0});
}

std::vector<SetOption> SceneOptions::set_options() const {
  std::vector<SetOption> list;
  if (!renderer.empty()) list.push_back({"--renderer", "renderer"});
  if (rgb) list.push_back({"--rgb", "wavelengths"});
  for (const std::string& set : sets) list.push_back({"--set", split("--set", set, "path=value").first});
  return list;
}

void SceneOptions::apply_renderer(Job& job) const {
  const Ref<Renderer> named = named_renderer(job, renderer, "--renderer");
  if (named == job.renderer) return;
  take_over(*named, *job.renderer);
  for (const char* member : {"samples", "map_filter"})
    if (!written(*named, member) && named->class_info().find(member) && job.renderer->class_info().find(member))
      set(*named, member, get(*job.renderer, member));
  job.renderer = named;
}

void SceneOptions::apply_sets(Job& job) const {
  require_kept(set_options());
  if (!renderer.empty()) apply_renderer(job);
  if (rgb && job.wavelengths->class_info().name != rgb_wavelengths) set_path(job, "wavelengths", rgb_wavelengths);
  std::vector<Error> errors;
  for (const std::string& set : sets) {
    try {
      const auto [path, value] = split("--set", set, "path=value");
      set_path(job, path, value);
    } catch (const Errors& several) {
      errors.insert(errors.end(), several.errors.begin(), several.errors.end());
    } catch (const Error& error) {
      errors.push_back(error);
    }
  }
  if (!errors.empty()) throw Errors(std::move(errors));
}

std::string SceneOptions::command_line() const { return " " + shell_quoted(file) + overrides_line(); }

std::string SceneOptions::overrides_line() const {
  std::string text;
  for (const std::string& define : defines) text += " -D " + shell_quoted(define);
  if (!renderer.empty()) text += " --renderer " + shell_quoted(renderer);
  if (rgb) text += " --rgb";
  for (const std::string& set : sets) text += " --set " + shell_quoted(set);
  for (const std::string& plugin : plugins) text += " --plugin " + shell_quoted(plugin);
  if (import.strict) text += " --strict";
  for (const std::string& folder : import.allowed_folders) text += " --allow-path " + shell_quoted(folder);
  if (frame) text += fmt::format(" --frame {}", *frame);
  if (!fps.empty()) text += " --fps " + shell_quoted(fps);
  return text;
}

std::string shell_quoted(const std::string& text) {
  constexpr const char* harmless = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/@%";
  if (!text.empty() && text.find_first_not_of(harmless) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string stem_of(const std::string& file) { return std::filesystem::path(file).stem().string(); }

}  // namespace etendue
