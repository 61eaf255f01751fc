#include "thread_messages.h"

#include <deque>
#include <mutex>

namespace etendue {
namespace {

/// What was sent to one rank and is not yet received.
struct Inbox {
  std::mutex mutex;
  std::deque<Messages::Received> messages;
};

class ThreadMessages final : public Messages {
 public:
  ThreadMessages(int rank, std::shared_ptr<std::vector<Inbox>> inboxes) : rank_(rank), inboxes_(std::move(inboxes)) {}
  void open() override {}
  int rank() const override { return rank_; }
  int size() const override { return int(inboxes_->size()); }
  void send(int to, Parcel parcel) override {
    Inbox& inbox = (*inboxes_)[size_t(to)];
    const std::lock_guard lock(inbox.mutex);
    inbox.messages.push_back({rank_, *parcel});
  }
  std::optional<Received> receive() override {
    Inbox& inbox = (*inboxes_)[size_t(rank_)];
    const std::lock_guard lock(inbox.mutex);
    if (inbox.messages.empty()) return {};
    Received first = std::move(inbox.messages.front());
    inbox.messages.pop_front();
    return first;
  }
  bool all_sent() override { return true; }
  void close() override {}
  void abandon(int) override {}

 private:
  int rank_;
  std::shared_ptr<std::vector<Inbox>> inboxes_;
};

}  // namespace

std::vector<std::unique_ptr<Messages>> thread_messages(int size) {
  const auto inboxes = std::make_shared<std::vector<Inbox>>(size_t(size));
  std::vector<std::unique_ptr<Messages>> all;
  for (int rank = 0; rank < size; ++rank) all.push_back(std::make_unique<ThreadMessages>(rank, inboxes));
  return all;
}

}  // namespace etendue
