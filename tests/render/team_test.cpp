// Renders that several processes compute together; here threads stand for the processes.

#include <gtest/gtest.h>

#include <cstring>
#include <thread>

#include "etendue/language/language.h"
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
  try {
    while (team.next_render()) {
      try {
        Render(job(team.rank()), {.threads = threads, .team = &team}).run();
      } catch (const LostProcess&) {
        throw;
      } catch (const Error& error) {
        team.failed({error});
      }
    }
  } catch (const LostProcess&) {
    return;  // the process would end
  }
}

/// Ranks as threads of this process; the leader's work is done by the caller.
class Threads {
 public:
  Threads(int ranks, std::function<Ref<Job>(int rank)> job, int threads = 1, double patience = 25) : job_(std::move(job)) {
    auto messages = thread_messages(ranks);
    for (int rank = 1; rank < ranks; ++rank)
      followers_.emplace_back([this, threads, patience, own = std::move(messages[size_t(rank)])]() mutable {
        ProcessTeam team(std::move(own), {"test", patience});
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
  std::function<Ref<Job>(int)> job_;
  std::vector<std::thread> followers_;
};

/// The end of a render of the team, whatever ends the test.
struct Begun {
  explicit Begun(ProcessTeam& team_) : team(team_) { team.begin_render({}); }
  ~Begun() { team.end_render(); }
  ProcessTeam& team;
};

class TeamTest : public CheckpointTest {
 protected:
  static void expect_same_bytes(const std::function<Ref<Job>()>& described, const Render& alone) {
    for (const int ranks : {2, 3, 5}) {
      SCOPED_TRACE(ranks);
      Threads team(ranks, [&](int) { return described(); }, ranks == 2 ? 2 : 1);
      const Begun begun(*team.leader);
      Render render(described(), {.threads = ranks == 3 ? 2 : 1, .team = &*team.leader});
      EXPECT_EQ(render.run(), Ended::samples);
      EXPECT_TRUE(film(render) == film(alone));
      EXPECT_TRUE(render.picture().values == alone.picture().values);
      EXPECT_EQ(render.film().bad_samples(), alone.film().bad_samples());
    }
  }
};

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
    expect_same_bytes([&] { return described(samples); }, *alone);
  }
  EXPECT_GE(tried, 10);
}

// What renderers do only when they are told to: learn a guide, mix chains, make beams.
TEST_F(TeamTest, so_do_the_variants) {
  for (const char* renderer :
       {"BidirectionalPathTracer { guided: true }", "VertexConnectionMerging { guided: true, merging: false }"}) {
    SCOPED_TRACE(renderer);
    const auto described = [&] { return job_of(text_of(renderer), 24); };
    std::unique_ptr<Render> alone;
    ASSERT_EQ(complaint([&] { alone = rendered(described(), two_threads); }), "");
    expect_same_bytes(described, *alone);
  }
}

TEST_F(TeamTest, so_do_layers_of_surfaces) {
  const auto described = [&] {
    const Ref<Job> job = job_of(text_of("PathTracer {}"), 24);
    job->image->layers = {"crypto_object", "object", "position", "normal"};
    return job;
  };
  expect_same_bytes(described, *rendered(described(), two_threads));
}

TEST_F(TeamTest, continues_with_another_number_of_processes) {
  const std::string renderer = "GuidedPathTracer {}";
  const auto described = [&] { return job_of(text_of(renderer), 24); };
  const auto alone = rendered(described(), two_threads);
  for (const int ranks : {3, 2}) {
    Threads team(ranks, [&](int) { return described(); });
    const Begun begun(*team.leader);
    Render render(described(), {.threads = 1, .team = &*team.leader});
    if (ranks == 2) render.load(folder / "state");
    for (int step = 0; ranks == 3 && step < 2; ++step) EXPECT_FALSE(render.step());
    if (ranks == 2) EXPECT_EQ(render.run(), Ended::samples);
    render.save(folder / "state");
    if (ranks == 2) EXPECT_TRUE(film(render) == film(*alone));
  }
}

TEST_F(TeamTest, goes_on_after_a_step_that_was_aborted) {
  const auto described = [] { return job_of(text_of("PhotonMapper {}"), 64); };
  const auto alone = rendered(described(), two_threads);
  Threads team(3, [&](int) { return described(); });
  const Begun begun(*team.leader);
  int reports = 0;
  Render render(described(), {.threads = 1,
                              .on_progress =
                                  [&](const Progress&) {
                                    if (++reports == 70) render.abort();
                                  },
                              .progress_interval = 0,
                              .team = &*team.leader});
  EXPECT_EQ(render.run(), Ended::aborted);
  EXPECT_EQ(render.run(), Ended::samples);
  EXPECT_TRUE(film(render) == film(*alone));
}

// A studio's render (studio_team.h): the others are told of the job anew when it was edited, and before a step alone.
TEST_F(TeamTest, follows_the_edits_of_its_leader) {
  const auto bytes_of = [](const std::string& text) {
    const auto all = std::as_bytes(std::span(text));
    return std::vector<std::byte>(all.begin(), all.end());
  };
  const auto text_in = [](const std::vector<std::byte>& bytes) {
    return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  };
  auto messages = thread_messages(3);
  std::vector<std::thread> followers;
  for (int rank = 1; rank < 3; ++rank)
    followers.emplace_back([&, own = std::move(messages[size_t(rank)])]() mutable {
      ProcessTeam team(std::move(own), {"test", 25});
      while (const auto what = team.next_render()) {
        const Ref<Job> job = ref_cast<Job>(parse_component(text_in(*what), "text", folder.path()));
        Render(job, {.threads = 1, .team = &team}).run();
      }
    });
  {
    ProcessTeam team(std::move(messages[0]), {"test", 25});
    std::vector<bool> told;
    team.follow_edits([&](const Job& job, bool fresh) {
      told.push_back(fresh);
      return bytes_of(write_description(job, false, folder.path()));
    });
    const auto described = [] { return job_of(text_of("GuidedPathTracer {}"), 24); };
    const Ref<Job> job = described();
    Render render(job, {.threads = 1, .team = &team});
    EXPECT_FALSE(render.step());
    EXPECT_FALSE(render.step());
    EXPECT_EQ(told, (std::vector{true}));
    const auto edited = [&](Render& of) { of.edit(*of.job().renderer, "max_depth", Value(Number{3})); };
    edited(render);
    EXPECT_EQ(render.run(), Ended::samples);
    EXPECT_EQ(told, (std::vector{true, false}));
    Render alone(described(), two_threads);
    edited(alone);
    alone.run();
    EXPECT_TRUE(film(render) == film(alone));
    render.restart(7);
    alone.restart(7);
    alone.run();
    EXPECT_EQ(render.run(), Ended::samples);
    EXPECT_EQ(told.size(), 3u);
    EXPECT_TRUE(film(render) == film(alone));
  }
  for (std::thread& follower : followers) follower.join();
}

TEST_F(TeamTest, names_who_sees_another_scene_and_renders_the_next) {
  bool other = true;
  const auto described = [&](int rank) {
    return job_of(ball_text("PathTracer {}", "width: 2", rank == 1 && other ? "0.6" : "0.5"), 100);
  };
  Threads team(3, described);
  {
    const Begun begun(*team.leader);
    Render render(described(0), {.threads = 1, .team = &*team.leader});
    const std::string text = complaint([&] { render.run(); });
    EXPECT_TRUE(has(text, "do not render the same: the description differs: ")) << text;
    EXPECT_TRUE(has(text, "in process 1 on ")) << text;
  }
  other = false;
  const Begun begun(*team.leader);
  Render render(described(0), {.threads = 1, .team = &*team.leader});
  EXPECT_EQ(render.run(), Ended::samples);
}

TEST_F(TeamTest, names_who_cannot_prepare_the_render) {
  const auto described = [&](int rank) -> Ref<Job> {
    if (rank == 2) throw Error("there is no file 'a.ply'");
    return ball(100);
  };
  Threads team(3, described);
  const Begun begun(*team.leader);
  Render render(described(0), {.threads = 1, .team = &*team.leader});
  const std::string text = complaint([&] { render.run(); });
  EXPECT_TRUE(has(text, "process 2 on ") && has(text, ": there is no file 'a.ply'")) << text;
}

/// Fails in one of its paths, or has another state in each process.
class FailingProcess final : public RenderProcess {
 public:
  using RenderProcess::RenderProcess;
  static inline std::atomic<bool> fails{false}, differs{false};
  static inline std::atomic<int> made{0};
  const int number = made++;
  Spectrum radiance(const Ray&, SampleContext&) const override {
    if (fails) throw Error("this path fails");
    return Spectrum(1.0f);
  }
  std::vector<std::byte> save_state() const override { return {std::byte(differs && loaded_ ? number : 0)}; }
  void load_state(std::span<const std::byte>) override { loaded_ = true; }

 private:
  bool loaded_ = false;
};

class FailingRenderer final : public Renderer {
 public:
  static void describe(Description<FailingRenderer>& d) { d.summary("For tests: fails."); }
  Expectation expectation() const override { return Expectation::biased; }
  bool steps_depend() const override { return true; }
  PathClasses finds() const override { return no_paths; }

 private:
  std::unique_ptr<RenderProcess> begin(const RenderContext& context) const override {
    return std::make_unique<FailingProcess>(*this, context);
  }
};

TEST_F(TeamTest, a_step_that_fails_or_differs_leaves_nothing) {
  static const Register<FailingRenderer> registered;  // only once this test runs: other tests go through all renderers
  const auto described = [] { return job_of(text_of("FailingRenderer {}"), 1000); };
  Threads team(2, [&](int) { return described(); });
  const Begun begun(*team.leader);
  Render render(described(), {.threads = 1, .team = &*team.leader});
  FailingProcess::fails = true;
  EXPECT_TRUE(has(complaint([&] { render.step(); }), "this path fails"));
  EXPECT_TRUE(render.samples_done().empty());
  FailingProcess::fails = false;
  EXPECT_FALSE(render.step());
  FailingProcess::made = 1;
  FailingProcess::differs = true;
  render.save(folder / "state");
  render.load(folder / "state");
  const std::string text = complaint([&] { render.step(); });
  EXPECT_TRUE(has(text, "has computed something else than process 0")) << text;
  FailingProcess::differs = false;
  EXPECT_EQ(render.run(), Ended::samples);
}

/// The messages of a process that falls silent.
class Silenced final : public Messages {
 public:
  explicit Silenced(std::unique_ptr<Messages> of) : of_(std::move(of)) {}
  static inline std::atomic<bool> silent{false};
  void open() override { of_->open(); }
  int rank() const override { return of_->rank(); }
  int size() const override { return of_->size(); }
  void send(int to, Parcel parcel) override {
    if (!silent) of_->send(to, std::move(parcel));
  }
  std::optional<Received> receive() override { return of_->receive(); }
  bool all_sent() override { return true; }
  void close() override {}
  void abandon(int) override {}

 private:
  std::unique_ptr<Messages> of_;
};

TEST_F(TeamTest, a_process_that_falls_silent_ends_the_render_and_the_last_step_is_kept) {
  Silenced::silent = false;
  auto messages = thread_messages(2);
  const auto described = [] { return job_of(text_of("PathTracer {}"), 1'000'000); };
  std::thread follower([&, own = std::move(messages[1])]() mutable {
    ProcessTeam team(std::make_unique<Silenced>(std::move(own)), {"test", 2});
    follow(team, [&](int) { return described(); }, 1);
  });
  {
    ProcessTeam team(std::move(messages[0]), {"test", 2});
    const Begun begun(team);
    Render render(described(), {.threads = 1,
                                .on_progress =
                                    [&](const Progress& now) {
                                      if (now.samples > 0) Silenced::silent = true;
                                    },
                                .progress_interval = 0,
                                .checkpoint_file = folder / "state",
                                .team = &team});
    EXPECT_THROW(render.run(), LostProcess);
    EXPECT_EQ(count(read_checkpoint(folder / "state").done), count(render.samples_done()));
    EXPECT_GT(count(render.samples_done()), 0u);
  }
  Silenced::silent = false;
  follower.join();
}

TEST_F(TeamTest, other_versions_are_refused) {
  auto messages = thread_messages(2);
  std::thread follower([own = std::move(messages[1])]() mutable {
    ProcessTeam team(std::move(own), {"version 2", 2});
    EXPECT_THROW(team.next_render(), LostProcess);
  });
  std::string text;
  {
    ProcessTeam team(std::move(messages[0]), {"version 1", 25});
    text = complaint([&] { team.begin_render({}); });
  }
  follower.join();
  EXPECT_TRUE(has(text, "process 1 on ") && has(text, " runs 'version 2', and this process on ")) << text;
}

}  // namespace
}  // namespace etendue::checkpoint_test
