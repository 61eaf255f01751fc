#pragma once
// Film: sums of samples, as CIE XYZ in double precision, that do not depend on the order in which they are added.
//
// A render goes on in steps (passes over the picture). Within a step tiles are added as they come, which must be in a fixed
// order; the sums of whole steps are added exactly (src/film/exact_sums.h). So whoever renders which steps, and in whatever
// order states are added, the film is the same to the bit: docs/decisions/023-exact-sums.md.

#include <memory>
#include <span>
#include <vector>

#include "etendue/core/image.h"
#include "etendue/film/image_tile.h"

namespace etendue {

/// How the samples of an algorithm depend on one another, from which the error of their mean follows.
enum class Estimator : std::uint8_t {
  independent,  ///< Every sample is independent of the others; its splats, wherever they fall, are one outcome. The error comes
                ///< from the spread of samples. (Low-discrepancy samples spread better: it is an upper bound then.)
  correlated,   ///< Samples of a step depend on each other (mutated paths, photons shared by pixels). The error comes from the
                ///< spread of whole steps, which must depend little on one another; unknown before 8 of them.
};

/// What a film held at a moment. Independent of it, and of the description: for any thread.
class FilmSnapshot {
 public:
  /// The picture as X Y Z, with the wanted layers as further channels.
  Image develop() const;
  /// Mean over pixels of the standard error of Y, relative to (Y + 1e-3 of the picture's mean): the measure for stopping at an
  /// error. Infinite where too few samples are there to tell.
  double relative_error() const;
  /// Samples taken so far, bad ones included.
  std::uint64_t samples() const;
  std::uint64_t bad_samples() const;

 private:
  friend class Film;
  struct Values;
  std::shared_ptr<const Values> values_;
};

/// Its functions may be called from any thread: one lock guards all of them.
class Film {
 public:
  /// Of a prepared description, which may be gone or edited before the film is.
  explicit Film(const ImageBuffer&, Estimator = Estimator::independent);
  ~Film();
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  Estimator estimator() const;
  /// Takes over a description that was prepared again, or another kind of algorithm. Keeps what was collected where that is
  /// still valid, when only layers that need nothing further are wanted or not; else the film is empty then. Whether it was
  /// kept.
  bool follow(const ImageBuffer&, Estimator);
  /// Empties the film.
  void clear();

  /// Adds a tile to the step at hand. Throws Error, with the pixel, when a sum is beyond 1e288: the step should be dropped
  /// then.
  void merge(const ImageTile&);
  /// Adds the step at hand to the sums. Throws Error when there were too many (2^24) of them.
  void end_step();
  /// Forgets the step at hand: all is as it was at the end of the last one.
  void drop_step();

  /// What was collected, with the step at hand: each pixel is divided by its own number of samples.
  FilmSnapshot snapshot() const;
  Image develop() const { return snapshot().develop(); }
  double relative_error() const { return snapshot().relative_error(); }
  std::uint64_t samples() const;
  std::uint64_t bad_samples() const;
  /// The first bad samples by row, pixel and sample, at most 32.
  std::vector<BadSample> first_bad_samples() const;

  /// From now on keeps the n samples that brought most light. Not part of the state.
  void keep_largest(size_t n);
  size_t largest_kept() const;
  /// Those, largest first.
  std::vector<LargeSample> largest_samples() const;

  /// All state at the end of the last step: the same samples give the same bytes, and the same bytes restore the same film.
  /// Loading forgets the step at hand, and throws Error when the bytes do not fit.
  std::vector<std::byte> save_state() const;
  void load_state(std::span<const std::byte>);
  /// Adds what another film of the same picture has collected, of other samples, in any order.
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
