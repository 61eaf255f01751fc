#include "team_schedule.h"

#include <time.h>

#include <numeric>

namespace etendue {
namespace {

/// Results of an item, until all before it have been taken.
struct Made {
  std::unique_ptr<ImageTile> tile;
  std::shared_ptr<void> results;
};

/// The processor time of this thread [s].
double own_seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + double(now.tv_nsec) * 1e-9;
}

/// A process asks for so many items.
struct Wish {
  int rank = 0;
  std::uint64_t count = 1;
};

/// The items that each process computes first, without being dealt them: four for each thread, fewer if there are few.
std::vector<std::uint64_t> first_shares(std::uint64_t count, const std::vector<int>& threads) {
  const int all = std::accumulate(threads.begin(), threads.end(), 0);
  std::vector<std::uint64_t> shares;
  std::uint64_t left = count;
  for (const int own : threads) {
    const std::uint64_t fair = std::max<std::uint64_t>(count * std::uint64_t(own) / std::uint64_t(2 * all), 1);
    shares.push_back(std::min({left, fair, std::uint64_t(4 * own)}));
    left -= shares.back();
  }
  return shares;
}

}  // namespace

/// One call of run.
class TeamSchedule::Call {
 public:
  Call(TeamSchedule& s, const Items& items, Work& work, Number number)
      : schedule_(s),
        team_(s.team_),
        items_(items),
        work_(work),
        number_(number),
        combines_(items.results || team_.leads()),
        threads_(team_.threads_) {
    const std::vector<std::uint64_t> shares = first_shares(items.count, threads_);
    for (int rank = 0; rank < team_.size(); ++rank) {
      if (rank == team_.rank()) add(dealt_, shares[size_t(rank)]);
      dealt_ += shares[size_t(rank)];
    }
    const int all = std::accumulate(threads_.begin(), threads_.end(), 0);
    all_threads_ = std::uint64_t(all);
    window_ = 64 * all_threads_;
  }

  /// Works until there is nothing left to do here; on several threads.
  void work(Arena& arena) {
    std::unique_lock lock(mutex_);
    while (!failure_ && !schedule_.stopped()) {
      if (!asked_ && !all_dealt_ && unstarted_ < stock()) ask();
      if (!taking_ && !ready_.empty() && ready_.begin()->first == next_)
        take(lock);
      else if (!arrived_.empty())
        unpack(lock);
      else if (!own_.empty())
        compute(lock, arena);
      else if (over())
        return;
      else
        wait(lock);
    }
  }

  void received(Reading&& letter) {
    const std::lock_guard lock(mutex_);
    switch (letter.kind) {
      case LetterKind::want: deal({letter.from, letter.take<std::uint64_t>()}); break;
      case LetterKind::deal: {
        const auto first = letter.take<std::uint64_t>(), count = letter.take<std::uint64_t>();
        dealt_to_me(first, count);
        break;
      }
      default: arrived_.push_back(std::move(letter)); changed_.notify_one();
    }
  }

  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  /// Waits for letters; not for long, as an abort is not announced.
  void wait(std::unique_lock<std::mutex>& lock) {
    const Post::Waiting looks_often(team_.post_);
    changed_.wait_for(lock, std::chrono::milliseconds(5));
  }

  /// Of work that runs unlocked: an exception ends the call.
  template <class F>
  void unlocked(std::unique_lock<std::mutex>& lock, const F& f) {
    lock.unlock();
    std::exception_ptr failure;
    try {
      f();
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    if (failure && !failure_) failure_ = failure;
    if (failure) changed_.notify_all();
  }

  bool over() const { return combines_ ? next_ == items_.count : all_dealt_; }

  void take(std::unique_lock<std::mutex>& lock) {
    taking_ = true;
    Made made = std::move(ready_.begin()->second);
    ready_.erase(ready_.begin());
    unlocked(lock, [&] {
      if (items_.results) work_.take(made.results.get());
      if (!made.tile) return;
      schedule_.film_.merge(*made.tile);
      schedule_.give_back(std::move(made.tile));
      if (schedule_.tick_) schedule_.tick_(next_ + 1, items_.count);  // only here next_ changes
    });
    taking_ = false;
    ++next_;
    while (!waiting_.empty() && (dealt_ == items_.count || dealt_ < next_ + window_)) {
      const Wish wish = waiting_.front();
      waiting_.pop_front();
      deal(wish);
    }
    if (over()) changed_.notify_all();
  }

  void unpack(std::unique_lock<std::mutex>& lock) {
    Reading letter = std::move(arrived_.front());
    arrived_.pop_front();
    Made made;
    std::uint64_t item = 0;
    unlocked(lock, [&] {
      item = letter.take<std::uint64_t>();
      if (items_.film && team_.leads()) {
        made.tile = schedule_.tile();
        schedule_.film_.unpack(letter.rest, *made.tile);
      }
      if (items_.results) made.results = work_.unpack(letter.rest);
    });
    if (!failure_) add_ready(item, std::move(made));
  }

  void compute(std::unique_lock<std::mutex>& lock, Arena& arena) {
    const std::uint64_t item = own_.front()++;
    if (own_.front() == own_end_.front()) {
      own_.pop_front();
      own_end_.pop_front();
    }
    --unstarted_;
    Made made;
    const auto began = std::chrono::steady_clock::now();
    unlocked(lock, [&] {
      const double before = own_seconds();
      if (items_.film) {
        made.tile = schedule_.tile();
        made.tile->keep_largest(team_.largest_);
      }
      made.results = work_.make();
      work_.fill(item, made.tile.get(), made.results.get(), arena);
      if (!items_.film) arena.reset();
      team_.items_ += own_seconds() - before;
      if (schedule_.stopped()) return;  // it may be incomplete
      send(item, made);
    });
    if (failure_) return;
    busy_ += std::chrono::steady_clock::now() - began;
    ++computed_;
    if (!combines_)
      schedule_.give_back(std::move(made.tile));
    else
      add_ready(item, std::move(made));
  }

  Writing letter(LetterKind kind) const {
    Writing letter(kind);
    letter.add(number_.first).add(number_.second);
    return letter;
  }

  /// Sends the results of an item to those who need them.
  void send(std::uint64_t item, const Made& made) const {
    // The leader gets the tile as well, if there is one; otherwise all get the same letter.
    const bool with_tile = items_.film && !team_.leads();
    Parcel results;
    if (items_.results) {
      Writing to_all = letter(LetterKind::item).add(item);
      work_.pack(made.results.get(), to_all.bytes());
      results = to_all.parcel();
      for (int rank = with_tile ? 1 : 0; rank < team_.size(); ++rank)
        if (rank != team_.rank()) team_.post_.send_soon(rank, results);
    }
    if (!with_tile) return;
    Writing to_leader = letter(LetterKind::item).add(item);
    const auto head = std::ptrdiff_t(to_leader.bytes().size());
    made.tile->pack(to_leader.bytes());
    if (results) to_leader.bytes().insert(to_leader.bytes().end(), results->begin() + head, results->end());
    team_.post_.send_soon(0, to_leader.parcel());
  }

  // ---- the rest is called with the lock held -------------------------------------------------------------------------------

  void add_ready(std::uint64_t item, Made made) {
    ready_.emplace(item, std::move(made));
    if (item == next_ && !taking_) changed_.notify_one();
  }

  /// How many items that are not begun should be here: as many as are computed while more are asked for, which takes the time
  /// of some looks for messages, and longer on slow networks.
  std::uint64_t stock() const {
    constexpr std::chrono::duration<double> looks = std::chrono::milliseconds(10);
    const auto enough = std::max(looks, 1.5 * schedule_.answer_time_);
    const auto own = std::uint64_t(threads_[size_t(team_.rank())]);
    if (computed_ == 0) return own;
    const double each = std::max(busy_.count() / double(computed_), 1e-6);
    return own * std::uint64_t(std::clamp(enough.count() / each, 1.0, 64.0));
  }

  void ask() {
    asked_ = true;
    asked_at_ = std::chrono::steady_clock::now();
    if (team_.leads())
      deal({0, stock()});
    else
      team_.post_.send(0, letter(LetterKind::want).add(stock()).parcel());
  }

  void add(std::uint64_t first, std::uint64_t count) {
    if (count == 0) return;
    own_.push_back(first);
    own_end_.push_back(first + count);
    unstarted_ += count;
  }

  void dealt_to_me(std::uint64_t first, std::uint64_t count) {
    asked_ = false;
    if (!team_.leads() && count > 0) {
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - asked_at_;
      schedule_.answer_time_ += 0.25 * (took - schedule_.answer_time_);
    }
    all_dealt_ = count == 0;
    add(first, count);
    changed_.notify_all();
  }

  /// The leader deals items to a process, or lets it wait.
  void deal(Wish wish) {
    const std::uint64_t left = items_.count - dealt_;
    const std::uint64_t room = next_ + window_ > dealt_ ? next_ + window_ - dealt_ : 0;
    if (left > 0 && room == 0) {
      waiting_.push_back(wish);
      return;
    }
    // At the end one by one, so that all processes end at the same time.
    const std::uint64_t fair = std::max<std::uint64_t>(left / (2 * all_threads_), 1);
    const std::uint64_t count = std::min({left, room, fair, wish.count});
    if (wish.rank == 0)
      dealt_to_me(dealt_, count);
    else
      team_.post_.send(wish.rank, letter(LetterKind::deal).add(dealt_).add(count).parcel());
    dealt_ += count;
  }

  TeamSchedule& schedule_;
  ProcessTeam& team_;
  const Items items_;
  Work& work_;
  const Number number_;
  const bool combines_;  ///< whether the results come together here
  const std::vector<int> threads_;
  std::uint64_t all_threads_ = 1, window_ = 1;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::exception_ptr failure_;

  // Items to be computed here: ranges, the number of their items that are not begun, and whether more may come.
  std::deque<std::uint64_t> own_, own_end_;
  std::uint64_t unstarted_ = 0;
  bool asked_ = false, all_dealt_ = false;
  std::chrono::steady_clock::time_point asked_at_;
  std::chrono::duration<double> busy_{0};  ///< the time that items took, and their number
  std::uint64_t computed_ = 0;

  std::deque<Reading> arrived_;          ///< results of others, still packed
  std::map<std::uint64_t, Made> ready_;  ///< results that wait for their turn
  std::uint64_t next_ = 0;               ///< the item whose turn it is
  bool taking_ = false;                  ///< a thread is taking the results of `next_`

  // The leader's.
  std::uint64_t dealt_ = 0;
  std::deque<Wish> waiting_;  ///< of those who asked while too much was under way
};

TeamSchedule::TeamSchedule(ProcessTeam& team, Film& film, int threads, const std::atomic<bool>& abort_,
                           std::function<void(std::uint64_t, std::uint64_t)> tick)
    : team_(team), film_(film), local_(film, threads, abort_), tick_(std::move(tick)) {
  abort = &abort_;
  team_.connect(this);
}

TeamSchedule::~TeamSchedule() { team_.connect(nullptr); }

void TeamSchedule::run(const Items& items, Work& work) {
  if (items.everywhere) {
    local_.run(items, work);
    return;
  }
  team_.require_whole();
  ++team_.calls_;
  std::optional<Call> call;
  {
    const std::lock_guard lock(mutex_);
    const std::uint64_t step = team_.epoch_;
    last_ = {step, last_.first == step ? last_.second + 1 : 1};
    call.emplace(*this, items, work, last_);
    call_ = &*call;
    early_.erase(early_.begin(), early_.lower_bound(last_));
    const auto [first, end] = early_.equal_range(last_);
    for (auto letter = first; letter != end; ++letter) call->received(std::move(letter->second));
    early_.erase(first, end);
  }
  local_.on_threads([&](Arena& arena) { call->work(arena); });
  {
    const std::lock_guard lock(mutex_);
    call_ = nullptr;
  }
  call->rethrow();
  if (!aborted()) team_.require_whole();
}

void TeamSchedule::received(Reading&& letter) {
  const auto step = letter.take<std::uint64_t>(), call = letter.take<std::uint64_t>();
  const Number number{step, call};
  const std::lock_guard lock(mutex_);
  if (call_ && number == last_)
    call_->received(std::move(letter));
  else if (number > last_)
    early_.emplace(number, std::move(letter));
  else if (letter.kind == LetterKind::want && number.first == last_.first)  // of a call that has ended: all items are dealt
    team_.post_.send(letter.from,
                     Writing(LetterKind::deal).add(step).add(call).add(std::uint64_t(0)).add(std::uint64_t(0)).parcel());
}

std::unique_ptr<ImageTile> TeamSchedule::tile() {
  const std::lock_guard lock(tiles_mutex_);
  if (tiles_.empty()) return std::make_unique<ImageTile>();
  std::unique_ptr<ImageTile> tile = std::move(tiles_.back());
  tiles_.pop_back();
  return tile;
}

void TeamSchedule::give_back(std::unique_ptr<ImageTile> tile) {
  if (!tile) return;
  const std::lock_guard lock(tiles_mutex_);
  tiles_.push_back(std::move(tile));
}

}  // namespace etendue
