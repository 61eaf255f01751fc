// What a film holds at the end of a step, within a step, and after a step was dropped.

#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <random>
#include <thread>

#include "etendue/film/film.h"
#include "film/exact_sums.h"
#include "support/filter_support.h"

namespace etendue {
namespace {

const Wavelengths wavelengths({450, 530, 600, 650}, {1 / 470.0f, 1 / 470.0f, 1 / 470.0f, 1 / 470.0f});

Ref<ImageBuffer> picture(int width, int height, const std::string& filter = "GaussianFilter") {
  auto image = make<ImageBuffer>();
  image->width = width;
  image->height = height;
  image->filter = test::make_filter(filter);
  image->layers = {"variance", "samples"};
  image->path_lengths = 2;
  image->prepare();
  return image;
}

/// Samples of all kinds for one pass, with values that differ by orders of magnitude; they depend on the pass only.
void add_pass(const ImageBuffer& image, Film& film, unsigned pass, std::uint32_t block = 0, int rows = 1 << 20,
              bool packed = false) {
  std::mt19937 random(pass);
  std::uniform_real_distribution<float> uniform(0, 1);
  const PixelArea& all = image.area();
  for (int y0 = all.y0; y0 < std::min(all.y1, all.y0 + rows); y0 += 4) {
    ImageTile tile;
    tile.keep_largest(film.largest_kept());
    tile.begin(image, {all.x0, y0, all.x1, std::min(y0 + 4, all.y1)}, block);
    for (int y = y0; y < std::min(y0 + 4, all.y1); ++y)
      for (int x = all.x0; x < all.x1; ++x) {
        const Point2 at{float(x) + uniform(random), float(y) + uniform(random)};
        const Spectrum value(uniform(random) * std::pow(10.0f, 12 * uniform(random) - 3));
        const std::array<Spectrum, 2> lengths = {value * 0.25f, value * 0.75f};
        tile.count_path();
        tile.contribute(at, x, y, pass, random() % 50 ? value : Spectrum(-1.0f), wavelengths, random() % 9 ? 1.0f : 1.3f,
                        lengths);
        for (unsigned i = random() % 4; i > 0; --i)
          tile.splat({float(all.x1) * uniform(random), float(all.y1) * uniform(random)}, x, y, pass, value, wavelengths,
                     int(1 + i));
      }
    if (packed) {
      std::vector<std::byte> bytes;
      tile.pack(bytes);
      std::span<const std::byte> rest(bytes);
      film.unpack(rest, tile);
      EXPECT_TRUE(rest.empty());
    }
    film.merge(tile);
  }
}

void add_step(const ImageBuffer& image, Film& film, unsigned pass) {
  add_pass(image, film, pass);
  film.end_step();
}

bool same(const Image& a, const Image& b) {
  return a.channels == b.channels && std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(double)) == 0;
}

void expect_same(const Film& a, const Film& b) {
  EXPECT_TRUE(a.save_state() == b.save_state());
  EXPECT_TRUE(same(a.develop(), b.develop()));
  EXPECT_EQ(a.samples(), b.samples());
  EXPECT_EQ(a.bad_samples(), b.bad_samples());
  const auto largest = a.largest_samples(), others = b.largest_samples();
  ASSERT_EQ(largest.size(), others.size());
  for (size_t i = 0; i < largest.size(); ++i) EXPECT_EQ(largest[i].luminance, others[i].luminance);
}

// Steps added in three orders, all to one film or to parts that are merged in different orders.
TEST(FilmSteps, PackedTilesGiveTheSameBytes) {
  const Ref<ImageBuffer> image = picture(19, 13);
  Film direct(*image), packed(*image);
  for (Film* film : {&direct, &packed}) film->keep_largest(5);
  for (unsigned pass = 0; pass < 3; ++pass) {
    add_pass(*image, direct, pass);
    add_pass(*image, packed, pass, 0, 1 << 20, true);
    direct.end_step();
    packed.end_step();
  }
  expect_same(packed, direct);
}

TEST(FilmSteps, PackedTilesOfAnotherPictureOrCutOffAreRefused) {
  const Ref<ImageBuffer> image = picture(19, 13), smaller = picture(8, 8);
  Film film(*image), other(*smaller);
  ImageTile tile, read;
  tile.begin(*image, {0, 0, 16, 13});
  tile.contribute({3, 4}, 3, 4, 0, Spectrum(1.0f), wavelengths, 1, std::array{Spectrum(0.5f), Spectrum(0.5f)});
  std::vector<std::byte> bytes;
  tile.pack(bytes);
  for (size_t size = 0; size < bytes.size(); size += 97) {
    std::span<const std::byte> some(bytes.data(), size);
    EXPECT_THROW(film.unpack(some, read), Error) << size;
  }
  std::span<const std::byte> all(bytes);
  EXPECT_THROW(other.unpack(all, read), Error);
}

TEST(FilmSteps, any_order_and_division_gives_the_same_bits) {
  for (const Estimator estimator : {Estimator::independent, Estimator::correlated}) {
    const Ref<ImageBuffer> image = picture(13, 10);
    Film straight(*image, estimator);
    for (unsigned pass = 0; pass < 12; ++pass) add_step(*image, straight, pass);
    std::mt19937 random(3);
    std::vector<unsigned> order = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
    for (int run = 0; run < 3; ++run) {
      std::ranges::shuffle(order, random);
      Film shuffled(*image, estimator), merged(*image, estimator);
      std::vector<std::vector<std::byte>> parts;
      for (size_t i = 0; i < order.size(); i += 3) {
        Film part(*image, estimator);
        for (size_t k = i; k < i + 3; ++k) {
          add_step(*image, shuffled, order[k]);
          add_step(*image, part, order[k]);
        }
        parts.push_back(part.save_state());
      }
      expect_same(shuffled, straight);
      std::ranges::shuffle(parts, random);
      for (const auto& part : parts) merged.add_state(part);
      expect_same(merged, straight);
    }
  }
}

TEST(FilmSteps, a_dropped_step_leaves_nothing) {
  for (const Estimator estimator : {Estimator::independent, Estimator::correlated}) {
    const Ref<ImageBuffer> image = picture(13, 10);
    Film film(*image, estimator), other(*image, estimator);
    for (Film* f : {&film, &other}) f->keep_largest(3);
    film.drop_step();
    for (unsigned pass = 0; pass < 4; ++pass) add_step(*image, film, pass), add_step(*image, other, pass);
    const std::vector<std::byte> state = film.save_state();
    // One block, several blocks, and a part of the picture only.
    for (int blocks = 0; blocks <= 2; ++blocks) {
      for (int block = 0; block < blocks; ++block) add_pass(*image, film, unsigned(50 + block), std::uint32_t(block));
      add_pass(*image, film, 77, 9, 4);
      EXPECT_GT(film.samples(), other.samples());
      EXPECT_TRUE(film.save_state() == state);  // the state at the end of the last step
      film.drop_step();
      expect_same(film, other);
    }
    add_step(*image, film, 8);
    add_step(*image, other, 8);
    expect_same(film, other);
  }
}

// A part that is added while a step is open is not dropped with the step.
TEST(FilmSteps, another_part_may_come_in_the_middle_of_a_step) {
  const Ref<ImageBuffer> image = picture(7, 5);
  Film film(*image), part(*image), straight(*image);
  add_step(*image, part, 1);
  add_pass(*image, film, 50, 0);
  add_pass(*image, film, 51, 1);
  film.add_state(part.save_state());
  film.drop_step();
  expect_same(film, part);
  add_pass(*image, film, 2);
  film.add_state(part.save_state());
  film.end_step();
  for (const unsigned pass : {1u, 2u, 1u}) add_step(*image, straight, pass);
  expect_same(film, straight);
}

// The sums treat each block of a step like a step of its own: the result is as if each had been ended separately.
TEST(FilmSteps, blocks_of_a_step_are_summed_like_steps) {
  const Ref<ImageBuffer> image = picture(9, 9, "BoxFilter");
  Film blocks(*image), steps(*image);
  for (unsigned pass = 0; pass < 5; ++pass) {
    add_pass(*image, blocks, pass, pass);
    add_step(*image, steps, pass);
  }
  blocks.end_step();
  expect_same(blocks, steps);
}

// Tiles that have been merged so far are divided by their own numbers of samples: constant light stays constant although other
// tiles are still missing.
TEST(FilmSteps, pictures_in_the_middle_of_a_step) {
  auto image = make<ImageBuffer>();
  image->width = image->height = 16;
  image->filter = test::make_filter("BoxFilter");
  image->layers = {"samples"};
  image->prepare();
  Film film(*image);
  const auto add = [&](const PixelArea& area) {
    ImageTile tile;
    tile.begin(*image, area);
    for (int y = area.y0; y < area.y1; ++y)
      for (int x = area.x0; x < area.x1; ++x)
        tile.contribute({float(x) + 0.5f, float(y) + 0.5f}, x, y, 0, Spectrum(2.0f), wavelengths);
    film.merge(tile);
  };
  add(image->area());
  add(image->area());
  film.end_step();
  add({0, 0, 16, 8});
  const FilmSnapshot held = film.snapshot();
  const Image now = held.develop();
  const double expected = to_xyz(Spectrum(2.0f), wavelengths).y;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      EXPECT_NEAR(now.at(x, y, 1), expected, 1e-12);
      EXPECT_EQ(now.at(x, y, 3), y < 8 ? 3 : 2);
    }
  film.clear();
  EXPECT_TRUE(same(held.develop(), now));  // a snapshot does not change with the film
  EXPECT_EQ(film.develop().at(3, 3, 1), 0);
}

/// A filter whose weights times a large spectrum overflow a float, as a plugin's could.
class HugeFilter final : public Filter {
 public:
  float weight(float, float) const override { return 4; }
  float radius() const override { return 0.75f; }
};

TEST(FilmSteps, what_cannot_be_summed_is_an_error_that_says_where) {
  auto image = make<ImageBuffer>();
  image->width = image->height = 8;
  image->filter = Ref<Filter>(new HugeFilter);
  image->prepare();
  Film film(*image);
  ImageTile tile;
  const auto add = [&](float weight) {
    tile.begin(*image, image->area());
    tile.contribute({5.5f, 2.5f}, 5, 2, 0, Spectrum(1e30f), wavelengths, weight);
    film.merge(tile);
  };
  add(1e30f);  // about 1e62, and squared
  film.end_step();
  EXPECT_GT(film.develop().at(5, 2, 1), 1e29);
  const std::vector<std::byte> before = film.save_state();
  std::string message;
  try {
    add(2e38f);
  } catch (const Error& error) {
    message = error.what();
  }
  EXPECT_NE(message.find("the light of pixel 5,2 adds up to"), std::string::npos) << message;
  film.drop_step();
  EXPECT_TRUE(film.save_state() == before);
}

TEST(FilmSteps, too_many_steps_and_impossible_states_are_refused) {
  const Ref<ImageBuffer> image = picture(3, 2);
  Film film(*image);
  add_step(*image, film, 1);
  std::vector<std::byte> state = film.save_state();
  // The state begins with the magic number, eight numbers of the picture and the filter's hash; then the steps follow.
  const size_t at = 8 + 8 * 4 + 8;
  std::uint32_t steps = 0;
  std::memcpy(&steps, &state[at], sizeof steps);
  ASSERT_EQ(steps, 1u);
  steps = ExactSums::most_addends;
  std::memcpy(&state[at], &steps, sizeof steps);
  Film full(*image);
  full.load_state(state);
  add_pass(*image, full, 2);
  EXPECT_THROW(full.end_step(), Error);
  full.drop_step();
  EXPECT_TRUE(full.save_state() == state);
  EXPECT_THROW(full.add_state(film.save_state()), Error);
  EXPECT_TRUE(full.save_state() == state);
  steps = 0;
  std::memcpy(&state[at], &steps, sizeof steps);
  EXPECT_THROW(film.load_state(state), Error);  // sums of no step
  steps = ExactSums::most_addends + 1;
  std::memcpy(&state[at], &steps, sizeof steps);
  EXPECT_THROW(film.load_state(state), Error);
}

// Snapshots from another thread while tiles are merged and steps are ended and dropped: each snapshot holds complete rows.
TEST(FilmSteps, snapshots_from_another_thread_are_consistent) {
  auto image = make<ImageBuffer>();
  image->width = 16, image->height = 32;
  image->layers = {"samples"};
  image->filter = test::make_filter("BoxFilter");
  image->prepare();
  Film film(*image);
  std::atomic<bool> going{true};
  std::atomic<int> taken{0};
  std::thread watcher([&] {
    while (going) {
      const FilmSnapshot snapshot = film.snapshot();
      const Image now = snapshot.develop();
      double count = 0;
      for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 16; ++x) {
          count += now.at(x, y, 3);
          EXPECT_EQ(now.at(x, y, 3), now.at(0, y / 8 * 8, 3));
          EXPECT_TRUE(now.at(x, y, 3) == 0 || std::abs(now.at(x, y, 1) - now.at(0, 0, 1)) < 1e-9);
        }
      }
      EXPECT_EQ(count, double(snapshot.samples()));
      EXPECT_GE(film.relative_error(), 0);
      film.save_state();
      ++taken;
    }
  });
  for (int step = 0; step < 400 || taken < 20; ++step) {
    for (int y0 = 0; y0 < 32; y0 += 8) {
      ImageTile tile;
      tile.begin(*image, {0, y0, 16, y0 + 8}, unsigned(step % 3));
      for (int y = y0; y < y0 + 8; ++y)
        for (int x = 0; x < 16; ++x) {
          tile.count_path();
          tile.contribute({float(x) + 0.5f, float(y) + 0.5f}, x, y, 0, Spectrum(1.0f), wavelengths);
        }
      film.merge(tile);
    }
    if (step % 5 == 4)
      film.drop_step();
    else if (step % 2)
      film.end_step();
    if (step % 100 == 99) film.clear();
  }
  going = false;
  watcher.join();
}

}  // namespace
}  // namespace etendue
