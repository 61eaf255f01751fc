#pragma once
// Services: what functions of the library need from the world: the renderer, its scene, its files, and the point that is
// shaded.
//
// The default of each method is an empty world: nothing is found, nothing is printed. All strings are interned. A method that
// fills a value gets its type and its address; `derivatives` says that the two blocks of derivatives follow and must be set,
// too.

#include <string>
#include <string_view>

#include "color_system.h"
#include "etendue/core/error.h"
#include "etendue/core/spectrum.h"
#include "osl/values/dual.h"
#include "osl/values/interned_string.h"
#include "osl/values/type.h"

namespace etendue::osl {

/// Options of texture(), texture3d() and environment(), as given behind the coordinates; the defaults are the language's.
struct TextureOptions {
  float blur[3] = {0, 0, 0};                            ///< s, t, r: relative to the texture's size
  float width[3] = {1, 1, 1};                           ///< factors of the filter's size
  const String* wrap[3] = {nullptr, nullptr, nullptr};  ///< "black", "periodic", "clamp", "mirror"; null: the texture's own
  int first_channel = 0;
  int subimage = 0;
  const String* subimage_name = nullptr;  ///< instead of the index, unless null
  float fill = 0;                         ///< value of channels that the file does not have
  float time = 0;
  const String* interpolation = nullptr;  ///< "smartcubic" (the default, null), "cubic", "linear", "closest"
  const String* color_space = nullptr;
  const char* shader_file = "";  ///< of the shader that asks: relative names are searched beside it first
  bool has_missing_color = false;
  Triple missing_color;
  float missing_alpha = 0;
};

/// What a lookup of a texture gives: `channels` values (1 or 3) and, if asked, the channel behind them; with their derivatives
/// by s, t (and r) if the caller wants them.
struct TextureLookup {
  int channels = 3;
  bool wants_alpha = false, wants_derivatives = false;
  float value[4] = {};  ///< the channels, then alpha at index `channels`
  float by_s[4] = {};   ///< derivatives of the same [1 per unit of s]
  float by_t[4] = {};
  float by_r[4] = {};
};

class Services {
 public:
  virtual ~Services() = default;

  // Coordinate systems and units

  /// Sets the matrix that takes points from the named space to "common" space; false if the name is unknown. "common" itself is
  /// known by the library.
  virtual bool to_common(const String* /*space*/, Matrix& /*out*/) { return false; }
  /// The same from "common" space to the named one. The default inverts to_common.
  virtual bool from_common(const String* space, Matrix& out);
  /// Whether an unknown space is an error of the shader (the library then calls error) instead of the identity.
  virtual bool unknown_space_is_error() const { return true; }
  /// Seconds per unit of "common" time, and per frame.
  virtual float seconds_per_time() const { return 1; }
  virtual float seconds_per_frame() const { return 1.0f / 24; }
  /// Metres per unit of "common" space.
  virtual float metres_per_unit() const { return 1; }

  // The point that is shaded

  virtual Triple geometric_normal() const { return {0, 0, 1}; }
  virtual bool backfacing() const { return false; }
  /// Whether the ray has the named type: "camera", "shadow", "diffuse", "glossy", "reflection", "refraction", ...
  virtual bool ray_type(const String* /*name*/) const { return false; }
  /// Whether calculatenormal and area see a coordinate system that is left-handed, so that the cross product of dP/dx and dP/dy
  /// points inside.
  virtual bool flipped_handedness() const { return false; }
  /// The area of the object's surface [common units squared].
  virtual float surface_area() const { return 0; }
  /// displace() and bump(): moves P by the offset (bump: not), and N accordingly.
  virtual void displace(const Dual<Triple>& /*offset*/, bool /*bump*/) {}
  /// displace(amount) and bump(amount): along N, in a space's units (null: common).
  virtual void displace_along_normal(const Dual<float>& /*amount*/, const String* /*space*/, bool /*bump*/) {}

  // Attributes and messages

  /// getattribute: the attribute of the named object (null: the current one, then the scene), element `index` of an array
  /// unless it is -1. Sets the value and returns true if there is one of exactly this type (all triples are of one type for
  /// this).
  virtual bool attribute(const String* /*object*/, const String* /*name*/, int /*index*/, const Type&, bool /*derivatives*/,
                         void* /*out*/) {
    return false;
  }
  virtual void set_message(const String* /*name*/, const Type&, bool /*derivatives*/, const void* /*value*/, Location) {}
  /// `source` is null or "trace". False if there is no such message.
  virtual bool get_message(const String* /*source*/, const String* /*name*/, const Type&, bool /*derivatives*/, void* /*out*/,
                           Location) {
    return false;
  }

  // Images

  /// Each lookup returns an empty text, or the reason why there is no texture. The coordinates' derivatives give the filter.
  virtual std::string_view texture(const String* /*file*/, const Dual<float>& /*s*/, const Dual<float>& /*t*/,
                                   const TextureOptions&, TextureLookup&) {
    return "there are no textures here";
  }
  static constexpr std::string_view no_solid_textures = "texture3d() is not supported: there are no textures of volumes";
  virtual std::string_view texture3d(const String* /*file*/, const Dual<Triple>& /*p*/, const TextureOptions&, TextureLookup&) {
    return no_solid_textures;
  }
  virtual std::string_view environment(const String* /*file*/, const Dual<Triple>& /*direction*/, const TextureOptions&,
                                       TextureLookup&) {
    return "there are no textures here";
  }
  /// gettextureinfo; `at` are coordinates or null, `shader_file` as in TextureOptions. False if there is no such fact of this
  /// type.
  virtual bool texture_info(const String* /*file*/, const float* /*at*/, const String* /*name*/, const Type&, void* /*out*/,
                            const char* /*shader_file*/ = "") {
    return false;
  }

  /// dict_find: the text of an XML file. Throws Error with the reason. The default reads a regular file of this name.
  virtual std::string dictionary(const String* file);

  // Text

  virtual void print(std::string_view) {}
  virtual void print_to(const String* /*file*/, std::string_view) {}
  virtual void warn(std::string_view, Location) {}
  virtual void error(std::string_view, Location) {}

  // Colour and spectra

  /// The RGB space of the shader's colours.
  virtual const ColorSystem& color_system() const { return ColorSystem::rec709(); }
  /// transformc between spaces of which the library does not know both; false if the renderer does not either.
  virtual bool transform_color(const String* /*from*/, const String* /*to*/, const Triple&, Triple& /*out*/) { return false; }
  /// The wavelengths of the path [nm].
  virtual const Wavelengths& wavelengths() const;
  /// spectrum("metal Au"): a spectrum of the description language; false if the words mean none.
  virtual bool named_spectrum(const String* /*words*/, Spectrum& /*out*/) { return false; }
  /// A colour of the color_system as a reflectance spectrum (`light`: as radiance).
  virtual Spectrum color_spectrum(const Triple&, bool /*light*/) { return {}; }

  // Memory

  /// Memory that is valid until the end of the run of the shader at this point. Never null.
  virtual void* allocate(std::size_t size, std::size_t alignment) = 0;
};

}  // namespace etendue::osl
