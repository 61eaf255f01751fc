// Ctrl-C while a job renders.

#include "interruption.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <string_view>

namespace etendue {

namespace {

std::atomic<Job*> running{nullptr};
std::atomic<int> requests{0};  // 1: finish, 2: abort
static_assert(std::atomic<Job*>::is_always_lock_free && std::atomic<int>::is_always_lock_free &&
              std::atomic<bool>::is_always_lock_free);

void say(std::string_view text) { [[maybe_unused]] const auto written = write(STDERR_FILENO, text.data(), text.size()); }

// Only what is safe in a signal handler: atomics and write().
void handle(int signal) {
  Job* job = running.load();
  if (!job) return;
  const int error = errno;  // of whatever was interrupted
  int none = 0;
  if (requests.compare_exchange_strong(none, 1)) {
    say("\nfinishing this pass and writing what there is; Ctrl-C again aborts\n");
    job->finish();
  } else if (signal == SIGINT) {
    requests.store(2);
    say("\naborting\n");
    job->abort();
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
  // What nohup started is to survive its terminal.
  struct sigaction old = {};
  if (sigaction(SIGHUP, nullptr, &old) == 0 && old.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
}

}  // namespace

Interruption::Interruption(Job& job) {
  requests = 0;
  running = &job;
  install(handle);
}

Interruption::~Interruption() {
  install(SIG_DFL);
  running = nullptr;
}

bool Interruption::asked() const { return requests.load() != 0; }

}  // namespace etendue
