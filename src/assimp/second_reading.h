#pragma once
// Reads the same file a second time, to detect results that depend on uninitialized memory.
//
// For a damaged file Assimp may read values beyond the end of a list, or memory that it never initialized: the result is
// garbage that differs from run to run and sometimes looks valid. So two processes do everything at the same time, with
// different initial memory contents and different addresses; if their results are equal, they depend on the file only.

#include <cstdint>
#include <optional>

namespace etendue::assimp_helper {

class SecondReading {
 public:
  /// Forks the process: both continue from here.
  SecondReading();
  ~SecondReading();
  SecondReading(const SecondReading&) = delete;
  SecondReading& operator=(const SecondReading&) = delete;

  /// Whether this is the second process, whose only output is `tell`.
  bool here() const { return here_; }
  /// Called in the second process: sends the digest of its result to the first.
  void tell(std::uint64_t digest) const;
  /// Called in the first process: the digest from the second; nothing: it failed.
  std::optional<std::uint64_t> told() const;

 private:
  bool here_ = false;
  int read_ = -1, write_ = -1;
};

}  // namespace etendue::assimp_helper
