// Renders that a team of processes computes.

#include "describe/guard.h"
#include "render_members.h"

namespace etendue {

std::unique_ptr<Schedule> Render::Members::make_schedule(std::function<void(std::uint64_t, std::uint64_t)> tick) {
  if (settings.team) return settings.team->schedule(*film, settings.threads, give_up, std::move(tick));
  return std::make_unique<ParallelSchedule>(*film, settings.threads, give_up, std::move(tick));
}

/// Meets the other processes, before the first step.
void Render::Members::assemble() {
  if (!settings.team || assembled) return;
  if (settings.team->leads()) settings.team->announce(*job, !announced);
  announced = true;
  const auto command = job->metadata.find("command_line");
  settings.team->assemble({.identity = identity_now(),
                           .seed = job->seed,
                           .samples_per_step = samples_per_step(),
                           .command = command == job->metadata.end() ? std::string() : command->second,
                           .threads = settings.threads});
  assembled = true;
}

/// Takes the leader's steps, until its render has ended.
Ended Render::Members::follow_leader() {
  Team& team = *settings.team;
  const std::shared_lock sharing(description);
  const std::unique_ptr<Schedule> schedule = make_schedule({});
  assembled = false;  // for the leader's last render, which was another one or is edited since
  assemble();
  while (std::optional<Team::Task> task = team.next_step(give_up)) {
    try {
      const WithinStep no_edits(*this);
      if (task->fresh || !process) {
        process = fresh_process();
        if (!task->state.empty()) process->load_state(task->state);
      }
      rendering(*job, [&] { render_step(*schedule, task->step); });
      surfaces->drop_step();  // the leader has them as well
      if (!give_up) team.finished(process->save_state());
    } catch (const LostProcess&) {
      throw;
    } catch (...) {
      process.reset();  // it may be anywhere within the step
      if (!give_up) team.failed(thrown_errors());
    }
  }
  return Ended::samples;
}

}  // namespace etendue
