#include "render_team.h"

#include <fmt/format.h>

#include <csignal>
#include <filesystem>

#include "describe/guard.h"
#include "etendue/describe/component.h"
#include "files/sent_files.h"
#include "render/team/letter.h"
#include "render/team/scene_transfer.h"
#include "render_series.h"

namespace etendue {
namespace {

/// The render as the leader's command line describes it; each process was given the same one.
struct Announced {
  std::string file;
  std::optional<int> frame;
  bool in_series = false;
  bool sends_scene = false;
};

std::vector<std::byte> packed(const RenderOptions& options) {
  Writing to(LetterKind::render);
  to.add(options.file).add(options.frame.value_or(-1)).add(options.in_series).add(options.send_scene);
  return std::move(to.bytes());
}

Announced unpacked(std::vector<std::byte> bytes) {
  Reading from(0, std::move(bytes));
  Announced what;
  what.file = from.take_text();
  if (const int frame = from.take<int>(); frame >= 0) what.frame = frame;
  what.in_series = from.take<bool>();
  what.sends_scene = from.take<bool>();
  return what;
}

/// The options without those that concern only who writes the picture.
RenderOptions of_follower(const RenderOptions& options, const Announced& what) {
  RenderOptions own = one_of(options, what.file, what.frame, what.in_series);
  for (std::string* leaders : {&own.checkpoint, &own.resume, &own.continue_file, &own.every, &own.passes, &own.tev})
    leaders->clear();
  own.outputs.clear();
  // The scene's files may be elsewhere here (files/sent_files.h).
  own.file = where_sent(own.file);
  for (std::string& folder : own.import.allowed_folders) folder = where_sent(folder);
  return own;
}

/// A place in a file that was sent, where it is on the leader's machine.
Location at_leader(Location at) {
  at.file = intern(where_sent_from(std::string(at.file)));
  return at;
}

}  // namespace

TeamRender::TeamRender(const RenderOptions& options) {
  auto* const team = dynamic_cast<ProcessTeam*>(options.team);
  if (!team || !options.pixel.empty()) return;
  team->begin_render(packed(options));
  team_ = team;
}

TeamRender::~TeamRender() {
  if (witness_ && team_->orphaned()) witness_->act();  // nobody shows what this process prints
  if (team_) team_->end_render();
}

void TeamRender::send_scene(const InputsRead& inputs, const RenderOptions& options) const {
  if (!team_ || !options.send_scene) return;
  const std::set<std::string> paths = inputs.paths();
  const SceneSent sent = etendue::send_scene(*team_, {paths.begin(), paths.end()});
  if (sent.receivers == 0 || options.quiet || options.progress == "json") return;
  fmt::print("sent {} of the scene's {} file{} to {} process{}\n", amount_text(sent.bytes), sent.files,
             sent.files == 1 ? "" : "s", sent.receivers, sent.receivers == 1 ? "" : "es");
  std::fflush(stdout);
}

void TeamRender::leave_word(const RenderOptions& options, const std::vector<Ref<Output>>& outputs) {
  if (!team_) return;
  std::string beside = options.checkpoint_file();
  const bool continues = !beside.empty();
  if (!continues) beside = outputs.empty() ? options.stem() : outputs.front()->path(options.stem());
  std::error_code ignored;
  const std::string text = fmt::format(
      "{}, the first of {}, ended before its render was finished, and so did what had started it (mpirun, srun): both were "
      "killed, "
      "or the machine is short of memory. {}",
      team_->name_of(0), team_->size(),
      continues ? "The checkpoint is that of the last whole pass that was saved. To continue, with any number of processes: " +
                      options.resume_command()
                : "There is no checkpoint: --continue FILE keeps one.");
  witness_.emplace(
      Witness::Task{.remove = {}, .file = std::filesystem::absolute(beside + ".killed.txt", ignored).string(), .text = text});
}

int follow_renders(const RenderOptions& options, ProcessTeam& team) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGUSR1}) std::signal(signal, SIG_IGN);
  handle_warnings([&](const std::string& message, Location at) { team.warn(message, at_leader(at)); });
  std::unique_ptr<SceneFolder> folder;
  while (std::optional<std::vector<std::byte>> render = team.next_render()) {
    try {
      const Announced what = unpacked(std::move(*render));
      if (what.sends_scene && !receive_scene(team, folder)) continue;
      const RenderOptions own = of_follower(options, what);
      const Ref<Job> job = own.load();
      // The leader compares it, and has its own names of the files.
      job->metadata["command_line"] = one_of(options, what.file, what.frame, what.in_series).picture_command();
      job->outputs.clear();
      Render(job, own.settings()).run();
    } catch (const LostProcess&) {
      throw;
    } catch (...) {
      std::vector<Error> errors = thrown_errors();
      for (Error& error : errors) error.location = at_leader(error.location);
      team.failed(errors);
    }
  }
  handle_warnings({});
  return exit_status::done;
}

}  // namespace etendue
