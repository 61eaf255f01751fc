#pragma once
// Values as they are written in XML attributes.

#include <functional>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "element.h"

namespace etendue::mitsuba {

/// An attribute's text with parameters put in, and its place.
struct Text {
  std::string text;
  Location at;
};
/// Gives an attribute of a node; absent: none.
using Attributes = std::function<std::optional<Text>(const pugi::xml_node&, const char* name)>;
using PlaceOf = std::function<Location(const pugi::xml_node&)>;

/// Finite numbers; what is not one is an Error at the text.
double parse_number(const Text&);
std::int64_t parse_integer(const Text&);
bool parse_boolean(const Text&);
/// Separated by spaces or commas.
std::vector<double> parse_numbers(const Text&);

/// `<rgb>` or `<srgb>`: one number or three, or "#rrggbb". `encoded`: they are sRGB code values.
ColorValue parse_rgb(const Text&, bool encoded);
/// `<xyz>` of version 0.x, which is red, green and blue there.
ColorValue parse_xyz(const Text&);
/// `<spectrum value="0.5">` or "400:0.1, 700:0.9".
ColorValue parse_spectrum(const Text&);
ColorValue constant_spectrum(double value);
/// Of two columns, wavelength [nm] and value, as in an SPD file.
ColorValue file_spectrum_value(const std::string& path, Location at);

/// Mitsuba's frame about a direction: Duff et al. 2017, "Building an orthonormal basis, revisited".
struct FrameAbout {
  DoubleVector3 u, v, n;
};
FrameAbout frame_about(const DoubleVector3& way);
/// `<transform>`: its operations, the first of them first. `old`: written for a Mitsuba before 2.
TransformValue parse_transform(const pugi::xml_node&, const Attributes&, const PlaceOf&, bool old);
/// x, y and z, or a value of one or three numbers.
DoubleVector3 parse_vector(const pugi::xml_node&, const Attributes&, const PlaceOf&, double otherwise);

}  // namespace etendue::mitsuba
