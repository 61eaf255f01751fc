#pragma once

#include <OpenImageIO/imageio.h>

#include <memory>
#include <string>

#include "files/regular_file.h"

namespace etendue {

/// An open image file. The library may open it again while it reads, so a temporary file unpacked from another file is kept.
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

/// Opens an image if it is a regular file that can hold the pixels its header claims; the library itself allocates memory for
/// any claim. Throws Error with the reason, without the path.
CheckedInput open_checked(const std::string& path);

}  // namespace etendue
