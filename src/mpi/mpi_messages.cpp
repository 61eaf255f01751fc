// Messages by MPI. All calls come from the thread that opens them, as MPI_THREAD_FUNNELED asks.

#include <fmt/format.h>
#include <mpi.h>

#include <algorithm>
#include <deque>
#include <utility>

#include "etendue/core/error.h"
#include "render/team/message_library.h"

namespace etendue {
namespace {

/// Counts are ints: larger messages are sent in pieces of this size, the last of which has another tag.
constexpr size_t most = size_t(1) << 30;
constexpr int last_piece = 0, piece = 1;

void require(int result, const char* what) {
  if (result == MPI_SUCCESS) return;
  char text[MPI_MAX_ERROR_STRING] = {};
  int length = 0;
  MPI_Error_string(result, text, &length);
  throw Error(fmt::format("MPI: {} failed: {}", what, text));
}

class MpiMessages final : public Messages {
 public:
  void open() override {
    int provided = MPI_THREAD_SINGLE;
    require(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided), "MPI_Init_thread");
    if (provided < MPI_THREAD_FUNNELED) throw Error("this MPI does not support threads (MPI_THREAD_FUNNELED)");
    require(MPI_Comm_dup(MPI_COMM_WORLD, &all_), "MPI_Comm_dup");
    MPI_Comm_set_errhandler(all_, MPI_ERRORS_RETURN);
    MPI_Comm_rank(all_, &rank_);
    MPI_Comm_size(all_, &size_);
    incoming_.resize(size_t(size_));
    partial_.resize(size_t(size_));
  }
  int rank() const override { return rank_; }
  int size() const override { return size_; }

  void send(int to, Parcel parcel) override {
    size_t begin = 0;
    do {
      const size_t count = std::min(parcel->size() - begin, most);
      const int tag = begin + count == parcel->size() ? last_piece : piece;
      sending_.push_back({parcel, MPI_REQUEST_NULL});
      require(MPI_Isend(parcel->data() + begin, int(count), MPI_BYTE, to, tag, all_, &sending_.back().request), "MPI_Isend");
      begin += count;
    } while (begin < parcel->size());
  }

  std::optional<Received> receive() override {
    forget_sent();
    begin_receiving();
    for (int from = 0; from < size_; ++from) {
      std::deque<Incoming>& queue = incoming_[size_t(from)];
      while (!queue.empty()) {
        int complete = 0;
        require(MPI_Test(&queue.front().request, &complete, MPI_STATUS_IGNORE), "MPI_Test");
        if (!complete) break;
        std::vector<std::byte> bytes = std::move(queue.front().bytes);
        const bool last = queue.front().tag == last_piece;
        queue.pop_front();
        std::vector<std::byte>& before = partial_[size_t(from)];
        if (!before.empty() || !last) {
          before.insert(before.end(), bytes.begin(), bytes.end());
          if (!last) continue;
          bytes = std::exchange(before, {});
        }
        return Received{from, std::move(bytes)};
      }
    }
    return {};
  }

  bool all_sent() override {
    forget_sent();
    return sending_.empty();
  }

  void close() override {
    MPI_Comm_free(&all_);
    MPI_Finalize();
  }
  void abandon(int status) override { MPI_Abort(MPI_COMM_WORLD, status); }

 private:
  struct Sending {
    Parcel parcel;  ///< kept until it is sent
    MPI_Request request;
  };
  struct Incoming {
    std::vector<std::byte> bytes;
    int tag;
    MPI_Request request;
  };

  /// Begins to receive all messages that have been announced, without waiting for them.
  void begin_receiving() {
    while (true) {
      int found = 0;
      MPI_Message message = MPI_MESSAGE_NULL;
      MPI_Status status;
      require(MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, all_, &found, &message, &status), "MPI_Improbe");
      if (!found) return;
      int count = 0;
      MPI_Get_count(&status, MPI_BYTE, &count);
      Incoming& next = incoming_[size_t(status.MPI_SOURCE)].emplace_back();
      next.bytes.resize(size_t(count));
      next.tag = status.MPI_TAG;
      require(MPI_Imrecv(next.bytes.data(), count, MPI_BYTE, &message, &next.request), "MPI_Imrecv");
    }
  }
  void forget_sent() {
    while (!sending_.empty()) {
      int complete = 0;
      require(MPI_Test(&sending_.front().request, &complete, MPI_STATUS_IGNORE), "MPI_Test");
      if (!complete) return;  // those behind it are kept a little longer
      sending_.pop_front();
    }
  }

  MPI_Comm all_ = MPI_COMM_NULL;
  int rank_ = 0, size_ = 1;
  std::deque<Sending> sending_;
  std::vector<std::deque<Incoming>> incoming_;   ///< by sender, in order
  std::vector<std::vector<std::byte>> partial_;  ///< pieces of a large message, by sender
};

std::unique_ptr<Messages> make_messages() { return std::make_unique<MpiMessages>(); }

const struct Announced {
  Announced() { announce_messages(make_messages, ETENDUE_VERSION); }
} announced_here;

}  // namespace
}  // namespace etendue
