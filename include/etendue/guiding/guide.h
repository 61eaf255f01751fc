#pragma once
// Guide: what has been learned of where light comes from, at every place of a scene.
//
// Where a path goes on, a direction is chosen by the guide with probability a and by the scattering itself otherwise:
//     p(w) = a p_guide(w) + (1 - a) p_scatter(w).
// A binary tree divides space; each of its regions has lobes that point at places light comes from (lobe_mixture.h), and a.
// Surfaces near one another that face different ways see different halves of the world, so there are seven such trees: one for
// each axis that a surface may face along, either way, and one for points in media.
//
// Lobes and a are fitted together, by weighted expectation maximization (Dempster, Laird & Rubin 1977; of such lobes: Ruppert,
// Herholz & Lensch 2020, section 4), so that the Kullback-Leibler divergence of p from f |cos| L_i falls: scattering is one
// more component, with the weight 1 - a and a shape of its own at each sample. Lobes learn only what scattering does not
// explain: of an evenly lit room nothing, and of a bright spot in it the spot. A sample counts as X = f |cos| L_i / p in
// proportion.
//
// Samples come in batches, and a batch is as good as it is even: it counts as (sum X)^2 / sum X^2 effective samples (Kish
// 1965). What is known from batches before counts as those it was made of (maximum a posteriori: the density before, as so many
// samples, beside the new ones). So a first batch of which two samples found light says little, and is soon outvoted. A region
// that has gathered enough effective samples is divided; both halves begin with its lobes, which are right for both, as they
// point at places.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "etendue/guiding/lobe_mixture.h"

namespace etendue {

/// What a path found where it went on in a direction.
struct GuideSample {
  Point3 position;
  Vector3 direction;
  std::uint32_t region = 0;  ///< Guide::region_of
  float nearness = 0;        ///< 1 / the distance of the place that light came from [1/m]; 0: infinitely far
  float found = 0;           ///< X: the light that came back from there by way of this direction, over its density
  float scatter = 0;         ///< p_scatter [1/sr]
  bool specular = false;     ///< a lobe that only scattering itself can choose
};

struct GuideSettings {
  float region_samples = 1000;  ///< effective samples with which a region is divided
  bool learn_share = true;
  float share = 0.5f;           ///< a, at first or always
  size_t memory = 64ull << 20;  ///< [bytes]
};

class Guide {
 public:
  /// A place's densities.
  class Region {
   public:
    /// a; 0: nothing is known yet.
    float share() const { return share_; }
    const LobeMixture& lobes() const { return lobes_; }

   private:
    friend class Guide;
    LobeMixture lobes_;
    float share_ = 0;
    double known_ = 0;     // what lobes and share are made of, in effective samples
    double gathered_ = 0;  // effective samples since it was divided
    // Of X, of the last samples: a batch is weighed by more than itself, as a small one that has not the rare, large X among
    // it would count too much, and one that has too little.
    double seen_ = 0, found_ = 0, found_squared_ = 0;
    // Of the positions of samples since then, for the region's centre and where to divide it.
    double count_ = 0, sum_[3] = {0, 0, 0}, squares_[3] = {0, 0, 0};
  };

  explicit Guide(const GuideSettings&);

  /// `normal`: of a surface, on the side where the path came from; zero in media.
  std::uint32_t region_of(const Point3& position, const Normal3& normal) const;
  const Region& region(std::uint32_t i) const { return regions_[i]; }
  size_t regions() const { return regions_.size(); }
  const Region& at(const Point3& position, const Normal3& normal) const { return regions_[region_of(position, normal)]; }

  /// Learns from samples that are of one region, in their order. Different regions may learn at once.
  void learn(std::uint32_t region, std::span<const GuideSample* const>);
  /// Divides regions that know enough. Between `learn` and this, what is asked of a guide changes.
  void divide();

  /// Of all that grows.
  size_t bytes() const { return regions_.size() * sizeof(Region) + cells_.size() * sizeof(Cell); }
  std::vector<std::byte> save() const;
  /// Error: the bytes are damaged; nothing has changed.
  void load(std::span<const std::byte>);

 private:
  /// Of a tree over space: divided in two across an axis, or a region.
  struct Cell {
    std::uint32_t child = 0;  // the first of two, below the plane; the second follows; 0: none
    std::uint32_t what = 0;   // the axis, or the region
    float plane = 0;
  };
  class Fit;

  void divide(std::uint32_t cell);
  static std::uint64_t check(std::span<const std::byte>);

  static constexpr std::uint32_t trees = 7;
  GuideSettings settings_;
  std::vector<Cell> cells_;
  std::vector<Region> regions_;
};

}  // namespace etendue
