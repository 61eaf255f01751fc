#pragma once
// Open Image Denoise (Áfra 2025, www.openimagedenoise.org), loaded at run time. The library's functions are declared here
// according to its documentation of version 2, so that no part of the library is needed to build.

#include <cstddef>
#include <string>

namespace etendue {

class OpenImageDenoise {
 public:
  using Device = struct DeviceHandle*;
  using Filter = struct FilterHandle*;

  /// The library, loaded once and never unloaded. Its path is that in the environment variable ETENDUE_OIDN, else the system's
  /// search path is tried, else the package pyoidn of Python installations. (Render descriptions cannot name the library, as
  /// opening a description would then execute a library of its choice.) Throws Error with the paths that were tried and how to
  /// get the library.
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
  /// Sets a filter's image to `width` x `height` pixels in memory; offset and strides are in bytes (0: packed).
  void (*set_image)(Filter, const char* name, void*, int format, std::size_t width, std::size_t height, std::size_t offset,
                    std::size_t pixel_stride, std::size_t row_stride) = nullptr;
  void (*set_switch)(Filter, const char* name, bool) = nullptr;
  void (*set_number)(Filter, const char* name, int) = nullptr;
  void (*commit_filter)(Filter) = nullptr;
  void (*execute)(Filter) = nullptr;

  // Values of the library's enumerations OIDNDeviceType, OIDNError, OIDNFormat and OIDNQuality.
  static constexpr int cpu_device = 1, no_error = 0, three_floats = 3;
  static constexpr int fast_quality = 4, balanced_quality = 5, high_quality = 6;

 private:
  explicit OpenImageDenoise(void* library);
  int version_ = 0;  // 10000 major + 100 minor + patch
};

}  // namespace etendue
