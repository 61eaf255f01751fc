// attribute_number: assigns numbers to the names of attributes.

#include <map>
#include <mutex>

#include "etendue/mesh_facts.h"

namespace etendue {

int attribute_number(const std::string& name) {
  static std::mutex mutex;
  static std::map<std::string, int> numbers;
  const std::lock_guard lock(mutex);
  return numbers.emplace(name, int(numbers.size())).first->second;
}

}  // namespace etendue
