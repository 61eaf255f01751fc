// Facilities of render processes with a state: records that paths leave, wavelengths shared by a whole step, and chains that
// are saved.

#include <gtest/gtest.h>

#include <cstring>

#include "etendue/transport/primary_sample_vectors.h"
#include "support/checkpoint_test_support.h"

namespace etendue::checkpoint_test {
namespace {

/// Returns radiance 1, adds one record per path, and gives all paths of a step the same wavelengths.
class NotingProcess final : public RenderProcess {
 public:
  using RenderProcess::RenderProcess;
  void step(Schedule& schedule, const Step& step) override {
    const std::vector<float> heroes = film_paths<float>(schedule, step);
    noted.insert(noted.end(), heroes.begin(), heroes.end());
  }
  Spectrum radiance(const Ray&, SampleContext& sample) const override {
    sample.sink.records.add(sample.wavelengths[0] + sample.numbers.next());
    return Spectrum(1.0f);
  }
  Wavelengths wavelengths(SampleKey, float) const override { return context.wavelengths.sample(SampleKey(1, 2, 3, 4), 0.5f); }
  std::vector<std::byte> save_state() const override {
    const auto bytes = std::as_bytes(std::span(noted));
    return {bytes.begin(), bytes.end()};
  }
  void load_state(std::span<const std::byte> bytes) override {
    noted.resize(bytes.size() / sizeof(float));
    std::memcpy(noted.data(), bytes.data(), noted.size() * sizeof(float));
  }
  std::vector<float> noted;
};

class NotingRenderer final : public Renderer {
 public:
  static void describe(Description<NotingRenderer>& d) { d.summary("For tests: notes something of each path."); }
  Expectation expectation() const override { return Expectation::biased; }
  bool steps_depend() const override { return true; }
  PathClasses finds() const override { return no_paths; }

 private:
  std::unique_ptr<RenderProcess> begin(const RenderContext& context) const override {
    return std::make_unique<NotingProcess>(*this, context);
  }
};

TEST_F(CheckpointTest, what_paths_note_comes_in_a_fixed_order_and_is_kept) {
  static const Register<NotingRenderer> registered;  // only once this test runs: other tests go through all renderers
  const auto state = [&](int threads, bool broken_off) {
    Render render(job_of(ball_text("NotingRenderer {}"), 2 * step), {.threads = threads});
    if (broken_off) {
      EXPECT_FALSE(render.step());
      render.save(folder / "half");
      Render other(job_of(ball_text("NotingRenderer {}"), 2 * step), {.threads = threads});
      other.load(folder / "half");
      other.run();
      other.save(folder / "whole");
    } else {
      render.run();
      render.save(folder / "whole");
    }
    const std::vector<std::byte> bytes = read_checkpoint(folder / "whole").state.renderer;
    std::vector<float> noted(bytes.size() / sizeof(float));
    std::memcpy(noted.data(), bytes.data(), bytes.size());
    return noted;
  };
  const std::vector<float> one = state(1, false);
  EXPECT_EQ(one.size(), size_t(2 * 2 * step));  // of two pixels
  const auto [least, most] = std::ranges::minmax_element(one);
  EXPECT_LT(*most - *least, 1.01f);  // the same wavelengths, and a number in [0, 1)
  EXPECT_GT(*most - *least, 0.99f);
  EXPECT_EQ(state(2, false), one);
  EXPECT_EQ(state(2, true), one);
}

TEST(MutatedPrimarySamples, go_on_from_their_saved_state) {
  const auto walk = [](MutatedPrimarySamples& numbers, int steps) {
    std::vector<float> seen;
    for (int n = 0; n < steps; ++n) {
      if (n % 5 == 0)
        numbers.large_step();
      else
        numbers.small_step();
      for (const std::uint64_t name : {7u, 3u})
        for (std::uint32_t d = 0; d < 3 + std::uint32_t(n % 4); ++d) {
          SampleKey key;
          key.walk = name;
          seen.push_back(numbers.number(key, d));
        }
      if (n % 3 == 0)
        numbers.reject();
      else
        numbers.accept();
    }
    return seen;
  };
  MutatedPrimarySamples numbers(11);
  walk(numbers, 23);
  std::vector<std::byte> bytes;
  numbers.save(bytes);
  bytes.push_back(std::byte{9});  // belongs to the next object in the stream
  MutatedPrimarySamples other(99);
  std::span<const std::byte> rest(bytes);
  other.load(rest);
  EXPECT_EQ(rest.size(), 1u);
  std::vector<std::byte> again;
  other.save(again);
  again.push_back(std::byte{9});
  EXPECT_EQ(again, bytes);
  EXPECT_EQ(walk(other, 30), walk(numbers, 30));
  for (size_t n = 0; n + 1 < bytes.size(); n += 7) {
    std::span<const std::byte> cut = std::span<const std::byte>(bytes).first(n);
    EXPECT_THROW(other.load(cut), Error) << n;
  }
}

}  // namespace
}  // namespace etendue::checkpoint_test
