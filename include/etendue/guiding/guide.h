#pragma once
// Guide: what has been learned of where light comes from, at every place of a scene.
//
// A binary tree divides space; each of its regions has a density of directions (direction_tree.h), which follows what paths
// have found there (the SD-tree of Müller, Gross & Novák 2017, "Practical path guiding for efficient light-transport
// simulation"). Surfaces near one another that face different ways see different halves of the world, so there are seven such
// trees: one for each axis that a surface may face along, either way, and one for points in media.
//
// Where a path goes on, a direction is chosen by the guide with probability a and by the scattering itself otherwise:
//     p(w) = a p_guide(w) + (1 - a) p_scatter(w).
// Each region learns its own a, by stochastic gradient descent (Adam: Kingma & Ba 2015) on the Kullback-Leibler divergence of p
// from f |cos| L_i (Müller 2019, "Path guiding in production", section 10.5.2): with a = 1 / (1 + exp(-t)) and
// X = f |cos| L_i / p for a sample of p,
//     dD/dt = -E[ X (p_guide - p_scatter) a (1 - a) / p ].
//
// Samples come in rounds. `learn` adds to sums, one region at a time, so regions may learn at once; `refine` ends a round: it
// makes densities from the sums, divides regions and begins new sums. In between all that is asked stays the same, so a density
// never depends on the path that asks for it. Where light is rare, thousands of samples may tell no more than a few do: what
// counts are effective samples, (sum X)^2 / sum X^2 (Kish 1965). A region is not made anew from fewer of them than it was made
// of (it goes on adding), and neither it nor its directions are divided more finely than they tell.

#include "etendue/guiding/direction_tree.h"

namespace etendue {

/// What a path found where it went on in a direction.
struct GuideSample {
  Point3 position;
  Normal3 normal;  ///< of the surface, on the side where the path came from; zero in media
  Vector3 direction;
  float found = 0;    ///< X: the light that came back from there by way of this direction, over its density
  float density = 0;  ///< p [1/sr], of the mixture; of a specular lobe the probability of having chosen it
  float guide = 0;    ///< p_guide [1/sr]; negative: the guide was not asked
  float scatter = 0;  ///< p_scatter [1/sr]; of a specular lobe a probability
  bool specular = false;
};

struct GuideSettings {
  float fraction = 0.01f;  ///< of a region's light in one cell of directions, at most
  float region_samples =
      64;                   ///< effective samples with which a region is divided, in the first round; in round k, 2^(k/4) times
  double cell_samples = 4;  ///< a cell of directions with fewer is not divided
  float learning_rate = 0.01f;  ///< of the mixture; 0: it stays
  float share = 0.5f;           ///< a, at first
  size_t memory = 64ull << 20;  ///< for nodes [bytes]
};

class Guide {
 public:
  /// A place's densities.
  class Region {
   public:
    /// a; 0: nothing is known yet.
    float share() const { return share_; }
    const DirectionTree& directions() const { return directions_; }

   private:
    friend class Guide;
    DirectionTree directions_;
    float share_ = 0;
    double sum_ = 0, squares_ = 0;  // of X, in this round
    double known_from_ = 0;         // what its density is made of, in effective samples
    // Of Adam: t, the moments of its gradient, and the steps taken.
    double logit_ = 0, first_ = 0, second_ = 0;
    std::uint64_t steps_ = 0;
  };

  /// Of what lies within so far of a point along each axis (Scene::centre, Scene::radius); places outside count as the nearest
  /// inside.
  Guide(const Point3& centre, float radius, const GuideSettings&);

  const Region& at(const Point3& position, const Normal3& normal) const { return regions_[region_of(position, normal).region]; }

  /// The region that a sample is for: chosen by chance near its place, as far away as the region there is large, so that no
  /// border shows (Müller 2019, section 10.5.1).
  std::uint32_t region_for(const GuideSample&) const;
  size_t regions() const { return regions_.size(); }
  /// Adds samples that are for one region, in their order. Different regions may learn at once.
  void learn(std::uint32_t region, std::span<const GuideSample* const>, GuideTarget);
  void refine(GuideTarget);

  /// Of all that grows.
  size_t bytes() const;
  std::vector<std::byte> save() const;
  /// Error: the bytes are damaged, or of a guide with other bounds; nothing has changed.
  void load(std::span<const std::byte>);

 private:
  /// Of a tree over space: divided in two across the axis depth % 3, or a region.
  struct Cell {
    std::uint32_t child = 0;  // the first of two, the second follows; 0: none
    std::uint32_t region = 0;
  };
  struct Place {
    std::uint32_t cell, region;
    Vector3 size;  // of the region
  };

  Place region_of(const Point3&, const Normal3&) const;
  void adapt(Region&, const GuideSample&) const;
  /// How many samples of equal X would tell as much as those of this round: (sum X)^2 / sum X^2 (Kish 1965).
  static double effective(const Region&);
  /// Into how many a region is to be divided.
  double parts(const Region&) const;
  void divide(std::uint32_t cell, int depth, double parts, size_t most_regions);
  float known_share(const Region&) const;
  static std::uint64_t check(std::span<const std::byte>);

  static constexpr std::uint32_t trees = 7;
  static constexpr int deepest = 60;
  GuideSettings settings_;
  Point3 low_;
  float side_;  // of the cube
  std::vector<Cell> cells_;
  std::vector<Region> regions_;
  std::uint32_t round_ = 0;
};

}  // namespace etendue
