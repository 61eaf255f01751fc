#pragma once
// A trial of unbiased algorithms on a scene: how large is the error of each at equal cost?
//
// The picture is divided into tiles. In each tile the same few pixels are chosen for all algorithms, and each algorithm traces
// one path through every chosen pixel, in four batches with independent random numbers. b_k [Y] is the mean light of a tile in
// batch k: the mean of its paths' own light, plus the splats that fell onto the tile (transport/path_sink.h). A batch is a
// picture of large pixels, with the same share of light paths for each, so light that is splatted counts as in a whole render.
// With m paths in each tile and batch,
//     v = m/3 sum_k (b_k - b)^2,   b the mean of the b_k,
// estimates the variance of one sample without bias: all batches look at the same pixels, so that what the picture shows within
// a tile is no variance. Errors count relative to r, the mean light in the tiles around, of that algorithm for which it is the
// median: a tile's own samples would not do, as a bright one among them would make its own error small. The relative mean
// squared error of one sample per pixel is then
//     V = mean over the tiles of v / (r^2 + e),   e = 0.01 (mean of r)^2     (docs/compare.md),
// and that after a given cost is in proportion to V C, with C the cost of a sample.
//
// A few bright samples must not decide, and must not be forgotten: where light is found seldom, they are most of the error. The
// tiles are divided at random into eight groups. The mean over all groups follows the brightest sample. Their median (the
// median of means) forgets it, and prefers the algorithms that find light so seldom that the trial has not seen it: on
// door_ajar it prefers path tracing five times. Between the two is the mean of the roots, V = (mean over the groups g of sqrt
// V_g)^2, the power mean of exponent 1/2: if one group has all the error, it counts an eighth of what it does in the mean.
//
// What a path tracer finds seldom, its own trial has most often not found at all, so that its error looks small. A
// bidirectional one that takes part finds such light by its other strategies, and knows how seldom path tracing would
// (transport/bidirectional_subpaths.h, PathTracingExcess): with X the mean of its records relative to r^2 + e,
//     V' = V of the bidirectional one + X
// estimates the error of path tracing, and that error is taken to be at least V'. A guided path tracer has learned from the
// same few paths, and is taken to be as much better where nothing was seen as where something was: its error is multiplied as
// that of the path tracer without a guide.
//
// Without a bidirectional one among them there are the means: light of relative mean m that none of n paths has found has a
// probability q of about 1/n or less, and its variance is m^2 / q. So an algorithm whose mean is less than another's by m, by
// more than three standard errors, has at least V = n m^2.
//
// The cost is counted, never measured by a clock, so that the choice is the same everywhere. A path takes pairs of primary
// samples wherever it samples a direction, a point of a luminaire or of the lens, and to each belongs a ray and the evaluation
// of a surface. Where two subpaths are connected no numbers are taken, but every vertex of one is joined with every vertex of
// the other. So C = pairs + connections, in units of a ray with its surface.

#include <array>
#include <vector>

#include "etendue/guiding/guide.h"
#include "etendue/render/process.h"

namespace etendue {

class LearnsFromPaths;

class AlgorithmTrial {
 public:
  static constexpr int batches = 4;

  /// For the sampled pixels of the context's image. `paths`: how many each algorithm may trace, approximately.
  AlgorithmTrial(const RenderContext&, std::uint64_t seed, double paths);

  /// What was measured of an algorithm.
  struct Measured {
    std::vector<std::array<double, batches>> tiles;  ///< b_k [Y]
    double cost = 0;                                 ///< C
    std::vector<double> excess;  ///< the mean of PathTracingExcess in each tile; empty: the algorithm gives no such records
    bool from_camera = false;    ///< its paths begin at the camera alone
    bool guided = false;         ///< its directions are chosen by a guide
  };
  /// `number`: of the algorithm, so that each has random numbers of its own. A process with a guide learns after each batch;
  /// `lessons` counts these. After an abort the result is not meaningful.
  Measured measure(Schedule&, RenderProcess&, std::uint32_t number, std::uint32_t& lessons) const;

  /// V of each algorithm. Algorithms that found nothing have V = 0.
  std::vector<double> errors(const std::vector<Measured>&) const;

 private:
  struct Part;
  struct Groups;
  std::vector<double> seen(const std::vector<Measured>&) const;
  std::vector<double> with_missed_light(const std::vector<double>& errors, const std::vector<double>& means) const;
  PixelArea tile_area(int tile) const;
  int tile_of(const Point2& film) const;
  void trace(const RenderProcess&, std::uint64_t seed, int tile, bool records, const std::atomic<bool>* abort, Part&,
             Arena&) const;

  const RenderContext context_;
  const std::uint64_t seed_;
  const PixelArea area_;
  int side_ = 1, columns_ = 1, rows_ = 1;
  int paths_ = 1;  ///< m
};

}  // namespace etendue
