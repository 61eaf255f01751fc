#pragma once
// SurfaceFilm: collects the surfaces that the samples of a picture meet first, beside the Film that collects their light. Its
// sums do not depend on the order of steps either: weights, nearest samples and shares are integers, and the sums of numbers
// are exact sums of whole steps, or of the blocks of a crop's step (docs/decisions/023-exact-sums.md).

#include <mutex>

#include "etendue/core/image.h"
#include "exact_sums.h"
#include "surface_tile.h"

namespace etendue {

/// An immutable copy of a SurfaceFilm's sums, which any thread may use.
class SurfaceSnapshot {
 public:
  /// Adds the channels of all layers but those of mattes to a picture of the same pixels.
  void add_channels(Image&) const;

  const PictureFormat& format() const { return *format_; }
  /// The names of the objects that are seen.
  const std::map<std::uint64_t, SurfaceNames>& names() const { return sums_->names; }
  /// What the pixels show, row by row; empty before the first step, or if no mattes are wanted.
  std::span<const SurfaceShares> shares() const { return sums_->shares; }
  /// The weight of all samples of a pixel, of which the shares are parts.
  std::int64_t whole(size_t pixel) const { return sums_->weights[weight_count * pixel + weight_of_all]; }

 private:
  friend class SurfaceFilm;
  struct Sums {
    ExactSums values;  ///< of each pixel in order, for each stored number
    std::vector<std::int64_t> weights;
    std::vector<NearestSample> nearest;
    std::vector<SurfaceShares> shares;
    std::map<std::uint64_t, SurfaceNames> names;
    std::uint32_t steps = 0;

    void make_room(const PictureFormat&);
    void add(const Sums&);
  };
  double value(const SurfaceChannel&, size_t pixel) const;

  std::shared_ptr<const PictureFormat> format_;
  std::shared_ptr<const Sums> sums_;
};

/// All functions may be called from any thread.
class SurfaceFilm {
 public:
  /// From a prepared ImageBuffer, which need not outlive the film.
  explicit SurfaceFilm(const ImageBuffer&);

  /// Whether the picture has any layers of surfaces.
  bool wanted() const;
  /// Adopts an ImageBuffer that was prepared again. The sums are kept if they are sums for it, too; otherwise the film is
  /// emptied. Returns whether they were kept.
  bool follow(const ImageBuffer&);
  void clear();

  /// Takes the tiles of the current step, in their order.
  void take(std::vector<SurfaceTile>);
  /// Adds the current step to the sums. Throws Error after too many steps.
  void end_step();
  /// Discards the current step.
  void drop_step();

  /// The sums at the end of the last step; null if the picture has no layers of surfaces.
  std::shared_ptr<const SurfaceSnapshot> snapshot() const;

  /// As the functions of Film; empty if the picture has no layers of surfaces.
  std::vector<std::byte> save_state() const;
  void load_state(std::span<const std::byte>);
  void add_state(std::span<const std::byte>);

 private:
  using Sums = SurfaceSnapshot::Sums;
  bool wants_any() const { return format_->surfaces.any(); }
  void require_fitting(const SurfaceTile&) const;
  Sums& own_sums();
  Sums read_state(std::span<const std::byte>) const;

  mutable std::mutex mutex_;
  std::shared_ptr<const PictureFormat> format_;
  std::shared_ptr<Sums> sums_;  // may be shared with snapshots: own_sums makes a copy then
  std::vector<SurfaceTile> step_;
};

}  // namespace etendue
