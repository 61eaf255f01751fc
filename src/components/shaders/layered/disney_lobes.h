#pragma once
// What the two Disney shaders have in common: their lobes, and how much of the light these send away.
//
// Burley 2012, "Physically based shading at Disney"; Burley 2015, "Extending the Disney BRDF to a BSDF with integrated
// subsurface scattering"; as the `principled` and `principledthin` of Mitsuba 3 (Jakob et al. 2022) have them, for scenes made
// with those.
//
// The lobes are added, so a bright body with a shine or a sheen would send away more light than arrives: up to a fifth, and at
// grazing angles more. Where it would, f is multiplied by min(s(out), s(in)) with s(v) = 1 / A(v) of the albedo A(v) > 1. That
// is reciprocal, sends no more than arrives, and leaves everything else as it was.

#include "components/shaders/half_vector.h"
#include "components/shaders/microfacet/microfacet.h"
#include "etendue/object_map.h"

namespace etendue::disney {

/// GGX of a roughness and an anisotropy, both in [0, 1] (Burley 2012); alpha may exceed 1 along the grooves.
MicrofacetDistribution facets(float roughness, float anisotropy);

/// F0 + (1 - F0) (1 - c)^5, c being the cosine on the side of the lower index.
Spectrum schlick(Spectrum f0, float cosine, float eta);

/// The diffuse lobe with its retro-reflection, turned towards the look of subsurface scattering by `flatness`: f pi over the
/// colour. `half_cosine` is that of either direction with the half-vector.
float diffuse(float cosine_out, float cosine_in, float half_cosine, float roughness, float flatness);

/// Albedos of the diffuse lobe with a colour of 1, and of the sheen (1 - half_cosine)^5.
float diffuse_albedo(float cosine, float roughness, float flatness);
float sheen_albedo(float cosine);
struct Bounds {
  float least, greatest;
};
/// Of the albedos of a lobe of facets with Schlick's F of f0 = 0, and with F = 1.
Bounds grazing_albedo(const MicrofacetDistribution&, const Vector3& v, float eta);
Bounds whole_albedo(const MicrofacetDistribution&, const Vector3& v);
/// And with Fresnel's of a dielectric.
Bounds dielectric_albedo(const MicrofacetDistribution&, const Vector3& v, float eta);

/// The colour over its luminance under daylight, which is what tints are: 1 where it is black.
Spectrum tint_of(const ObjectMap& color, Spectrum at_path, const SurfacePoint&);

inline Spectrum mix(float t, Spectrum a, Spectrum b) { return a * (1 - t) + b * t; }

}  // namespace etendue::disney
