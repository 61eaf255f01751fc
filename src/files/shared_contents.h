#pragma once
// What several components read from one file, in memory once.

#include <map>
#include <memory>
#include <mutex>

namespace etendue {

/// Contents of files by keys, kept for as long as somebody has them. From any thread: different files are read at the same
/// time, and who asks for one that is being read waits for it. Whoever reads must not take up other work meanwhile (tbb's
/// `isolate`), for that might ask for the same.
template <class Key, class Version, class Contents>
class SharedContents {
 public:
  using Shared = std::shared_ptr<const Contents>;

  /// What `read()` returns, or has returned before for that key and version. What it throws is passed on.
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
    if (all_.size() > many_) {  // twice as many as were kept: some may be nobody's
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
