#pragma once
// The options of all commands that read a render description: the file, and overrides of its parts.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"
#include "etendue/render/job.h"
#include "render/import_job.h"

namespace etendue {

/// A member that an option sets in a job.
struct SetOption {
  std::string option, path;
};

/// Throws Error if an option is overwritten by a later one, which sets the same member or one that contains it.
void require_kept(const std::vector<SetOption>&);

struct SceneOptions {
  std::string file;
  std::vector<std::string> defines;  ///< "name=value"
  std::vector<std::string> sets;     ///< "path=value"
  std::string renderer;              ///< a class or expression instead of the description's renderer; empty: that one
  bool rgb = false;                  ///< RgbWavelengths instead of the description's
  std::vector<std::string> plugins;
  ImportOptions import;      ///< for files of other formats
  std::optional<int> frame;  ///< the value of `frame` in the file; without it 0
  std::string fps;           ///< frames per second of `time`, as written; empty: default_fps
  bool animated = false;     ///< the file is rendered for several frames

  static constexpr double default_fps = 24;
  static constexpr int most_frames = 999'999'999;

  void add_to(Command& command);
  /// Adds all options but the file, for commands with several files.
  void add_overrides_to(Command& command);

  /// Loads the plugins and the file, and applies the overrides. Throws Errors.
  Ref<Job> load() const;
  /// The same for a file of another format, with the differences from it. Throws Error if no Importer reads the format.
  ImportedJob load_imported() const;
  /// Frames per second of `time`. Throws Error if the option is not a positive number.
  double frames_per_second() const;
  /// The options as written on a command line, quoted for a shell, with a blank before each.
  std::string command_line() const;
  /// The same without the file.
  std::string overrides_line() const;

 protected:
  /// The members that `sets` sets, in their order.
  std::vector<SetOption> set_options() const;

 private:
  LoadOptions load_options() const;
  void apply_renderer(Job&) const;
  void apply_sets(Job&) const;
};

/// The text, in single quotes if it has characters that are special to a shell.
std::string shell_quoted(const std::string& text);

/// The file's name without folder and ending.
std::string stem_of(const std::string& file);

}  // namespace etendue
