#pragma once
// The lobes that the two Disney shaders share, and their albedos.
//
// Burley 2012, "Physically based shading at Disney"; Burley 2015, "Extending the Disney BRDF to a BSDF with integrated
// subsurface scattering"; in the variants of `principled` and `principledthin` of Mitsuba 3 (Jakob et al. 2022), for scenes
// made with those.
//
// The lobes are added, so a bright body with a specular lobe or a sheen would reflect more light than arrives: up to a fifth,
// and at grazing angles more. Where it would, f is multiplied by min(s(out), s(in)) with s(v) = 1 / A(v) of the albedo A(v) >
// 1. This is reciprocal, keeps the albedo at most 1, and changes nothing elsewhere.

#include "components/shaders/half_vector.h"
#include "components/shaders/microfacet/microfacet.h"
#include "etendue/object_map.h"

namespace etendue::disney {

/// The GGX distribution of a roughness and an anisotropy, both in [0, 1] (Burley 2012); alpha may exceed 1 along the grooves.
MicrofacetDistribution facets(float roughness, float anisotropy);

/// F0 + (1 - F0) (1 - c)^5, c being the cosine on the side of the lower index.
Spectrum schlick(Spectrum f0, float cosine, float eta);

/// The diffuse lobe with its retro-reflection, blended by `flatness` with the approximation of subsurface scattering: f pi over
/// the colour. `half_cosine` is that of either direction with the half-vector.
float diffuse(float cosine_out, float cosine_in, float half_cosine, float roughness, float flatness);

/// Albedos of the diffuse lobe with a colour of 1, and of the sheen (1 - half_cosine)^5.
float diffuse_albedo(float cosine, float roughness, float flatness);
float sheen_albedo(float cosine);
struct Bounds {
  float least, greatest;
};
/// Bounds of the albedos of a microfacet lobe with Schlick's F of f0 = 0, and with F = 1.
Bounds grazing_albedo(const MicrofacetDistribution&, const Vector3& v, float eta);
Bounds whole_albedo(const MicrofacetDistribution&, const Vector3& v);
/// The same with the Fresnel reflectance of a dielectric.
Bounds dielectric_albedo(const MicrofacetDistribution&, const Vector3& v, float eta);

/// The tint: the colour over its luminance under daylight; 1 where it is black.
Spectrum tint_of(const ObjectMap& color, Spectrum at_path, const SurfacePoint&);

inline Spectrum mix(float t, Spectrum a, Spectrum b) { return a * (1 - t) + b * t; }

}  // namespace etendue::disney
