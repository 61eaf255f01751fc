#include "render_team.h"

#include <csignal>

#include "describe/guard.h"
#include "etendue/describe/component.h"
#include "render/team/letter.h"
#include "render_series.h"

namespace etendue {
namespace {

/// The render as the leader's command line describes it; each process was given the same one.
struct Announced {
  std::string file;
  std::optional<int> frame;
  bool in_series = false;
};

std::vector<std::byte> packed(const RenderOptions& options) {
  Writing to(LetterKind::render);
  to.add(options.file).add(options.frame.value_or(-1)).add(options.in_series);
  return std::move(to.bytes());
}

Announced unpacked(std::vector<std::byte> bytes) {
  Reading from(0, std::move(bytes));
  Announced what;
  what.file = from.take_text();
  if (const int frame = from.take<int>(); frame >= 0) what.frame = frame;
  what.in_series = from.take<bool>();
  return what;
}

/// The options without those that concern only who writes the picture.
RenderOptions of_follower(const RenderOptions& options, const Announced& what) {
  RenderOptions own = one_of(options, what.file, what.frame, what.in_series);
  for (std::string* leaders : {&own.checkpoint, &own.resume, &own.continue_file, &own.every, &own.passes, &own.tev})
    leaders->clear();
  own.outputs.clear();
  return own;
}

}  // namespace

TeamRender::TeamRender(const RenderOptions& options) {
  auto* const team = dynamic_cast<ProcessTeam*>(options.team);
  if (!team || !options.pixel.empty()) return;
  team->begin_render(packed(options));
  team_ = team;
}

TeamRender::~TeamRender() {
  if (team_) team_->end_render();
}

int follow_renders(const RenderOptions& options, ProcessTeam& team) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGUSR1}) std::signal(signal, SIG_IGN);
  handle_warnings([&](const std::string& message, Location at) { team.warn(message, at); });
  while (std::optional<std::vector<std::byte>> render = team.next_render()) {
    try {
      const RenderOptions own = of_follower(options, unpacked(std::move(*render)));
      const Ref<Job> job = own.load();
      job->outputs.clear();
      Render(job, own.settings()).run();
    } catch (const LostProcess&) {
      throw;
    } catch (...) {
      team.failed(thrown_errors());
    }
  }
  handle_warnings({});
  return exit_status::done;
}

}  // namespace etendue
