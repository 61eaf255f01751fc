#include "etendue/render/primary_sample_chains.h"

#include <array>

#include "etendue/transport/primary_sample_vectors.h"

namespace etendue {
namespace {

/// A bootstrap pool of independent paths, stored as their luminance in the cells of the film.
struct Pool {
  std::vector<Contribution::Brightness> parts;
  std::vector<size_t> ends;  ///< end index in `parts` for each path

  std::span<const Contribution::Brightness> path(size_t i) const {
    const size_t begin = i > 0 ? ends[i - 1] : 0;
    return std::span(parts).subspan(begin, ends[i] - begin);
  }
  std::vector<double> light() const {
    std::vector<double> sums(FilmWeights::cells);
    for (const Contribution::Brightness& part : parts) sums[part.cell] += double(part.luminance);
    return sums;
  }
  ChainStarts starts(const FilmWeights& v) const {
    std::vector<ChainStarts::Path> paths(ends.size());
    for (size_t i = 0; i < paths.size(); ++i)
      paths[i] = {i, Contribution::brightness(path(i), v), path(i).empty() ? 0 : FilmWeights::order(path(i)[0].cell)};
    return ChainStarts(std::move(paths));
  }
};

/// The seed of a path of a pool.
std::uint64_t path_seed(std::uint64_t seed, std::uint64_t pool, std::uint64_t path) {
  return mix_bits(seed ^ mix_bits(0x9e3779b97f4a7c15ull * (2 * path + pool + 1)));
}

Pool make_pool(Schedule& schedule, const Chains& chains, std::uint64_t seed, std::uint64_t which, std::uint64_t count) {
  using Parts = std::vector<Contribution::Brightness>;
  constexpr std::uint64_t item_size = 256;
  Pool pool;
  for (const Parts& parts : schedule.collect<Parts>(
           (count + item_size - 1) / item_size, [&](std::uint64_t item, std::vector<Parts>& paths, Arena& arena) {
             Contribution f;
             const std::uint64_t end = std::min(count, (item + 1) * item_size);
             for (std::uint64_t i = item * item_size; i < end && !schedule.aborted(); ++i) {
               chains.draw(path_seed(seed, which, i), arena, schedule.abort, f);
               paths.push_back(f.luminances);
             }
           })) {
    pool.parts.insert(pool.parts.end(), parts.begin(), parts.end());
    pool.ends.push_back(pool.parts.size());
  }
  return pool;
}

class PrimarySampleChains final : public Chains {
 public:
  PrimarySampleChains(const ChainSettings& settings, const PathFunction& path) : settings_(settings), path_(path) {}

  void draw(std::uint64_t seed, Arena& arena, const std::atomic<bool>* abort, Contribution& f) const override {
    path_.evaluate(MutatedPrimarySamples(seed), arena, abort, f);
  }

  void run(std::uint64_t first, std::uint64_t own_seed, std::uint64_t states, const StateWeights& weights, const FilmWeights& v,
           ImageTile& tile, Arena& arena, const std::atomic<bool>* abort) const override {
    ChoiceNumbers choices(own_seed);
    MutatedPrimarySamples numbers(first);
    Contribution current, proposed;
    path_.evaluate(numbers, arena, abort, current);
    numbers.accept();
    double I = current.brightness(v), waiting = 0;  // the weight of the current state that is not yet added to the film
    for (std::uint64_t i = 0; i < states && !(abort && abort->load(std::memory_order_relaxed)); ++i) {
      const bool large = choices.next() < double(settings_.large_steps);
      if (large)
        numbers.large_step();
      else
        numbers.small_step(settings_.deviation);
      path_.evaluate(numbers, arena, abort, proposed);
      proposed.report_bad(tile);
      const double J = proposed.brightness(v), accept = I > 0 ? std::min(1.0, J / I) : 1;
      waiting += weights.factor(false, 1 - accept, I);
      const double now = weights.factor(large, accept, J);
      if (choices.next() < accept) {
        numbers.accept();
        current.add_to(tile, waiting);
        std::swap(current, proposed);
        I = J;
        waiting = now;
      } else {
        numbers.reject();
        proposed.add_to(tile, now);
      }
    }
    current.add_to(tile, waiting);
  }

 private:
  const ChainSettings& settings_;
  const PathFunction& path_;
};

}  // namespace

void mutate_primary_samples(Schedule& schedule, const ImageBuffer& image, const ChainSettings& settings,
                            const PathFunction& path, std::uint64_t seed, std::uint64_t paths, bool count_paths) {
  run_chains(schedule, image, settings, PrimarySampleChains(settings, path), seed, paths, count_paths);
}

void run_chains(Schedule& schedule, const ImageBuffer& image, const ChainSettings& settings, const Chains& chains,
                std::uint64_t seed, std::uint64_t paths, bool count_paths) {
  const std::uint64_t mutations = paths * std::uint64_t(settings.mutations);
  // Half of the chains start with paths of one pool, the other half with paths of the other pool. Each half takes its weights v
  // and b from the other half's pool, so that they are independent of the paths they weight.
  const auto pool = std::uint64_t(std::max(1.0, double(mutations) * double(settings.bootstrap) / 2));
  const std::array<Pool, 2> pools{make_pool(schedule, chains, seed, 0, pool), make_pool(schedule, chains, seed, 1, pool)};
  if (schedule.aborted()) return;
  struct Half {
    FilmWeights v;
    ChainStarts starts;
    StateWeights weights;
  };
  const auto half = [&](const Pool& own, const Pool& other) {
    FilmWeights v = settings.even_errors ? FilmWeights(other.light()) : FilmWeights();
    ChainStarts starts = own.starts(v);
    const StateWeights weights{starts.mean(), other.starts(v).mean(), double(settings.large_steps), 1.0 / settings.mutations};
    return Half{std::move(v), std::move(starts), weights};
  };
  const std::array<Half, 2> halves{half(pools[0], pools[1]), half(pools[1], pools[0])};
  const auto count = std::uint64_t(settings.chains);
  schedule.film(count, [&](std::uint64_t item, ImageTile& tile, Arena& arena) {
    tile.begin(image, {});  // splats alone
    const std::uint64_t which = item % 2, states = mutations / count + (item < mutations % count);
    const auto& [v, starts, weights] = halves[which];
    if (count_paths)
      for (std::uint64_t i = paths * item / count; i < paths * (item + 1) / count; ++i) tile.count_path();
    const std::uint64_t first = starts.begin(item / 2, (count + 1 - which) / 2, ChoiceNumbers(seed + which).next());
    chains.run(path_seed(seed, which, first), mix_bits(seed + item), states, weights, v, tile, arena, schedule.abort);
  });
}

}  // namespace etendue
