#pragma once
// What exporters ask of the parts that they write.

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

// Members of a part by name, which it must have. Exporters ask for them here and nowhere else, so that it is known what they
// asked for (asked_members.h). What is of another kind is 0, false, "" or null. Numbers that floats hold are as they would be
// written (0.3, not 0.30000001192092896), angles are in degrees, files are paths that can be opened.
Value value_of(const Component&, std::string_view member);
double number_of(const Component&, std::string_view member);
bool truth_of(const Component&, std::string_view member);
std::string word_of(const Component&, std::string_view member);
Ref<Component> part_of(const Component&, std::string_view member);
std::vector<double> numbers_of(const Component&, std::string_view member);
Color color_of(const Component&, std::string_view member);
AnimatedTransform transform_of(const Component&, std::string_view member);
const std::string& class_of(const Component&);

/// Whether a part, or one within it, is of one of these classes; null: it is not.
bool holds(const Component* part, std::initializer_list<std::string_view> classes);
/// Whether any map of a shader looks at surface coordinates; null: none does.
bool textured(const Component* shader);
/// The value of a map that is the same everywhere; null: it is not.
Color constant_of(const Component& map);
/// The components of a colour that was written as rgb(...), perhaps times a number; nothing: it was written otherwise.
std::optional<std::array<double, 3>> written_rgb(const Color&);
/// Wavelengths [nm] and values of a spectrum. Between whole nanometres everything is linear or smooth; steps of five are fine
/// enough for what is smooth.
std::vector<std::pair<int, double>> sampled(const Color&, ColorUse);
/// Linear sRGB of a spectrum: of light as it is, of a reflectance under D65, of a coefficient as if it were one.
std::array<double, 3> rgb_of(const Color&, ColorUse);
/// The angle of view of a PerspectiveCamera across its fov_axis [deg].
double field_of_view(const Component& camera);
/// Whether light turns in a medium as Henyey's and Greenstein's function says, of whichever anisotropy.
bool turns_by_anisotropy_alone(const Component& medium);
/// The mean cosine of the angle that light turns by in a medium.
double mean_cosine(const Component& medium);
/// The same of a PhaseFunction.
double mean_cosine_of(const Component& phase_function);

}  // namespace etendue
