#pragma once
// Messages between the processes of a team (ranks, as MPI calls them).

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace etendue {

/// The bytes of a message, which may be sent to several processes.
using Parcel = std::shared_ptr<const std::vector<std::byte>>;

/// All functions are called from one thread, and none of them waits for another process, except open and close.
class Messages {
 public:
  virtual ~Messages() = default;
  /// Connects with the others. Throws Error.
  virtual void open() = 0;
  virtual int rank() const = 0;  ///< of this process: 0 … size - 1
  virtual int size() const = 0;

  virtual void send(int to, Parcel) = 0;
  struct Received {
    int from = 0;
    std::vector<std::byte> bytes;
  };
  /// The next message of any other process; those of one process arrive in the order in which they were sent.
  virtual std::optional<Received> receive() = 0;
  /// Whether everything that was sent is on its way, and may be forgotten here.
  virtual bool all_sent() = 0;

  /// Waits for the others, which close, too.
  virtual void close() = 0;
  /// Ends all processes of the team without waiting, this one included if they are processes of the system.
  virtual void abandon(int status) = 0;
};

}  // namespace etendue
