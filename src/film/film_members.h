#pragma once
// The members of a Film.

#include <mutex>

#include "film_values.h"

namespace etendue {

/// The sums of the current step, or of its current block.
struct Film::Step {
  Lists lists;
  FilmCounts counts;
  std::vector<LargeSample> largest;
  bool begun = false;
  std::uint32_t block = 0;
};

struct Film::Members {
  mutable std::mutex mutex;
  std::shared_ptr<const PictureFormat> format;
  Estimator estimator = Estimator::independent;
  Totals totals;
  std::unique_ptr<Totals> before_step;  ///< the sums before the current step, if the step has several blocks
  Step step;
  std::vector<double> splatted;  ///< luminance of the current path's splats per pixel; zero between paths
  std::vector<LargeSample> largest;
  size_t largest_wanted = 0;

  /// The sums at the end of the last step.
  const Totals& ended() const { return before_step ? *before_step : totals; }
  void empty();
  std::vector<double>& list(List);
  void add_step();
  void note_batch(FilmSnapshot::Values&) const;
  [[noreturn]] void complain(std::span<const double> values, size_t stride, int x0, int y) const;
};

}  // namespace etendue
