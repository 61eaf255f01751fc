#pragma once
// What `etendue render` takes, and how it changes a Job.

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "etendue/render/render.h"
#include "files/output_files.h"
#include "scene_options.h"

namespace etendue {

struct RenderOptions : SceneOptions {
  std::vector<std::string> files;  ///< those to be rendered, of which `file` is the one it is at
  std::string frames;              ///< as written
  bool skip_existing = false;
  bool in_series = false;  ///< several frames are rendered: a picture that is not finished is not written
  std::vector<std::string> outputs;
  std::string samples, time, error, seed, size, crop;  ///< as written; empty: as the file says
  bool denoise = false;
  int threads = 0;
  bool quiet = false;
  std::string progress = "auto";
  std::string checkpoint, resume, continue_file, every, passes;  ///< as written
  std::string pixel;
  std::optional<std::uint32_t> sample;
  int paths = 5;       ///< how many of a pixel's samples are told
  std::string replay;  ///< the JSON file they are written to; empty: none
  int fireflies = 0;   ///< how many samples are listed after the render
  std::string tev;     ///< where a tev shows the picture, as written; empty: nowhere

  void add_to(CLI::App& command);

  /// Loads the file and applies all overrides but the outputs, and checks the settings. Throws Errors.
  Ref<Job> load() const;
  /// How it is to be run. Throws Error when that makes no sense.
  RenderSettings settings() const;
  /// The file to go on from; empty: the render begins.
  std::string resumed_file() const;
  /// The file to keep the state in; empty: none.
  const std::string& checkpoint_file() const;
  /// The command line that gives the same picture: without what changes only how or where it is computed.
  std::string picture_command() const;
  /// The command line that goes on with this render from its checkpoint.
  std::string resume_command() const;
  /// The names of pictures that nothing else names begin with it: the file's name, with the number of the frame.
  std::string stem() const;
  /// Whether something other than a number of samples is to stop the render.
  bool open_ended() const { return samples.empty() && (!time.empty() || !error.empty()); }

 private:
  /// 16 hexadecimal digits that change with every override and with the contents of all files that were read for the job, and
  /// of those that it names.
  std::string hash_of(const Job&, std::set<std::string> read) const;
  /// Member paths and the expressions they are set to, with the options they come from.
  struct Override {
    std::string option, path, expression;
  };
  std::vector<Override> overrides() const;
  /// Another size with a crop of the description's: the same part of the picture.
  void scale_crop(const Job&, std::vector<Override>&) const;
  std::vector<CLI::Option*> add_checkpoint_options(CLI::App& command);
  std::optional<IndexRange> parse_passes() const;
};

/// Outputs to files whose endings choose the format, with the settings of a described output of the same class if there is one.
/// Without files the described ones; if there are none, a PNG.
std::vector<Ref<Output>> chosen_outputs(const std::vector<Ref<Output>>& described, const std::vector<std::string>& files);
/// Writes a picture to each output by itself, with file names from `stem` for those without: when one fails, the others are
/// still written. Returns what was written.
std::vector<std::string> write_each(const std::vector<Ref<Output>>& outputs, const Job&, const Image& picture,
                                    const std::string& stem, std::vector<Error>& errors);
/// Adds the files of outputs, with file names from `stem` for those without.
void add_outputs(const std::vector<Ref<Output>>& outputs, const std::string& stem, OutputFiles&);

}  // namespace etendue
