#pragma once
// RenderServices: the world as shaders see it at a point of a scene.

#include "etendue/describe/color.h"
#include "etendue/object_map.h"
#include "map_inputs.h"
#include "osl/language/tree.h"
#include "osl/library/services.h"
#include "osl/running/globals.h"
#include "osl/running/point_memory.h"

namespace etendue::osl {

class RenderServices final : public Services {
 public:
  /// `wavelengths` may be null where only numbers are asked for. `scene_file` is that which describes the part.
  RenderServices(const SurfacePoint& p, const Wavelengths* w, PointMemory& memory, const std::string& class_name,
                 const char* scene_file, const MapInputs& maps)
      : point_(p), wavelengths_(w), memory_(memory), class_name_(class_name), scene_file_(scene_file), maps_(maps) {}

  bool to_common(const String* space, Matrix& out) override;
  bool from_common(const String* space, Matrix& out) override;
  bool attribute(const String* object, const String* name, int index, const Type&, bool derivatives, void* out) override;
  std::string_view texture(const String* file, const Dual<float>& s, const Dual<float>& t, const TextureOptions&,
                           TextureLookup&) override;
  std::string_view environment(const String* file, const Dual<Triple>& direction, const TextureOptions&,
                               TextureLookup&) override;
  bool texture_info(const String* file, const float* at, const String* name, const Type&, void* out,
                    const char* shader_file) override;
  void print(std::string_view) override;
  void warn(std::string_view, Location) override;
  void error(std::string_view, Location) override;
  bool transform_color(const String* from, const String* to, const Triple&, Triple& out) override;
  const Wavelengths& wavelengths() const override;
  bool named_spectrum(const String* words, Spectrum& out) override;
  Spectrum color_spectrum(const Triple&, bool light) override;
  void* allocate(std::size_t size, std::size_t alignment) override { return memory_.allocate(size, alignment); }

 private:
  const SurfacePoint& point_;
  const Wavelengths* wavelengths_;
  PointMemory& memory_;
  const std::string& class_name_;
  const char* scene_file_;
  const MapInputs& maps_;
};

/// What the shaders of a group read of the point that is not at hand but has to be computed.
struct NeededGlobals {
  bool position = false;     ///< P, with its derivatives
  bool coordinates = false;  ///< u and v, with theirs
  bool tangents = false;     ///< dPdu and dPdv
  bool area = false;         ///< surfacearea()
  /// Adds what a shader needs.
  void add(const osl::Shader&);
};

/// Sets the variables of a point that is seen from where its ray came from, or from the front if that is unknown; those that
/// are not needed are 0. Returns whether the geometric normal pointed away from the viewer: N and Ng are turned to the viewer.
bool set_globals(SurfacePoint, NeededGlobals, Globals&);

}  // namespace etendue::osl
