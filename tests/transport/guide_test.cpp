// Guides: their pdfs integrate to one and are those of their samples; what they learn is compared with closed forms; their
// state is restored byte by byte or not at all.

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

/// The direction of a point of the unit square, by Lambert's equal-area map.
Vector3 direction_at(double x, double y) {
  const double z = 2 * x - 1, r = std::sqrt(1 - z * z);
  return {float(r * std::cos(2 * M_PI * y)), float(r * std::sin(2 * M_PI * y)), float(z)};
}

/// Lobes of all kinds: nearly uniform, wide, narrow; near, far and at infinity.
LobeMixture all_kinds() {
  LobeMixture m;
  const Point3 c{0.3f, -0.2f, 1};
  for (int i = 0; i < LobeMixture::size; ++i) {
    const auto f = float(i);
    m.set(c, i, {direction_at(0.1 + 0.11 * i, 0.37 * i), i % 3 ? 1 / (1 + f) : 0, 0.1f * std::pow(3.0f, f), (f + 1) / 36});
  }
  return m;
}

TEST(LobeMixture, its_pdf_integrates_to_one_and_is_that_of_its_samples) {
  for (const Point3& from : {Point3{0.3f, -0.2f, 1}, Point3{0, 0, 0}, Point3{1, 2, -1}}) {
    const SeenLobes lobes(all_kinds(), from);
    constexpr int fine = 1024, rows = 16, columns = 32;
    std::vector<double> expected(rows * columns, 0), seen(rows * columns, 0);
    double integral = 0;
    for (int i = 0; i < fine; ++i)
      for (int j = 0; j < fine; ++j) {
        const double p = double(lobes.pdf(direction_at((i + 0.5) / fine, (j + 0.5) / fine))) * 4 * M_PI / (fine * fine);
        integral += p;
        expected[size_t(i * rows / fine * columns + j * columns / fine)] += p;
      }
    EXPECT_NEAR(integral, 1, 2e-4);

    Random random(2);
    constexpr int samples = 200000;
    for (int n = 0; n < samples; ++n) {
      const float choice = random.next();
      const Vector3 d = lobes.sample(choice, random.pair());
      ASSERT_NEAR(length(d), 1, 1e-5f);
      double turn = std::atan2(double(d.y), double(d.x)) / (2 * M_PI);
      if (turn < 0) turn += 1;
      ++seen[size_t(std::min(int((double(d.z) + 1) / 2 * rows), rows - 1) * columns +
                    std::min(int(turn * columns), columns - 1))];
    }
    // Pearson's chi^2 over bins where ten samples are expected, the others together; by Wilson & Hilferty's approximation five
    // standard deviations, a probability of 3e-7.
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
  }
}

// The pdf is k / (4 pi sinh k) exp(k cos) (Fisher 1953); seen from another point, the lobe points at the same place.
TEST(LobeMixture, is_fishers_pdf_and_points_at_one_place_from_everywhere) {
  LobeMixture m;
  const Vector3 axis = normalize(Vector3{1, 2, 2});
  const float k = 12;
  m.set({1, 1, 1}, 3, {axis, 0.5f, k, 1});  // it is at (1, 1, 1) + 2 axis
  const SeenLobes here(m, {1, 1, 1});
  for (const float cosine : {1.0f, 0.9f, 0.3f, -0.5f}) {
    const Vector3 d = Frame(Normal3(axis)).to_world({std::sqrt(1 - cosine * cosine), 0, cosine});
    const double expected = 12 / (4 * M_PI * std::sinh(12.0)) * std::exp(12 * double(cosine));
    EXPECT_NEAR(here.pdf(d), expected, 2e-6 * 12 * expected);
  }
  const Point3 place = Point3{1, 1, 1} + 2 * axis, other{4, -2, 0.5f};
  const Vector3 way = place - other;
  const LobeMixture::Lobe lobe = m.seen_from(other, 3);
  EXPECT_LT(length(lobe.direction - normalize(way)), 1e-6f);
  EXPECT_NEAR(1 / lobe.nearness, length(way), 1e-4f);
  EXPECT_NEAR(lobe.concentration, k * length_squared(way) / 4, 1e-3f * lobe.concentration);
  EXPECT_NEAR(SeenLobes(m, other).pdf(lobe.direction), lobe.concentration / (2 * pi), 1e-3f * lobe.concentration);
  // A lobe at infinity is the same seen from everywhere.
  m.set({1, 1, 1}, 3, {axis, 0, k, 1});
  EXPECT_EQ(m.seen_from(other, 3).direction, axis);
  EXPECT_EQ(m.seen_from(other, 3).concentration, k);
}

/// Two round spots in the plane z = 0 that emit upwards, seen from all over a plane 1 m above: three quarters of the light, by
/// directions that choose both spots equally often, is from the first.
struct TwoSpots {
  static constexpr float radius = 0.15f;
  Point3 spot[2] = {{-0.6f, 0.4f, 0}, {0.8f, -0.5f, 0}};

  GuideSample sample(Random& random, const Guide& guide) const {
    GuideSample s;
    s.position = {3 * random.next() - 1.5f, 3 * random.next() - 1.5f, 1};
    s.region = guide.region_of(s.position, {0, 0, -1});
    const bool second = random.next() >= 0.5f;
    const float r = radius * std::sqrt(random.next()), turn = 2 * pi * random.next();
    const Point3 at = spot[second] + Vector3{r * std::cos(turn), r * std::sin(turn), 0};
    s.direction = normalize(at - s.position);
    s.nearness = 1 / distance(at, s.position);
    s.found = second ? 0.5f : 1.5f;
    s.scatter = 0.01f;
    return s;
  }
};

TEST(Guide, learns_two_spots_their_places_their_width_and_what_each_sends) {
  const TwoSpots scene;
  GuideSettings settings;
  settings.region_samples = 1e9f;  // one region that is never divided
  Guide guide(settings);
  Random random(5);
  for (int batch = 0; batch < 10; ++batch) {
    std::vector<GuideSample> samples;
    for (int i = 0; i < 2000; ++i) samples.push_back(scene.sample(random, guide));
    std::vector<const GuideSample*> all;
    for (const GuideSample& s : samples) all.push_back(&s);
    guide.learn(samples[0].region, all);
  }
  const Guide::Region& region = guide.at({0, 0, 1}, {0, 0, -1});
  for (const Point3& from : {Point3{0, 0, 1}, Point3{-1.2f, 1, 1}, Point3{1, -1, 1}}) {
    const SeenLobes lobes(region.lobes(), from);
    int at[2] = {0, 0};
    constexpr int n = 20000;
    Vector3 mean[2]{};
    for (int i = 0; i < n; ++i) {
      const float choice = random.next();
      const Vector3 d = lobes.sample(choice, random.pair());
      if (!(d.z < 0)) continue;
      const Point3 met = from + (-1 / d.z) * d;
      for (int k = 0; k < 2; ++k)
        if (distance(met, scene.spot[k]) < 3 * TwoSpots::radius) {
          ++at[k];
          mean[k] += met - scene.spot[k];
        }
    }
    // Nearly all samples lie within three radii of one spot or the other, in the proportion of their light.
    EXPECT_GT(at[0] + at[1], 0.85 * n);
    EXPECT_NEAR(at[0] / double(at[0] + at[1]), 0.75, 0.04);
    for (int k = 0; k < 2; ++k) EXPECT_LT(length(mean[k] / float(at[k])), 0.5f * TwoSpots::radius);
  }
  EXPECT_GT(region.share(), 0.8f);
}

TEST(Guide, samples_of_no_distance_or_no_number_spoil_nothing) {
  const TwoSpots scene;
  Guide guide(GuideSettings{});
  Random random(6);
  std::vector<GuideSample> samples;
  for (int i = 0; i < 100; ++i) samples.push_back(scene.sample(random, guide));
  samples[3].nearness = infinity;
  samples[5].found = std::numeric_limits<float>::quiet_NaN();
  samples[7].scatter = infinity;
  samples[9].direction.x = std::numeric_limits<float>::quiet_NaN();
  std::vector<const GuideSample*> all, sound;
  for (size_t i = 0; i < samples.size(); ++i) {
    all.push_back(&samples[i]);
    if (i > 9 || i % 2 == 0 || i == 1) sound.push_back(&samples[i]);
  }
  Guide other(GuideSettings{});
  guide.learn(samples[0].region, all);
  other.learn(samples[0].region, sound);
  EXPECT_EQ(guide.save(), other.save());
}

/// A lamp of 0.4 m by 0.4 m, 2 m over a floor of 2 m by 2 m. Training samples have points on the floor, and directions from the
/// guide or uniform ones, one batch after the other. Returns E[X^2] / E[X]^2 - 1 of the last batch.
struct LampOverFloor {
  GuideSettings settings;
  bool forgets_pdf = false;

  double learn(Guide& guide, int batches, std::vector<double>* means = nullptr) const {
    Random random(4);
    double mean = 0, square = 0;
    for (int batch = 0; batch < batches; ++batch) {
      mean = square = 0;
      std::vector<GuideSample> samples;
      constexpr int count = 60000;
      for (int i = 0; i < count; ++i) {
        GuideSample s;
        s.position = {2 * random.next() - 1, 2 * random.next() - 1, -1};
        s.region = guide.region_of(s.position, {0, 0, 1});
        const Guide::Region& region = guide.region(s.region);
        const SeenLobes lobes(region.lobes(), s.position);
        const float a = region.share();
        const float choice = random.next();
        if (choice < a)
          s.direction = lobes.sample(choice / a, random.pair());
        else
          s.direction = warp::hemisphere(random.pair());
        s.scatter = s.direction.z > 0 ? warp::hemisphere_pdf : 0;
        const float pdf = (a > 0 ? a * lobes.pdf(s.direction) : 0) + (1 - a) * s.scatter;
        const Point3 above = s.position + (2 / s.direction.z) * s.direction;
        s.nearness = s.direction.z / 2;
        const bool hit = s.direction.z > 0 && std::abs(above.x) < 0.2f && std::abs(above.y) < 0.2f;
        s.found = hit ? s.direction.z / pdf : 0;
        mean += double(s.found) / count;
        square += double(s.found) * double(s.found) / count;
        if (forgets_pdf) s.found *= pdf;
        samples.push_back(s);
      }
      if (means) means->push_back(mean);
      teach(guide, samples);
    }
    return square / (mean * mean) - 1;
  }

  static void teach(Guide& guide, const std::vector<GuideSample>& samples) {
    std::vector<std::vector<const GuideSample*>> by_region(guide.regions());
    for (const GuideSample& s : samples) by_region[s.region].push_back(&s);
    for (size_t r = 0; r < by_region.size(); ++r) guide.learn(std::uint32_t(r), by_region[r]);
    guide.divide();
  }
};

TEST(Guide, finds_a_lamp_and_means_stay_what_they_are) {
  const LampOverFloor scene;
  Guide guide(scene.settings);
  std::vector<double> means;
  const double before = scene.learn(guide, 1);
  const double after = scene.learn(guide, 6, &means);
  EXPECT_GT(before, 150);
  EXPECT_LT(after, 1.5);
  // The integral by quadrature: the mean over the floor of the lamp's solid angle weighted by the cosine.
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
  // A share is learned, and it is large under the lamp.
  EXPECT_GT(guide.at({0, 0, -1}, {0, 0, 1}).share(), 0.6f);
  EXPECT_EQ(guide.at({0, 0, -1}, {0, 0, -1}).share(), 0);  // no samples on the other side
}

// Training samples without the division by the pdf do not change the mean; the fault shows in the variance, by a worse guide.
TEST(Guide, a_pdf_forgotten_in_training_is_seen_in_the_variance) {
  LampOverFloor scene;
  Guide sound(scene.settings), faulty(scene.settings);
  const double right = scene.learn(sound, 6);
  scene.forgets_pdf = true;
  std::vector<double> means;
  const double wrong = scene.learn(faulty, 6, &means);
  EXPECT_GT(wrong, 1.4 * right);
  EXPECT_NEAR(means.back(), 0.0298, 0.1 * 0.0298);
}

TEST(Guide, keeps_to_its_memory) {
  LampOverFloor scene;
  scene.settings.memory = 50 << 10;
  scene.settings.region_samples = 1;
  Guide guide(scene.settings);
  scene.learn(guide, 9);
  EXPECT_GT(guide.regions(), 100u);
  EXPECT_LE(guide.bytes(), size_t(50) << 10);
  LampOverFloor free;
  free.settings.region_samples = 1;
  Guide other(free.settings);
  free.learn(other, 9);
  EXPECT_GT(other.bytes(), size_t(100) << 10);
}

TEST(Guide, comes_back_byte_by_byte_or_not_at_all) {
  const LampOverFloor scene;
  Guide guide(scene.settings);
  scene.learn(guide, 3);
  const std::vector<std::byte> bytes = guide.save();
  Guide other(scene.settings);
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
  EXPECT_EQ(other.save(), before);
}

}  // namespace

namespace checkpoint_test {
namespace {

// A room in an image of a few pixels, so that a step is short and all its paths are training paths.
std::string guided_room(const std::string& renderer) {
  return test::job_text(renderer, "PerspectiveCamera { from: [0, 0, 0] m, to: [0, 0, 1] m, fov: 60 deg }", 2,
                        "Sphere { radius: 1, shader: Lambertian { color: 0.7 } }\n"
                        "Sphere { centre: [0, 0.6, 0] m, radius: 0.1 m, emission: DiffuseEmission { radiance: 5 } }");
}

TEST_F(CheckpointTest, a_guide_is_the_same_for_any_number_of_threads_and_after_a_break) {
  struct Case {
    const char* renderer;
    int samples;
  };
  // Steps with merging have one sample per pixel, the others 256.
  for (const auto& [renderer, samples] :
       {Case{"GuidedPathTracer { max_depth: 6 }", 6 * 256},
        Case{"BidirectionalPathTracer { max_depth: 6, guided: true }", 6 * 256},
        Case{"VertexConnectionMerging { max_depth: 6, guided: true, photon_walks: 500 }", 6}}) {
    SCOPED_TRACE(renderer);
    const auto fresh = [&] { return job_of(guided_room(renderer), samples); };
    const auto one = rendered(fresh(), {.threads = 1});
    const auto two = rendered(fresh(), {.threads = 2});
    EXPECT_TRUE(film(*one) == film(*two));
    one->save(folder / "one");
    two->save(folder / "two");
    const std::vector<std::byte> guide = read_checkpoint(folder / "one").state.renderer;
    EXPECT_GT(guide.size(), 2000u);
    EXPECT_TRUE(guide == read_checkpoint(folder / "two").state.renderer);

    part(fresh(), "half", IndexRange{0, 3});
    const auto continued_one = continued(fresh(), folder / "half");
    EXPECT_TRUE(film(*continued_one) == film(*one));
    continued_one->save(folder / "again");
    EXPECT_TRUE(guide == read_checkpoint(folder / "again").state.renderer);
  }
}

}  // namespace
}  // namespace checkpoint_test
}  // namespace etendue
