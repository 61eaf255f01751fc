#pragma once
// The reference of a comparison: an image file, renders made for it, or the weighted mean of the variants.

#include <optional>
#include <string>
#include <vector>

#include "pixel_errors.h"
#include "runs.h"
#include "variants.h"

namespace etendue::comparing {

/// The mean of several sources, each the mean of independent runs, with weights that add up to 1. A source's weight is
/// proportional to the inverse of its relative variance over the whole image; weights per pixel would prefer sources that are
/// too dark there.
class AgreedMean {
 public:
  /// `sums` must outlive this object; null: the source is no member.
  explicit AgreedMean(std::vector<const RunSums*> sums);

  size_t members() const;
  bool has(size_t source) const { return sums_[source] != nullptr; }
  double weight(size_t source) const { return weights_[source]; }
  Reference whole() const { return mean({}, {}, {}); }
  /// The mean without a source, to measure the bias of this source against. Requires another member.
  Reference without(size_t source) const { return mean(source, {}, {}); }
  /// The mean without one run of a source, to measure the error of that run against: the two are independent.
  Reference without_run(size_t source, std::span<const float> run) const { return mean({}, source, run); }

 private:
  Reference mean(std::optional<size_t> left_out, std::optional<size_t> of_run, std::span<const float> run) const;
  std::vector<const RunSums*> sums_;
  std::vector<double> weights_;
};

/// A reference from a picture of linear values. `what` names it in errors. Throws Error if it has another size, or if values
/// are not finite.
Reference reference_from(const Image&, const std::string& what, int width, int height);
/// Reads a reference: an image file of linear values, or a checkpoint. Throws Error, with --reference as location, if it cannot
/// be read or has another size.
Reference read_reference(const std::string& path, int width, int height);

}  // namespace etendue::comparing
