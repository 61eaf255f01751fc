// A tree of points: its queries find the same points as a search through all of them.

#include "etendue/transport/point_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace etendue {
namespace {

std::vector<Point3> some_points(size_t count, bool with_twins) {
  std::mt19937 random(unsigned(count) + 7);
  std::uniform_real_distribution<float> u(-1, 1);
  std::vector<Point3> points;
  for (size_t i = 0; i < count; ++i)
    points.push_back(with_twins && i % 3 == 1 ? points[i / 2] : Point3{u(random), 0.1f * u(random), u(random)});
  return points;
}

TEST(PointTree, finds_all_within_a_distance_and_the_nearest) {
  for (const size_t count : {0u, 1u, 8u, 9u, 17u, 1000u, 70000u})
    for (const bool with_twins : {false, true}) {
      const std::vector<Point3> points = some_points(count, with_twins);
      PointTree tree;
      const std::vector<std::uint32_t> order = tree.build(points);
      ASSERT_EQ(order.size(), count);
      std::vector<std::uint32_t> sorted = order;
      std::ranges::sort(sorted);
      for (size_t i = 0; i < count; ++i) ASSERT_EQ(sorted[i], i);
      for (size_t i = 0; i < count; ++i) ASSERT_EQ(tree[i], points[order[i]]);

      std::mt19937 random(3);
      std::uniform_real_distribution<float> u(-1.2f, 1.2f);
      for (int n = 0; n < 20; ++n) {
        const Point3 p{u(random), 0.1f * u(random), u(random)};
        const float radius = n % 2 ? 0.05f : 0.6f;
        std::vector<std::uint32_t> found, truth;
        tree.within(p, radius, [&](std::uint32_t i, float d2) {
          EXPECT_EQ(d2, length_squared(tree[i] - p));
          found.push_back(order[i]);
        });
        std::vector<std::pair<float, std::uint32_t>> by_distance;
        for (std::uint32_t i = 0; i < count; ++i)
          if (const float d2 = length_squared(points[i] - p); d2 < radius * radius) {
            truth.push_back(i);
            by_distance.emplace_back(d2, i);
          }
        std::ranges::sort(found);
        EXPECT_EQ(found, truth);

        constexpr size_t wanted = 12;
        std::vector<PointTree::Near> near;
        tree.nearest(p, radius, wanted, near);
        ASSERT_EQ(near.size(), std::min(wanted, truth.size()));
        std::sort_heap(near.begin(), near.end());
        std::ranges::sort(by_distance);
        for (size_t k = 0; k < near.size(); ++k) EXPECT_EQ(near[k].squared, by_distance[k].first);
        // Points near a line, which is sometimes parallel to an axis.
        const Vector3 direction = n % 5 == 0 ? Vector3{0, 0, 1} : normalize(Vector3{u(random), u(random), u(random)});
        const float reach = n % 3 == 0 ? 0.7f : infinity;
        std::vector<std::uint32_t> passed, near_line;
        tree.along(p, direction, reach, 0.1f, [&](std::uint32_t i, float t) {
          EXPECT_EQ(t, dot(tree[i] - p, direction));
          passed.push_back(order[i]);
        });
        for (std::uint32_t i = 0; i < count; ++i) {
          const float t = dot(points[i] - p, direction);
          if (t > 0 && t < reach && length_squared(points[i] - p - t * direction) < square(0.1f)) near_line.push_back(i);
        }
        std::ranges::sort(passed);
        EXPECT_EQ(passed, near_line);
      }
    }
}

}  // namespace
}  // namespace etendue
