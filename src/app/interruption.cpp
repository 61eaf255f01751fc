// Handles Ctrl-C during a render.

#include "interruption.h"

#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <string_view>

namespace etendue {

namespace {

std::atomic<Render*> running{nullptr};
std::atomic<int> requests{0};  // 1: finish the pass, 2: end without it
static_assert(std::atomic<Render*>::is_always_lock_free && std::atomic<int>::is_always_lock_free &&
              std::atomic<bool>::is_always_lock_free);

/// Prints the text unless that would block, as the reader of standard error may have stalled.
void say(std::string_view text) {
  pollfd ready{STDERR_FILENO, POLLOUT, 0};
  if (poll(&ready, 1, 0) <= 0) return;
  [[maybe_unused]] const auto written = write(STDERR_FILENO, text.data(), text.size());
}

// Calls only what is safe in a signal handler: atomics, poll() and write().
void handle(int signal) {
  Render* render = running.load();
  if (!render) return;
  const int error = errno;  // of the interrupted call
  int none = 0;
  if (requests.compare_exchange_strong(none, 1)) {
    say(render->settings().team ? "\nwriting what there is, without this pass; Ctrl-C again ends at once\n"
                                : "\nfinishing this pass and writing what there is; Ctrl-C again leaves this pass out\n");
    render->stop();
  } else if (signal == SIGINT) {
    requests.store(2);
    say("\nwriting what there is, without this pass; Ctrl-C again ends at once\n");
    render->abort();
    std::signal(SIGINT, SIG_DFL);
  }
  errno = error;
}

void install(void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // Slurm sends it some time before the end of a job, and mpirun passes it on, without killing soon after.
  sigaction(SIGUSR1, &action, nullptr);
  // A process that was started by nohup must survive the end of its terminal.
  struct sigaction old = {};
  if (sigaction(SIGHUP, nullptr, &old) == 0 && old.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
}

}  // namespace

Interruption::Interruption(Render& render) {
  requests = 0;
  running = &render;
  install(handle);
}

Interruption::~Interruption() {
  install(SIG_DFL);
  running = nullptr;
}

bool Interruption::asked() { return requests.load() != 0; }

}  // namespace etendue
