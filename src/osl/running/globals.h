#pragma once
// The global variables of shaders: the point that is shaded.

#include <string_view>

#include "osl/values/closure.h"
#include "osl/values/dual.h"

namespace etendue::osl {

/// Where, whence and when. All places are in "common" space; derivatives are per pixel. A renderer fills the structure for each
/// point. The variables are shared by all layers of a group: what one layer assigns, later layers see.
struct Globals {
  Dual<Triple> P;                   ///< the point
  Dual<Triple> I;                   ///< the direction of the ray that sees it
  Dual<Triple> N;                   ///< the shading normal
  Dual<Triple> Ng;                  ///< the geometric normal
  Dual<float> u, v;                 ///< surface parameters
  Dual<Triple> dPdu, dPdv;          ///< tangents
  Dual<Triple> Ps;                  ///< the light's point, in shaders of light
  Dual<float> time, dtime;          ///< of the sample, and the shutter's duration
  Dual<Triple> dPdtime;             ///< the point's velocity
  const ClosureNode* Ci = nullptr;  ///< the result: how the surface scatters and emits light

  // What library functions answer.
  float surface_area = 0;
  bool backfacing = false;
  bool flipped_handedness = false;
};

/// The place of a global variable in Globals [bytes], or -1 if none has the name. All but Ci have derivatives in Globals.
int global_offset(std::string_view name);

}  // namespace etendue::osl
