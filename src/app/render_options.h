#pragma once
// What `etendue render` takes, and how it changes a Job.

#include <optional>
#include <string>
#include <vector>

#include "app/scene_options.h"

namespace etendue {

struct RenderOptions : SceneOptions {
  std::vector<std::string> outputs;
  std::string samples, time, error, seed, size, crop;  ///< as written; empty: as the file says
  int threads = 0;
  bool quiet = false;
  std::string progress = "auto";
  std::string pixel;
  std::optional<std::uint32_t> sample;

  void add_to(CLI::App& command);

  /// Loads the file and applies all overrides, outputs included. Throws Errors.
  Ref<Job> load() const;
  /// The command line that gives the same picture: without what changes only how or where it is computed.
  std::string picture_command() const;
  /// 16 hexadecimal digits that change with the file's text and every override of it.
  std::string file_hash() const;
  /// Whether something other than a number of samples is to stop the render.
  bool open_ended() const { return samples.empty() && (!time.empty() || !error.empty()); }

 private:
  /// Member paths and the expressions they are set to, with the options they come from.
  struct Override {
    std::string option, path, expression;
  };
  std::vector<Override> overrides() const;
};

/// Replaces a job's outputs by files whose endings choose the format. The settings of an output of the same class that
/// the job has are kept. Without files, a job that has no output gets a PNG.
void choose_outputs(Job&, const std::vector<std::string>& files);

/// Throws an Error now if a folder to be written to is not there, rather than after the render.
void check_output_folders(const Job&);

}  // namespace etendue
