// The output of meshoptimizer's encoder (1.3.0, its JavaScript module) for known numbers, and the filters against their
// definitions in KHR_meshopt_compression.

#include "components/importers/gltf/compressed/meshopt.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>
#include <vector>

#include "components/importers/gltf/data_uri.h"
#include "etendue/core/error.h"

namespace etendue::gltf {
namespace {

constexpr const char* vertices_0 =
    "oBUqqqqqqqqqqqqqAAAqDu7u7u7u7u7u7u7u7u7u7u7u7u4AAAAAFQJAAAACQAAAAkAAAB8AYPR3HLC7J2z/ayi8rxt48180yKMPhOdTQNSXA5DbR///AABM"
    "4IsInM87WB8AoKCCoKCCoKCCoKCCoKCCoKCCoKCCoKCCoKCCoKCCoP//AACggqCggqCgghkq66uuBAQEBCQiJCJCIkIkq64AAAQEKgMzNjMzYzM2MzNjMzYz"
    "M2MzNjMzAAAAABUVVVVVVVVVVVVVAAAfAEra2QAASJFK2pFHSJLckkfaANlIkUrakQCS2UlKSEc//AAASJLc25FHHwCSSUoAAJLckknckZLbR9uRSQBKktyS"
    "SdwA20qRkpKRP/wAAJLbR0jckR8AJG6SgIBkeEROVjw0Oj44JCYoKiwwGBoaHB4eICAeEv//AAASEhQUFBQWFgUCAgACAAAACAAAFTDw8PB/gH+Af4B/8PDw"
    "8IB/gH+Af4B/8PAAAIB/gH8VIGBgYGBgYGBgYAAAHwCdnZ2dnZ2dnZ2dnZ2dnZ2dnZ2dnZ2dnZ2dnZ2dnZ2d//8AAJ2dnZ2dnZ2dHwD09PL09PL09PL09PL0"
    "9PTy9PTy9PTy9PTy9PT08vT0//8AAPL09PL09PL0HwBucG5wbnBucG5wbnBucG5wbnBubnBucG5wbnBucG5w//8AAG5wbnBucG5wHwDDw8PBw8PDw8HDw8PB"
    "w8PDw8HDw8PDwcPDw8HDw8PD//8AAMHDw8PBw8PDAAAAAAAAAAAAAAAAAAAFAAAAYOoAAIA/AACAPrF5N54=";
constexpr const char* vertices_1 =
    "odVXv2r/FSqqqqqqqqqqqqoAACoO7u7u7u7u7u7u7u7u7u7u7u7u7gAAAAAAGAACARgAAgEYAAIBAGD0dxywuyds/2sovK8bePNfNMijD4TnU0DUlwOQ20dM"
    "4IsInM87WACgoIKgoIKgoIKgoIKgoIKgoIKgoIKgoIKgoIKgoIKgoIKgoIKgoIIVKqqqqqqqqqqqqgAAKgMzPzMz8zM/+fn5MzPzMz8zM/P5+fkzPzMzAAAA"
    "APkVKpqmqapqmqapqgAAAEolJgAASG5KJW5HSG0jbUclACZIbkolbgBtJklKSEcASG0jJG5HAACSSUkAAJLbkknbkpLbSduSSQBJktuSSdsA20mSkpKSAJLb"
    "SUnbkgAAJG6SgIBkeEROVjw0Oj44JCYoKiwwGBoaHB4eICAeEhISFBQUFBYWCgcAdwB3AHcAdwB3AHcAdwAzAAcHBwcAnZ2dnZ2dnZ2dnZ2dnZ2dnZ2dnZ2d"
    "nZ2dnZ2dnZ2dnZ2dnZ2dnZ2dAPT08vT08vT08vT08vT09PL09PL09PL09PL09PTy9PTy9PTy9PTy9ABucG5wbnBucG5wbnBucG5wbnBubnBucG5wbnBucG5w"
    "bnBucG5wbnAAw8PDwcPDw8PBw8PDwcPDw8PBw8PDw8HDw8PBw8PDw8HDw8PBw8PDAAAFAAAAYOoAAIA/AACAPrF5N54AAQEiAA==";
constexpr const char* triangles = "4f4eEA4QDo4eFA4TDo4eEw4TDv//////Dwj/F9rFCN3FCPocHTEE/xwCAvMsAgB2h1ZneKmGZYlomAFpAAA=";
constexpr const char* indices =
    "0QAEDAoQAgoEDAoQAgoEDAoQAgYEDAoQAgoEDAoQAgoEDAoQAgYEDAoQAgoEDAoQAgoEDAoQAirBixEGODokGgICQAQEWARiAAAAAA==";

std::string bytes_of(const char* base64) { return decode_data_uri(std::string("data:;base64,") + base64).bytes; }

template <class T>
void put(std::string& to, T value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Elements of 20 bytes that use every way of encoding differences.
constexpr MeshoptLayout vertex_layout{MeshoptMode::attributes, MeshoptFilter::none, 40, 20};
std::string vertices() {
  std::string all;
  for (std::uint32_t i = 0; i < 40; ++i) {
    for (const std::uint32_t x : {i, i * 7, i % 16 == 3 ? 6u : 5u, i * i * 37 + i * 11}) put(all, std::uint8_t(x));
    put(all, std::uint16_t(i * 331 + i % 3 * 5));
    put(all, std::uint16_t(60000 - i * 257 - i % 5));
    put(all, float(double(i * i) / 7 + 1));
    put(all, i % 4 == 0 ? 0.25f : 0.75f);
    put(all, (i + 1) * 2654435761u);
  }
  return all;
}

/// A grid of 3 by 3 squares, and triangles that share nothing with the triangles before them.
std::vector<std::uint32_t> corners() {
  std::vector<std::uint32_t> all;
  for (std::uint32_t y = 0; y < 3; ++y)
    for (std::uint32_t x = 0; x < 3; ++x) {
      const std::uint32_t a = 4 * y + x;
      all.insert(all.end(), {a, a + 1, a + 4, a + 1, a + 5, a + 4});
    }
  all.insert(all.end(), {3, 70000, 1, 15, 0, 9, 2, 1, 0, 16, 17, 18, 40, 41, 16});
  return all;
}

std::string error_of(const std::string& compressed, const MeshoptLayout& layout) {
  try {
    decode_meshopt(compressed, layout);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(Meshopt, VerticesOfBothVersions) {
  EXPECT_EQ(decode_meshopt(bytes_of(vertices_0), vertex_layout), vertices());
  EXPECT_EQ(decode_meshopt(bytes_of(vertices_1), vertex_layout), vertices());
}

TEST(Meshopt, TrianglesAndOtherIndices) {
  const std::vector<std::uint32_t> expected = corners();
  for (const auto& [mode, base64] : {std::pair{MeshoptMode::triangles, triangles}, {MeshoptMode::indices, indices}}) {
    const std::string wide = decode_meshopt(bytes_of(base64), {mode, MeshoptFilter::none, expected.size(), 4});
    const std::string narrow = decode_meshopt(bytes_of(base64), {mode, MeshoptFilter::none, expected.size(), 2});
    ASSERT_EQ(wide.size(), 4 * expected.size());
    ASSERT_EQ(narrow.size(), 2 * expected.size());
    std::vector<std::array<std::uint32_t, 3>> found(expected.size() / 3), wanted(found.size());
    std::memcpy(found.data(), wide.data(), wide.size());
    std::memcpy(wanted.data(), expected.data(), wide.size());
    // The decoder may rotate a triangle's corners.
    for (size_t i = 0; i < found.size(); ++i)
      for (auto* t : {&found[i], &wanted[i]}) std::ranges::rotate(*t, std::ranges::min_element(*t));
    EXPECT_EQ(found, wanted);
    std::uint16_t first = 0;
    std::memcpy(&first, narrow.data() + 2 * 55, 2);
    std::uint32_t same = 0;
    std::memcpy(&same, wide.data() + 4 * 55, 4);
    EXPECT_EQ(first, std::uint16_t(same));
  }
}

// A stream with missing bytes is refused, and so is one with a byte too many.
TEST(Meshopt, WhatIsTooShortOrTooLongIsRefused) {
  const MeshoptLayout of_indices{MeshoptMode::indices, MeshoptFilter::none, corners().size(), 4};
  MeshoptLayout of_triangles = of_indices;
  of_triangles.mode = MeshoptMode::triangles;
  for (const auto& [base64, layout] :
       {std::pair{vertices_0, vertex_layout}, {vertices_1, vertex_layout}, {triangles, of_triangles}, {indices, of_indices}}) {
    const std::string right = bytes_of(base64);
    for (size_t size = 0; size < right.size(); ++size) EXPECT_NE(error_of(right.substr(0, size), layout), "") << size;
    std::string longer = right;
    longer.insert(right.size() - 40, 1, '\0');
    EXPECT_NE(error_of(longer, layout), "");
    MeshoptLayout more = layout;
    more.count = 3'000'000'000;
    EXPECT_NE(error_of(right, more).find("cannot hold"), std::string::npos);  // and no memory is allocated for it
  }
  std::string kind = bytes_of(vertices_1);
  kind.back() = 3;
  EXPECT_NE(error_of(kind, vertex_layout).find("differences are of kind 3"), std::string::npos);
  // The first triangle has no earlier edge to refer to.
  const std::string edge = "\xe1" + std::string("\0", 1) + std::string(16, '\0');
  EXPECT_NE(error_of(edge, {MeshoptMode::triangles, MeshoptFilter::none, 3, 4}).find("before the first"), std::string::npos);
}

template <class T>
std::vector<T> undone(MeshoptFilter filter, std::vector<T> values, size_t width) {
  undo_meshopt_filter(filter, values.size() / width, width * sizeof(T), reinterpret_cast<char*>(values.data()));
  return values;
}

TEST(Meshopt, OctahedralVectors) {
  using Bytes = std::vector<std::int8_t>;
  using Words = std::vector<std::int16_t>;
  // Along each axis; in the lower half of the sphere, the corners of the square are the pole.
  EXPECT_EQ(undone(MeshoptFilter::octahedral, Bytes{0, 0, 127, 5, 127, 0, 127, 6, 0, -127, 127, 7, 127, 127, 127, 8}, 4),
            (Bytes{0, 0, 127, 5, 127, 0, 0, 6, 0, -127, 0, 7, 0, 0, -127, 8}));
  // With 10 bits: 1 is 511.
  const Words tilted = undone(MeshoptFilter::octahedral, Words{170, 170, 511, -3, 400, -300, 511, 9}, 4);
  const float third = 32767 / std::sqrt(3.0f);
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(tilted[i], third, 100);
  EXPECT_EQ(tilted[3], -3);
  // x = 400/511, y = -300/511: z = 1 - |x| - |y| is negative, and both are folded back.
  const double z = 1 - 700.0 / 511, x = 1 - 300.0 / 511, y = -(1 - 400.0 / 511), scale = 32767 / std::hypot(x, y, z);
  EXPECT_NEAR(tilted[4], x * scale, 1);
  EXPECT_NEAR(tilted[5], y * scale, 1);
  EXPECT_NEAR(tilted[6], z * scale, 1);
}

TEST(Meshopt, QuaternionsWithoutTheirLargestComponent) {
  using Words = std::vector<std::int16_t>;
  // With 12 bits: 1 is 2047, whose two lowest bits give the omitted component. x, y, z of the formula are the components after
  // it, cyclically.
  for (int largest = 0; largest < 4; ++largest) {
    const Words q = undone(MeshoptFilter::quaternion, Words{1000, -500, 200, std::int16_t((2047 & ~3) | largest)}, 4);
    const double scale = 32767 / (2047 * std::numbers::sqrt2);
    double rest = 32767.0 * 32767.0;
    for (int i = 0; i < 3; ++i) {
      const double expected = std::array{1000, -500, 200}[size_t(i)] * scale;
      EXPECT_NEAR(q[size_t(largest + 1 + i) % 4], expected, 1);
      rest -= expected * expected;
    }
    EXPECT_NEAR(q[size_t(largest)], std::sqrt(rest), 1);
  }
}

TEST(Meshopt, NumbersWithAnExponent) {
  const auto packed = [](int exponent, int mantissa) {
    return std::uint32_t(exponent) << 24 | (std::uint32_t(mantissa) & 0xffffff);
  };
  const std::vector<std::uint32_t> bits =
      undone(MeshoptFilter::exponential, std::vector{packed(0, 3), packed(-10, -5), packed(20, 8388607), packed(-100, 1)}, 2);
  std::vector<float> values(4);
  std::memcpy(values.data(), bits.data(), 16);
  EXPECT_EQ(values, (std::vector<float>{3, -5.0f / 1024, 8388607.0f * 1048576, std::ldexp(1.0f, -100)}));
}

TEST(Meshopt, ColorsAsLumaAndChroma) {
  using Bytes = std::vector<std::uint8_t>;
  using Words = std::vector<std::uint16_t>;
  // With 8 bits: red 200, green 100, blue 50, whose Co is 75, Cg -12 and Y 112 or 113; alpha has the seven bits below the
  // highest.
  const Bytes eight = undone(MeshoptFilter::color, Bytes{112, 75, std::uint8_t(-12), 128 + 127}, 4);
  EXPECT_EQ(eight, (Bytes{199, 100, 49, 255}));
  // With 6 bits: 63 is 1.
  const Words six = undone(MeshoptFilter::color, Words{32, std::uint16_t(-20), 8, 32 + 10}, 4);
  for (const auto& [place, value] : {std::pair{0, 4}, {1, 40}, {2, 44}, {3, 20}})
    EXPECT_NEAR(six[size_t(place)], value * 65535.0 / 63, 1) << place;
}

}  // namespace
}  // namespace etendue::gltf
