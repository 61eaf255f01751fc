#include "describe/guard.h"

#include <gtest/gtest.h>

#include <new>

namespace etendue {
namespace {

template <class T>
std::vector<Error> errors_of(const T& thrown) {
  try {
    throw thrown;
  } catch (...) {
    return thrown_errors();
  }
}

TEST(ThrownErrors, are_those_of_the_exception_with_their_locations) {
  const Location place{"a.etd", 3, 4};
  const std::vector<Error> one = errors_of(Error("first", place));
  ASSERT_EQ(one.size(), 1u);
  EXPECT_STREQ(one[0].what(), "first");
  EXPECT_EQ(one[0].location, place);
  const std::vector<Error> two = errors_of(Errors({Error("first"), Error("second", place)}));
  ASSERT_EQ(two.size(), 2u);
  EXPECT_STREQ(two[1].what(), "second");
  EXPECT_EQ(two[1].location, place);
}

TEST(ThrownErrors, describe_other_exceptions) {
  const std::vector<Error> memory = errors_of(std::bad_alloc());
  ASSERT_EQ(memory.size(), 1u);
  EXPECT_STREQ(memory[0].what(), "there is not enough memory");
  const std::vector<Error> number = errors_of(7);
  ASSERT_EQ(number.size(), 1u);
  EXPECT_STREQ(number[0].what(), "an exception of type int");
}

}  // namespace
}  // namespace etendue
