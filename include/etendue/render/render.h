#pragma once
// Render: a Job being rendered. Programs, panels, scripts and other machines that watch or control a render use this interface
// only.

#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "etendue/film/film.h"
#include "etendue/render/job.h"

namespace etendue {

class SurfaceSnapshot;
class Team;

/// How far a render is.
struct Progress {
  std::uint32_t samples = 0, samples_wanted = 0;  ///< per pixel, in whole steps
  double fraction = 0;                            ///< of the work, by the limit that will probably stop the render first
  double seconds = 0;                             ///< spent on its steps
  double seconds_left = 0;                        ///< estimated; negative: unknown
  double samples_per_second = 0;                  ///< over the whole picture
  double error = 0;                               ///< relative, see FilmSnapshot::relative_error; only if the job limits it
  bool finished = false;
};

/// Why a render ended.
enum class Ended : std::uint8_t { samples, time, error, interrupted, aborted };

/// How this program runs a job: none of these settings changes the picture.
struct RenderSettings {
  int threads = 0;  ///< 0: all cores
  /// Only these steps; their number follows from the picture's size and the samples.
  std::optional<IndexRange> steps = {};
  /// Called during the render, from any of its threads, one call at a time. It may read the render, stop and abort it, but not
  /// edit, replay, save or load.
  std::function<void(const Progress&)> on_progress = {};
  double progress_interval = 0.25;   ///< [s]
  std::string checkpoint_file = {};  ///< where `run` saves its state while it renders; empty: nowhere
  double checkpoint_interval = 60;   ///< [s] between two savings at least; 0: after every step
  /// The processes that compute this render together (src/render/team.h); null: this one alone. The leader's render collects
  /// the picture, and cannot be edited. Others only compute: `run` ends when the leader's render has ended, and their film is
  /// empty.
  Team* team = nullptr;
};

/// A copy of the state of a render at one moment. It is independent of the render and may be used by any thread.
struct RenderSnapshot {
  FilmSnapshot film;
  Progress progress;
  std::map<std::string, std::string> metadata;
  std::shared_ptr<const SurfaceSnapshot> surfaces;  ///< null: the picture has no layers that show surfaces
  /// The picture as X Y Z, with layers and metadata.
  Image picture() const;
};

/// A new value for one member of a component of the job.
struct Edit {
  Ref<const Component> component;
  std::string member;
  Value value;
};

/// One thread may step or run; all other functions may be called at any time, from any thread.
class Render {
 public:
  /// Prepares the job; throws Errors with their locations. From now on only `edit` may change the job, and no other Render of
  /// it may be made while this one is running.
  explicit Render(Ref<Job>, RenderSettings = {});
  ~Render();
  Render(const Render&) = delete;
  Render& operator=(const Render&) = delete;

  const Job& job() const;
  const RenderSettings& settings() const;

  // ---- rendering -----------------------------------------------------------------------------------------------------------

  /// Continues until a limit of the job is reached, or stop or abort is called. The picture depends on the description and the
  /// seed alone. Exceptions of components are rethrown as Error; the current step then leaves nothing.
  Ended run();
  /// Renders the next step. Returns the reason if it rendered none: all samples are done, or stop or abort was called.
  std::optional<Ended> step();
  /// Stops the current run, or else the next one: `stop` after the current step, or without it if a team computes it; `abort`
  /// at once, in the middle of its paths, and without the step. Safe in signal handlers.
  void stop();
  void abort();
  /// Starts over, with other random numbers if a seed is given.
  void restart(std::optional<std::uint64_t> seed = {});
  /// Replaces RenderSettings::steps, between two steps: a prepared render can so make one part after another.
  void select_steps(std::optional<IndexRange>);

  // ---- progress and results ------------------------------------------------------------------------------------------------

  Progress progress() const;
  RenderSnapshot snapshot() const;
  /// The picture of a snapshot, with metadata.
  Image picture() const { return snapshot().picture(); }
  /// A picture after the job's current tone map.
  Image display(const Image& picture) const;
  /// Writes all outputs of the job; an output without a file name gets one from `default_stem`. Returns the paths written.
  std::vector<std::string> write_outputs(const std::string& default_stem) const;
  /// The film that collects the samples.
  Film& film();
  const Film& film() const;
  /// Samples of each pixel per step; the last step of a render may have fewer.
  std::uint32_t samples_per_step() const;
  /// The samples of each pixel that the picture contains, in order.
  std::vector<IndexRange> samples_done() const;

  // ---- editing --------------------------------------------------------------------------------------------------------------

  /// Sets members between two steps, either all or none. The current step is aborted for it, unless only the display changes.
  /// Only components that the edits affect are prepared again (Effect). The render continues or starts over, whichever gives
  /// the picture that a new render of the edited job would give. Throws Error, with everything unchanged, if a value or its
  /// consequence is invalid, or the component is not part of the job.
  void edit(std::span<const Edit>);
  void edit(const Component&, const std::string& member, const Value&);

  // ---- state ---------------------------------------------------------------------------------------------------------------

  /// The state at the end of the last step, from which another process can continue: the same samples give the same bytes.
  void save(std::ostream&) const;
  /// Saves to a file, which is written whole or stays unchanged.
  void save(const std::string& file) const;
  /// Replaces the state by a saved one of this job. Throws Error, before anything changes, if the state is damaged, belongs to
  /// another job, or holds too many samples.
  void load(std::istream&);
  void load(const std::string& file);
  /// Adds samples that another process rendered and this one lacks; in any order, with bit-identical sums.
  void add(std::istream&);
  /// Why the last checkpoint could not be written; empty: it could. The render continues without it.
  std::string checkpoint_failure() const;

  // ---- single samples ------------------------------------------------------------------------------------------------------

  /// A process of the renderer, prepared for the step that contains a sample. It is made between two steps of the render, and
  /// may be used until the next edit or the next such process. If steps depend on each other, all earlier steps are rendered
  /// first.
  std::unique_ptr<RenderProcess> start_at(std::uint32_t sample) const;
  /// Renders one sample alone and returns its film point. Throws Error if there is no such pixel, or if the algorithm's samples
  /// do not belong to pixels.
  Point2 replay(int x, int y, std::uint32_t sample, PathRecord&) const;

  struct Members;

 private:
  const std::unique_ptr<Members> members_;
};

/// The metadata that pictures of a job carry.
std::map<std::string, std::string> picture_metadata(const Job&, std::uint32_t samples);
/// Writes a picture as one of the job's outputs describes, with the output's tone map or the job's. Returns the path.
std::string write_output(const Job&, const Output&, const Image& picture, const std::string& default_stem);

}  // namespace etendue
