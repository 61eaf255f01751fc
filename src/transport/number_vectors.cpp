#include "etendue/transport/number_vectors.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "etendue/core/error.h"

namespace etendue {

float RecordedNumbers::number(SampleKey key, std::uint32_t dimension) const {
  auto& walk = walks_[key.walk];
  const auto known = walk.find(dimension);
  if (known != walk.end()) return known->second;
  if (!source_) return 0.5f;
  return walk[dimension] = source_->number(key, dimension);
}

Point2 RecordedNumbers::pair(SampleKey key, std::uint32_t dimension) const {
  auto& walk = walks_[key.walk];
  if (source_ && !walk.contains(dimension)) {
    const Point2 p = source_->pair(key, dimension);
    walk[dimension] = p.x;
    walk[dimension + 1] = p.y;
  }
  return {number(key, dimension), number(key, dimension + 1)};
}

void MutatedNumbers::begin(bool large) {
  ++iteration_;
  large_ = large;
  touched_.clear();
}

void MutatedNumbers::accept() {
  if (large_) last_large_ = iteration_;
  touched_.clear();
}

void MutatedNumbers::reject() {
  for (const auto& [walk, dimension] : touched_) {
    Coordinate& c = walks_[walk][dimension];
    c.value = c.before;
    c.changed = c.changed_before;
  }
  touched_.clear();
  --iteration_;
}

float MutatedNumbers::draw() const {
  return to_unit_float(std::uint32_t(mix_bits(seed_ + ++drawn_ * 0x9e3779b97f4a7c15ull) >> 32));
}

float MutatedNumbers::number(SampleKey key, std::uint32_t dimension) const {
  std::vector<Coordinate>& walk = walks_[key.walk];
  if (walk.size() <= dimension) walk.resize(size_t(dimension) + 1);
  Coordinate& c = walk[dimension];
  if (c.changed == iteration_) return c.value;
  c.before = c.value;
  c.changed_before = c.changed;
  touched_.emplace_back(key.walk, dimension);
  // Since the last large step it stands as that would have drawn it. A coordinate that was never asked for is such a one.
  if (c.changed < last_large_) {
    c.value = draw();
    c.changed = last_large_;
  }
  if (large_) {
    c.value = draw();
  } else {
    // So many normal deviates add up to one (Box & Muller 1958).
    const auto steps = double(iteration_ - c.changed);
    const double radius = std::sqrt(-2 * std::log(1 - double(draw())) * steps) * double(deviation_);
    const double moved = double(c.value) + radius * std::cos(2 * M_PI * double(draw()));
    c.value = std::min(float(moved - std::floor(moved)), one_minus_epsilon);
  }
  c.changed = iteration_;
  return c.value;
}

namespace {

template <class T>
void append(std::vector<std::byte>& to, const T& value) {
  const auto bytes = std::as_bytes(std::span(&value, 1));
  to.insert(to.end(), bytes.begin(), bytes.end());
}

template <class T>
void take(std::span<const std::byte>& from, T& value) {
  if (from.size() < sizeof value) throw Error("the state of a chain ends too early");
  std::memcpy(&value, from.data(), sizeof value);
  from = from.subspan(sizeof value);
}

}  // namespace

void MutatedNumbers::save(std::vector<std::byte>& to) const {
  append(to, seed_);
  append(to, iteration_);
  append(to, last_large_);
  append(to, drawn_);
  std::vector<std::uint64_t> names;
  for (const auto& [name, walk] : walks_) names.push_back(name);
  std::ranges::sort(names);
  append(to, std::uint64_t(names.size()));
  for (const std::uint64_t name : names) {
    const std::vector<Coordinate>& walk = walks_.at(name);
    append(to, name);
    append(to, std::uint64_t(walk.size()));
    for (const Coordinate& c : walk) {
      append(to, c.value);
      append(to, c.changed);
    }
  }
}

void MutatedNumbers::load(std::span<const std::byte>& from) {
  MutatedNumbers read(0, deviation_);
  take(from, read.seed_);
  take(from, read.iteration_);
  take(from, read.last_large_);
  take(from, read.drawn_);
  std::uint64_t walks = 0, size = 0, name = 0;
  take(from, walks);
  for (; walks > 0; --walks) {
    take(from, name);
    take(from, size);
    if (size > from.size()) throw Error("the state of a chain ends too early");
    std::vector<Coordinate>& walk = read.walks_[name];
    walk.resize(size_t(size));
    for (Coordinate& c : walk) {
      take(from, c.value);
      take(from, c.changed);
    }
  }
  *this = std::move(read);
}

Point2 MutatedNumbers::pair(SampleKey key, std::uint32_t dimension) const {
  const float x = number(key, dimension);
  return {x, number(key, dimension + 1)};
}

}  // namespace etendue
