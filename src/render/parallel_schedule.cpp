#include "parallel_schedule.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <bit>
#include <map>
#include <mutex>
#include <utility>

#include "core/current_step.h"

namespace etendue {

std::uint32_t samples_per_step(const PixelArea& area) {
  constexpr std::uint64_t wanted = std::uint64_t(1) << 19;
  const auto pixels = std::uint64_t(area.width()) * std::uint64_t(area.height());
  return std::uint32_t(std::bit_floor(std::clamp<std::uint64_t>(wanted / std::max<std::uint64_t>(pixels, 1), 1, 1 << 14)));
}

namespace {

/// A task arena for a number of threads, which is kept for the next schedule: an arena that is destroyed while a worker joins
/// it is never freed (7 kB each, oneTBB 2021.8), and programs make thousands of schedules.
class ReusedArena {
 public:
  explicit ReusedArena(int threads) : threads_(threads) {
    const std::lock_guard lock(mutex());
    std::vector<std::unique_ptr<tbb::task_arena>>& left = idle()[threads];
    if (!left.empty()) {
      arena_ = std::move(left.back());
      left.pop_back();
    } else {
      arena_ = std::make_unique<tbb::task_arena>(threads);
    }
  }
  ~ReusedArena() {
    const std::lock_guard lock(mutex());
    idle()[threads_].push_back(std::move(arena_));
  }
  ReusedArena(const ReusedArena&) = delete;
  ReusedArena& operator=(const ReusedArena&) = delete;
  tbb::task_arena& operator*() const { return *arena_; }

 private:
  static std::mutex& mutex() {
    static std::mutex guard;
    return guard;
  }
  /// By the number of threads; never destroyed, as renders may end after the static objects.
  static std::map<int, std::vector<std::unique_ptr<tbb::task_arena>>>& idle() {
    static auto* all = new std::map<int, std::vector<std::unique_ptr<tbb::task_arena>>>;
    return *all;
  }

  int threads_;
  std::unique_ptr<tbb::task_arena> arena_;
};

}  // namespace

struct ParallelSchedule::State {
  Film& film;
  std::function<void(std::uint64_t, std::uint64_t)> tick;
  int threads;
  tbb::global_control limit;
  ReusedArena tasks;
  tbb::enumerable_thread_specific<Arena> arenas;

  // Tiles are reused: a worker takes one, and returns it after merging.
  std::mutex mutex;
  std::vector<std::unique_ptr<ImageTile>> tiles;

  ImageTile* take() {
    const std::lock_guard lock(mutex);
    if (tiles.empty()) return new ImageTile;
    ImageTile* tile = tiles.back().release();
    tiles.pop_back();
    return tile;
  }
  void give(ImageTile* tile) {
    const std::lock_guard lock(mutex);
    tiles.emplace_back(tile);
  }
};

namespace {
int thread_count(int wanted) { return wanted > 0 ? wanted : tbb::info::default_concurrency(); }
}  // namespace

ParallelSchedule::ParallelSchedule(Film& film, int threads, const std::atomic<bool>& abort_,
                                   std::function<void(std::uint64_t, std::uint64_t)> tick)
    : state_(new State{film,
                       std::move(tick),
                       thread_count(threads),
                       tbb::global_control(tbb::global_control::max_allowed_parallelism, size_t(thread_count(threads))),
                       ReusedArena(thread_count(threads)),
                       {},
                       {},
                       {}}) {
  abort = &abort_;
}

ParallelSchedule::~ParallelSchedule() = default;

int ParallelSchedule::threads() const { return state_->threads; }

void ParallelSchedule::on_threads(const std::function<void(Arena&)>& work) {
  (*state_->tasks).execute([&] {
    tbb::parallel_for(0, state_->threads, [&](int) { work(state_->arenas.local()); }, tbb::simple_partitioner());
  });
}

namespace {

/// Runs `make(item)` on all threads, and `take(result)` on one at a time, in the order of items.
template <class Made, class Make, class Take>
void in_order(tbb::task_arena& tasks, int threads, std::uint64_t count, const std::function<bool()>& aborted, const Make& make,
              const Take& take) {
  std::uint64_t next = 0;
  tasks.execute([&] {
    // Enough items in flight that no thread waits for a slow item, few enough that memory stays small.
    tbb::parallel_pipeline(size_t(4 * threads),
                           tbb::make_filter<void, std::uint64_t>(tbb::filter_mode::serial_in_order,
                                                                 [&](tbb::flow_control& flow) -> std::uint64_t {
                                                                   if (next == count || aborted()) flow.stop();
                                                                   return next++;
                                                                 }) &
                               tbb::make_filter<std::uint64_t, Made*>(tbb::filter_mode::parallel, make) &
                               tbb::make_filter<Made*, void>(tbb::filter_mode::serial_in_order, take));
  });
}

}  // namespace

namespace {

thread_local const std::atomic<bool>* abort_of_thread = nullptr;

/// Makes a request to give up that of the thread as long as it lives.
class CurrentStep {
 public:
  explicit CurrentStep(const std::atomic<bool>* abort) : before_(std::exchange(abort_of_thread, abort)) {}
  ~CurrentStep() { abort_of_thread = before_; }
  CurrentStep(const CurrentStep&) = delete;
  CurrentStep& operator=(const CurrentStep&) = delete;

 private:
  const std::atomic<bool>* before_;
};

}  // namespace

const std::atomic<bool>* abort_of_current_step() { return abort_of_thread; }

void ParallelSchedule::run(const Items& items, Work& work) {
  State& s = *state_;
  std::uint64_t done = 0;
  const size_t largest = s.film.largest_kept();
  struct Made {
    ImageTile* tile = nullptr;
    std::shared_ptr<void> results;
  };
  in_order<Made>(
      *s.tasks, s.threads, items.count, [&] { return aborted(); },
      [&](std::uint64_t item) {
        const CurrentStep step(abort);
        auto made = std::make_unique<Made>();
        std::unique_ptr<ImageTile> tile(items.film ? s.take() : nullptr);
        if (tile) tile->keep_largest(largest);
        made->results = work.make();
        Arena& arena = s.arenas.local();
        work.fill(item, tile.get(), made->results.get(), arena);
        if (!items.film) arena.reset();
        made->tile = tile.release();
        return made.release();
      },
      [&](Made* made) {
        const std::unique_ptr<Made> owned(made);
        if (items.results) work.take(made->results.get());
        if (!made->tile) return;
        s.film.merge(*made->tile);
        s.give(made->tile);
        if (s.tick) s.tick(++done, items.count);
      });
}

}  // namespace etendue
