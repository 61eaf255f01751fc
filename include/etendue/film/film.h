#pragma once
// Film: accumulates samples, as sums of CIE XYZ in double precision that do not depend on the order of summation.
//
// A render proceeds in steps (passes over the image). Within a step, tiles must be merged in a fixed order; the sums of whole
// steps are added exactly (src/film/exact_sums.h). So the film is the same to the bit, whatever process renders which steps,
// and in whatever order states are added: docs/decisions/023-exact-sums.md.

#include <memory>
#include <span>
#include <vector>

#include "etendue/core/image.h"
#include "etendue/film/image_tile.h"

namespace etendue {

/// Whether the samples of an algorithm are correlated, which determines how the standard error is estimated.
enum class Estimator : std::uint8_t {
  independent,  ///< The samples are independent; all splats of a sample together are one random variable. The error is computed
                ///< from the variance of samples. (For low-discrepancy samples it is an upper bound.)
  correlated,   ///< The samples of a step depend on each other (mutated paths, photons shared by pixels). The error is computed
                ///< from the variance of whole steps, which must be almost independent; unknown before 8 steps.
};

/// An immutable copy of a film's sums, independent of the film and of the description. May be used by any thread.
class FilmSnapshot {
 public:
  /// The image as X Y Z, with the requested layers, and the bands of a spectral film, as further channels.
  Image develop() const;
  /// The mean over pixels of the standard error of Y, relative to Y + 1e-3 of the image's mean: the criterion for stopping at a
  /// given error. Infinite if there are too few samples for an estimate.
  double relative_error() const;
  /// The number of samples so far, including bad ones.
  std::uint64_t samples() const;
  std::uint64_t bad_samples() const;

 private:
  friend class Film;
  struct Values;
  std::shared_ptr<const Values> values_;
};

/// All functions may be called from any thread; they are protected by a lock.
class Film {
 public:
  /// From a prepared ImageBuffer, which need not outlive the film.
  explicit Film(const ImageBuffer&, Estimator = Estimator::independent);
  ~Film();
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  Estimator estimator() const;
  /// Adopts an ImageBuffer that was prepared again, or another kind of algorithm. The sums are kept if they are still valid,
  /// that is if the change concerns only layers that need no further sums; otherwise the film is emptied. Returns whether the
  /// sums were kept.
  bool follow(const ImageBuffer&, Estimator);
  /// Empties the film.
  void clear();

  /// Adds a tile to the current step. Throws Error, with the pixel, if a sum exceeds 1e288: the step should then be dropped.
  void merge(const ImageTile&);
  /// Fills a tile from what ImageTile::pack of another process wrote, and removes it from the front of the bytes. Throws Error
  /// if the bytes are no tile of this picture.
  void unpack(std::span<const std::byte>&, ImageTile&) const;
  /// Ends the current step: adds it to the sums. Throws Error after too many (2^24) steps.
  void end_step();
  /// Discards the current step: the film is as at the end of the last step.
  void drop_step();

  /// A copy of the sums, including the current step: each pixel is divided by its own number of samples.
  FilmSnapshot snapshot() const;
  Image develop() const { return snapshot().develop(); }
  double relative_error() const { return snapshot().relative_error(); }
  std::uint64_t samples() const;
  std::uint64_t bad_samples() const;
  /// The first bad samples by row, pixel and sample, at most 32.
  std::vector<BadSample> first_bad_samples() const;

  /// From now on keeps the n samples of largest luminance. They are not part of the saved state.
  void keep_largest(size_t count);
  size_t largest_kept() const;
  /// The samples that were kept, in decreasing order.
  std::vector<LargeSample> largest_samples() const;

  /// The state at the end of the last step: the same samples give the same bytes, and the same bytes restore the same film.
  /// Loading discards the current step, and throws Error if the bytes are not the state of such a film.
  std::vector<std::byte> save_state() const;
  void load_state(std::span<const std::byte>);
  /// Adds the saved state of another film of the same image with other samples. The order of several calls does not matter.
  void add_state(std::span<const std::byte>);

 private:
  friend class FilmSnapshot;
  struct Totals;
  struct Step;
  void add_tile(const ImageTile&);
  void add_splats(const ImageTile&);
  FilmSnapshot::Values values() const;
  Totals read_state(std::span<const std::byte>) const;
  struct Members;
  std::unique_ptr<Members> members_;
};

}  // namespace etendue
