#pragma once
// Sample files for members that name one: small, made up when first asked for, in a temporary folder.

#include <mutex>
#include <set>
#include <string>

#include "etendue/describe/registry.h"

namespace etendue::conform {

class Fixtures {
 public:
  Fixtures();
  /// Removes the folder unless it was to be kept.
  ~Fixtures();
  Fixtures(const Fixtures&) = delete;
  Fixtures& operator=(const Fixtures&) = delete;

  /// A file the member of a class should be able to read, judged by what the class says of it; "" when there is none. Safe to
  /// call from any thread.
  std::string file_for(const ClassInfo&, const Member&) const;

  const std::string& folder() const { return folder_; }
  void keep() { keep_ = true; }

 private:
  std::string folder_;
  bool keep_ = false;
  mutable std::mutex mutex_;
  mutable std::set<std::string> written_;
};

}  // namespace etendue::conform
