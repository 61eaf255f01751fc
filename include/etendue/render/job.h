#pragma once
// Job: holds all parts of a render and runs them. User interfaces talk to it alone.

#include <atomic>
#include <functional>
#include <optional>

#include "etendue/camera.h"
#include "etendue/film/film.h"
#include "etendue/language/language.h"
#include "etendue/output.h"
#include "etendue/render/renderer.h"
#include "etendue/scene.h"
#include "etendue/tone_map.h"
#include "etendue/wavelength_sampler.h"

namespace etendue {

/// How far a render is.
struct Progress {
  std::uint32_t samples = 0, samples_wanted = 0;  ///< per pixel
  double fraction = 0;                            ///< of the work, by whichever rule will stop it first
  double seconds = 0;                             ///< since the first pass began
  double seconds_left = 0;                        ///< estimated; negative: unknown
  double samples_per_second = 0;                  ///< over the whole picture
  double error = 0;                               ///< relative, see FilmSnapshot::relative_error; only when asked for
  bool finished = false;
};

/// The state of a render at a pass boundary; see render/checkpoint.h.
struct Checkpoint;

/// Why a render ended.
enum class Ended : std::uint8_t { samples, time, error, interrupted, aborted };

class Job final : public Component {
 public:
  using Interface = Job;
  using Parent = Component;
  static void describe(Description<Job>&);
  Job();
  ~Job() override;

  Ref<Renderer> renderer;
  Ref<Camera> camera;
  Ref<Scene> scene;
  Ref<ImageBuffer> image;
  Ref<WavelengthSampler> wavelengths;
  Ref<ToneMap> tone_map;
  std::vector<Ref<Output>> outputs;
  std::uint64_t seed = 0;
  double time_limit = 0;   ///< [s]; 0: none
  double error_limit = 0;  ///< relative standard error; 0: none

  // Not described: how this process runs the job.
  int threads = 0;  ///< 0: all cores
  std::function<void(const Progress&)> on_progress;
  double progress_interval = 0.25;   ///< [s]
  std::string checkpoint_file;       ///< where to keep the state while it renders; empty: nowhere
  double checkpoint_interval = 60;   ///< [s] at least from one writing to the next; 0: after every pass
  std::optional<IndexRange> passes;  ///< only these; their number and size follow from the picture's size and the samples

  void before_prepare() override;
  void prepare() override;
  /// The point of the world that rendering coordinates count from.
  const DoublePoint3& world_centre() const { return centre_; }

  /// Prepares everything and renders from the beginning until a rule says stop. The picture depends on the description and
  /// the seed alone.
  Ended render();
  /// Goes on where a checkpoint of this job ended, with the passes that it lacks: to the same bits. Throws Error before
  /// anything changes when it is damaged or of something else.
  Ended resume(const std::string& checkpoint);
  /// Asks the render that runs, or else the next one, to stop: at the end of the pass (`finish`), or now, within whatever
  /// paths it is at, discarding the pass (`abort`). Safe in signal handlers.
  void finish() { finish_.store(true); }
  void abort() { abort_.store(true); }

  /// Why the state could not be written to `checkpoint_file` the last time; empty: it could. A render goes on without.
  const std::string& checkpoint_failure() const { return checkpoint_failure_; }
  /// A pass is a range of so many samples per pixel, the last of a render perhaps fewer. The job must be prepared.
  std::uint32_t samples_per_pass() const;
  /// The samples of each pixel that the picture holds, in order.
  const std::vector<IndexRange>& samples_done() const { return done_; }

  /// What has been collected. The job, or at least its image, must be prepared.
  Film& film() const;

  /// Takes over the state of a checkpoint as it is. The image must be prepared.
  void restore(const Checkpoint&);

  /// The picture so far, with metadata.
  Image picture() const;
  /// Writes all outputs; the file name of one without a name comes from `default_stem`. Returns the paths written.
  std::vector<std::string> write_outputs(const std::string& default_stem) const;

  /// A process of the renderer at the step a sample is in, ready to be asked for it.
  std::unique_ptr<RenderProcess> start_at(std::uint32_t sample);
  /// Replays one sample alone; returns its film point.
  Point2 replay(int x, int y, std::uint32_t sample, PathRecord&);

  /// Metadata that pictures carry, besides what the Job knows itself ("file_hash", …).
  std::map<std::string, std::string> metadata;

 private:
  RenderContext context() const;
  void count_from(const DoublePoint3& centre);
  IndexRange wanted_samples() const;
  void begin_film();
  Ended run(const Checkpoint* from, const std::string& from_file);

  std::unique_ptr<RenderProcess> process_;
  std::atomic<bool> finish_{false}, abort_{false};
  std::vector<IndexRange> done_;
  double seconds_ = 0;
  std::string checkpoint_failure_;
  bool prepared_ = false;
  DoublePoint3 centre_;
  std::unique_ptr<Film> film_;
};

/// Reads a render description; throws Errors with everything wrong that can be found in one run. Not prepared yet.
Ref<Job> load_job(const std::string& path, const LoadOptions& = {});
/// The same from a text; `name` stands for the file in messages, paths are relative to `folder`.
Ref<Job> load_job_text(const std::string& text, const std::string& name, const std::string& folder = {},
                       const LoadOptions& = {});

}  // namespace etendue
