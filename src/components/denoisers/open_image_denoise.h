#pragma once
// Open Image Denoise (Áfra 2025, www.openimagedenoise.org), found while the program runs. Its functions are declared here as
// its documentation of version 2 has them, so that nothing of it is needed to build.

#include <cstddef>
#include <string>

namespace etendue {

class OpenImageDenoise {
 public:
  using Device = struct DeviceHandle*;
  using Filter = struct FilterHandle*;

  /// The library, loaded once and never unloaded. It is looked for where the environment variable ETENDUE_OIDN says, else
  /// where the system looks for libraries, else in the package pyoidn of Pythons. (No description names it: whoever opens one
  /// would run what it names.) Throws Error that tells what was tried and how to get it.
  static const OpenImageDenoise& load();

  std::string version() const;  ///< "2.5.1"

  Device (*new_device)(int type) = nullptr;
  void (*commit_device)(Device) = nullptr;
  void (*release_device)(Device) = nullptr;
  int (*device_number)(Device, const char* name) = nullptr;
  void (*set_device_number)(Device, const char* name, int) = nullptr;
  void (*set_device_switch)(Device, const char* name, bool) = nullptr;
  int (*device_error)(Device, const char** message) = nullptr;
  Filter (*new_filter)(Device, const char* type) = nullptr;
  void (*release_filter)(Filter) = nullptr;
  /// Pixels at an address: of `width` x `height` pixels, offset and strides in bytes (0: packed).
  void (*set_image)(Filter, const char* name, void*, int format, std::size_t width, std::size_t height, std::size_t offset,
                    std::size_t pixel_stride, std::size_t row_stride) = nullptr;
  void (*set_switch)(Filter, const char* name, bool) = nullptr;
  void (*set_number)(Filter, const char* name, int) = nullptr;
  void (*commit_filter)(Filter) = nullptr;
  void (*execute)(Filter) = nullptr;

  // Of its enumerations OIDNDeviceType, OIDNError, OIDNFormat and OIDNQuality.
  static constexpr int cpu_device = 1, no_error = 0, three_floats = 3;
  static constexpr int fast_quality = 4, balanced_quality = 5, high_quality = 6;

 private:
  explicit OpenImageDenoise(void* library);
  int version_ = 0;  // 10000 major + 100 minor + patch
};

}  // namespace etendue
