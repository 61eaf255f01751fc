#pragma once
// Laboratory: renders the runs of a comparison and computes its results, for the program and for scripts.

#include <memory>

#include "analysis.h"

namespace etendue::comparing {

/// A scene of a comparison.
struct ComparedScene {
  std::string name;                 ///< in texts and tables: its file
  std::function<Ref<Job>()> load;   ///< creates its job anew, not prepared
  std::optional<Image> reference;   ///< the reference, if `reference_file` is empty: linear values, of any colour space
  std::string reference_file = {};  ///< as of read_reference; empty: none
};

/// The request for a comparison.
struct ComparisonOptions {
  std::vector<ComparedScene> scenes;
  std::vector<Variant> variants;
  Budget budget;
  size_t runs = 8;                ///< of each variant on each scene, at least 3
  double reference_seconds = 0;   ///< CPU time of the reference that is rendered for each scene; 0: none is
  int tile = 0;                   ///< side of the tiles that are tested for bias [pixels]; 0: chosen from the image's size
  double significance = 0.01;     ///< probability of calling any of several equal variants better, or biased
  int threads = 0;                ///< 0: all cores
  std::string state_folder;       ///< where runs are stored; empty: in memory
  bool pictures = false;          ///< the HTML of each scene's images is made as well
  std::vector<PixelArea> insets;  ///< parts of the images that are shown enlarged; empty: where the variants differ most
};

/// Follows a comparison. All functions are called by the thread that runs it.
class ComparisonWatcher {
 public:
  virtual ~ComparisonWatcher() = default;
  /// A run begins; `what` names it. While the returned object lives, the render may be stopped and aborted, also by other
  /// threads.
  virtual std::shared_ptr<void> begin(const std::string& what, Render&) = 0;
  /// This fraction of the current run is done.
  virtual void at(double fraction) = 0;
  /// A run took so many seconds, now or, if it was stored, when it was rendered.
  virtual void end(double seconds) = 0;
  /// A scene's runs are complete, and are analysed.
  virtual void analysing() = 0;
  /// Whether to go on; asked between steps and runs.
  virtual bool go_on() = 0;
};

class Laboratory {
 public:
  /// Loads all scenes and finds their references, so that errors are thrown before anything is rendered. Throws Errors.
  explicit Laboratory(ComparisonOptions);
  ~Laboratory();
  Laboratory(const Laboratory&) = delete;
  Laboratory& operator=(const Laboratory&) = delete;

  /// Renders and analyses all runs. False: the watcher ended it. Throws Error if the folder holds other runs.
  bool run(ComparisonWatcher&);

  /// The seed of the comparison, from which those of the runs follow (seed_of).
  std::uint64_t seed() const;
  /// The runs that are not in the folder of runs, in the order in which `run` renders them. Requires a folder, which is created
  /// if it does not exist; throws Error if it holds other runs.
  std::vector<RunKey> missing_runs();

  size_t all_runs() const;
  size_t stored_runs() const;  ///< those that are rendered
  /// Complete after `run`.
  const Results& results() const;
  /// The page with the results. Requires `pictures`.
  std::string html_report(const std::string& command_line) const;

 private:
  struct Members;
  const std::unique_ptr<Members> members_;
};

}  // namespace etendue::comparing
