#pragma once
// Parts with valid random members, made from what classes say of themselves.

#include <random>
#include <string>

#include "check/conform/fixtures/fixtures.h"
#include "etendue/describe/registry.h"

namespace etendue::conform {

struct Drawn {
  Ref<Component> part;  ///< prepared; null: none could be made
  std::string text;     ///< from which it was read: it can be made again
  std::string refused;  ///< without a part: what the last try said
};

/// With all defaults; only what must be written is (required members, sample files, lists that must not be empty).
Drawn default_part(const ClassInfo&, const Fixtures&, std::mt19937_64&);

/// With random members: numbers over their ranges, ends included, choices, colours, transforms, and other components in turn.
/// What `prepare` refuses is drawn again.
Drawn draw_part(const ClassInfo&, const Fixtures&, std::mt19937_64&);

/// A random value for one member, which its class may refuse; none: nothing is known of what fits.
Value draw_value(const ClassInfo&, const Member&, const Fixtures&, std::mt19937_64&);

/// With defaults and a sample file for each member that names one.
Drawn part_with_files(const ClassInfo&, const Fixtures&, std::mt19937_64&);

}  // namespace etendue::conform
