// The film's state as bytes, for checkpoints.

#include <fmt/format.h>

#include <cstring>

#include "etendue/film/image_buffer.h"

namespace etendue {
namespace {

constexpr std::uint64_t magic = 0x33304d4c49465445;  // "ETFILM03": name and version of the format, little endian

class Writer {
 public:
  template <class T>
  void value(T v) {
    static_assert(std::is_arithmetic_v<T>);
    append(&v, sizeof v);
  }
  void list(const std::vector<double>& v) {
    value(std::uint64_t(v.size()));
    append(v.data(), v.size() * sizeof(double));
  }
  std::vector<std::byte> bytes;

 private:
  void append(const void* data, size_t size) {
    const auto* from = static_cast<const std::byte*>(data);
    bytes.insert(bytes.end(), from, from + size);
  }
};

class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : rest_(bytes) {}

  template <class T>
  T value() {
    T v;
    take(&v, sizeof v);
    return v;
  }
  /// A list that is empty or has the expected length.
  std::vector<double> list(size_t expected) {
    const auto size = value<std::uint64_t>();
    if (size != 0 && size != expected)
      throw Error(fmt::format("the film's state holds {} values where {} belong", size, expected));
    if (size > rest_.size() / sizeof(double)) truncated();
    std::vector<double> v(size);
    take(v.data(), size * sizeof(double));
    return v;
  }
  bool at_end() const { return rest_.empty(); }

 private:
  [[noreturn]] static void truncated() { throw Error("the film's state ends too early"); }
  void take(void* to, size_t size) {
    if (size > rest_.size()) truncated();
    if (size > 0) std::memcpy(to, rest_.data(), size);
    rest_ = rest_.subspan(size);
  }
  std::span<const std::byte> rest_;
};

}  // namespace

/// FNV-1a over the filter's table: sums made with another filter must not be added to.
std::uint64_t ImageBuffer::filter_hash() const {
  std::uint64_t h = 0xcbf29ce484222325ull;
  const auto add = [&](float f) { h = (h ^ std::bit_cast<std::uint32_t>(f)) * 0x100000001b3ull; };
  add(filter_radius_);
  for (const float w : filter_table_) add(w);
  return h;
}

std::vector<std::byte> ImageBuffer::save_state() const {
  Writer w;
  w.bytes.reserve(200 + bad_.size() * 16 +
                  sizeof(double) * (sums_.size() + moments_.size() + features_.size() + splats_.size() + lengths_.size() +
                                    length_splats_.size()));
  w.value(magic);
  for (const int i : {width, height, area_.x0, area_.y0, area_.x1, area_.y1, int(wants_features_), path_lengths})
    w.value(std::int32_t(i));
  w.value(filter_hash());
  w.list(sums_);
  w.list(moments_);
  w.list(features_);
  w.list(splats_);
  w.list(lengths_);
  w.list(length_splats_);
  w.value(samples_);
  w.value(bad_count_);
  w.value(std::uint64_t(bad_.size()));
  for (const BadSample& b : bad_) {
    w.value(std::int32_t(b.x));
    w.value(std::int32_t(b.y));
    w.value(b.sample);
    w.value(std::uint8_t(b.kind));
  }
  return std::move(w.bytes);
}

void ImageBuffer::load_state(std::span<const std::byte> bytes) {
  Reader r(bytes);
  if (r.value<std::uint64_t>() != magic) throw Error("this is not a film's state, or one of another version");
  for (const int i : {width, height, area_.x0, area_.y0, area_.x1, area_.y1, int(wants_features_), path_lengths})
    if (r.value<std::int32_t>() != i) throw Error("the film's state belongs to a picture of another size, crop or layers");
  if (r.value<std::uint64_t>() != filter_hash()) throw Error("the film's state was made with another filter");

  // All is read and checked before anything changes.
  const size_t pixels = size_t(area_.width()) * size_t(area_.height());
  std::vector<double> sums = r.list(4 * pixels), moments = r.list(3 * pixels);
  std::vector<double> features = r.list(wants_features_ ? feature_values * pixels : 0), splats = r.list(4 * pixels);
  const size_t by_length = 3 * size_t(path_lengths) * pixels;
  std::vector<double> lengths = r.list(by_length), length_splats = r.list(by_length);
  if (sums.empty() != moments.empty() || (wants_features_ && sums.empty() != features.empty()) ||
      (sums.empty() && !splats.empty()) || (path_lengths > 0 && sums.empty() != lengths.empty()) ||
      (path_lengths > 0 && splats.empty() != length_splats.empty()))
    throw Error("the film's state lacks a part");
  const auto samples = r.value<std::uint64_t>(), bad_count = r.value<std::uint64_t>(), noted = r.value<std::uint64_t>();
  if (noted > bad_samples_kept || noted > bad_count) throw Error("the film's state holds an impossible number of bad samples");
  std::vector<BadSample> bad;
  for (std::uint64_t i = 0; i < noted; ++i) {
    BadSample b;
    b.x = r.value<std::int32_t>();
    b.y = r.value<std::int32_t>();
    b.sample = r.value<std::uint32_t>();
    const auto kind = r.value<std::uint8_t>();
    if (kind > std::uint8_t(BadSample::Kind::negative)) throw Error("the film's state holds an unknown kind of bad sample");
    b.kind = BadSample::Kind(kind);
    bad.push_back(b);
  }
  if (!r.at_end()) throw Error("the film's state is longer than it should be");

  sums_ = std::move(sums);
  moments_ = std::move(moments);
  features_ = std::move(features);
  splats_ = std::move(splats);
  lengths_ = std::move(lengths);
  length_splats_ = std::move(length_splats);
  samples_ = samples;
  bad_count_ = bad_count;
  bad_ = std::move(bad);
}

void ImageBuffer::add_state(std::span<const std::byte> bytes) {
  // Read into a copy of the settings first: an error leaves this buffer as it was.
  ImageBuffer other;
  other.width = width;
  other.height = height;
  other.filter = filter;
  other.crop = crop;
  other.layers = layers;
  other.path_lengths = path_lengths;
  other.prepare();
  other.load_state(bytes);
  const auto add = [](std::vector<double>& to, const std::vector<double>& from) {
    if (to.empty())
      to = from;
    else
      for (size_t i = 0; i < from.size(); ++i) to[i] += from[i];
  };
  for (size_t i = 0; i + feature_values <= other.features_.size() && !features_.empty(); i += feature_values)
    if (features_[i + 9] > 0)
      other.features_[i + 8] = 0;  // the object is of the first sample, not a sum
    else
      features_[i + 8] = 0;
  add(sums_, other.sums_);
  add(moments_, other.moments_);
  add(features_, other.features_);
  add(splats_, other.splats_);
  add(lengths_, other.lengths_);
  add(length_splats_, other.length_splats_);
  for (const BadSample& b : other.bad_)
    if (bad_.size() < bad_samples_kept) bad_.push_back(b);
  samples_ += other.samples_;
  bad_count_ += other.bad_count_;
}

}  // namespace etendue
