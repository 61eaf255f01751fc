// NanoVDB files. Those in this folder were written by OpenVDB and its nanovdb_convert (make_grids.py), so their contents are
// known independently of our reader.

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <random>

#include "components/volumes/nanovdb_file.h"
#include "components/volumes/nanovdb_tree.h"
#include "etendue/core/error.h"
#include "support/luminaire_test_support.h"
#include "support/process.h"

namespace etendue::test {
namespace {

std::string beside(const std::string& name) { return ETENDUE_SOURCE_DIR "/tests/volumes/" + name; }

std::vector<unsigned char> contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}
template <class T>
T number_at(const std::vector<unsigned char>& bytes, size_t offset) {
  T v;
  std::memcpy(&v, &bytes.at(offset + sizeof v - 1) - (sizeof v - 1), sizeof v);
  return v;
}
template <class T>
void put(std::vector<unsigned char>& bytes, size_t offset, T v) {
  std::memcpy(&bytes.at(offset + sizeof v - 1) - (sizeof v - 1), &v, sizeof v);
}
std::string refusal(const std::string& path, const std::string& name = {}) {
  try {
    read_nanovdb(path, name);
  } catch (const Error& e) {
    return e.what();
  }
  return "it was read";
}

/// The value that make_grids.py wrote.
float written(int i, int j, int k) {
  if (i >= -3 && i < 12 && j >= 5 && j < 9 && k >= 0 && k < 3) return 100 + 0.25f * float(i) + float(j) + 16 * float(k);
  return i >= 16 && i < 24 && j >= 0 && j < 8 && k >= 0 && k < 8 ? 7.5f : 0.0f;
}
void expect_written(const VolumeGrid& grid, float tolerance) {
  ASSERT_EQ(grid.size, (std::array<int, 3>{27, 9, 8}));
  ASSERT_EQ(grid.channels, 1);
  size_t n = 0;
  for (int k = 0; k < 8; ++k)
    for (int j = 0; j < 9; ++j)
      for (int i = -3; i < 24; ++i) ASSERT_NEAR(grid.values[n++], written(i, j, k), tolerance) << i << " " << j << " " << k;
  // Cells of half a metre centred at the positions of indices, which are i / 2 + (1, 2, 3).
  EXPECT_LT(distance(grid.low, Point3{-0.75f, 1.75f, 2.75f}), 1e-6f);
  EXPECT_LT(distance(grid.high, Point3{12.75f, 6.25f, 6.75f}), 1e-6f);
}

TEST(NanoVdb, HoldsWhatOpenVdbWrote) {
  EXPECT_EQ(nanovdb_grids(beside("three_grids.nvdb")), (std::vector<std::string>{"color", "density", "temperature"}));
  expect_written(read_nanovdb(beside("three_grids.nvdb"), "density"), 0);
  const VolumeGrid hot = read_nanovdb(beside("three_grids.nvdb"), "temperature"),
                   color = read_nanovdb(beside("three_grids.nvdb"), "");
  EXPECT_EQ(hot.size, (std::array<int, 3>{4, 1, 1}));
  EXPECT_EQ(hot.values, (std::vector<float>{1000, 1001, 1002, 1003}));
  EXPECT_EQ(color.channels, 3);
  EXPECT_EQ(color.values, (std::vector<float>{0.25f, 0.5f, 0.75f, 1, 2, 3}));
}

// Values in a leaf are between 0 and 143; rounding changes a value by half a step.
TEST(NanoVdb, ReadsRoundedValues) {
  expect_written(read_nanovdb(beside("rounded_fp16.nvdb"), "density"), 0.51f * 143 / 65535);
  expect_written(read_nanovdb(beside("rounded_fp8.nvdb"), "density"), 0.51f * 143 / 255);
  expect_written(read_nanovdb(beside("rounded_fp4.nvdb"), "density"), 0.51f * 143 / 15);
  expect_written(read_nanovdb(beside("rounded_fpn.nvdb"), "density"), 1);
}

TEST(NanoVdb, SaysWhatItCannotRead) {
  EXPECT_NE(refusal(beside("three_grids.nvdb"), "smoke").find("no grid 'smoke', only: color, density, temperature"),
            std::string::npos);
  EXPECT_NE(refusal(beside("blosc.nvdb")).find("nanovdb_convert --zip"), std::string::npos);
  const TemporaryFolder folder;
  EXPECT_NE(refusal(folder.write("a.nvdb", "NanoVDB9 and more than sixteen")).find("begins neither"), std::string::npos);
  EXPECT_NE(refusal(folder.write("b.nvdb", "")).find("no grid"), std::string::npos);
  expect_refused("GridMap { file: \"" + folder.write("c.vdb", "") + "\" }", "file", "nanovdb_convert");
}

TEST(NanoVdb, IsADensityWhereItsFileSaysIt) {
  const Ref<VolumeShader> v =
      prepared_as<VolumeShader>("GridVolume { file: \"" + beside("three_grids.nvdb") +
                                "\", grid_name: \"density\", file_box: true, outside: empty, extinction: 2 }");
  // Half way between the positions of the indices (4, 6, 1) and (5, 6, 1).
  const Point3 p{1 + 4.5f / 2, 2 + 6 / 2.0f, 3 + 1 / 2.0f};
  EXPECT_NEAR(v->coefficients(p, 0, wavelengths()).extinction()[0], written(4, 6, 1) + written(5, 6, 1), 1e-3f);
}

/// The uncompressed bytes of a grid.
std::vector<unsigned char> unpacked(const std::string& path) {
  const std::vector<unsigned char> file = contents(path);
  const auto size = size_t(number_at<std::uint64_t>(file, 16)), name = size_t(number_at<std::uint32_t>(file, 16 + 136));
  const size_t at = 16 + 176 + name;
  std::vector<unsigned char> bytes(size);
  uLongf count = size;
  EXPECT_EQ(uncompress(bytes.data(), &count, &file[at + 8], number_at<std::uint64_t>(file, at)), Z_OK);
  return bytes;
}

// Damaged grids are read or refused, without any other failure; a sanitizer would find reads beyond the end.
TEST(NanoVdb, BelievesNoOffset) {
  const std::vector<unsigned char> good = unpacked(beside("rounded_fp8.nvdb"));
  expect_written(dense_grid(good), 0.51f * 143 / 255);
  const auto refused = [](const std::vector<unsigned char>& bytes) -> std::string {
    try {
      dense_grid(bytes);
      return "it was read";
    } catch (const Error& e) {
      return e.what();
    }
  };
  const size_t root = 672 + size_t(number_at<std::int64_t>(good, 672 + 24));
  for (const std::int64_t offset :
       {std::int64_t(-1), std::int64_t(1) << 40, INT64_MAX, INT64_MIN, std::int64_t(good.size()) - 100}) {
    std::vector<unsigned char> bad = good;
    put(bad, 672 + 24, offset);
    EXPECT_NE(refused(bad), "it was read");
    bad = good;
    put(bad, root + 64 + 8, offset);
    if (offset != -1) EXPECT_NE(refused(bad), "it was read") << offset;  // any position within the bytes may hold a node
  }
  std::vector<unsigned char> bad = good;
  put(bad, root + 24, std::uint32_t(-1));
  EXPECT_NE(refused(bad).find("beyond its end"), std::string::npos);
  bad = good;
  put(bad, root + 12, std::int32_t(INT32_MAX));
  put(bad, root + 16, std::int32_t(INT32_MAX));
  EXPECT_NE(refused(bad).find("at most"), std::string::npos);
  bad = good;
  put(bad, 384 + 8, 0.1);
  EXPECT_NE(refused(bad).find("turned"), std::string::npos);
  // Changes anywhere in the headers, the root and the entries in use, and truncation anywhere.
  std::mt19937 random(3);
  std::vector<size_t> used;
  for (size_t i = 0; i < good.size(); ++i)
    if (good[i] != 0 || i < root + 128) used.push_back(i);
  for (int trial = 0; trial < 400; ++trial) {
    bad = good;
    for (int change = 0; change < 3; ++change) bad[used[random() % used.size()]] = (unsigned char)random();
    for (int k = 0; k < 6; ++k) bad[root + 4 * size_t(k) + 1] = good[root + 4 * size_t(k) + 1];  // large boxes would take time
    for (int k = 0; k < 6; ++k) bad[root + 4 * size_t(k) + 2] = good[root + 4 * size_t(k) + 2];
    for (int k = 0; k < 6; ++k) bad[root + 4 * size_t(k) + 3] = good[root + 4 * size_t(k) + 3];
    if (trial % 4 == 0) bad.resize(random() % bad.size());
    refused(bad);
  }
}

}  // namespace
}  // namespace etendue::test
