#include "etendue/transport/point_tree.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <bit>
#include <limits>

#include "etendue/core/error.h"

namespace etendue {
namespace {

/// An integer that has the order of a float; 0 and -0 are equal.
std::uint32_t ordered(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x + 0.0f);
  return bits ^ (std::uint32_t(std::int32_t(bits) >> 31) | 0x8000'0000u);
}
float from_ordered(std::uint32_t key) {
  return std::bit_cast<float>(key ^ (std::uint32_t(std::int32_t(~key) >> 31) | 0x8000'0000u));
}

/// A point while the tree is built: its coordinates as ordered integers, and its index.
struct Entry {
  std::array<std::uint32_t, 4> values;
  std::uint32_t index() const { return values[3]; }
  Point3 point() const { return {from_ordered(values[0]), from_ordered(values[1]), from_ordered(values[2])}; }
  /// By a coordinate, and by the index where two are equal: no two entries have the same key.
  template <int axis>
  std::uint64_t key() const {
    return std::uint64_t(values[axis]) << 32 | values[3];
  }
};

/// Sorts up to `most` entries: each goes to the place that the number of smaller keys gives. Without branches, which no
/// processor could predict.
template <int axis, size_t most>
void sort_few(Entry* entries, size_t count) {
  std::array<std::uint64_t, most> keys;
  std::array<Entry, most> copies;
  for (size_t i = 0; i < count; ++i) {
    copies[i] = entries[i];
    keys[i] = entries[i].key<axis>();
  }
  std::fill(keys.begin() + count, keys.end(), ~std::uint64_t(0));
  for (size_t i = 0; i < count; ++i) {
    std::uint64_t smaller = 0;
    for (size_t j = 0; j < most; ++j) smaller += keys[j] < keys[i];
    entries[smaller] = copies[i];
  }
}

/// Moves the entry that would be number `middle` of the sorted ones there, smaller ones before it and greater ones after it.
///
/// Floyd and Rivest 1975, "Expected time bounds for selection": the entries are divided by one of a sample of them, chosen a
/// little beyond the wanted one, so that this is probably in the smaller part: some 1.5 comparisons for each entry.
template <int axis>
void select(Entry* entries, size_t count, size_t middle) {
  constexpr size_t few = 32, largest_sample = 512;
  while (count > few) {
    std::array<std::uint64_t, largest_sample> sample;
    const size_t size = std::min(size_t(std::sqrt(double(count))), largest_sample);
    for (size_t i = 0; i < size; ++i) sample[i] = entries[(2 * i + 1) * count / (2 * size)].key<axis>();
    // The wanted one's place in the sample has a binomial distribution; beyond it by 1.2 standard deviations.
    const double share = double(middle) / double(count), variance = double(size) * share * (1 - share);
    const double beyond = 1.2 * std::sqrt(std::max(variance, 1.0));
    const double place = double(size) * share + (2 * middle < count ? beyond : -beyond);
    const auto chosen = std::ptrdiff_t(std::clamp(place, 0.0, double(size - 1)));
    std::nth_element(sample.begin(), sample.begin() + chosen, sample.begin() + std::ptrdiff_t(size));
    const std::uint64_t pivot = sample[size_t(chosen)];
    // entries[0 … lower) < pivot <= entries[lower … i).
    size_t lower = 0;
    for (size_t i = 0; i < count; ++i) {
      const Entry entry = entries[i];
      entries[i] = entries[lower];
      entries[lower] = entry;
      lower += entry.key<axis>() < pivot;
    }
    if (middle < lower) {
      count = lower;
      continue;
    }
    if (lower == 0) {  // the pivot is the smallest of all
      std::swap(entries[0], *std::find_if(entries, entries + count, [&](const Entry& e) { return e.key<axis>() == pivot; }));
      if (middle == 0) return;
      lower = 1;
    }
    entries += lower;
    count -= lower;
    middle -= lower;
  }
  count > few / 2 ? sort_few<axis, few>(entries, count) : sort_few<axis, few / 2>(entries, count);
}

}  // namespace

struct PointTree::Build {
  std::vector<Entry> entries;
  std::vector<Plane>& planes;

  void divide(size_t begin, size_t end, size_t node) {
    if (end - begin <= leaf) return;
    std::array<std::uint32_t, 4> low = entries[begin].values, high = low;
    for (size_t i = begin + 1; i < end; ++i)
      for (size_t k = 0; k < 4; ++k) {
        low[k] = std::min(low[k], entries[i].values[k]);
        high[k] = std::max(high[k], entries[i].values[k]);
      }
    const Vector3 edge = Entry{high}.point() - Entry{low}.point();
    const int axis = edge.x >= edge.y && edge.x >= edge.z ? 0 : edge.y >= edge.z ? 1 : 2;
    const size_t count = end - begin, middle = begin + count / 2;
    switch (axis) {
      case 0: select<0>(&entries[begin], count, count / 2); break;
      case 1: select<1>(&entries[begin], count, count / 2); break;
      default: select<2>(&entries[begin], count, count / 2);
    }
    planes[node] = {entries[middle].point()[axis], std::uint32_t(axis)};
    const auto lower = [&] { divide(begin, middle, 2 * node + 1); };
    const auto upper = [&] { divide(middle, end, 2 * node + 2); };
    if (count > (1 << 15)) {
      tbb::parallel_invoke(lower, upper);
    } else {
      lower();
      upper();
    }
  }
};

std::vector<std::uint32_t> PointTree::build(const Point3* first, size_t stride, size_t count) {
  if (count > std::numeric_limits<std::uint32_t>::max()) throw Error("a tree of points holds at most 2^32 of them");
  // Ranges are halved until the larger half fits in a leaf: the nodes above are numbered level by level.
  size_t levels = 0;
  for (size_t n = count; n > leaf; n -= n / 2) ++levels;
  planes_.assign((size_t(1) << levels) - 1, {});
  const auto for_all = [&](const auto& work) {
    tbb::parallel_for(tbb::blocked_range<size_t>(0, count, 1 << 14), [&](const tbb::blocked_range<size_t>& range) {
      for (size_t i = range.begin(); i < range.end(); ++i) work(i);
    });
  };
  Build build{std::vector<Entry>(count), planes_};
  for_all([&](size_t i) {
    const Point3& p = *reinterpret_cast<const Point3*>(reinterpret_cast<const std::byte*>(first) + i * stride);
    build.entries[i] = {{ordered(p.x), ordered(p.y), ordered(p.z), std::uint32_t(i)}};
  });
  build.divide(0, count, 0);
  std::vector<std::uint32_t> order(count);
  points_.resize(count);
  for_all([&](size_t i) {
    order[i] = build.entries[i].index();
    points_[i] = build.entries[i].point();
  });
  return order;
}

std::vector<PointTree::Near>& PointTree::near_on_this_thread() {
  static thread_local std::vector<Near> near;
  return near;
}

void PointTree::nearest(const Point3& p, float radius, size_t count, std::vector<Near>& found) const {
  found.clear();
  if (count == 0) return;
  float squared = square(radius);
  search(p, squared, [&](std::uint32_t i, float d2) {
    if (found.size() == count) {
      std::pop_heap(found.begin(), found.end());
      found.pop_back();
    }
    found.push_back({d2, i});
    std::push_heap(found.begin(), found.end());
    if (found.size() == count) squared = found.front().squared;
  });
}

}  // namespace etendue
