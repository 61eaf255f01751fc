#pragma once
// Components with valid random members, made from the declarations of their classes.

#include <random>
#include <string>

#include "check/conform/fixtures/fixtures.h"
#include "etendue/describe/registry.h"

namespace etendue::conform {

struct Drawn {
  Ref<Component> part;  ///< prepared; null: none could be created
  std::string text;     ///< the text it was parsed from, which reproduces it
  std::string refused;  ///< if there is no component: the message of the last try
};

/// A component with defaults; only required members, sample files and lists that must not be empty are set.
Drawn default_part(const ClassInfo&, const Fixtures&, std::mt19937_64&);

/// A component with random members: numbers over their ranges including the ends, choices, colours, transforms, and nested
/// components. If `prepare` rejects it, another one is drawn.
Drawn draw_part(const ClassInfo&, const Fixtures&, std::mt19937_64&);

/// A random value for one member, which its class may reject; none: no suitable value is known.
Value draw_value(const ClassInfo&, const Member&, const Fixtures&, std::mt19937_64&);

/// A component with defaults and a sample file for each member that names one.
Drawn part_with_files(const ClassInfo&, const Fixtures&, std::mt19937_64&);

}  // namespace etendue::conform
