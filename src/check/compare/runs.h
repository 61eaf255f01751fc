#pragma once
// Runs: whole renders with independent random numbers, whose images are stored at several marks. They are kept in a folder, so
// that an interrupted comparison can be resumed and a finished one analysed again.

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "etendue/render/render.h"
#include "render/checkpoint.h"

namespace etendue::comparing {

/// The end of a run: a number of samples per pixel, or processor time. One of them is not 0.
struct Budget {
  std::uint32_t samples = 0;
  double seconds = 0;
};

/// A point of a run at which its image is stored: after 1, 2, 4, … samples per pixel, and at its end.
struct Mark {
  std::uint32_t samples = 0;
  double seconds = 0;  ///< processor time on all threads for these samples
};

struct Run {
  std::vector<Mark> marks;
  std::uint64_t bad_samples = 0;
  double wall_seconds = 0;  ///< wall-clock time of the whole run
};
/// X Y Z of each pixel, row by row.
using Pixels = std::vector<float>;

/// The processor time of this process on all threads [s].
double processor_seconds();

struct RunResult {
  Run run;
  std::vector<Pixels> pictures;  ///< at the marks
};
/// Renders the render's job with a seed. `go_on` is called between steps; the result is empty if it returns false or the render
/// was stopped.
std::optional<RunResult> render_run(Render&, std::uint64_t seed, const Budget&, const std::function<bool()>& go_on);

/// Identifies a run: the indices of scene and variant, and its number.
struct RunKey {
  size_t scene = 0, variant = 0, run = 0;
  auto operator<=>(const RunKey&) const = default;
};
/// The seed of a run: no two runs of a comparison have the same random numbers.
std::uint64_t seed_of(std::uint64_t base, const RunKey&);

/// The contents of a run's file: a line that says what it is, a line of JSON, and the numbers of its images.
std::string run_file(const RunResult&);
/// The name of a run's file in the folder.
std::string run_file_name(const RunKey&);

/// Identifies the comparison that a folder of runs belongs to, so that another one does not continue with it.
struct ComparisonIdentity {
  struct Part {
    std::string scene, variant;
    Identity identity;
  };
  std::vector<Part> parts;  ///< one for each scene and variant
  std::uint64_t seed = 0;
  Budget budget;
};

class RunStore {
 public:
  /// Keeps runs in memory.
  RunStore() = default;
  /// Keeps runs in a folder, which is created if it does not exist. Throws Error if it holds the runs of another comparison or
  /// other files.
  RunStore(std::string folder, const ComparisonIdentity&);

  bool has(const RunKey&) const;
  const Run& run(const RunKey& key) const { return runs_.at(key); }
  Pixels picture(const RunKey&, size_t mark) const;
  void keep(const RunKey&, RunResult);
  size_t count() const { return runs_.size(); }

 private:
  std::string file(const RunKey&) const;
  void find(const RunKey&) const;
  std::string folder_;
  mutable std::map<RunKey, Run> runs_;
  std::map<RunKey, std::vector<Pixels>> pictures_;               // only without a folder
  mutable std::map<RunKey, std::uint64_t> data_begins_;          // offset in the file
  mutable std::map<RunKey, std::vector<std::uint64_t>> hashes_;  // of the images
};

}  // namespace etendue::comparing
