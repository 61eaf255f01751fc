#pragma once
// File contents that several components share, loaded once.

#include <map>
#include <memory>
#include <mutex>

namespace etendue {

/// Contents of files by key, kept for as long as they are in use. Thread-safe: different files are read concurrently, and a
/// request for a file that is being read waits. `read` must not take up other tbb tasks (use tbb's `isolate`), since such a
/// task might request the same file.
template <class Key, class Version, class Contents>
class SharedContents {
 public:
  using Shared = std::shared_ptr<const Contents>;

  /// The contents for this key and version, from `read()` unless they are in memory. Exceptions of `read` are passed on.
  template <class Read>
  Shared get(const Key& key, const Version& version, Read read) {
    const std::shared_ptr<Entry> entry = entry_of(key);
    const std::lock_guard lock(entry->reading);
    if (entry->version == version)
      if (Shared there = entry->contents.lock()) return there;
    Shared made = read();
    entry->version = version;
    entry->contents = made;
    return made;
  }

 private:
  struct Entry {
    std::mutex reading;
    Version version{};
    std::weak_ptr<const Contents> contents;
  };

  std::shared_ptr<Entry> entry_of(const Key& key) {
    const std::lock_guard lock(guard_);
    if (all_.size() > many_) {  // twice as many as remained the last time: some may be unused
      std::erase_if(all_, [](const auto& e) { return e.second.use_count() == 1 && e.second->contents.expired(); });
      many_ = 2 * all_.size() + 64;
    }
    std::shared_ptr<Entry>& entry = all_[key];
    if (!entry) entry = std::make_shared<Entry>();
    return entry;
  }

  std::mutex guard_;
  std::map<Key, std::shared_ptr<Entry>> all_;
  size_t many_ = 64;
};

}  // namespace etendue
