#pragma once
// A fast 64-bit hash against accidental changes; it is not cryptographic.

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>

namespace etendue {

/// Four lanes each take one word of eight bytes per block. For a given word each step is a bijection of the lane, and for a
/// given lane a bijection of the word, and the final mix is a bijection of each lane: so every change within one word changes
/// the hash. The value depends on the bytes alone, not on how they are split into calls.
class Hash {
 public:
  void add(std::span<const std::byte> bytes) {
    if (bytes.empty()) return;  // memcpy must not be given the null pointer of an empty span
    length_ += bytes.size();
    if (held_ > 0) {
      const size_t n = std::min(bytes.size(), block_.size() - held_);
      std::memcpy(block_.data() + held_, bytes.data(), n);
      held_ += n;
      bytes = bytes.subspan(n);
      if (held_ < block_.size()) return;
      take(block_.data());
      held_ = 0;
    }
    for (; bytes.size() >= block_.size(); bytes = bytes.subspan(block_.size())) take(bytes.data());
    if (!bytes.empty()) std::memcpy(block_.data(), bytes.data(), bytes.size());
    held_ = bytes.size();
  }

  std::uint64_t value() const {
    Hash last = *this;
    if (held_ > 0) {
      std::memset(last.block_.data() + held_, 0, block_.size() - held_);
      last.take(last.block_.data());
    }
    std::uint64_t h = length_;
    for (const std::uint64_t lane : last.lanes_) h = step(h, lane);
    h ^= h >> 32;
    h *= multiplier;
    return h ^ h >> 29;
  }

 private:
  static constexpr std::uint64_t multiplier = 0x9e3779b97f4a7c15ull;  // odd: 2^64 / golden ratio
  static std::uint64_t step(std::uint64_t lane, std::uint64_t word) { return std::rotl(lane ^ word, 29) * multiplier; }
  void take(const std::byte* block) {
    std::array<std::uint64_t, 4> words;
    std::memcpy(words.data(), block, sizeof words);
    for (size_t i = 0; i < 4; ++i) lanes_[i] = step(lanes_[i], words[i]);
  }

  std::array<std::uint64_t, 4> lanes_ = {1, 2, 3, 4};
  std::array<std::byte, 32> block_{};
  size_t held_ = 0;
  std::uint64_t length_ = 0;
};

}  // namespace etendue
