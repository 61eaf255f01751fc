#pragma once
// What the truth is thought to be: a picture from elsewhere, renders made for it, or the mean that the variants agree on.

#include <optional>
#include <string>
#include <vector>

#include "pixel_errors.h"
#include "runs.h"
#include "variants.h"

namespace etendue::comparing {

/// The mean of several sources, each the mean of independent runs, with weights that add up to 1. A source is as good as the
/// inverse of its relative variance over the whole picture; weights of single pixels would prefer those that came out dark.
class AgreedMean {
 public:
  /// `sums` must live as long; null: that one takes no part.
  explicit AgreedMean(std::vector<const RunSums*> sums);

  size_t members() const;
  bool has(size_t source) const { return sums_[source] != nullptr; }
  double weight(size_t source) const { return weights_[source]; }
  Reference whole() const { return mean({}, {}, {}); }
  /// Without a source: what a bias of that one shows against. Only when there is another.
  Reference without(size_t source) const { return mean(source, {}, {}); }
  /// Without one run of a source: what the error of that run is told from, as they have nothing in common then.
  Reference without_run(size_t source, std::span<const float> run) const { return mean({}, source, run); }

 private:
  Reference mean(std::optional<size_t> left_out, std::optional<size_t> of_run, std::span<const float> run) const;
  std::vector<const RunSums*> sums_;
  std::vector<double> weights_;
};

/// A picture from a file: whatever reads as an image of linear values, or a checkpoint. Throws Error, said to come from
/// --reference, when it cannot be one of so many pixels.
Reference read_reference(const std::string& path, int width, int height);

}  // namespace etendue::comparing
