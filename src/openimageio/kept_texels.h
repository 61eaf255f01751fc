#pragma once
// Stores all texels of an image in memory, in the smallest lossless form.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/huge_pages.h"

namespace etendue {

/// The decoded values of an image in rows. An image of at most 256 different values, such as one of 8 bits per channel, takes a
/// byte for each value and a table; any other takes floats.
class KeptTexels {
 public:
  /// Reserves memory for `count` values. Throws std::bad_alloc.
  explicit KeptTexels(size_t count);
  ~KeptTexels();
  KeptTexels(const KeptTexels&) = delete;
  KeptTexels& operator=(const KeptTexels&) = delete;

  /// Whether so many values may be stored, assuming floats: all stored texels of the process take at most half of the machine's
  /// memory.
  static bool allowed(size_t count);

  /// Appends values.
  void add(const float* values, size_t count);

  float operator[](size_t place) const { return codes_.empty() ? values_[place] : values_[codes_[place]]; }
  /// sum += weight * values, for one or three channels from index `place` on.
  void add_to(float* sum, size_t place, int channels, float weight) const {
    sum[0] += weight * (*this)[place];
    if (channels == 3) {
      sum[1] += weight * (*this)[place + 1];
      sum[2] += weight * (*this)[place + 2];
    }
  }
  /// [bytes]
  size_t memory() const { return codes_.capacity() + values_.capacity() * sizeof(float); }

 private:
  bool code(const float* values, size_t count);
  void become_floats();
  void account();

  size_t count_, accounted_ = 0;
  HugeVector<std::uint8_t> codes_;    // empty: values_ holds the values themselves
  HugeVector<float> values_;          // value of each code
  std::vector<std::int16_t> places_;  // hash table of values_ by their bits, used while codes are made; -1: free
};

}  // namespace etendue
