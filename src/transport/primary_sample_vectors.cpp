#include "etendue/transport/primary_sample_vectors.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "etendue/core/error.h"

namespace etendue {

float RecordedPrimarySamples::number(SampleKey key, std::uint32_t dimension) const {
  auto& walk = walks_[key.walk];
  const auto known = walk.find(dimension);
  if (known != walk.end()) return known->second;
  if (!source_) return 0.5f;
  return walk[dimension] = source_->number(key, dimension);
}

Point2 RecordedPrimarySamples::pair(SampleKey key, std::uint32_t dimension) const {
  auto& walk = walks_[key.walk];
  if (source_ && !walk.contains(dimension)) {
    const Point2 p = source_->pair(key, dimension);
    walk[dimension] = p.x;
    walk[dimension + 1] = p.y;
  }
  return {number(key, dimension), number(key, dimension + 1)};
}

void MutatedPrimarySamples::begin(bool large, double variance) {
  time_before_ = time_;
  time_ += variance;
  large_ = large;
  touched_.clear();
}

void MutatedPrimarySamples::accept() {
  if (large_) last_large_ = time_;
  touched_.clear();
}

void MutatedPrimarySamples::reject() {
  for (const auto& [walk, dimension] : touched_) {
    Coordinate& c = (*walk)[dimension];
    c.value = c.before;
    c.changed = c.changed_before;
  }
  touched_.clear();
  time_ = time_before_;
}

float MutatedPrimarySamples::draw() const {
  return to_unit_float(std::uint32_t(mix_bits(seed_ + ++drawn_ * 0x9e3779b97f4a7c15ull) >> 32));
}

Point2 MutatedPrimarySamples::normal_pair() const {  // Box & Muller 1958
  const float radius = std::sqrt(-2 * std::log(1 - draw())), angle = 2 * pi * draw();
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

MutatedPrimarySamples::Walk& MutatedPrimarySamples::walk(std::uint64_t name) const {
  if (!last_ || name != last_name_) {
    last_ = &walks_[name];
    last_name_ = name;
  }
  return *last_;
}

void MutatedPrimarySamples::move(Coordinate& c, double time, float normal) {
  const float moved = c.value + float(std::sqrt(time - c.changed)) * normal;
  c.value = std::min(moved - std::floor(moved), one_minus_epsilon);
  c.changed = time;
}

template <class Normal>
float MutatedPrimarySamples::proposed(Walk& walk, std::uint32_t dimension, const Normal& normal) const {
  Coordinate& c = walk[dimension];
  if (c.changed == time_) return c.value;
  if (!large_) {
    // The value of the number in the current state, which this proposal mutates. If the number was not used since the last
    // large step (or never), it is drawn now, as that step would have done; then it gets the small steps that it missed. This
    // value belongs to the current state, and stays if the proposal is rejected. If it were drawn again for each proposal,
    // states that do not use a number would repeatedly try new values of it, starting from one that once was good: such states
    // would be left too early, for states that use more numbers.
    if (c.changed < last_large_) {
      c.value = draw();
      c.changed = last_large_;
    }
    if (c.changed < time_before_) move(c, time_before_, normal_pair().x);
  }
  c.before = c.value;
  c.changed_before = c.changed;
  touched_.emplace_back(&walk, dimension);
  if (large_) {
    c.value = draw();
    c.changed = time_;
  } else {
    move(c, time_, normal());
  }
  return c.value;
}

float MutatedPrimarySamples::number(SampleKey key, std::uint32_t dimension) const {
  Walk& all = walk(key.walk);
  if (all.size() <= dimension) all.resize(size_t(dimension) + 1);
  return proposed(all, dimension, [&] { return normal_pair().x; });
}

Point2 MutatedPrimarySamples::pair(SampleKey key, std::uint32_t dimension) const {
  Walk& all = walk(key.walk);
  if (all.size() <= dimension + 1) all.resize(size_t(dimension) + 2);
  const Point2 normal = large_ ? Point2{} : normal_pair();
  const float x = proposed(all, dimension, [&] { return normal.x; });
  return {x, proposed(all, dimension + 1, [&] { return normal.y; })};
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

void MutatedPrimarySamples::save(std::vector<std::byte>& to) const {
  append(to, seed_);
  append(to, time_);
  append(to, last_large_);
  append(to, drawn_);
  std::vector<std::uint64_t> names;
  for (const auto& [name, walk] : walks_) names.push_back(name);
  std::ranges::sort(names);
  append(to, std::uint64_t(names.size()));
  for (const std::uint64_t name : names) {
    const Walk& walk = walks_.at(name);
    append(to, name);
    append(to, std::uint64_t(walk.size()));
    for (const Coordinate& c : walk) {
      append(to, c.value);
      append(to, c.changed);
    }
  }
}

void MutatedPrimarySamples::load(std::span<const std::byte>& from) {
  std::uint64_t seed = 0, drawn = 0, count = 0, size = 0, name = 0;
  double time = 0, last_large = 0;
  take(from, seed);
  take(from, time);
  take(from, last_large);
  take(from, drawn);
  take(from, count);
  std::unordered_map<std::uint64_t, Walk> walks;
  for (; count > 0; --count) {
    take(from, name);
    take(from, size);
    if (size > from.size()) throw Error("the state of a chain ends too early");
    Walk& walk = walks[name];
    walk.resize(size_t(size));
    for (Coordinate& c : walk) {
      take(from, c.value);
      take(from, c.changed);
    }
  }
  seed_ = seed;
  time_ = time_before_ = time;
  last_large_ = last_large;
  drawn_ = drawn;
  walks_ = std::move(walks);
  last_ = nullptr;
  touched_.clear();
}

}  // namespace etendue
