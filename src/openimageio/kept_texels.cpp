#include "kept_texels.h"

#include <unistd.h>

#include <atomic>
#include <bit>

namespace etendue {

namespace {

constexpr size_t most_codes = 256, hash_size = 1024;

std::atomic<size_t> kept_bytes = 0;

size_t memory_limit() {
  static const size_t limit = size_t(sysconf(_SC_PHYS_PAGES)) * size_t(sysconf(_SC_PAGE_SIZE)) / 2;
  return limit;
}

}  // namespace

KeptTexels::KeptTexels(size_t count) : count_(count), places_(hash_size, std::int16_t(-1)) {
  codes_.reserve(count);
  account();
}

KeptTexels::~KeptTexels() { kept_bytes -= accounted_; }

void KeptTexels::account() {
  kept_bytes += memory() - accounted_;
  accounted_ = memory();
}

bool KeptTexels::allowed(size_t count) {
  return count <= memory_limit() / sizeof(float) && kept_bytes + count * sizeof(float) <= memory_limit();
}

void KeptTexels::add(const float* values, size_t count) {
  if (places_.empty()) {
    values_.insert(values_.end(), values, values + count);
    return;
  }
  if (code(values, count)) return;
  become_floats();
  values_.insert(values_.end(), values, values + count);
}

/// Appends 8-bit codes; false, with nothing appended, if there are too many different values.
bool KeptTexels::code(const float* values, size_t count) {
  const size_t before = codes_.size();
  for (size_t i = 0; i < count; ++i) {
    const auto bits = std::bit_cast<std::uint32_t>(values[i]);
    size_t at = (bits * 2654435761u) >> 22;  // the highest 10 bits of Knuth's multiplicative hash
    while (places_[at] >= 0 && std::bit_cast<std::uint32_t>(values_[size_t(places_[at])]) != bits) at = (at + 1) % hash_size;
    if (places_[at] < 0) {
      if (values_.size() == most_codes) {
        codes_.resize(before);
        return false;
      }
      places_[at] = std::int16_t(values_.size());
      values_.push_back(values[i]);
    }
    codes_.push_back(std::uint8_t(places_[at]));
  }
  return true;
}

void KeptTexels::become_floats() {
  HugeVector<float> floats;
  floats.reserve(count_);
  for (const std::uint8_t code : codes_) floats.push_back(values_[code]);
  values_ = std::move(floats);
  codes_ = {};
  places_ = {};
  account();
}

}  // namespace etendue
