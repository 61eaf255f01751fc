// The table of interned strings.

#include "interned_string.h"

#include <OpenImageIO/strutil.h>

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <unordered_map>

namespace etendue::osl {

namespace {

// The table is cut into parts by the hash, so that threads which intern different texts rarely wait for each other.
struct Part {
  std::shared_mutex mutex;
  std::unordered_map<std::string_view, std::unique_ptr<const String>> strings;
};

struct Table {
  std::array<Part, 64> parts;
};

std::atomic<std::size_t> total_bytes = 0;

Table& table() {
  static Table* const all = new Table;  // never destroyed: static objects of shaders hold strings
  return *all;
}

}  // namespace

std::uint64_t farm_hash(std::string_view text) { return text.empty() ? 0 : OIIO::Strutil::strhash(text.size(), text.data()); }

const String* intern_string(std::string_view text) {
  const std::uint64_t hash = farm_hash(text);
  Part& part = table().parts[(hash >> 32) % 64];
  {
    const std::shared_lock lock(part.mutex);
    if (const auto found = part.strings.find(text); found != part.strings.end()) return found->second.get();
  }
  auto made = std::make_unique<const String>(text, std::uint32_t(hash));
  total_bytes.fetch_add(text.size() + sizeof(String), std::memory_order_relaxed);
  const std::unique_lock lock(part.mutex);
  return part.strings.try_emplace(made->view(), std::move(made)).first->second.get();
}

std::size_t interned_bytes() { return total_bytes.load(std::memory_order_relaxed); }

const String* empty_string() {
  static const String* const empty = intern_string("");
  return empty;
}

}  // namespace etendue::osl
