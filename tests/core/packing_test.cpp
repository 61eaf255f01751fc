// Values as bytes, and back.

#include "etendue/core/packing.h"

#include <gtest/gtest.h>

#include <string>

namespace etendue {
namespace {

/// Not trivially copyable: it has a packing of its own.
struct Named {
  std::string name;
  int number = 0;
  bool operator==(const Named&) const = default;

  void pack(std::vector<std::byte>& to) const {
    Packing::pack(to, std::vector<char>(name.begin(), name.end()));
    Packing::pack(to, number);
  }
  static Named unpack(std::span<const std::byte>& from) {
    std::vector<char> letters;
    Named named;
    Packing::unpack(from, letters);
    Packing::unpack(from, named.number);
    named.name.assign(letters.begin(), letters.end());
    return named;
  }
};

static_assert(packable<double> && packable<std::vector<double>> && packable<std::vector<std::vector<Named>>>);
static_assert(!packable<const int*> && !packable<std::string> && !packable<std::vector<std::string>>);

TEST(Packing, ValuesComeBackInOrder) {
  const std::vector<std::vector<float>> lists{{1, 2.5f}, {}, {-3}};
  const std::vector<Named> names{{"one", 1}, {"", 2}};
  std::vector<std::byte> bytes;
  Packing::pack(bytes, lists);
  Packing::pack(bytes, names);
  Packing::pack(bytes, 7);
  std::span<const std::byte> rest(bytes);
  std::vector<std::vector<float>> lists_again;
  std::vector<Named> names_again;
  int seven = 0;
  Packing::unpack(rest, lists_again);
  Packing::unpack(rest, names_again);
  Packing::unpack(rest, seven);
  EXPECT_EQ(lists_again, lists);
  EXPECT_EQ(names_again, names);
  EXPECT_EQ(seven, 7);
  EXPECT_TRUE(rest.empty());
}

TEST(Packing, BytesThatEndTooEarlyAreRefused) {
  std::vector<std::byte> bytes;
  Packing::pack(bytes, std::vector<double>{1, 2, 3});
  for (size_t size = 0; size < bytes.size(); ++size) {
    std::span<const std::byte> some(bytes.data(), size);
    std::vector<double> values;
    EXPECT_THROW(Packing::unpack(some, values), Error) << size;
  }
  // A length that no memory holds is refused before anything is allocated.
  std::vector<std::byte> long_list;
  Packing::pack(long_list, ~std::uint64_t(0));
  std::span<const std::byte> from(long_list);
  std::vector<Named> values;
  EXPECT_THROW(Packing::unpack(from, values), Error);
}

}  // namespace
}  // namespace etendue
