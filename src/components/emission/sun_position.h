#pragma once
// Where the sun stands at a place and time.

#include <string>

#include "etendue/core/vector.h"

namespace etendue {

/// A moment of universal time.
struct UniversalTime {
  double days = 0;  ///< since 2000-01-01 12:00 (Julian date 2451545.0)
};
/// Of "2024-06-21T12:00Z" or with seconds; throws Error saying what is wrong. Years 1950 to 2050, in which the sun's place is
/// known to 0.01 degrees.
UniversalTime parse_time(const std::string&);

/// Towards the sun's middle, unit: x east, y up, z south. Latitude (north) and longitude (east) in degrees. Refraction, which
/// lifts the sun by 0.5 degrees at the horizon and by 0.02 at 45 degrees, is left out.
Vector3 sun_direction(UniversalTime, double latitude, double longitude);

/// Apparent right ascension and declination of the sun [rad].
struct SunCoordinates {
  double right_ascension = 0, declination = 0;
};
SunCoordinates sun_coordinates(UniversalTime);

}  // namespace etendue
