// Types, interned strings, matrices and closures' text of the shading language.

#include "osl/values/closure.h"
#include "osl/values/interned_string.h"
#include "osl/values/triple.h"
#include "osl/values/type.h"

#include <gtest/gtest.h>

#include <thread>

namespace etendue::osl {

TEST(OslTypes, HaveTheSizesOfTheirParts) {
  EXPECT_EQ(Type(Base::color).size(), 12u);
  EXPECT_EQ(Type(Base::matrix, 3).size(), 192u);
  EXPECT_EQ(Type(Base::string).size(), sizeof(void*));
  EXPECT_EQ(Type::closure_color(2).size(), 2 * sizeof(void*));
  EXPECT_EQ(Type(Base::float_, Type::unsized).size(), 0u);
  EXPECT_EQ(Type(Base::color, 3).name(), "color[3]");
  EXPECT_EQ(Type::closure_color().name(), "closure color");
  EXPECT_FALSE(Type::closure_color().is_triple());
  EXPECT_TRUE(Type(Base::color, 3).float_based());
}

TEST(OslTypes, StructuresAreLaidOutWithNaturalAlignment) {
  StructType s{"Pair", {}};
  s.add("flag", Base::int_);
  s.add("name", Base::string);
  s.add("c", Base::color);
  EXPECT_EQ(s.find("name")->offset, 8u);
  EXPECT_EQ(s.find("c")->offset, 16u);
  EXPECT_EQ(s.size, 32u);
  EXPECT_EQ(s.find("none"), nullptr);
  StructType outer{"Outer", {}};
  outer.add("x", Base::float_);
  outer.add("pairs", Type::of(&s, 2));
  EXPECT_EQ(outer.find("pairs")->offset, 8u);
  EXPECT_EQ(outer.size, 72u);
}

TEST(OslStrings, AreTheSameWhateverThreadMadeThem) {
  std::array<std::vector<const String*>, 4> made;
  std::vector<std::jthread> threads;
  for (auto& list : made)
    threads.emplace_back([&list] {
      for (int i = 0; i < 1000; ++i) list.push_back(intern_string("osl test " + std::to_string(i)));
    });
  threads.clear();
  for (const auto& list : made) EXPECT_EQ(list, made[0]);
  EXPECT_EQ(made[0][7]->text(), "osl test 7");
  EXPECT_NE(made[0][7]->hash(), made[0][8]->hash());
  EXPECT_EQ(empty_string()->hash(), 0u);
}

TEST(OslMatrices, InverseAndDeterminant) {
  Matrix m;
  const float numbers[16] = {1, 2, 0, 0.5f, 0, 3, -1, 0, 4, 0, 1, 0, 0.25f, -2, 5, 1};
  for (int i = 0; i < 16; ++i) m.m[i / 4][i % 4] = numbers[i];
  Matrix inverse;
  ASSERT_TRUE(invert(m, inverse));
  const Matrix one = m * inverse;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) EXPECT_NEAR(one.m[i][j], i == j ? 1 : 0, 1e-6);
  EXPECT_NEAR(determinant(m) * determinant(inverse), 1, 1e-6);
  EXPECT_FLOAT_EQ(determinant(Matrix::diagonal(3)), 81);
  EXPECT_FALSE(invert(Matrix(), inverse));
  EXPECT_EQ(inverse, Matrix::identity());
  EXPECT_EQ(m / Matrix(), Matrix());
}

TEST(OslMatrices, PointsAreRows) {
  Matrix move = Matrix::identity();
  move.m[3][0] = 5;
  EXPECT_EQ(transform_point(move, {1, 2, 3}), Triple(6, 2, 3));
  EXPECT_EQ(transform_vector(move, {1, 2, 3}), Triple(1, 2, 3));
  Matrix stretch = Matrix::identity();
  stretch.m[0][0] = 2;
  // The normal of the plane x + y = 0 stays perpendicular to its vectors.
  EXPECT_FLOAT_EQ(dot(transform_normal(stretch, {1, 1, 0}), transform_vector(stretch, {1, -1, 0})), 0);
}

TEST(OslClosures, AreShownAsSums) {
  ClosureShape shape;
  shape.name = intern_string("phong");
  shape.add(Base::normal);
  shape.add(Base::float_);
  shape.add(Base::string, intern_string("label"));
  std::vector<std::byte> memory(shape.size);
  *reinterpret_cast<Triple*>(memory.data()) = {0, 0, 1};
  *reinterpret_cast<float*>(memory.data() + shape.arguments[1].offset) = 20;
  *reinterpret_cast<const String**>(memory.data() + shape.arguments[2].offset) = intern_string("coat");
  ClosureComponent phong;
  phong.kind = ClosureNode::Kind::component, phong.shape = &shape, phong.arguments = memory.data();
  ClosureProduct half;
  half.kind = ClosureNode::Kind::product, half.weight = {0.5f}, half.closure = &phong;
  ClosureSum sum;
  sum.kind = ClosureNode::Kind::sum, sum.a = &half, sum.b = &phong;
  ClosureProduct twice;
  twice.kind = ClosureNode::Kind::product, twice.weight = {2, 1, 1}, twice.closure = &sum;
  EXPECT_EQ(
      to_text(&twice),
      "(1, 0.5, 0.5) * phong ((0, 0, 1), 20, \"label\", \"coat\")\n\t+ (2, 1, 1) * phong ((0, 0, 1), 20, \"label\", \"coat\")");
  EXPECT_EQ(to_text(nullptr), "");
  ClosureShape plain;
  plain.name = intern_string("emission");
  phong.shape = &plain;
  EXPECT_EQ(to_text(&phong), "(1, 1, 1) * emission ()");
  plain.add(Base::normal);
  plain.name = intern_string("diffuse");
  EXPECT_EQ(to_text(&phong), "(1, 1, 1) * diffuse ((0, 0, 1), \"label\", \"\")");
}

}  // namespace etendue::osl
