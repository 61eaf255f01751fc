#pragma once
// Values of the description as values of the language, and back.

#include "etendue/describe/registry.h"
#include "osl/language/tree.h"

namespace etendue {
struct RgbSpace;
}

namespace etendue::osl {

/// Whether a constant's colors can be written as colours: no component is negative.
bool is_color(const Constant&);
/// The value of a member for a parameter's default.
etendue::Value value_of(const Constant&, const Member&);
/// The value of a member whose parameter has no constant default.
etendue::Value empty_value(const Member&);
/// A colour in the shaders' RGB space. Exact for colours that are written by components in it; else the RGB of the spectrum as
/// a reflectance.
Triple rgb_of(const SpectralFunction&);
/// RGB of one space as RGB of another.
Triple converted(const Triple&, const RgbSpace& from, const RgbSpace& to);

}  // namespace etendue::osl
