#pragma once
// Faults that the tests of `etendue verify` switch on, one at a time, in a build of their own: proof that verify sees
// them. Elsewhere `seeded` is false when compiled, and nothing of this is left.

#include <cstdint>
#include <cstdlib>

namespace etendue {

enum class SeededBug : std::uint8_t {
  none,
  wrong_mis_weight,       ///< the other strategy's density enters unsquared
  no_squared_index,       ///< radiance is not changed by refraction
  lost_cosine,            ///< in connections of two surfaces
  wrong_measure,          ///< a density by area taken for one by solid angle
  roulette_undivided,     ///< survivors are not made up for those that ended
  luminaire_twice,        ///< met luminaires count in full beside sampled ones
  lens_importance,        ///< of light tracing: one cosine of the camera too many
  phase_density,          ///< phase functions sampled as if isotropic, weighted as if not
  transmittance_squared,  ///< along connections
  skipped_length,         ///< no paths of exactly four segments
};

#ifdef ETENDUE_SEEDED_BUGS
/// The fault numbered by the environment variable ETENDUE_SEEDED_BUG (1 to 10).
inline bool seeded(SeededBug bug) {
  static const int active = [] {
    const char* text = std::getenv("ETENDUE_SEEDED_BUG");
    return text ? std::atoi(text) : 0;
  }();
  return int(bug) == active;
}
#else
constexpr bool seeded(SeededBug) { return false; }
#endif

}  // namespace etendue
