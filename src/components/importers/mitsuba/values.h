#pragma once
// Values as they are written in XML attributes.

#include <functional>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "element.h"

namespace etendue::mitsuba {

/// An attribute's text after substitution of parameters, and its location.
struct Text {
  std::string text;
  Location at;
};
/// Returns an attribute of a node; nothing: the node does not have it.
using Attributes = std::function<std::optional<Text>(const pugi::xml_node&, const char* name)>;
using PlaceOf = std::function<Location(const pugi::xml_node&)>;

/// Finite numbers; throw Error at the text otherwise.
double parse_number(const Text&);
std::int64_t parse_integer(const Text&);
bool parse_boolean(const Text&);
/// Numbers separated by spaces or commas.
std::vector<double> parse_numbers(const Text&);

/// `<rgb>` or `<srgb>`: one number or three, or "#rrggbb". `encoded`: they are sRGB code values.
ColorValue parse_rgb(const Text&, bool encoded);
/// `<xyz>` of version 0.x, which Mitsuba reads as red, green and blue.
ColorValue parse_xyz(const Text&);
/// `<spectrum value="0.5">` or "400:0.1, 700:0.9".
ColorValue parse_spectrum(const Text&);
ColorValue constant_spectrum(double value);
/// A spectrum from two columns, wavelength [nm] and value, as in an SPD file.
ColorValue file_spectrum_value(const std::string& path, Location at);

/// Mitsuba's orthonormal frame about a direction: Duff et al. 2017, "Building an orthonormal basis, revisited".
struct FrameAbout {
  DoubleVector3 u, v, n;
};
FrameAbout frame_about(const DoubleVector3& way);
/// `<transform>`: its operations, applied in their order. `old`: written for a Mitsuba before 2.
TransformValue parse_transform(const pugi::xml_node&, const Attributes&, const PlaceOf&, bool old);
/// x, y and z, or the attribute `value` with one or three numbers.
DoubleVector3 parse_vector(const pugi::xml_node&, const Attributes&, const PlaceOf&, double otherwise);

}  // namespace etendue::mitsuba
