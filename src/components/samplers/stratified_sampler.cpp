// StratifiedSampler: one sample in each cell of a grid.

#include "hashed_permutation.h"
#include "owen_scrambling.h"

namespace etendue {
namespace {

// The unit square of each pair of dimensions is divided into x by y cells, the interval of each single number into x y, and any
// aligned block of x y samples has one sample in each, at a place that is uniform in the cell (Cook, Porter & Carpenter 1984;
// Mitchell 1996, "Consequences of stratified sampling in graphics"). Which sample has which cell is a random permutation for
// each pair of dimensions ("padding"). Further blocks have other permutations and places.

class StratifiedSampler final : public Sampler {
  int x = 4;
  int y = 4;

 public:
  static void describe(Description<StratifiedSampler>& d) {
    d.summary(
         "One sample in each cell of a grid over the pixel, and over each pair of dimensions; best with as many samples as "
         "cells, or a multiple.",
         "Cook, Porter & Carpenter 1984, Distributed ray tracing; Mitchell 1996, Consequences of stratified sampling in "
         "graphics")
        .member<&StratifiedSampler::x>("x", "1", "cells of the grid along the first number of a pair", range(1, 4096),
                                       soft(1, 32))
        .member<&StratifiedSampler::y>("y", "1", "cells of the grid along the second number of a pair", range(1, 4096),
                                       soft(1, 32));
  }

  float number(SampleKey key, std::uint32_t dimension) const override {
    const Cell cell = cell_of(key, dimension);
    return in_cell(cell.index, std::uint32_t(x * y), std::uint32_t(cell.random));
  }

  Point2 pair(SampleKey key, std::uint32_t dimension) const override {
    const Cell cell = cell_of(key, dimension);
    const auto columns = std::uint32_t(x);
    return {in_cell(cell.index % columns, columns, std::uint32_t(cell.random)),
            in_cell(cell.index / columns, std::uint32_t(y), std::uint32_t(cell.random >> 32))};
  }

 private:
  struct Cell {
    std::uint32_t index;
    std::uint64_t random;  ///< for the place within the cell
  };
  Cell cell_of(SampleKey key, std::uint32_t dimension) const {
    const auto cells = std::uint32_t(x * y);
    const std::uint32_t block = key.sample / cells, i = key.sample % cells;
    const std::uint64_t h = mix_bits(hash(key, dimension) + block);
    return {permuted(i, cells, h), mix_bits(h ^ (std::uint64_t(i) + 1) * 0xd1342543de82ef95ull)};
  }
  static float in_cell(std::uint32_t cell, std::uint32_t cells, std::uint32_t random) {
    return std::min(float((double(cell) + double(random) * 0x1p-32) / double(cells)), one_minus_epsilon);
  }
};

const Register<StratifiedSampler> registered;

}  // namespace
}  // namespace etendue
