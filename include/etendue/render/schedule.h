#pragma once
// Schedule: runs work on all cores. An algorithm gives a function of an item; the results are combined in the order of items,
// so no result depends on threads. The work of an item changes nothing but its results, and these can be packed: so a schedule
// may also have items computed by other processes, each of which makes the same calls and gets the same results.

#include <atomic>
#include <iterator>
#include <memory>
#include <vector>

#include "etendue/core/arena.h"
#include "etendue/core/packing.h"
#include "etendue/film/image_tile.h"

namespace etendue {

class Schedule {
 public:
  virtual ~Schedule() = default;

  /// Runs `work(item, tile, arena)` for items 0 … count-1 on all threads and adds the tiles to the film, in the order of items.
  /// The work calls ImageTile::begin (with an empty area if there are only splats) and counts its paths; it must not change
  /// anything else, because each item runs in one process only. An item should take some milliseconds. Its arena belongs to one
  /// thread, and each path empties it (RenderProcess::path). A step may call this several times. An exception of the work ends
  /// the step, which then leaves nothing.
  template <class Work>
  void film(std::uint64_t count, Work&& work) {
    struct None {};
    const auto call = [&](std::uint64_t item, ImageTile* tile, std::vector<None>&, Arena& arena) { work(item, *tile, arena); };
    Collection<None, true, decltype(call)> collection(call);
    run({.count = count, .film = true}, collection);
  }

  /// Runs `work(item, results, arena)`, which appends to its own std::vector<T>, and returns the results of all items in order:
  /// photons, training samples. The work must not change anything but its results. After an abort items are missing: check
  /// `aborted()` before relying on their number. The arena is emptied after each item.
  template <class T, class Work>
  std::vector<T> collect(std::uint64_t count, Work&& work) {
    const auto call = [&](std::uint64_t item, ImageTile*, std::vector<T>& results, Arena& arena) {
      work(item, results, arena);
    };
    Collection<T, true, decltype(call)> collection(call);
    run({.count = count, .results = true}, collection);
    return std::move(collection.all);
  }

  /// The same for results that cannot be packed, because they refer to memory of the process. Each process computes all items,
  /// so more machines make it no faster.
  template <class T, class Work>
  std::vector<T> collect_everywhere(std::uint64_t count, Work&& work) {
    const auto call = [&](std::uint64_t item, ImageTile*, std::vector<T>& results, Arena& arena) {
      work(item, results, arena);
    };
    Collection<T, false, decltype(call)> collection(call);
    run({.count = count, .results = true, .everywhere = true}, collection);
    return std::move(collection.all);
  }

  /// film and collect at once: `work(item, tile, results, arena)` fills a tile and appends to its results, for algorithms that
  /// learn from the paths they display.
  template <class T, class Work>
  std::vector<T> film_and_collect(std::uint64_t count, Work&& work) {
    const auto call = [&](std::uint64_t item, ImageTile* tile, std::vector<T>& results, Arena& arena) {
      work(item, *tile, results, arena);
    };
    Collection<T, true, decltype(call)> collection(call);
    run({.count = count, .film = true, .results = true}, collection);
    return std::move(collection.all);
  }

  /// Whether the current results will be dropped. Items that have not begun are then skipped; long items should check this,
  /// too.
  bool aborted() const { return abort && abort->load(std::memory_order_relaxed); }
  const std::atomic<bool>* abort = nullptr;  ///< null: never

 protected:
  /// One call of the functions above.
  struct Items {
    std::uint64_t count = 0;
    bool film = false;        ///< each fills a tile
    bool results = false;     ///< each has results
    bool everywhere = false;  ///< every process computes all
  };

  /// The interface to work with results of any type.
  class Work {
   public:
    /// An empty container for the results of one item, or a filled one; any thread.
    virtual std::shared_ptr<void> make() = 0;
    virtual std::shared_ptr<void> unpack(std::span<const std::byte>& from) = 0;
    virtual void pack(const void* results, std::vector<std::byte>& to) = 0;  ///< any thread
    /// Runs one item; any thread. The tile is null if the items have none.
    virtual void fill(std::uint64_t item, ImageTile* tile, void* results, Arena& arena) = 0;
    /// Appends the results of one item; called in order.
    virtual void take(void* results) = 0;

   protected:
    ~Work() = default;
  };
  virtual void run(const Items&, Work&) = 0;

 private:
  template <class T, bool packed, class Call>
  struct Collection final : Work {
    static_assert(
        !packed || packable<T>,
        "Results must be trivially copyable, without pointers, because they may be computed on another machine: store "
        "indices instead of pointers, or give the type the functions pack and unpack (core/packing.h), or use "
        "collect_everywhere.");
    using Results = std::vector<T>;
    const Call& call;
    Results all;
    explicit Collection(const Call& call_) : call(call_) {}
    std::shared_ptr<void> make() override { return std::make_shared<Results>(); }
    std::shared_ptr<void> unpack([[maybe_unused]] std::span<const std::byte>& from) override {
      const auto results = std::make_shared<Results>();
      if constexpr (packed) Packing::unpack(from, *results);
      return results;
    }
    void pack([[maybe_unused]] const void* results, [[maybe_unused]] std::vector<std::byte>& to) override {
      if constexpr (packed) Packing::pack(to, *static_cast<const Results*>(results));
    }
    void fill(std::uint64_t item, ImageTile* tile, void* results, Arena& arena) override {
      call(item, tile, *static_cast<Results*>(results), arena);
    }
    void take(void* results) override {
      auto& some = *static_cast<Results*>(results);
      all.insert(all.end(), std::make_move_iterator(some.begin()), std::make_move_iterator(some.end()));
    }
  };
};

}  // namespace etendue
