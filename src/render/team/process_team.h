#pragma once
// ProcessTeam: a Team whose members send each other messages.

#include <condition_variable>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

#include "letter.h"
#include "post.h"
#include "render/team.h"

namespace etendue {

class TeamSchedule;

/// How the members work, for each of them alike.
struct TeamSettings {
  std::string version;   ///< of the program, and of its build: all must have the same
  double patience = 25;  ///< [s] a process may be silent for so long
};

/// What a process has done for a render so far.
struct Effort {
  std::uint64_t bytes = 0, messages = 0;  ///< sent
  std::uint64_t calls = 0;                ///< of Schedule::run whose items were divided
  double items = 0;                       ///< processor time of the items that were dealt to it [s]
  double post = 0;                        ///< of sending and receiving, and of looking for messages [s]
  double all = 0;                         ///< of everything: the rest is what each process does for itself [s]
};

class ProcessTeam final : public Team {
 public:
  /// Connects. The leader waits for all others, and throws Error if one of them is of another version.
  ProcessTeam(std::unique_ptr<Messages>, const TeamSettings&);
  /// Ends all other processes at once if one is lost; otherwise sends them home and waits until they have gone.
  ~ProcessTeam() override;

  int rank() const { return post_.rank(); }
  int size() const { return post_.size(); }
  /// Whether the process that started this one has ended, which can thus show no messages.
  bool orphaned() const { return orphaned_; }
  /// "process 3 on node7"
  std::string name_of(int rank) const;

  // ---- renders, one after the other ----------------------------------------------------------------------------------------

  /// Leader: of each process, up to the last step that is finished; without what they did to prepare the render.
  std::vector<Effort> efforts() const;
  /// Leader: lets the others prepare a render, of which `what` tells them.
  void begin_render(std::vector<std::byte> what);
  /// Leader, before its first render: renders begin, and end, by themselves whenever the leader's job is another one; the
  /// function packs what the others need to know of it.
  void follow_edits(std::function<std::vector<std::byte>(const Job&, bool fresh)>);
  void end_render() noexcept;
  /// Follower: waits for the next render; nothing: there is none.
  std::optional<std::vector<std::byte>> next_render();
  /// Follower: the leader warns the user, once if several have the same warning.
  void warn(const std::string& text, const Location&);

  // ---- the scene's files, within a render (scene_transfer.h)
  // -----------------------------------------------------------------

  const std::string& host_of(int rank) const { return members_[size_t(rank)].host; }
  /// The beginning of a letter of this render; `word` says what it is about.
  template <class Word>
  Writing scene_letter(Word word) const {
    Writing letter(LetterKind::scene);
    letter.add(render_).add(word);
    return letter;
  }
  void send_scene_letter(int to, Parcel parcel) { post_.send(to, std::move(parcel)); }
  /// Waits for the next one. Follower: nothing if the leader's render has ended. Throws what is wrong with the team.
  std::optional<Reading> next_scene_letter();

  // ---- Team ----------------------------------------------------------------------------------------------------------------

  bool leads() const override { return rank() == 0; }
  bool follows_edits() const override { return follows_edits_; }
  void announce(const Job&, bool fresh) override;
  void assemble(const Prepared&) override;
  std::unique_ptr<Schedule> schedule(Film&, int threads, const std::atomic<bool>& abort,
                                     std::function<void(std::uint64_t, std::uint64_t)> tick) override;
  void begin_step(const Step&, const std::vector<std::byte>& state) override;
  void end_step(const std::vector<std::byte>& state) override;
  void drop_step() noexcept override;
  std::optional<Task> next_step(std::atomic<bool>& abort) override;
  void finished(const std::vector<std::byte>& state) override;
  void failed(const std::vector<Error>&) noexcept override;

 private:
  friend class TeamSchedule;
  struct Member {
    std::string host;
    std::uint64_t process = 0;
    std::vector<std::uint64_t> cores;  ///< a bit for each core that it may use
  };
  void say_hello();
  void meet();
  void lose(const std::string& why);
  void forget_errors();
  void received(int from, std::vector<std::byte>);
  void lead(Reading&);
  void follow(Reading&);
  Effort effort() const;
  void require_same(int rank, Reading&, const Prepared& own);
  void require_whole() const;
  template <class Done>
  void wait(std::unique_lock<std::mutex>&, const Done&);
  void connect(TeamSchedule*);
  void to_all(const Parcel&);
  bool troubled() const { return trouble_.load(); }

  const TeamSettings settings_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Member> members_;
  std::string lost_;                  ///< why the team is no longer whole; empty: it is
  std::vector<Error> errors_;         ///< of followers, about the current render or step
  std::atomic<bool> trouble_{false};  ///< one of these two
  std::atomic<bool> orphaned_{false};
  std::uint64_t render_ = 0, epoch_ = 0;  ///< numbers of the current render, and of the current step among all that were begun
  std::atomic<int> share_{1};             ///< the number of threads for this process that the cores suffice for
  std::vector<int> threads_;              ///< of each process, in the current step
  std::atomic<double> items_{0};          ///< Effort::items
  std::atomic<std::uint64_t> calls_{0};
  Effort before_;       ///< efforts before the current render
  size_t largest_ = 0;  ///< samples that each tile keeps (Film::largest_kept)

  // The leader's.
  std::vector<std::optional<Reading>> prepared_;
  std::vector<std::optional<std::uint64_t>> finished_;  ///< hashes of the followers' states after the current step
  std::optional<std::uint64_t> common_;                 ///< hash of the state that all processes have
  std::vector<Effort> efforts_;
  bool step_at_hand_ = false;
  std::function<std::vector<std::byte>(const Job&, bool fresh)> packs_;
  std::atomic<bool> follows_edits_{false};
  std::deque<Reading> scene_letters_;  ///< followers' as well

  // Followers'.
  std::deque<Reading> orders_;
  std::uint64_t dropped_ = 0;  ///< the last step that the leader dropped, and all before it
  std::atomic<bool>* abort_ = nullptr;
  bool over_ = false;

  std::mutex schedule_mutex_;
  TeamSchedule* schedule_ = nullptr;
  Post post_;  // last: its thread uses all of the above
};

}  // namespace etendue
