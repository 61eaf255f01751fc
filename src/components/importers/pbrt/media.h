#pragma once
// Common parts of pbrt's media.

#include "reader.h"

namespace etendue::pbrt {

/// The factor of a medium's emission: "Lescale" and the sensor's imaging ratio.
double light_scale(const Reader&, const Parameters&);
/// Sets the emission of a medium from its "Le", if given, and its absorption.
void set_emission_of_medium(Reader&, Component& medium, const Parameters&, const Color& absorption);
/// Stores a medium, and the transform from its space to world space.
void place_medium(Reader&, const std::string& name, const Ref<Component>& medium, const Transform& placed, Location box_at);

// media_in_space.cpp: heterogeneous media.
void make_grid(Reader&, const std::string& name, Parameters&);
void make_rgb_grid(Reader&, const std::string& name, Parameters&);
void make_nanovdb(Reader&, const std::string& name, const Parameters&);
void make_cloud(Reader&, const std::string& name, const Parameters&);

}  // namespace etendue::pbrt
