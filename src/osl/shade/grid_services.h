#pragma once
// GridServices: the world in which `etendue shade` runs shaders. It is that of the reference implementation's testshade: fixed
// coordinate systems, a camera, and a few data of the geometry.

#include <cstdio>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "arguments.h"
#include "osl/library/services.h"
#include "osl/running/globals.h"
#include "osl/running/point_memory.h"
#include "osl/textures/texture_files.h"

namespace etendue::osl {

class GridServices final : public Services {
 public:
  explicit GridServices(const ShadeArguments&);
  ~GridServices() override;

  /// The point that is shaded next, and its number.
  void begin(const Globals& point, int index);
  bool failed() const { return failed_; }

  bool to_common(const String*, Matrix&) override;
  bool ray_type(const String*) const override;
  bool attribute(const String* object, const String* name, int index, const Type&, bool derivatives, void* out) override;
  std::string_view texture(const String* file, const Dual<float>& s, const Dual<float>& t, const TextureOptions& options,
                           TextureLookup& lookup) override {
    return textures_.texture({file, options.shader_file}, s, t, options, lookup);
  }
  std::string_view environment(const String* file, const Dual<Triple>& direction, const TextureOptions& options,
                               TextureLookup& lookup) override {
    return textures_.environment({file, options.shader_file}, direction, options, lookup);
  }
  bool texture_info(const String* file, const float* at, const String* name, const Type& type, void* out,
                    const char* shader_file) override {
    return textures_.texture_info({file, shader_file}, at, name, type, out);
  }
  void print(std::string_view) override;
  void print_to(const String* file, std::string_view) override;
  void warn(std::string_view, Location) override;
  void error(std::string_view, Location) override;
  const ColorSystem& color_system() const override { return *color_system_; }
  void* allocate(std::size_t size, std::size_t alignment) override;

 private:
  bool camera_attribute(std::string_view name, int index, const Type&, void* out) const;
  bool geometry_data(std::string_view name, const Type&, bool derivatives, void* out) const;
  void report(const char* kind, std::string_view, Location);

  const ShadeArguments& arguments_;
  const ColorSystem* color_system_;
  bool repeats_errors_ = false, failed_ = false;
  Globals point_;
  int index_ = 0;
  PointMemory memory_;
  TextureFiles textures_;
  std::set<std::string, std::less<>> reported_;
  std::map<const String*, std::FILE*> files_;
};

/// The point in column x and row y of the grid: P = (u, v, 1), with the derivatives per pixel.
Globals grid_point(const ShadeArguments&, int x, int y);

}  // namespace etendue::osl
