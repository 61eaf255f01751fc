#pragma once

#include <OpenImageIO/imageio.h>

#include <memory>
#include <string>

#include "files/regular_file.h"

namespace etendue {

/// An image file that is open. The library may open it once more while it reads: what was unpacked from another file stays.
class CheckedInput {
 public:
  CheckedInput() = default;
  CheckedInput(std::shared_ptr<const RegularFile> file, std::unique_ptr<OIIO::ImageInput> input, bool is_cube)
      : cube(is_cube), file_(std::move(file)), input_(std::move(input)) {}
  OIIO::ImageInput* operator->() const { return input_.get(); }
  explicit operator bool() const { return input_ != nullptr; }

  bool cube = false;  ///< see check_exr_header

 private:
  std::shared_ptr<const RegularFile> file_;
  std::unique_ptr<OIIO::ImageInput> input_;
};

/// Opens an image when it is a file and may hold what it claims; the library itself takes memory for whatever a header says.
/// Throws Error with the reason alone.
CheckedInput open_checked(const std::string& path);

}  // namespace etendue
