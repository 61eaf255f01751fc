#pragma once
// The options of `etendue render`, and how they change a Job.

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "etendue/render/render.h"
#include "files/output_files.h"
#include "scene_options.h"

namespace etendue {

struct RenderOptions : SceneOptions {
  std::vector<std::string> files;  ///< all to be rendered; `file` is the current one
  std::string frames;              ///< as written
  bool skip_existing = false;
  bool in_series = false;  ///< one of several frames: an unfinished image is not written
  std::vector<std::string> outputs;
  std::string samples, time, error, seed, size, crop;  ///< as written; empty: the description's value
  bool denoise = false;
  int threads = 0;
  bool quiet = false;
  std::string progress = "auto";
  std::string checkpoint, resume, continue_file, every, passes;  ///< as written
  std::string pixel;
  std::optional<std::uint32_t> sample;
  int paths = 5;            ///< number of the pixel's samples that are printed
  std::string replay;       ///< the JSON file the paths are written to; empty: none
  int fireflies = 0;        ///< number of samples that are listed after the render
  bool send_scene = false;  ///< to processes that do not see its files
  Team* team = nullptr;     ///< the processes that render together; null: this one alone
  std::string tev;          ///< address of the tev that shows the image, as written; empty: none

  void add_to(Command& command);
  /// Adds the options that choose the picture and its files, which are a part of those above.
  void add_picture_options(Command& command);

  /// Loads the file, applies all overrides except the outputs, and checks the settings. Throws Errors.
  Ref<Job> load() const;
  /// Likewise, without what a picture's file tells of the command.
  Ref<Job> load_overridden() const;
  /// The settings of the render. Throws Error for options that contradict each other.
  RenderSettings settings() const;
  /// The checkpoint to resume from; empty: the render starts anew.
  std::string resumed_file() const;
  /// The file that checkpoints are written to; empty: none.
  const std::string& checkpoint_file() const;
  /// The command line that reproduces the image: without the options that change only how or where it is computed.
  std::string picture_command() const;
  /// The command line that resumes this render from its checkpoint.
  std::string resume_command() const;
  /// The start of the names of images without a name of their own: the description's file name and the frame number.
  std::string stem() const;
  /// Whether a limit of time or error, and no number of samples, stops the render.
  bool open_ended() const { return samples.empty() && (!time.empty() || !error.empty()); }

 private:
  /// The file_hash of a job, with all overrides.
  std::string hash_of(const Job&, std::set<std::string> read) const;
  /// The path of a member, the expression it is set to, and the option this comes from.
  struct Override {
    std::string option, path, expression;
  };
  std::vector<Override> overrides() const;
  /// For --size with a crop in the description: scales the crop, so that it shows the same part of the image.
  void scale_crop(const Job&, std::vector<Override>&) const;
  void add_checkpoint_options(Command& command);
  std::optional<IndexRange> parse_passes() const;
};

/// Returns outputs to `files`, whose extensions choose the formats. Each takes the settings of a described output of the same
/// class if there is one. Without files it returns the described outputs; if there are none, a PNG.
std::vector<Ref<Output>> chosen_outputs(const std::vector<Ref<Output>>& described, const std::vector<std::string>& files);
/// Writes an image to each output, with file names from `stem` for outputs without one. When one fails, the others are still
/// written. Returns the written files; appends to `errors`.
std::vector<std::string> write_each(const std::vector<Ref<Output>>& outputs, const Job&, const Image& picture,
                                    const std::string& stem, std::vector<Error>& errors);
/// Adds the files that outputs will write, with file names from `stem` for outputs without one.
void add_outputs(const std::vector<Ref<Output>>& outputs, const std::string& stem, OutputFiles&);

}  // namespace etendue
