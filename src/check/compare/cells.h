#pragma once
// Cells: single runs of a comparison, rendered apart from each other, such as by several machines. A process that has the whole
// comparison (Laboratory) says which runs are missing, and finds them in its folder when they were stored there.

#include <memory>
#include <optional>
#include <string>

#include "laboratory.h"

namespace etendue::comparing {

/// How the runs of a comparison are rendered on one of its scenes.
struct CellRequest {
  ComparedScene scene;  ///< its reference is not needed
  std::vector<Variant> variants;
  Budget budget;
  double reference_seconds = 0;
  int threads = 0;  ///< 0: all cores
};

/// Renders a run of a variant or, if the key's variant is the number of variants, one for the reference, of which only the
/// final image is kept. `keep` is called with the result while the watcher still watches, so that an interruption finds the run
/// stored. False: the watcher ended the run.
bool render_cell(const CellRequest&, SceneSubjects&, std::uint64_t seed, const RunKey&, ComparisonWatcher&,
                 const std::function<void(RunResult)>& keep);

class CellRenderer {
 public:
  /// Loads and prepares the scene. Throws Errors.
  explicit CellRenderer(CellRequest);
  /// The contents of the run's file (RunStore). `seed` is that of the comparison. Empty: the watcher ended it.
  std::optional<std::string> render(std::uint64_t seed, const RunKey&, ComparisonWatcher&);

 private:
  CellRequest request_;
  std::unique_ptr<SceneSubjects> subjects_;
};

/// The number of runs that make a rendered reference; they share its CPU time.
inline constexpr size_t reference_runs = 8;
/// The variant that renders the reference: the first one that is unbiased and finds all light. Empty: there is none.
std::optional<size_t> reference_variant(const SceneSubjects&);

}  // namespace etendue::comparing
