#include "process_team.h"

#include <fmt/format.h>
#include <sched.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <bit>

#include "core/hash.h"
#include "team_schedule.h"

namespace etendue {
namespace {

std::uint64_t hash_of(std::span<const std::byte> bytes) {
  Hash hash;
  hash.add(bytes);
  return hash.value();
}

std::string own_host() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "an unknown host";
}

/// A bit for each core that this process may use.
std::vector<std::uint64_t> own_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  std::vector<std::uint64_t> bits(CPU_SETSIZE / 64, 0);
  if (sched_getaffinity(0, sizeof set, &set) != 0) return bits;
  for (size_t core = 0; core < CPU_SETSIZE; ++core)
    if (CPU_ISSET(core, &set)) bits[core / 64] |= std::uint64_t(1) << core % 64;
  return bits;
}

void add_errors(Writing& to, const std::vector<Error>& errors) {
  to.add(std::uint64_t(errors.size()));
  for (const Error& error : errors)
    to.add(std::string(error.what())).add(std::string(error.location.file)).add(error.location.line).add(error.location.column);
}

std::vector<Error> take_errors(Reading& from, const std::string& whose) {
  std::vector<Error> errors;
  for (auto left = from.take<std::uint64_t>(); left > 0; --left) {
    const std::string text = from.take_text(), file = from.take_text();
    const int line = from.take<int>(), column = from.take<int>();
    errors.emplace_back(whose + ": " + text, Location{intern(file), line, column});
  }
  return errors;
}

void add_identity(Writing& to, const Identity& identity) {
  to.add(identity.text).add(std::uint64_t(identity.files.size()));
  for (const Identity::File& file : identity.files) to.add(file.name).add(file.size).add(file.hash);
}

Identity take_identity(Reading& from) {
  Identity identity;
  identity.text = from.take_text();
  for (auto left = from.take<std::uint64_t>(); left > 0; --left) {
    Identity::File file;
    file.name = from.take_text();
    file.size = from.take<std::uint64_t>();
    file.hash = from.take<std::uint64_t>();
    identity.files.push_back(std::move(file));
  }
  return identity;
}

}  // namespace

// ---- meeting ----------------------------------------------------------------------------------------------------------------

ProcessTeam::ProcessTeam(std::unique_ptr<Messages> messages, const TeamSettings& settings)
    : settings_(settings), post_(std::move(messages), settings.patience) {
  const auto count = size_t(size());
  members_.resize(count);
  prepared_.resize(count);
  finished_.resize(count);
  efforts_.resize(count);
  threads_.assign(count, 1);
  members_[size_t(rank())] = {own_host(), std::uint64_t(getpid()), own_cores()};
  post_.start(
      {[this](int from, std::vector<std::byte> bytes) { received(from, std::move(bytes)); },
       [this](int silent) {
         const std::lock_guard lock(mutex_);
         if (over_) return;
         lose(fmt::format("{} has not answered for {:.0f} seconds: it has ended or is stopped, or the connection is broken",
                          name_of(silent), settings_.patience));
       },
       [this] {
         const std::lock_guard lock(mutex_);
         orphaned_ = true;
         if (!over_) lose(fmt::format("what started {} has ended (mpirun, srun)", name_of(this->rank())));
       }});
  if (leads())
    meet();
  else
    say_hello();
}

ProcessTeam::~ProcessTeam() {
  bool whole = false;
  {
    const std::lock_guard lock(mutex_);
    whole = lost_.empty();
    over_ = true;
  }
  if (!whole) {
    post_.abandon(1);
    return;
  }
  if (leads()) to_all(Writing(LetterKind::over).parcel());
  post_.end();
}

void ProcessTeam::say_hello() {
  const Member& own = members_[size_t(rank())];
  post_.send(0, Writing(LetterKind::hello).add(settings_.version).add(own.host).add(own.process).add(own.cores).parcel());
}

/// Waits for the others, and tells each its number of threads.
void ProcessTeam::meet() {
  std::unique_lock lock(mutex_);
  changed_.wait(
      lock, [&] { return !lost_.empty() || std::ranges::none_of(members_, [](const Member& m) { return m.host.empty(); }); });
  if (!lost_.empty()) return;  // the first render says so
  // Cores that several processes may use are divided among these.
  const auto shared = [](const Member& a, const Member& b) {
    bool any = false;
    for (size_t i = 0; i < std::min(a.cores.size(), b.cores.size()); ++i) any |= (a.cores[i] & b.cores[i]) != 0;
    return any && a.host == b.host;
  };
  for (int rank = 0; rank < size(); ++rank) {
    const Member& own = members_[size_t(rank)];
    int cores = 0;
    for (const std::uint64_t word : own.cores) cores += std::popcount(word);
    const auto users = std::ranges::count_if(members_, [&](const Member& other) { return shared(own, other); });
    const int share = std::max(cores / std::max(int(users), 1), 1);
    if (rank == 0)
      share_ = share;
    else
      post_.send(rank, Writing(LetterKind::hello).add(share).add(members_[0].host).parcel());
  }
}

void ProcessTeam::lose(const std::string& why) {
  if (lost_.empty()) lost_ = why;
  trouble_ = true;
  changed_.notify_all();
}

std::string ProcessTeam::name_of(int rank) const {
  const std::string& host = members_[size_t(rank)].host;
  return host.empty() ? fmt::format("process {}", rank) : fmt::format("process {} on {}", rank, host);
}

void ProcessTeam::to_all(const Parcel& parcel) {
  for (int other = 1; other < size(); ++other) post_.send(other, parcel);
}

void ProcessTeam::connect(TeamSchedule* schedule) {
  const std::lock_guard lock(schedule_mutex_);
  schedule_ = schedule;
}

// ---- letters ----------------------------------------------------------------------------------------------------------------

void ProcessTeam::received(int from, std::vector<std::byte> bytes) {
  try {
    Reading letter(from, std::move(bytes));
    if (letter.kind == LetterKind::want || letter.kind == LetterKind::deal || letter.kind == LetterKind::item) {
      const std::lock_guard lock(schedule_mutex_);
      if (schedule_) schedule_->received(std::move(letter));
      return;
    }
    if (letter.kind == LetterKind::warning) {
      const std::string text = letter.take_text(), file = letter.take_text();
      const int line = letter.take<int>(), column = letter.take<int>();
      etendue::warn(text, {intern(file), line, column});
      return;
    }
    const std::lock_guard lock(mutex_);
    if (letter.kind == LetterKind::scene)
      scene_letters_.push_back(std::move(letter));
    else if (leads())
      lead(letter);
    else
      follow(letter);
    changed_.notify_all();
  } catch (const std::exception& e) {
    const std::lock_guard lock(mutex_);
    lose(fmt::format("what {} sends cannot be read: {}", name_of(from), e.what()));
  }
}

/// What the leader receives.
void ProcessTeam::lead(Reading& letter) {
  Member& sender = members_[size_t(letter.from)];
  switch (letter.kind) {
    case LetterKind::hello: {
      const std::string version = letter.take_text();
      if (version == settings_.version) {
        sender.host = letter.take_text();
        sender.process = letter.take<std::uint64_t>();
        sender.cores = letter.take<std::vector<std::uint64_t>>();
      } else {
        // The letter's first two texts are the same in all versions.
        sender.host = letter.take_text();
        lose(fmt::format("{} runs '{}', and this process on {} runs '{}': install the same on all machines",
                         name_of(letter.from), version, members_[0].host, settings_.version));
      }
      break;
    }
    case LetterKind::prepared:
      if (letter.take<std::uint64_t>() == render_) prepared_[size_t(letter.from)] = std::move(letter);
      break;
    case LetterKind::finished:
      if (letter.take<std::uint64_t>() != epoch_) break;
      finished_[size_t(letter.from)] = letter.take<std::uint64_t>();
      efforts_[size_t(letter.from)] = letter.take<Effort>();
      break;
    case LetterKind::failed: {
      const auto render = letter.take<std::uint64_t>(), step = letter.take<std::uint64_t>();
      if (render != render_ || (step != 0 && (step != epoch_ || !step_at_hand_))) break;
      constexpr size_t most = 8;
      for (Error& error : take_errors(letter, name_of(letter.from)))
        if (errors_.size() < most) errors_.push_back(std::move(error));
      trouble_ = true;
      break;
    }
    default: throw Error("a letter for a follower");
  }
}

/// What a follower receives.
void ProcessTeam::follow(Reading& letter) {
  switch (letter.kind) {
    case LetterKind::hello:
      share_ = letter.take<int>();
      members_[0].host = letter.take_text();
      break;
    case LetterKind::drop:
      dropped_ = letter.take<std::uint64_t>();
      if (abort_ && dropped_ >= epoch_) *abort_ = true;
      break;
    case LetterKind::over: over_ = true; break;
    default: orders_.push_back(std::move(letter));
  }
}

/// Throws what is wrong with the team, or was wrong with the last work of one of its members.
void ProcessTeam::require_whole() const {
  if (!trouble_) return;
  const std::lock_guard lock(mutex_);
  if (!lost_.empty()) throw LostProcess(lost_);
  if (errors_.size() == 1) throw errors_.front();
  if (!errors_.empty()) throw Errors(errors_);
}

template <class Done>
void ProcessTeam::wait(std::unique_lock<std::mutex>& lock, const Done& done) {
  {
    const Post::Waiting looks_often(post_);
    changed_.wait(lock, [&] { return trouble_ || done(); });
  }
  if (!trouble_) return;
  lock.unlock();
  require_whole();
  lock.lock();
}

void ProcessTeam::forget_errors() {
  errors_.clear();
  trouble_ = !lost_.empty();
}

// ---- renders ----------------------------------------------------------------------------------------------------------------

void ProcessTeam::begin_render(std::vector<std::byte> what) {
  require_whole();
  const std::lock_guard lock(mutex_);
  ++render_;
  common_.reset();
  forget_errors();
  for (auto& prepared : prepared_) prepared.reset();
  efforts_.assign(efforts_.size(), {});
  to_all(Writing(LetterKind::render).add(render_).add(what).parcel());
}

void ProcessTeam::follow_edits(std::function<std::vector<std::byte>(const Job&, bool fresh)> packs) {
  packs_ = std::move(packs);
  follows_edits_ = true;
}

void ProcessTeam::announce(const Job& job, bool fresh) {
  if (!follows_edits_) return;
  std::vector<std::byte> what = packs_(job, fresh);
  if (render_ > 0) end_render();
  begin_render(std::move(what));
}

void ProcessTeam::end_render() noexcept {
  const std::lock_guard lock(mutex_);
  to_all(Writing(LetterKind::rendered).add(render_).parcel());
}

std::optional<std::vector<std::byte>> ProcessTeam::next_render() {
  std::unique_lock lock(mutex_);
  while (true) {
    wait(lock, [&] { return !orders_.empty() || over_; });
    if (orders_.empty()) return {};
    Reading letter = std::move(orders_.front());
    orders_.pop_front();
    if (letter.kind != LetterKind::render) continue;  // of a render that could not be prepared here
    render_ = letter.take<std::uint64_t>();
    epoch_ = 0;
    return letter.take<std::vector<std::byte>>();
  }
}

std::optional<Reading> ProcessTeam::next_scene_letter() {
  std::unique_lock lock(mutex_);
  while (true) {
    // To a follower the next order after that to render is that the render has ended, as a step needs it to be prepared.
    wait(lock, [&] { return !scene_letters_.empty() || !orders_.empty() || over_; });
    if (scene_letters_.empty()) return {};
    Reading letter = std::move(scene_letters_.front());
    scene_letters_.pop_front();
    if (letter.take<std::uint64_t>() == render_) return letter;  // else of a render that could not be prepared
  }
}

void ProcessTeam::warn(const std::string& text, const Location& at) {
  post_.send(0, Writing(LetterKind::warning).add(text).add(std::string(at.file)).add(at.line).add(at.column).parcel());
}

void ProcessTeam::assemble(const Prepared& own) {
  const int threads = own.threads > 0 ? own.threads : share_.load();
  before_ = {};
  before_ = effort();
  if (!leads()) {
    Writing letter(LetterKind::prepared);
    letter.add(render_).add(threads).add(own.seed).add(own.samples_per_step).add(own.command);
    add_identity(letter, own.identity);
    post_.send(0, letter.parcel());
    return;
  }
  std::unique_lock lock(mutex_);
  wait(lock, [&] {
    return std::all_of(prepared_.begin() + 1, prepared_.end(), [](const auto& prepared) { return prepared.has_value(); });
  });
  threads_[0] = threads;
  for (int other = 1; other < size(); ++other) require_same(other, *prepared_[size_t(other)], own);
}

Effort ProcessTeam::effort() const {
  const Post::Traffic traffic = post_.traffic();
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return {.bytes = traffic.bytes - before_.bytes,
          .messages = traffic.messages - before_.messages,
          .calls = calls_ - before_.calls,
          .items = items_ - before_.items,
          .post = traffic.seconds - before_.post,
          .all = double(now.tv_sec) + double(now.tv_nsec) * 1e-9 - before_.all};
}

std::vector<Effort> ProcessTeam::efforts() const {
  const std::lock_guard lock(mutex_);
  return efforts_;
}

void ProcessTeam::require_same(int other, Reading& letter, const Prepared& own) {
  const std::string whose = name_of(other), mine = name_of(0);
  threads_[size_t(other)] = letter.take<int>();
  const auto seed = letter.take<std::uint64_t>();
  const auto samples = letter.take<std::uint32_t>();
  const std::string command = letter.take_text();
  const Identity identity = take_identity(letter);
  std::string reason;
  if (command != own.command)
    reason = fmt::format("{} was started as '{}', {} as '{}'", whose, command, mine, own.command);
  else if (seed != own.seed || samples != own.samples_per_step)
    reason = fmt::format("the seed or the passes differ between {} and {}", whose, mine);
  else
    reason = difference(identity, whose, own.identity, mine);
  if (!reason.empty()) throw Error("the processes do not render the same: " + reason);
}

std::unique_ptr<Schedule> ProcessTeam::schedule(Film& film, int threads, const std::atomic<bool>& abort,
                                                std::function<void(std::uint64_t, std::uint64_t)> tick) {
  return std::make_unique<TeamSchedule>(*this, film, threads > 0 ? threads : share_.load(), abort, std::move(tick));
}

// ---- steps: the leader ------------------------------------------------------------------------------------------------------

void ProcessTeam::begin_step(const Step& step, const std::vector<std::byte>& state) {
  require_whole();
  {
    const std::lock_guard lock(schedule_mutex_);
    largest_ = schedule_ ? schedule_->largest_kept() : 0;
  }
  const std::lock_guard lock(mutex_);
  ++epoch_;
  step_at_hand_ = true;
  for (auto& finished : finished_) finished.reset();
  const bool fresh = common_ != hash_of(state);
  Writing letter(LetterKind::step);
  letter.add(epoch_).add(step).add(threads_).add(std::uint64_t(largest_)).add(fresh);
  if (fresh) letter.add(state);
  to_all(letter.parcel());
}

void ProcessTeam::end_step(const std::vector<std::byte>& state) {
  std::unique_lock lock(mutex_);
  wait(lock, [&] {
    return std::all_of(finished_.begin() + 1, finished_.end(), [](const auto& finished) { return finished.has_value(); });
  });
  const std::uint64_t own = hash_of(state);
  for (int other = 1; other < size(); ++other)
    if (*finished_[size_t(other)] != own)
      throw Error(
          fmt::format("{} has computed something else than {}: their processors may round differently (set "
                      "ETENDUE_ARCHITECTURE for both), or a memory may be faulty",
                      name_of(other), name_of(0)));
  common_ = own;
  step_at_hand_ = false;
  efforts_[0] = effort();
}

void ProcessTeam::drop_step() noexcept {
  const std::lock_guard lock(mutex_);
  if (!step_at_hand_) return;
  step_at_hand_ = false;
  common_.reset();
  forget_errors();
  to_all(Writing(LetterKind::drop).add(epoch_).parcel());
}

// ---- steps: followers -------------------------------------------------------------------------------------------------------

std::optional<Team::Task> ProcessTeam::next_step(std::atomic<bool>& abort) {
  std::unique_lock lock(mutex_);
  abort_ = &abort;
  while (true) {
    wait(lock, [&] { return !orders_.empty() || over_; });
    if (orders_.empty()) break;
    if (orders_.front().kind == LetterKind::render) break;
    Reading letter = std::move(orders_.front());
    orders_.pop_front();
    if (letter.kind == LetterKind::rendered) {
      if (letter.take<std::uint64_t>() == render_) break;
      continue;
    }
    epoch_ = letter.take<std::uint64_t>();
    abort = dropped_ >= epoch_;
    if (abort) continue;
    Task task;
    task.step = letter.take<Step>();
    threads_ = letter.take<std::vector<int>>();
    largest_ = size_t(letter.take<std::uint64_t>());
    task.fresh = letter.take<bool>();
    if (task.fresh) task.state = letter.take<std::vector<std::byte>>();
    return task;
  }
  abort_ = nullptr;
  return {};
}

void ProcessTeam::finished(const std::vector<std::byte>& state) {
  post_.send(0, Writing(LetterKind::finished).add(epoch_).add(hash_of(state)).add(effort()).parcel());
}

void ProcessTeam::failed(const std::vector<Error>& errors) noexcept {
  Writing letter(LetterKind::failed);
  letter.add(render_).add(epoch_);
  add_errors(letter, errors);
  post_.send(0, letter.parcel());
}

}  // namespace etendue
