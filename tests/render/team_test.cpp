// Renders that several processes compute together; here threads stand for the processes.

#include <gtest/gtest.h>

#include <cstring>
#include <thread>

#include "render/team/process_team.h"
#include "render/team/thread_messages.h"
#include "support/checkpoint_test_support.h"

namespace etendue::checkpoint_test {
namespace {

std::string text_of(const std::string& renderer) {
  std::string text = ball_text(renderer, "width: 48, layers: [\"albedo\", \"variance\", \"samples\"]", "0.5");
  text.replace(text.find("height: 1, "), 11, "height: 40, ");
  return text;
}

/// What a follower does: prepares and computes the leader's renders.
void follow(ProcessTeam& team, const std::function<Ref<Job>(int rank)>& job, int threads) {
  while (team.next_render()) {
    try {
      Render render(job(team.rank()), {.threads = threads, .team = &team});
      render.run();
    } catch (const LostProcess&) {
      return;
    } catch (const Error& error) {
      team.failed({error});
    }
  }
}

/// Ranks as threads of this process; the leader's work is done by the caller.
class Threads {
 public:
  Threads(int ranks, std::function<Ref<Job>(int rank)> job, int threads = 1, double patience = 25) : job_(std::move(job)) {
    auto messages = thread_messages(ranks);
    for (int rank = 1; rank < ranks; ++rank)
      followers_.emplace_back([this, threads, patience, own = std::shared_ptr<Messages>(std::move(messages[size_t(rank)]))] {
        ProcessTeam team(std::make_unique<Shared>(own), {"test", patience});
        follow(team, job_, threads);
      });
    leader.emplace(std::move(messages[0]), TeamSettings{"test", patience});
  }
  ~Threads() {
    leader.reset();
    for (std::thread& follower : followers_) follower.join();
  }

  std::optional<ProcessTeam> leader;

 private:
  /// A std::function, which a thread is made of, can be copied, and unique pointers cannot.
  class Shared final : public Messages {
   public:
    explicit Shared(std::shared_ptr<Messages> of) : of_(std::move(of)) {}
    void open() override { of_->open(); }
    int rank() const override { return of_->rank(); }
    int size() const override { return of_->size(); }
    void send(int to, Parcel parcel) override { of_->send(to, std::move(parcel)); }
    std::optional<Received> receive() override { return of_->receive(); }
    bool all_sent() override { return of_->all_sent(); }
    void close() override { of_->close(); }
    void abandon(int status) override { of_->abandon(status); }

   private:
    std::shared_ptr<Messages> of_;
  };

  std::function<Ref<Job>(int)> job_;
  std::vector<std::thread> followers_;
};

/// The end of a render of the team, whatever ends the test.
struct Begun {
  explicit Begun(ProcessTeam& team_) : team(team_) { team.begin_render({}); }
  ~Begun() { team.end_render(); }
  ProcessTeam& team;
};

class TeamTest : public CheckpointTest {};

TEST_F(TeamTest, every_renderer_gives_the_bytes_of_one_process_on_any_number) {
  int tried = 0;
  for (const ClassInfo* info : Registry::instance().subclasses(*Registry::instance().find("Renderer"))) {
    SCOPED_TRACE(info->name);
    const auto described = [&](int samples) { return job_of(text_of(info->name + " {}"), samples); };
    if (!complaint([&] { described(1); }).empty()) continue;
    const int own_step = int(described(1)->renderer->samples_per_step(256));
    const int samples = own_step > 16 ? 20 : 2 * own_step;
    std::unique_ptr<Render> alone;
    if (!complaint([&] { alone = rendered(described(samples), two_threads); }).empty()) continue;
    ++tried;
    for (const int ranks : {2, 3, 5}) {
      SCOPED_TRACE(ranks);
      Threads team(ranks, [&](int) { return described(samples); }, ranks == 2 ? 2 : 1);
      const Begun begun(*team.leader);
      Render render(described(samples), {.threads = ranks == 3 ? 2 : 1, .team = &*team.leader});
      EXPECT_EQ(render.run(), Ended::samples);
      EXPECT_TRUE(film(render) == film(*alone));
      EXPECT_EQ(render.film().bad_samples(), alone->film().bad_samples());
    }
  }
  EXPECT_GE(tried, 10);
}

}  // namespace
}  // namespace etendue::checkpoint_test
