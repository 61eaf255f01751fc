#pragma once
// Image files for tests.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "images/image_library.h"

namespace etendue::test {

/// Writes an image in the format of the path's extension.
inline void write_image(const std::string& path, const ImageHeader& header, const std::vector<float>& values) {
  const std::vector<unsigned char> bytes =
      image_library().encode(std::filesystem::path(path).extension().string(), header, values);
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

/// A temporary file that is removed by the destructor.
struct ImageFile {
  std::string path;
  explicit ImageFile(const std::string& name)
      : path((std::filesystem::temp_directory_path() / ("etendue-" + std::to_string(getpid()) + "-" + name)).string()) {}
  ImageFile(const std::string& name, const ImageHeader& header, const std::vector<float>& values) : ImageFile(name) {
    write_image(path, header, values);
  }
  /// Floats of R, G and B.
  ImageFile(const std::string& name, int width, int height, const std::vector<float>& rgb)
      : ImageFile(name, {width, height, 3, NumberType::single}, rgb) {}
  ImageFile(const ImageFile&) = delete;
  ImageFile& operator=(const ImageFile&) = delete;
  ~ImageFile() { std::filesystem::remove(path); }
};

}  // namespace etendue::test
