#pragma once
// Guide: a learned distribution of the directions that light comes from, at every point of a scene (path guiding).
//
// Where a path continues, its direction is sampled by the guide with probability a and by the scattering itself otherwise:
//     p(w) = a p_guide(w) + (1 - a) p_scatter(w).
// A binary tree divides space; each of its regions has a mixture of lobes that point at sources of light (lobe_mixture.h), and
// its own a. Nearby surfaces with different normals see different hemispheres, so there are seven such trees: one for each
// signed axis that a normal may be closest to, and one for points in media.
//
// Lobes and a are fitted together, by weighted expectation maximization (Dempster, Laird & Rubin 1977; for such lobes: Ruppert,
// Herholz & Lensch 2020, section 4), so that the Kullback-Leibler divergence of p from f |cos| L_i decreases: scattering is one
// more component, with the weight 1 - a and a given pdf at each sample. So the lobes learn only what scattering does not
// explain: nothing in an evenly lit room, and a bright spot in it if there is one. A sample has a weight in proportion to
//     X = f |cos| L_i / p.
//
// Samples come in batches. A batch with uneven weights has less information: it counts as (sum X)^2 / sum X^2 effective samples
// (Kish 1965). The result of earlier batches counts as the effective samples that it was fitted to (maximum a posteriori
// estimation, with the earlier distribution as the prior). So a first batch of which two samples found light has little weight,
// and is soon replaced. A region that has gathered enough effective samples is split; both halves start with its lobes, which
// are valid in both, as they point at positions.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "etendue/guiding/lobe_mixture.h"

namespace etendue {

/// The light that a path found in a direction that it sampled.
struct GuideSample {
  Point3 position;
  Vector3 direction;
  std::uint32_t region = 0;  ///< Guide::region_of
  float nearness = 0;        ///< 1 / the distance of the source of the light [1/m]; 0: infinitely far
  float found = 0;           ///< X = f |cos| L_i / p: the light from this direction that the vertex scattered along the path,
                             ///< over the pdf
  float scatter = 0;         ///< p_scatter [1/sr]
  bool specular = false;     ///< a lobe that the guide cannot sample
};

struct GuideSettings {
  float region_samples = 1000;  ///< effective samples at which a region is split
  bool learn_share = true;
  float share = 0.5f;           ///< a, initially or always
  size_t memory = 64ull << 20;  ///< [bytes]
};

class Guide {
 public:
  /// The learned distribution in one region of space.
  class Region {
   public:
    /// a; 0: nothing is learned yet.
    float share() const { return share_; }
    const LobeMixture& lobes() const { return lobes_; }

   private:
    friend class Guide;
    LobeMixture lobes_;
    float share_ = 0;
    double known_ = 0;     // effective samples that lobes and share were fitted to
    double gathered_ = 0;  // effective samples since the region was split
    // Moments of X over the latest samples: the number, sum X, sum X^2. A batch is weighted by these, and not by its own
    // moments alone: a small batch without the rare large values of X would get too much weight, and a batch with one too
    // little.
    double seen_ = 0, found_ = 0, found_squared_ = 0;
    // Moments of the positions of samples since the split, for the centre of the region and its next split.
    double count_ = 0, sum_[3] = {0, 0, 0}, squares_[3] = {0, 0, 0};
  };

  explicit Guide(const GuideSettings&);

  /// The region of a point. `normal`: of the surface, on the side from which the path came; zero in media.
  std::uint32_t region_of(const Point3& position, const Normal3& normal) const;
  const Region& region(std::uint32_t i) const { return regions_[i]; }
  size_t regions() const { return regions_.size(); }
  const Region& at(const Point3& position, const Normal3& normal) const { return regions_[region_of(position, normal)]; }

  /// A copy of a region, fitted to samples that all lie in it, in their order.
  Region fitted(std::uint32_t region, std::span<const GuideSample* const>) const;
  void replace(std::uint32_t region, const Region& by) { regions_[region] = by; }
  void learn(std::uint32_t region, std::span<const GuideSample* const> samples) { replace(region, fitted(region, samples)); }
  /// Splits the regions that have enough effective samples. `replace` and this function change the distributions of the guide.
  void divide();

  /// The memory of all members that grow.
  size_t bytes() const { return regions_.size() * sizeof(Region) + cells_.size() * sizeof(Cell); }
  std::vector<std::byte> save() const;
  /// Throws Error if the bytes are damaged, without changes to the guide.
  void load(std::span<const std::byte>);

 private:
  /// A node of a tree over space: an inner node, split at a plane across an axis, or a leaf with a region.
  struct Cell {
    std::uint32_t child = 0;  // the first of two children, below the plane; the second follows it; 0: a leaf
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
