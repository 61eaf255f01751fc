#pragma once
// What media of pbrt have in common.

#include "reader.h"

namespace etendue::pbrt {

/// What a medium's light is multiplied by: "Lescale" and the sensor.
double light_scale(const Reader&, const Parameters&);
/// The emission of a medium from the light of "Le", if there is one, and what it absorbs.
void set_emission_of_medium(Reader&, Component& medium, const Parameters&, const Color& absorption);
/// Remembers a medium, and how the coordinates it is in lie in the world.
void place_medium(Reader&, const std::string& name, const Ref<Component>& medium, const Transform& placed, Location box_at);

// media_in_space.cpp: media that differ from place to place.
void make_grid(Reader&, const std::string& name, Parameters&);
void make_rgb_grid(Reader&, const std::string& name, Parameters&);
void make_nanovdb(Reader&, const std::string& name, const Parameters&);
void make_cloud(Reader&, const std::string& name, const Parameters&);

}  // namespace etendue::pbrt
