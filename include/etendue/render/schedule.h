#pragma once
// Schedule: runs work on all cores. An algorithm gives a function of an item; the results are combined in the order of items,
// so no result depends on threads.

#include <atomic>
#include <type_traits>
#include <vector>

#include "etendue/core/arena.h"
#include "etendue/film/image_tile.h"

namespace etendue {

class Schedule {
 public:
  virtual ~Schedule() = default;

  /// Runs `work(item, tile, arena)` for items 0 … count-1 on all threads and adds the tiles to the film, in the order of items.
  /// The work calls ImageTile::begin (with an empty area if there are only splats) and counts its paths. An item should take
  /// some milliseconds. Its arena belongs to one thread, and each path empties it (RenderProcess::path). A step may call this
  /// several times. An exception of the work ends the step, which then leaves nothing.
  template <class Work>
  void film(std::uint64_t count, Work&& work) {
    using WorkType = std::remove_reference_t<Work>;
    film_items(
        count,
        [](void* self, std::uint64_t item, ImageTile& tile, Arena& arena) {
          (*static_cast<WorkType*>(self))(item, tile, arena);
        },
        &work);
  }

  /// Runs `work(item, results, arena)`, which appends to its own std::vector<T>, and returns the results of all items in order:
  /// photons, training samples. After an abort items are missing: check `aborted()` before relying on their number. The arena
  /// is emptied after each item.
  template <class T, class Work>
  std::vector<T> collect(std::uint64_t count, Work&& work) {
    struct Collection final : Results {
      std::remove_reference_t<Work>& work;
      std::vector<T> all;
      explicit Collection(std::remove_reference_t<Work>& work_) : work(work_) {}
      void* make() override { return new std::vector<T>; }
      void fill(std::uint64_t item, void* results, Arena& arena) override {
        work(item, *static_cast<std::vector<T>*>(results), arena);
      }
      void take(void* results) override {
        auto& some = *static_cast<std::vector<T>*>(results);
        all.insert(all.end(), std::make_move_iterator(some.begin()), std::make_move_iterator(some.end()));
        delete &some;
      }
    } collection(work);
    items(count, collection);
    return std::move(collection.all);
  }

  /// film and collect at once: `work(item, tile, results, arena)` fills a tile and appends to its results, for algorithms that
  /// learn from the paths they display.
  template <class T, class Work>
  std::vector<T> film_and_collect(std::uint64_t count, Work&& work) {
    std::vector<std::vector<T>> some(count);
    film(count, [&](std::uint64_t item, ImageTile& tile, Arena& arena) { work(item, tile, some[size_t(item)], arena); });
    std::vector<T> all;
    for (std::vector<T>& one : some)
      all.insert(all.end(), std::make_move_iterator(one.begin()), std::make_move_iterator(one.end()));
    return all;
  }

  /// Whether the current results will be dropped. Items that have not begun are then skipped; long items should check this,
  /// too.
  bool aborted() const { return abort && abort->load(std::memory_order_relaxed); }
  const std::atomic<bool>* abort = nullptr;  ///< null: never

 protected:
  using FilmWork = void (*)(void* self, std::uint64_t item, ImageTile&, Arena&);
  virtual void film_items(std::uint64_t count, FilmWork, void* self) = 0;

  /// The interface to results of any type.
  class Results {
   public:
    virtual void* make() = 0;  ///< makes an empty container for one item; any thread
    virtual void fill(std::uint64_t item, void* results, Arena& arena) = 0;  ///< runs one item; any thread
    virtual void take(void* results) = 0;  ///< appends the results of one item; called in order

   protected:
    ~Results() = default;
  };
  virtual void items(std::uint64_t count, Results&) = 0;
};

}  // namespace etendue
