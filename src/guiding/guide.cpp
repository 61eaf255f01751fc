#include "etendue/guiding/guide.h"

#include <algorithm>
#include <cmath>

#include "guiding/saved_bytes.h"

namespace etendue {
namespace {

/// The signed axis that a normal is closest to, one of six; without a normal 6.
std::uint32_t facing(const Normal3& n) {
  const float x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  if (!(x + y + z > 0)) return 6;
  if (x >= y && x >= z) return n.x > 0;
  return y >= z ? 2 + (n.y > 0) : 4 + (n.z > 0);
}

}  // namespace

Guide::Guide(const GuideSettings& settings) : settings_(settings), cells_(trees), regions_(trees) {
  for (std::uint32_t i = 0; i < trees; ++i) cells_[i].what = i;
}

std::uint32_t Guide::region_of(const Point3& position, const Normal3& normal) const {
  std::uint32_t cell = facing(normal);
  while (cells_[cell].child) cell = cells_[cell].child + std::uint32_t(position[int(cells_[cell].what)] >= cells_[cell].plane);
  return cells_[cell].what;
}

void Guide::divide() {
  const size_t before = cells_.size();
  for (std::uint32_t i = 0; i < before; ++i)
    if (!cells_[i].child && regions_[cells_[i].what].gathered_ >= double(settings_.region_samples)) divide(i);
}

void Guide::divide(std::uint32_t cell) {
  if (bytes() + sizeof(Region) + 2 * sizeof(Cell) > settings_.memory) return;
  const std::uint32_t region = cells_[cell].what;
  Region& r = regions_[region];
  // At the mean position of the samples, across the axis of their largest variance.
  int axis = 0;
  double widest = 0;
  for (int i = 0; i < 3; ++i) {
    const double mean = r.sum_[i] / r.count_, variance = r.squares_[i] / r.count_ - mean * mean;
    if (variance > widest) {
      widest = variance;
      axis = i;
    }
  }
  const auto plane = float(r.sum_[axis] / r.count_);
  if (!(widest > 1e-9 * double(plane) * double(plane)) || !std::isfinite(widest)) return;
  for (double* x : {&r.known_, &r.seen_, &r.found_, &r.found_squared_}) *x /= 2;
  r.gathered_ = r.count_ = 0;
  for (int i = 0; i < 3; ++i) r.sum_[i] = r.squares_[i] = 0;
  const auto other = std::uint32_t(regions_.size()), child = std::uint32_t(cells_.size());
  regions_.push_back(Region(regions_[region]));
  cells_.push_back({0, region, 0});
  cells_.push_back({0, other, 0});
  cells_[cell] = {child, std::uint32_t(axis), plane};
}

// ---- saving -----------------------------------------------------------------------------------------------------------------

std::uint64_t Guide::check(std::span<const std::byte> bytes) {
  std::uint64_t sum = bytes.size();
  for (; !bytes.empty(); bytes = bytes.subspan(std::min<size_t>(8, bytes.size()))) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data(), std::min<size_t>(8, bytes.size()));
    sum = mix_bits(sum * 0x9e3779b97f4a7c15ull + word);
  }
  return sum;
}

std::vector<std::byte> Guide::save() const {
  std::vector<std::byte> bytes;
  append_all(bytes, cells_);
  append(bytes, std::uint64_t(regions_.size()));
  for (const Region& r : regions_) {
    append(bytes, r.lobes_);
    append(bytes, r.share_);
    for (const double x : {r.known_, r.gathered_, r.seen_, r.found_, r.found_squared_, r.count_}) append(bytes, x);
    append(bytes, r.sum_);
    append(bytes, r.squares_);
  }
  append(bytes, check(bytes));
  return bytes;
}

void Guide::load(std::span<const std::byte> bytes) {
  const Error damaged("a guide's bytes are damaged");
  if (bytes.size() < sizeof(std::uint64_t)) throw damaged;
  auto last = bytes.last(sizeof(std::uint64_t));
  bytes = bytes.first(bytes.size() - last.size());
  if (take<std::uint64_t>(last) != check(bytes)) throw damaged;
  std::vector<Cell> cells = take_all<Cell>(bytes);
  const auto count = take<std::uint64_t>(bytes);
  if (cells.size() < trees || count < trees || count > bytes.size()) throw damaged;
  for (size_t i = 0; i < cells.size(); ++i) {
    const Cell& c = cells[i];
    if (c.child ? c.child <= i || c.child + size_t(1) >= cells.size() || c.what > 2 : c.what >= count) throw damaged;
  }
  std::vector<Region> regions(static_cast<size_t>(count));
  for (Region& r : regions) {
    r.lobes_ = take<LobeMixture>(bytes);
    r.share_ = take<float>(bytes);
    for (double* x : {&r.known_, &r.gathered_, &r.seen_, &r.found_, &r.found_squared_, &r.count_}) *x = take<double>(bytes);
    for (double* x : {r.sum_, r.squares_})
      for (int i = 0; i < 3; ++i) x[i] = take<double>(bytes);
    if (!(r.share_ >= 0 && r.share_ <= 1)) throw damaged;
  }
  if (!bytes.empty()) throw damaged;
  cells_ = std::move(cells);
  regions_ = std::move(regions);
}

}  // namespace etendue
