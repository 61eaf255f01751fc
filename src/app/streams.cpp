// Standard output and standard error of the program.
//
// Both are replaced by streams (fopencookie) that write to the descriptor and always report success, so that no caller of print
// needs to handle errors. The first error is stored and reported at the end of the program.

#include "streams.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <system_error>

#include "commands.h"

namespace etendue {

namespace {

struct StandardStream {
  int descriptor;
  int error = 0;  ///< the first error
};
StandardStream standard_output{STDOUT_FILENO}, standard_error{STDERR_FILENO};

/// Writes all bytes, or stores the error.
ssize_t write_to(void* cookie, const char* data, size_t size) {
  auto& stream = *static_cast<StandardStream*>(cookie);
  size_t done = 0;
  while (done < size && stream.error == 0) {
    const ssize_t written = ::write(stream.descriptor, data + done, size - done);
    if (written > 0) {
      done += size_t(written);
    } else if (written < 0 && errno == EAGAIN) {  // another process may have made a shared terminal non-blocking
      pollfd ready{stream.descriptor, POLLOUT, 0};
      ::poll(&ready, 1, 1000);
    } else if (written < 0 && errno != EINTR) {
      stream.error = errno;
    }
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
