#pragma once
// Importer: a file of another program into components.

#include <string>
#include <vector>

#include "etendue/describe/component.h"
#include "etendue/describe/description.h"

namespace etendue {

class Importer : public Component {
 public:
  using Interface = Importer;
  using Parent = Component;
  static void describe(Description<Importer>&);

  /// File name endings it reads, without dots, lower case.
  virtual std::vector<std::string> extensions() const = 0;
  /// The components a file holds: a Job, or parts of one. Throws Error naming the file and the place in it.
  virtual std::vector<Ref<Component>> import(const std::string& path) const = 0;
};

}  // namespace etendue
