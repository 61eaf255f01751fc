#pragma once
// Closures as scatter models: what each of the language's closures is here, and the BSDF of a closure that a shader made.

#include "etendue/shader.h"
#include "osl/language/tree.h"
#include "osl/values/closure.h"

namespace etendue {
struct RgbSpace;
}

namespace etendue::osl {

/// The point at which a closure was made.
struct ClosurePlace {
  const SurfacePoint& point;
  const Wavelengths& wavelengths;
  Arena& arena;
  const RgbSpace& space;    ///< of the colours
  bool from_behind;         ///< the point was seen from behind, so that N points to the back of the surface
  const std::string& name;  ///< of the class, for messages
  bool refracts = true;     ///< some closure of the shader may refract without facets, so that its sums may be whole boundaries
  bool exits = false;       ///< light that enters by subsurface closures leaves by sample_exit; no other closure lets light in
};

/// The BSDF of a closure; null: all light is absorbed. Its parts of emission and of volumes are left out.
const Scatter* scatter_of(const ClosureNode*, const ClosurePlace&);

/// Where light leaves that entered by the subsurface closures of a point.
std::optional<SubsurfaceExit> exit_of(const ClosureNode*, const ClosurePlace&, const Scene&, NumberStream&);
/// Whether the closure has a component of subsurface scattering.
bool has_body(const ClosureNode*);
/// Whether the closure has a component that lets light through the surface, other than those of subsurface scattering and hair.
bool lets_through(const ClosureNode*);

/// The light that a closure emits or, with `background`, sends from infinity [W m^-2 sr^-1 nm^-1].
Spectrum light_of(const ClosureNode*, const RgbSpace&, const Wavelengths&);

/// The index of refraction inside of the object, as the first component says that refracts; 1: none does.
float refracting_index(const ClosureNode*);

/// What the closures that a shader's text names may do.
struct ClosureUses {
  Lobes lobes = no_lobes;
  bool scatters = false, emits = false;
  bool reciprocal = true;  ///< no closure makes the scattering one that is not reciprocal, as layer() does
  bool bodies = false;     ///< closures of subsurface scattering occur
  bool interior = false;   ///< light may go through the surface into the body
  float albedo_error = 0;  ///< as Shader::albedo_error, of what the closures make together
  ClosureUses& operator|=(const ClosureUses&);
};
/// Throws Error with the place of a closure that is not known here.
ClosureUses uses_of(const Shader&);
/// Whether a shader calls functions of the library whose signatures begin so.
bool calls(const Shader&, std::string_view signature);

}  // namespace etendue::osl
