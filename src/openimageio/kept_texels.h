#pragma once
// All texels of an image in memory, as small as they can be without loss.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace etendue {

/// Numbers of an image in rows, decoded. An image of at most 256 different numbers, as one of 8 bits a channel has, takes a
/// byte for each and a table; any other takes floats.
class KeptTexels {
 public:
  /// Room for so many numbers. Throws std::bad_alloc.
  explicit KeptTexels(size_t count);
  ~KeptTexels();
  KeptTexels(const KeptTexels&) = delete;
  KeptTexels& operator=(const KeptTexels&) = delete;

  /// Whether that many numbers may be kept, if they should take floats: all that is kept in this process takes half of the
  /// machine's memory at most.
  static bool allowed(size_t count);

  /// Appends numbers.
  void add(const float* values, size_t count);

  float operator[](size_t place) const { return codes_.empty() ? values_[place] : values_[codes_[place]]; }
  /// sum += weight * (the numbers from a place on), three of them or one.
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
  std::vector<std::uint8_t> codes_;   // empty: values_ are the numbers themselves
  std::vector<float> values_;         // of the codes
  std::vector<std::int16_t> places_;  // a hash table of values_ by their bits, while codes are made; -1: free
};

}  // namespace etendue
