#include "accessor.h"

#include <cstring>

#include "files/regular_file.h"

namespace etendue::gltf {
namespace {

enum Component { int8 = 5120, uint8 = 5121, int16 = 5122, uint16 = 5123, uint32 = 5125, float32 = 5126 };

size_t width_of(const std::string& type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4" || type == "MAT2") return 4;
  if (type == "MAT3") return 9;
  if (type == "MAT4") return 16;
  throw Error("'type' '" + type.substr(0, 20) + "' is unknown");
}

template <class T>
T load(const char* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

// Normalized integers are fractions of the largest number (glTF 2.0, 3.6.2.2).
float number_at(const char* from, int component, bool normalized) {
  switch (component) {
    case int8: return normalized ? std::max(float(load<std::int8_t>(from)) / 127, -1.0f) : float(load<std::int8_t>(from));
    case uint8: return float(load<std::uint8_t>(from)) / (normalized ? 255.0f : 1.0f);
    case int16: return normalized ? std::max(float(load<std::int16_t>(from)) / 32767, -1.0f) : float(load<std::int16_t>(from));
    case uint16: return float(load<std::uint16_t>(from)) / (normalized ? 65535.0f : 1.0f);
    case uint32: return float(load<std::uint32_t>(from));
    default: return load<float>(from);
  }
}

std::uint32_t index_at(const char* from, int component) {
  switch (component) {
    case uint8: return load<std::uint8_t>(from);
    case uint16: return load<std::uint16_t>(from);
    case uint32: return load<std::uint32_t>(from);
    default: throw Error("indices must be unsigned numbers");
  }
}

/// Adjacent elements are read in blocks of this size.
constexpr size_t bytes_at_once = 1 << 22;

}  // namespace

size_t size_of_component(int component) {
  switch (component) {
    case int8:
    case uint8: return 1;
    case int16:
    case uint16: return 2;
    case uint32:
    case float32: return 4;
    default: throw Error("'componentType' " + std::to_string(component) + " is unknown");
  }
}

Accessor::Accessor(const Document& document, size_t index)
    : document_(document), json_(&document.element("accessors", index)), index_(index) {
  within(fmt::format("accessors[{}]", index), [&] {
    count = needed_whole(*json_, "count");
    width = width_of(text(*json_, "type"));
    component = int(std::min<size_t>(needed_whole(*json_, "componentType"), 1 << 20));
    normalized = truth(*json_, "normalized", false);
    const size_t size = size_of_component(component);
    if (count > UINT32_MAX - 1) throw Error("it has more than 2^32 elements");
    if (const auto view = whole(*json_, "bufferView")) {
      const std::uint64_t offset = whole(*json_, "byteOffset").value_or(0), element = size * width,
                          there = document.view_size(*view);
      const std::uint64_t stride = std::max<std::uint64_t>(document.view_stride(*view), 1),
                          step = stride > 1 ? stride : element;
      if (step < element) throw Error("its elements overlap");
      if (count > 0 && (offset > there || element > there - offset || (count - 1) > (there - offset - element) / step))
        throw Error(fmt::format("its {} elements do not lie within bufferViews[{}] of {} bytes", count, *view, there));
    } else if (count * width > (1 << 24) + document.buffer_bytes()) {
      throw Error(fmt::format("it has {} elements of nothing but zeros", count));
    }
    if (const Json& s = object_in(*json_, "sparse"); !s.empty() && needed_whole(s, "count") > count)
      throw Error("it replaces more elements than it has");
  });
}

template <class Take>
void Accessor::elements(Take take) const {
  const auto view = whole(*json_, "bufferView");
  if (!view || count == 0) return;
  const std::uint64_t offset = whole(*json_, "byteOffset").value_or(0);
  const size_t element = size_of_component(component) * width, stride = document_.view_stride(*view),
               step = stride > 0 ? stride : element;
  const size_t together = std::max<size_t>(bytes_at_once / step, 1);
  std::vector<char> bytes;
  for (size_t i = 0; i < count; i += together) {
    const size_t n = std::min(together, count - i);
    bytes.resize((n - 1) * step + element);
    document_.read_view(*view, offset + i * step, bytes.size(), bytes.data());
    for (size_t k = 0; k < n; ++k) take(i + k, bytes.data() + k * step);
  }
}

// Reads the sparse elements, which replace others.
template <class Take>
void Accessor::sparse(Take take) const {
  const Json& s = object_in(*json_, "sparse");
  if (s.empty()) return;
  within(fmt::format("accessors[{}].sparse", index_), [&] {
    const size_t n = needed_whole(s, "count");
    const Json &which = object_in(s, "indices"), &values = object_in(s, "values");
    const int type = int(std::min<size_t>(needed_whole(which, "componentType"), 1 << 20));
    const size_t size = size_of_component(type), element = size_of_component(component) * width;
    const size_t index_view = needed_whole(which, "bufferView"), value_view = needed_whole(values, "bufferView");
    if (n * size > document_.view_size(index_view) || n * element > document_.view_size(value_view))
      throw Error("it is longer than what it lies in");
    std::vector<char> indices(n * size), replaced(n * element);
    document_.read_view(index_view, whole(which, "byteOffset").value_or(0), indices.size(), indices.data());
    document_.read_view(value_view, whole(values, "byteOffset").value_or(0), replaced.size(), replaced.data());
    for (size_t i = 0; i < n; ++i) {
      const std::uint32_t place = index_at(indices.data() + i * size, type);
      if (place >= count) throw Error(fmt::format("it replaces element {} of {}", place, count));
      take(place, replaced.data() + i * element);
    }
  });
}

void Accessor::floats(float* to) const {
  const size_t size = size_of_component(component);
  const auto take = [&](size_t i, const char* from) {
    float* out = to + i * width;
    if (component == float32)
      std::memcpy(out, from, width * size);
    else
      for (size_t k = 0; k < width; ++k) out[k] = number_at(from + k * size, component, normalized);
  };
  if (!whole(*json_, "bufferView")) std::fill_n(to, count * width, 0.0f);
  elements(take);
  sparse(take);
}

std::vector<float> Accessor::floats() const {
  require_memory(double(count) * double(width) * sizeof(float), "it");
  std::vector<float> values(count * width);
  floats(values.data());
  return values;
}

bool Accessor::whole_numbers() const {
  return width == 1 && !normalized && (component == uint8 || component == uint16 || component == uint32);
}

std::vector<std::uint32_t> Accessor::indices() const {
  if (width != 1) throw Error(fmt::format("accessors[{}]: indices are single numbers", index_));
  require_memory(double(count) * sizeof(std::uint32_t), "it");
  std::vector<std::uint32_t> values(count);
  const auto take = [&](size_t i, const char* from) { values[i] = index_at(from, component); };
  within(fmt::format("accessors[{}]", index_), [&] {
    elements(take);
    sparse(take);
  });
  return values;
}

}  // namespace etendue::gltf
