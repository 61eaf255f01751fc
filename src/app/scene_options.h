#pragma once
// What every command takes that reads a render description: the file, and what replaces parts of it.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"
#include "etendue/render/job.h"
#include "render/import_job.h"

namespace etendue {

/// What an option sets in a job.
struct SetOption {
  std::string option, path;
};

/// Throws Error where what one says is lost, as a later one sets the same place or one around it.
void require_kept(const std::vector<SetOption>&);

struct SceneOptions {
  std::string file;
  std::vector<std::string> defines;  ///< "name=value"
  std::vector<std::string> sets;     ///< "path=value"
  std::vector<std::string> plugins;
  ImportOptions import;      ///< for files of other programs
  std::optional<int> frame;  ///< what `frame` means in the file; without it 0
  std::string fps;           ///< frames in a second of `time`, as written; empty: default_fps
  bool animated = false;     ///< the file is one of several frames

  static constexpr double default_fps = 24;
  static constexpr int most_frames = 999'999'999;

  void add_to(CLI::App& command);
  /// All but the file, for commands that take several.
  void add_overrides_to(CLI::App& command);

  /// Loads plugins and file and applies the overrides. Throws Errors.
  Ref<Job> load() const;
  /// The same for a file of another program, with what is not as there. Throws when no Importer reads it.
  ImportedJob load_imported() const;
  /// Frames in a second of `time`. Throws Error for what is none.
  double frames_per_second() const;
  /// These options as they are written on a command line, quoted for a shell, each with a blank before it.
  std::string command_line() const;
  /// The same without the file.
  std::string overrides_line() const;

 protected:
  /// What `sets` set, in their order.
  std::vector<SetOption> set_options() const;

 private:
  LoadOptions load_options() const;
  void apply_sets(Job&) const;
};

/// The text in single quotes when a shell would otherwise take it apart.
std::string shell_quoted(const std::string& text);

/// The file's name without folder and ending.
std::string stem_of(const std::string& file);

}  // namespace etendue
