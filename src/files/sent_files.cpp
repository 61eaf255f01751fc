#include "sent_files.h"

#include <atomic>
#include <filesystem>
#include <mutex>

namespace etendue {
namespace {

std::atomic<bool> any = false;  // almost always false, and asked for each path
std::mutex mutex;

std::string& sent_folder() {
  static auto* folder = new std::string;  // never destroyed: files are read until the program ends
  return *folder;
}

std::string current_folder() {
  if (!any) return {};
  const std::lock_guard lock(mutex);
  return sent_folder();
}

bool below(const std::string& path, const std::string& folder) { return path.starts_with(folder + "/"); }

}  // namespace

void set_sent_folder(const std::string& folder) {
  const std::lock_guard lock(mutex);
  sent_folder() = folder;
  any = !folder.empty();
}

std::string where_sent(const std::string& path) {
  const std::string folder = current_folder();
  if (folder.empty() || !path.starts_with('/') || below(path, folder)) return path;
  std::error_code ignored;
  return std::filesystem::exists(folder + path, ignored) ? folder + path : path;
}

std::string where_sent_from(const std::string& path) {
  const std::string folder = current_folder();
  return !folder.empty() && below(path, folder) ? path.substr(folder.size()) : path;
}

}  // namespace etendue
