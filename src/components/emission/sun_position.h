#pragma once
// The direction of the sun at a place and time.

#include <string>

#include "etendue/core/vector.h"

namespace etendue {

/// A moment of universal time.
struct UniversalTime {
  double days = 0;  ///< since 2000-01-01 12:00 (Julian date 2451545.0)
};
/// Parses "2024-06-21T12:00Z", also with seconds; throws Error with the reason. The years are limited to 1950 to 2050, for
/// which the formulas give the sun's position to 0.01 degrees.
UniversalTime parse_time(const std::string&);

/// The unit vector towards the sun's centre: x east, y up, z south. Latitude (north) and longitude (east) are in degrees.
/// Atmospheric refraction, which lifts the sun by 0.5 degrees at the horizon and by 0.02 at 45 degrees, is neglected.
Vector3 sun_direction(UniversalTime, double latitude, double longitude);

/// Apparent right ascension and declination of the sun [rad].
struct SunCoordinates {
  double right_ascension = 0, declination = 0;
};
SunCoordinates sun_coordinates(UniversalTime);

}  // namespace etendue
