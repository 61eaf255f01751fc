#pragma once
// A second reading of the same file, to find out whether the first one depends on memory that nobody wrote.
//
// Of a damaged file the library may take values from beyond the end of a list, or from memory that it never filled: what is
// read then is garbage that differs from run to run, and sometimes looks sound. So everything is done twice at once, in two
// processes whose memory differs in what is there before anything is written, and in all addresses; where what they make is the
// same, it comes from the file.

#include <cstdint>
#include <optional>

namespace etendue::assimp_helper {

class SecondReading {
 public:
  /// Divides the process: both go on from here.
  SecondReading();
  ~SecondReading();
  SecondReading(const SecondReading&) = delete;
  SecondReading& operator=(const SecondReading&) = delete;

  /// Whether this is the second process: it has no output but `tell`.
  bool here() const { return here_; }
  /// The second process tells the first what it has made, by a digest.
  void tell(std::uint64_t digest) const;
  /// In the first: what it told; nothing: it failed.
  std::optional<std::uint64_t> told() const;

 private:
  bool here_ = false;
  int read_ = -1, write_ = -1;
};

}  // namespace etendue::assimp_helper
