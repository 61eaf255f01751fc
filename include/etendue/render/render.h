#pragma once
// Render: a Job being rendered. Whatever watches or drives a render, a program, a panel, a script, another machine, talks to it
// alone.

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

/// How far a render is.
struct Progress {
  std::uint32_t samples = 0, samples_wanted = 0;  ///< per pixel, in whole steps
  double fraction = 0;                            ///< of the work, by whichever rule will stop it first
  double seconds = 0;                             ///< spent on the steps
  double seconds_left = 0;                        ///< estimated; negative: unknown
  double samples_per_second = 0;                  ///< over the whole picture
  double error = 0;                               ///< relative, see FilmSnapshot::relative_error; only if the job limits it
  bool finished = false;
};

/// Why a render ended.
enum class Ended : std::uint8_t { samples, time, error, interrupted, aborted };

/// How this process runs a job: nothing of it changes the picture.
struct RenderSettings {
  int threads = 0;  ///< 0: all cores
  /// Only these steps; how many there are follows from the picture's size and the samples.
  std::optional<IndexRange> steps = {};
  /// Called while it renders, from whatever thread is at work, one at a time. It may look, stop and abort, but neither edit,
  /// replay, save nor load.
  std::function<void(const Progress&)> on_progress = {};
  double progress_interval = 0.25;   ///< [s]
  std::string checkpoint_file = {};  ///< where `run` keeps the state while it renders; empty: nowhere
  double checkpoint_interval = 60;   ///< [s] at least from one writing to the next; 0: after every step
};

/// What a render held at a moment: independent of it, for any thread.
struct RenderSnapshot {
  FilmSnapshot film;
  Progress progress;
  std::map<std::string, std::string> metadata;
  /// The picture as X Y Z, with layers and metadata.
  Image picture() const;
};

/// One member of a part of the job, and what it is to be.
struct Edit {
  Ref<const Component> component;
  std::string member;
  Value value;
};

/// One thread may step or run; all else may be asked at any time, from any thread.
class Render {
 public:
  /// Prepares the job; throws Errors with places. From now on the job is changed by `edit` alone, and no other Render is made
  /// of it while this one is at work.
  explicit Render(Ref<Job>, RenderSettings = {});
  ~Render();
  Render(const Render&) = delete;
  Render& operator=(const Render&) = delete;

  const Job& job() const;
  const RenderSettings& settings() const;

  // ---- going on -------------------------------------------------------------------------------------------------------------

  /// Goes on from where it is until a rule of the job says stop, or somebody does. The picture depends on the description and
  /// the seed alone. What a part throws comes out as an Error; the step at hand then leaves nothing.
  Ended run();
  /// Renders the next step. Says why, if it did not: all samples are there, or somebody said stop or abort.
  std::optional<Ended> step();
  /// Asks what runs, or else runs next, to stop: after the step (`stop`), or now, within whatever paths it is at, and without
  /// the step (`abort`). Safe in signal handlers.
  void stop();
  void abort();
  /// Begins anew, with other random numbers if a seed is given.
  void restart(std::optional<std::uint64_t> seed = {});

  // ---- looking --------------------------------------------------------------------------------------------------------------

  Progress progress() const;
  RenderSnapshot snapshot() const;
  /// The picture so far, with metadata: that of a snapshot.
  Image picture() const { return snapshot().picture(); }
  /// A picture as the job's tone map shows it now.
  Image display(const Image& picture) const;
  /// Writes all outputs of the job; the file name of one without a name comes from `default_stem`. Returns the paths written.
  std::vector<std::string> write_outputs(const std::string& default_stem) const;
  /// What collects the samples.
  Film& film();
  const Film& film() const;
  /// How many samples of each pixel a step takes, the last of a render perhaps fewer.
  std::uint32_t samples_per_step() const;
  /// The samples of each pixel that the picture holds, in order.
  std::vector<IndexRange> samples_done() const;

  // ---- editing --------------------------------------------------------------------------------------------------------------

  /// Sets members, all or none, between two steps; a step at hand is given up for it unless only the look changes. What the
  /// edits concern is prepared again (Effect), no more, and the render goes on or begins anew: in any case to the picture that
  /// a new render of the edited job has. Throws Error, with everything as it was, when a value or what it leads to is not
  /// valid, or the component is no part of the job.
  void edit(std::span<const Edit>);
  void edit(const Component&, const std::string& member, const Value&);

  // ---- its state
  // --------------------------------------------------------------------------------------------------------------

  /// The state at the end of the last step, to go on from in another process: the same samples give the same bytes.
  void save(std::ostream&) const;
  /// The same as a file, which is whole or as it was.
  void save(const std::string& file) const;
  /// Takes over a state of this job. Throws Error, before anything changes, when it is damaged, of something else, or holds too
  /// much.
  void load(std::istream&);
  void load(const std::string& file);
  /// Adds the samples of another process, which must not be here yet; in any order, to the same bits.
  void add(std::istream&);
  /// Why the state could not be written to the settings' file the last time; empty: it could. A render goes on without.
  std::string checkpoint_failure() const;

  // ---- single samples
  // ---------------------------------------------------------------------------------------------------------

  /// A process of the renderer at the step a sample is in, ready to be asked for it; made between two steps of the render, and
  /// to be used while neither an edit nor another such process is made. Where steps depend all before it are rendered first.
  std::unique_ptr<RenderProcess> start_at(std::uint32_t sample) const;
  /// Renders one sample alone; returns its film point. Throws Error when there is no such pixel, or when the algorithm's
  /// samples are not those of pixels.
  Point2 replay(int x, int y, std::uint32_t sample, PathRecord&) const;

  struct Members;  ///< Render's own

 private:
  const std::unique_ptr<Members> m;
};

/// The texts that pictures of a job carry.
std::map<std::string, std::string> picture_metadata(const Job&, std::uint32_t samples);
/// Writes a picture as one of the job's outputs says, with the tone map that is its own or the job's. Returns the path.
std::string write_output(const Job&, const Output&, const Image& picture, const std::string& default_stem);

}  // namespace etendue
