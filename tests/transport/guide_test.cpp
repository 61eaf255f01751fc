// What guides learn, held against what is known of directions: densities that integrate to one and are those of the samples,
// optima in closed form, states that come back byte by byte or not at all.

#include "etendue/guiding/guide.h"

#include <gtest/gtest.h>

#include <random>

#include "etendue/core/error.h"
#include "etendue/core/warp.h"
#include "support/checkpoint_test_support.h"

namespace etendue {
namespace {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  float next() { return float(engine_() >> 8) * 0x1p-24f; }
  Point2 pair() {
    const float x = next();
    return {x, next()};
  }

 private:
  std::mt19937 engine_;
};

/// Learned, in five rounds of uniform samples, from a lobe around an axis.
DirectionTree lobe_tree(const Vector3& axis) {
  Random random(1);
  DirectionTree tree;
  for (int round = 0; round < 5; ++round) {
    for (int i = 0; i < 50000; ++i) {
      const Vector3 d = warp::sphere(random.pair());
      tree.add(d, std::exp(20 * (double(dot(d, axis)) - 1)), random.pair());
    }
    EXPECT_TRUE(tree.refine(GuideTarget::mean, 0.01f, 100000));
  }
  return tree;
}

/// A direction of the unit square, by the map that is stated.
Vector3 direction_at(double x, double y) {
  const double z = 2 * x - 1, r = std::sqrt(1 - z * z);
  return {float(r * std::cos(2 * M_PI * y)), float(r * std::sin(2 * M_PI * y)), float(z)};
}

TEST(DirectionTree, its_density_integrates_to_one_and_is_that_of_its_samples) {
  const Vector3 axis = normalize(Vector3{1, 2, 2});
  const DirectionTree tree = lobe_tree(axis);
  constexpr int fine = 512, rows = 16, columns = 32;
  std::vector<double> expected(rows * columns, 0), seen(rows * columns, 0);
  double integral = 0;
  for (int i = 0; i < fine; ++i)
    for (int j = 0; j < fine; ++j) {
      const double p = double(tree.density(direction_at((i + 0.5) / fine, (j + 0.5) / fine))) * 4 * M_PI / (fine * fine);
      integral += p;
      expected[size_t(i * rows / fine * columns + j * columns / fine)] += p;
    }
  EXPECT_NEAR(integral, 1, 1e-5);

  Random random(2);
  constexpr int samples = 200000;
  for (int n = 0; n < samples; ++n) {
    float density = 0;
    const Vector3 d = tree.sample(random.pair(), density);
    ASSERT_NEAR(length(d), 1, 1e-5f);
    if (n % 64 == 0) {
      EXPECT_NEAR(density, tree.density(d), 1e-4f * density);
    }
    double turn = std::atan2(double(d.y), double(d.x)) / (2 * M_PI);
    if (turn < 0) turn += 1;
    ++seen[size_t(std::min(int((double(d.z) + 1) / 2 * rows), rows - 1) * columns +
                  std::min(int(turn * columns), columns - 1))];
  }
  // Pearson's chi^2 over bins where ten are expected, the others together; by Wilson & Hilferty's approximation five standard
  // deviations, that is 3e-7.
  double chi = 0, rest = 0, rest_seen = 0;
  int bins = 0;
  for (size_t b = 0; b < seen.size(); ++b) {
    const double e = expected[b] * samples;
    if (e < 10) {
      rest += e;
      rest_seen += seen[b];
      continue;
    }
    chi += (seen[b] - e) * (seen[b] - e) / e;
    ++bins;
  }
  EXPECT_NEAR(rest_seen, rest, 5 * std::sqrt(rest) + 1);
  EXPECT_GT(bins, 30);
  const double k = bins, z = (std::cbrt(chi / k) - (1 - 2 / (9 * k))) / std::sqrt(2 / (9 * k));
  EXPECT_LT(z, 5) << chi << " of " << bins;
  // And it is the lobe, whose density has the value 20 / (2 pi) on its axis.
  EXPECT_NEAR(tree.density(axis), 20 / (2 * M_PI), 0.8);
}

// Above the equator every sample brings 1, below one in four brings 4: the same mean, twice the root of the mean square.
TEST(DirectionTree, follows_the_mean_or_the_root_of_the_second_moment) {
  for (const GuideTarget target : {GuideTarget::mean, GuideTarget::second_moment}) {
    Random random(3);
    DirectionTree tree;
    for (int i = 0; i < 100000; ++i) {
      const Vector3 d = warp::sphere(random.pair());
      const double found = d.z > 0 ? 1 : random.next() < 0.25f ? 4 : 0;
      tree.add(d, target == GuideTarget::mean ? found : found * found, {0.5f, 0.5f});
    }
    ASSERT_TRUE(tree.refine(target, 0.01f, 1000));
    const Vector3 up = normalize(Vector3{1, 1, 1}), down = normalize(Vector3{1, 1, -1});
    EXPECT_NEAR(tree.density(down) / tree.density(up), target == GuideTarget::mean ? 1 : 2, 0.06);
  }
}

/// A lamp of 0.4 m by 0.4 m, 2 m over a floor of 2 m by 2 m: places on the floor, directions by a guide and by chance, one
/// round after the other. Returns E[X^2] / E[X]^2 - 1 of the last round.
struct LampOverFloor {
  GuideSettings settings;
  bool forgets_density = false;

  double learn(Guide& guide, int rounds, std::vector<double>* means = nullptr) const {
    Random random(4);
    double mean = 0, square = 0;
    for (int round = 0; round < rounds; ++round) {
      mean = square = 0;
      std::vector<GuideSample> samples;
      const int count = 30000 << round;
      for (int i = 0; i < count; ++i) {
        GuideSample s;
        s.position = {2 * random.next() - 1, 2 * random.next() - 1, -1};
        s.normal = {0, 0, 1};
        const Guide::Region& region = guide.at(s.position, s.normal);
        const float a = region.share();
        if (random.next() < a)
          s.direction = region.directions().sample(random.pair(), s.guide);
        else
          s.direction = warp::hemisphere(random.pair());
        s.guide = a > 0 ? region.directions().density(s.direction) : -1;
        s.scatter = s.direction.z > 0 ? warp::hemisphere_density : 0;
        s.density = a * std::max(s.guide, 0.0f) + (1 - a) * s.scatter;
        const Point3 above = s.position + (2 / s.direction.z) * s.direction;
        const bool hit = s.direction.z > 0 && std::abs(above.x) < 0.2f && std::abs(above.y) < 0.2f;
        s.found = hit ? s.direction.z / s.density : 0;
        mean += double(s.found) / count;
        square += double(s.found) * double(s.found) / count;
        if (forgets_density) s.found *= s.density;
        samples.push_back(s);
      }
      if (means) means->push_back(mean);
      teach(guide, samples);
    }
    return square / (mean * mean) - 1;
  }

  static void teach(Guide& guide, const std::vector<GuideSample>& samples) {
    std::vector<std::vector<const GuideSample*>> by_region(guide.regions());
    for (const GuideSample& s : samples) by_region[guide.region_for(s)].push_back(&s);
    for (size_t r = 0; r < by_region.size(); ++r) guide.learn(std::uint32_t(r), by_region[r], GuideTarget::second_moment);
    guide.refine(GuideTarget::second_moment);
  }
};

TEST(Guide, finds_a_lamp_and_means_stay_what_they_are) {
  const LampOverFloor scene;
  Guide guide({0, 0, 0}, 1, scene.settings);
  std::vector<double> means;
  const double before = scene.learn(guide, 1);
  const double after = scene.learn(guide, 6, &means);
  EXPECT_GT(before, 150);
  EXPECT_LT(after, 15);
  // The integral, by quadrature: the mean over the floor of the lamp's solid angle weighted by the cosine.
  double expected = 0;
  constexpr int n = 40;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < 10; ++k)
        for (int l = 0; l < 10; ++l) {
          const double x = 2 * (i + 0.5) / n - 1 - (0.4 * (k + 0.5) / 10 - 0.2),
                       y = 2 * (j + 0.5) / n - 1 - (0.4 * (l + 0.5) / 10 - 0.2);
          const double d2 = x * x + y * y + 4;
          expected += 4 / (d2 * d2) * 0.0016 / (n * n);
        }
  for (const double mean : means) EXPECT_NEAR(mean, expected, 0.08 * expected);  // of the first: sqrt(210 / 30000) = 8 %
  EXPECT_NEAR(means.back(), expected, 0.02 * expected);
  // A share was learned, and it is a large one under the lamp.
  EXPECT_GT(guide.at({0, 0, -1}, {0, 0, 1}).share(), 0.6f);
  EXPECT_EQ(guide.at({0, 0, -1}, {0, 0, -1}).share(), 0);  // nobody came to the other side
}

// Samples that are not divided by their density leave the mean as it is: it is seen by what the guide is worth.
TEST(Guide, a_density_forgotten_in_training_is_seen_in_the_variance) {
  LampOverFloor scene;
  Guide sound({0, 0, 0}, 1, scene.settings), faulty({0, 0, 0}, 1, scene.settings);
  const double right = scene.learn(sound, 6);
  scene.forgets_density = true;
  std::vector<double> means;
  const double wrong = scene.learn(faulty, 6, &means);
  EXPECT_GT(wrong, 1.4 * right);
  EXPECT_NEAR(means.back(), 0.0298, 0.1 * 0.0298);
}

TEST(Guide, keeps_to_its_memory) {
  LampOverFloor scene;
  scene.settings.memory = 200 << 10;
  scene.settings.region_samples = 8;
  Guide guide({0, 0, 0}, 1, scene.settings);
  scene.learn(guide, 6);
  EXPECT_GT(guide.regions(), 20u);
  EXPECT_LE(guide.bytes(), size_t(300) << 10);  // nodes, and what regions take besides
  LampOverFloor free;
  free.settings.region_samples = 8;
  Guide other({0, 0, 0}, 1, free.settings);
  free.learn(other, 6);
  EXPECT_GT(other.bytes(), size_t(400) << 10);
}

TEST(Guide, comes_back_byte_by_byte_or_not_at_all) {
  const LampOverFloor scene;
  Guide guide({0, 0, 0}, 1, scene.settings);
  scene.learn(guide, 3);
  const std::vector<std::byte> bytes = guide.save();
  Guide other({0, 0, 0}, 1, scene.settings);
  other.load(bytes);
  EXPECT_EQ(other.save(), bytes);
  scene.learn(guide, 1);
  scene.learn(other, 1);
  EXPECT_EQ(other.save(), guide.save());

  const std::vector<std::byte> before = other.save();
  for (size_t n = 0; n < bytes.size(); n += 1 + bytes.size() / 200) {
    std::vector<std::byte> damaged = bytes;
    damaged[n] ^= std::byte{4};
    EXPECT_THROW(other.load(damaged), Error) << n;
    EXPECT_THROW(other.load(std::span(bytes).first(n)), Error) << n;
  }
  Guide elsewhere({0, 0, 1}, 1, scene.settings);
  EXPECT_THROW(elsewhere.load(bytes), Error);
  EXPECT_EQ(other.save(), before);
}

}  // namespace

namespace checkpoint_test {
namespace {

// A room seen by two pixels, so that steps are few; every sample is one the guide learned from.
std::string guided_room() {
  return test::job_text("GuidedPathTracer { max_depth: 6 }",
                        "PerspectiveCamera { from: [0, 0, 0] m, to: [0, 0, 1] m, fov: 60 deg }", 2,
                        "Sphere { radius: 1, shader: Lambertian { color: 0.7 } }\n"
                        "Sphere { centre: [0, 0.6, 0] m, radius: 0.1 m, emission: DiffuseEmission { radiance: 5 } }");
}

TEST_F(CheckpointTest, a_guide_is_the_same_for_any_number_of_threads_and_after_a_break) {
  const auto fresh = [] { return job_of(guided_room(), 6 * 2048); };
  const auto one = rendered(fresh(), {.threads = 1});
  const auto two = rendered(fresh(), {.threads = 2});
  EXPECT_TRUE(film(*one) == film(*two));
  one->save(folder / "one");
  two->save(folder / "two");
  const std::vector<std::byte> guide = read_checkpoint(folder / "one").state.renderer;
  EXPECT_GT(guide.size(), 3000u);
  EXPECT_TRUE(guide == read_checkpoint(folder / "two").state.renderer);

  part(fresh(), "half", IndexRange{0, 3});
  const auto continued_one = continued(fresh(), folder / "half");
  EXPECT_TRUE(film(*continued_one) == film(*one));
  continued_one->save(folder / "again");
  EXPECT_TRUE(guide == read_checkpoint(folder / "again").state.renderer);
}

}  // namespace
}  // namespace checkpoint_test
}  // namespace etendue
