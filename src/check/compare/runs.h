#pragma once
// Runs: whole renders with random numbers of their own, looked at on the way. They are kept in a folder, so that a comparison
// that was interrupted goes on, and one that is done can be judged anew.

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "etendue/render/render.h"
#include "render/checkpoint.h"

namespace etendue::comparing {

/// When a run ends: after so many samples of each pixel, or when so much processor time is spent. One of them is not 0.
struct Budget {
  std::uint32_t samples = 0;
  double seconds = 0;
};

/// A moment at which a run was looked at: after 1, 2, 4, … samples of each pixel, and at its end.
struct Mark {
  std::uint32_t samples = 0;
  double seconds = 0;  ///< of the processor, on all threads, spent on those samples
};

struct Run {
  std::vector<Mark> marks;
  std::uint64_t bad_samples = 0;
  double wall_seconds = 0;  ///< all that the run took
};
/// X Y Z of each pixel, row by row.
using Pixels = std::vector<float>;

/// Processor time of this process on all its threads [s].
double processor_seconds();

struct RunResult {
  Run run;
  std::vector<Pixels> pictures;  ///< at the marks
};
/// Renders what is ready, with a seed. `go_on` is asked between steps; empty when it says no, or the render was stopped.
std::optional<RunResult> render_run(Render&, std::uint64_t seed, const Budget&, const std::function<bool()>& go_on);

/// Which run: the places of scene and variant, and its number.
struct RunKey {
  size_t scene = 0, variant = 0, run = 0;
  auto operator<=>(const RunKey&) const = default;
};
/// No two runs of a comparison have the same random numbers.
std::uint64_t seed_of(std::uint64_t base, const RunKey&);

/// What a folder of runs belongs to; another comparison must not go on with it.
struct ComparisonIdentity {
  struct Part {
    std::string scene, variant;
    Identity identity;
  };
  std::vector<Part> parts;  ///< of each scene each variant
  std::uint64_t seed = 0;
  Budget budget;
};

class RunStore {
 public:
  /// Keeps runs in memory.
  RunStore() = default;
  /// Keeps them in a folder, which is made when it is not there. Throws Error when it holds the runs of another comparison, or
  /// something that is none.
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
  std::map<RunKey, std::vector<Pixels>> pictures_;               // without a folder
  mutable std::map<RunKey, std::uint64_t> data_begins_;          // in the file
  mutable std::map<RunKey, std::vector<std::uint64_t>> hashes_;  // of the pictures
};

}  // namespace etendue::comparing
