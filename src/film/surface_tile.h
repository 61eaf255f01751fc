#pragma once
// SurfaceTile: the surfaces that the samples of a part of a picture meet first, collected in one thread, for a SurfaceFilm.
//
// A number v of the surface is averaged over the samples k with the film's filter f: sum f_k v_k / sum f_k. Both sums are over
// the same samples, so what is the same everywhere in reach of the filter is exact, however few samples there are. (Light is
// divided by the expected sum of the weights instead, decision 013: its mean must be right for sums of estimates, too.) Numbers
// that mean nothing where no surface is met are averaged over those samples that meet one, by the positive part of the filter:
// with negative weights a mean over some of the samples could lie far outside of their values.
//
// Weights are integers, multiples of 2^-30 of the filter's largest weight: their sums are exact, in any order.

#include <map>
#include <memory>
#include <optional>

#include "etendue/core/vector.h"
#include "picture_format.h"

namespace etendue {

/// What a camera ray meets first.
struct FirstSurface {
  std::uint64_t key = 0;  ///< of the object's names (SurfaceTile::name); 0: nothing was met, and the rest means nothing
  Vector3 albedo;
  Vector3 normal, geometric_normal;
  DoublePoint3 position;
  double depth = 0;
  Point2 uv;
  float roughness = 0;
  std::optional<Vector2> motion_previous, motion_next;  ///< nothing: the point was not seen then
  std::int32_t object = 0, material = 0;                ///< 1 + an index
  std::uint32_t primitive = 0;                          ///< index in the object
};

/// The names of an object by each MatteKind; empty: it has none of this kind.
using SurfaceNames = std::array<std::string, matte_kinds>;

/// How much of a pixel shows an object.
struct SurfaceShare {
  std::uint64_t key = 0;
  std::int64_t weight = 0;
};
using SurfaceShares = std::vector<SurfaceShare>;  // by increasing key

/// Adds the weights of others to a pixel's.
void add_share(SurfaceShares&, const SurfaceShare&);

/// The sample nearest to the centre of its pixel, of several equally near ones the one with the smallest index.
struct NearestSample {
  std::uint32_t distance = ~0u;  ///< the bits of the squared distance [pixels^2] as a float: they are ordered as the numbers
  std::uint32_t sample = ~0u;
  std::int32_t object = 0, material = 0;
  std::uint32_t primitive = 0;  ///< 1 + its index; 0: no surface is met
  void add(const NearestSample& other) {
    if (std::pair(other.distance, other.sample) < std::pair(distance, sample)) *this = other;
  }
};

/// The sums of weights of a pixel.
enum WeightOf : std::uint8_t {
  weight_of_all,       ///< all samples
  weight_of_met,       ///< those that meet a surface
  weight_of_positive,  ///< those of them whose weight is positive
  weight_count
};

class SurfaceTile {
 public:
  /// For samples of the pixels in an area; see ImageTile::begin.
  void begin(const ImageBuffer&, const PixelArea&, std::uint32_t block);
  /// Adds what a sample at a film point of a pixel meets first.
  void add(Point2 film, int px, int py, std::uint32_t sample, const FirstSurface&);
  /// The names that belong to a key.
  void name(std::uint64_t key, SurfaceNames names) { names_[key] = std::move(names); }

  void pack(std::vector<std::byte>&) const;
  static SurfaceTile unpack(std::span<const std::byte>&);

 private:
  friend class SurfaceFilm;
  void add_weighted(size_t pixel, std::int64_t weight, const FirstSurface&);

  std::shared_ptr<const PictureFormat> format_;  // null after `unpack`
  std::uint32_t block_ = 0;
  PixelArea sampled_, area_, extent_;   // as in ImageTile
  std::vector<double> values_;          // three of each stored number, per pixel of the extent
  std::vector<std::int64_t> weights_;   // WeightOf, per pixel of the extent
  std::vector<NearestSample> nearest_;  // per pixel of the area
  std::vector<SurfaceShares> shares_;   // per pixel of the extent
  std::map<std::uint64_t, SurfaceNames> names_;
};

}  // namespace etendue
