// Standard output and standard error of the program.
//
// Both are replaced by streams (fopencookie) that write to the descriptor and always report success, so that no caller of print
// needs to handle errors. The first error is stored and reported at the end of the program.

#include "streams.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdio>
#include <system_error>

#include "commands.h"
#include "interruption.h"

namespace etendue {

namespace {

struct StandardStream {
  int descriptor;
  int error = 0;  ///< the first error
};
StandardStream standard_output{STDOUT_FILENO}, standard_error{STDERR_FILENO};

/// Waits until PIPE_BUF bytes can be written without blocking. A reader may take as long as it likes: a pager waits for its
/// user. But after a signal to stop, a reader that has taken nothing for some time is given up, so that a render still writes
/// its picture; then the result is false.
bool wait_for_reader(int descriptor) {
  constexpr int interval = 250, patience = 2000;  // [ms]
  for (int waited = 0; waited < patience; waited += Interruption::asked() ? interval : 0) {
    pollfd ready{descriptor, POLLOUT, 0};
    const int count = ::poll(&ready, 1, interval);
    if (count > 0 || (count < 0 && errno != EINTR)) return true;  // write() reports what is wrong with the descriptor
  }
  return false;
}

/// Writes all bytes, or stores the error.
ssize_t write_to(void* cookie, const char* data, size_t size) {
  auto& stream = *static_cast<StandardStream*>(cookie);
  size_t done = 0;
  while (done < size && stream.error == 0) {
    if (!wait_for_reader(stream.descriptor)) {
      stream.error = ETIMEDOUT;
      break;
    }
    const ssize_t written = ::write(stream.descriptor, data + done, std::min<size_t>(size - done, PIPE_BUF));
    if (written > 0)
      done += size_t(written);
    else if (written < 0 && errno != EINTR && errno != EAGAIN)  // EAGAIN: another process made a shared terminal non-blocking
      stream.error = errno;
  }
  return ssize_t(size);
}

/// Null if memory is short: then the original stream stays in use.
std::FILE* stream_to(StandardStream& stream, int buffering) {
  std::FILE* file = fopencookie(&stream, "w", {nullptr, write_to, nullptr, nullptr});
  if (file) std::setvbuf(file, nullptr, buffering, BUFSIZ);
  return file;
}

/// If a descriptor is closed, opens a file on it that fails as a closed one would: for reading if it is opened for writing
/// only, and vice versa.
void occupy(int descriptor) {
  if (::fcntl(descriptor, F_GETFD) >= 0 || errno != EBADF) return;
  int opened = ::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  if (opened < 0) opened = ::open("/", O_RDONLY | O_DIRECTORY);
  // open() returns the lowest free descriptor; all below this one are in use.
  if (opened >= 0 && opened != descriptor) {
    ::dup2(opened, descriptor);
    ::close(opened);
  }
}

}  // namespace

void open_standard_streams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) occupy(descriptor);
  std::signal(SIGPIPE, SIG_IGN);
  if (std::FILE* file = stream_to(standard_output, isatty(STDOUT_FILENO) ? _IOLBF : _IOFBF)) stdout = file;
  if (std::FILE* file = stream_to(standard_error, _IONBF)) stderr = file;
}

int close_standard_streams(int status) {
  std::fflush(stdout);
  const int error = standard_output.error;
  if (error == 0 || error == EPIPE) return status;
  fmt::print(stderr, "etendue: cannot write to standard output: {}\n", std::generic_category().message(error));
  return status == exit_status::done ? exit_status::failed : status;
}

}  // namespace etendue
