// The sun's position, by the low-precision formulas of the Astronomical Almanac (page C5).

#include "sun_position.h"

#include <charconv>
#include <cmath>
#include <string_view>

#include "etendue/core/error.h"

namespace etendue {
namespace {

constexpr double degree = 3.14159265358979323846 / 180;

/// Days from 2000-01-01 to a day of the Gregorian calendar (Fliegel & Van Flandern 1968).
int days_since_2000(int year, int month, int day) {
  const int a = (month - 14) / 12;
  return day - 32075 + 1461 * (year + 4800 + a) / 4 + 367 * (month - 2 - a * 12) / 12 - 3 * ((year + 4900 + a) / 100) / 4 -
         2451545;
}

}  // namespace

UniversalTime parse_time(const std::string& text) {
  const auto bad = [&](const char* why) -> Error {
    return Error("'" + text + "' " + why + "; a time is written as \"2024-06-21T12:00:00Z\" (universal time)");
  };
  std::string_view rest = text;
  // Reads a number of `digits` digits and the character `after` that must follow (0: none).
  const auto number = [&](size_t digits, char after) {
    int value = 0;
    if (rest.size() < digits) throw bad("is no time");
    const char *const first = rest.data(), *const last = first + digits;
    const auto [stop, error] = std::from_chars(first, last, value);
    if (error != std::errc() || stop != last || rest.front() == '-') throw bad("is no time");
    rest.remove_prefix(digits);
    if (after) {
      if (rest.empty() || rest.front() != after) throw bad("is no time");
      rest.remove_prefix(1);
    }
    return value;
  };
  const int year = number(4, '-'), month = number(2, '-'), day = number(2, 'T'), hour = number(2, ':'), minute = number(2, 0);
  int second = 0;
  if (!rest.empty() && rest.front() == ':') {
    rest.remove_prefix(1);
    second = number(2, 0);
  }
  if (rest != "Z") throw bad("does not end in Z: it must be universal time");
  if (year < 1950 || year > 2050) throw bad("is not within the years 1950 to 2050");
  if (month < 1 || month > 12) throw bad("has no such month");
  const int next = month == 12 ? days_since_2000(year + 1, 1, 1) : days_since_2000(year, month + 1, 1);
  const int date = days_since_2000(year, month, day);
  if (day < 1 || date >= next) throw bad("has no such day");
  if (hour > 23 || minute > 59 || second > 60) throw bad("has no such time of day");
  return {double(date) - 0.5 + (double(hour) + (double(minute) + double(second) / 60) / 60) / 24};
}

SunCoordinates sun_coordinates(UniversalTime time) {
  const double n = time.days;
  const double mean_longitude = (280.460 + 0.9856474 * n) * degree, anomaly = (357.528 + 0.9856003 * n) * degree;
  const double longitude = mean_longitude + (1.915 * std::sin(anomaly) + 0.020 * std::sin(2 * anomaly)) * degree;
  const double obliquity = (23.439 - 0.0000004 * n) * degree;
  return {std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude)),
          std::asin(std::sin(obliquity) * std::sin(longitude))};
}

Vector3 sun_direction(UniversalTime time, double latitude, double longitude) {
  const SunCoordinates sun = sun_coordinates(time);
  // Greenwich mean sidereal time (Meeus 1998, equation 12.4).
  const double sidereal = 280.46061837 + 360.98564736629 * time.days;
  const double hour_angle = (sidereal + longitude) * degree - sun.right_ascension, phi = latitude * degree;
  const double east = -std::cos(sun.declination) * std::sin(hour_angle);
  const double north =
      std::sin(sun.declination) * std::cos(phi) - std::cos(sun.declination) * std::sin(phi) * std::cos(hour_angle);
  const double up =
      std::sin(sun.declination) * std::sin(phi) + std::cos(sun.declination) * std::cos(phi) * std::cos(hour_angle);
  return normalize(Vector3{float(east), float(up), float(-north)});
}

}  // namespace etendue
