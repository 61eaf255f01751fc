#pragma once
// Functions by which exporters read members of components.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "etendue/core/transform.h"
#include "etendue/describe/color.h"
#include "etendue/describe/component.h"

namespace etendue {

// They read a member by name, which must exist. Exporters read members only by these functions, so that the members read are
// recorded (asked_members.h). If the member has another type, the result is 0, false, "" or null. Numbers stored as floats are
// returned as they would be written (0.3, not 0.30000001192092896), angles in degrees, files as paths that can be opened.
Value value_of(const Component&, std::string_view member);
double number_of(const Component&, std::string_view member);
bool truth_of(const Component&, std::string_view member);
std::string word_of(const Component&, std::string_view member);
Ref<Component> part_of(const Component&, std::string_view member);
std::vector<double> numbers_of(const Component&, std::string_view member);
Color color_of(const Component&, std::string_view member);
AnimatedTransform transform_of(const Component&, std::string_view member);
const std::string& class_of(const Component&);

/// Whether a component, or one nested in it, has one of these classes; false for null.
bool holds(const Component* part, std::initializer_list<std::string_view> classes);
/// Whether any map of a shader depends on texture coordinates; false for null.
bool textured(const Component* shader);
/// The value of a constant map; null: the map is not constant.
Color constant_of(const Component& map);
/// The components of a colour written as rgb(...), possibly times a number; nothing: it was written otherwise.
std::optional<std::array<double, 3>> written_rgb(const Color&);
/// Wavelengths [nm] and values of a spectrum. Between integer nanometres all spectra are linear or smooth; smooth ones are
/// sampled every 5 nm, which is fine enough.
std::vector<std::pair<int, double>> sampled(const Color&, ColorUse);
/// Linear sRGB of a spectrum: of a radiance directly, of a reflectance under D65, of a coefficient like a radiance.
std::array<double, 3> rgb_of(const Color&, ColorUse);
/// The field of view of a PerspectiveCamera along its fov_axis [deg].
double field_of_view(const Component& camera);
/// Whether an emission is a spot: a SpotEmission or a ForeignSpotEmission.
bool is_spot(const Component& emission);
/// How a spot's edge falls off, by ForeignSpotEmission's words; "smooth" of a SpotEmission.
std::string spot_edge(const Component& spot);
/// Whether a medium has a Henyey-Greenstein phase function, of any anisotropy.
bool turns_by_anisotropy_alone(const Component& medium);
/// The mean cosine of the scattering angle in a medium.
double mean_cosine(const Component& medium);
/// The mean cosine of a PhaseFunction.
double mean_cosine_of(const Component& phase_function);

}  // namespace etendue
