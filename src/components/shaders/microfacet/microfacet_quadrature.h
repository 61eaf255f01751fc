#pragma once
// Albedos of microfacet surfaces by quadrature, for tables.

#include <vector>

#include "microfacet.h"

namespace etendue::albedo {

struct Node {
  float x, weight;
};

/// The Gauss-Legendre rule on [0, 1].
std::vector<Node> gauss_legendre(int n);

/// Quadrature nodes over the slopes of a surface of alpha 1, with weights that sum to 1, over the azimuths from 0 to `end`
/// [rad].
struct Slopes {
  std::vector<float> x, y, weight;
  Slopes(MicrofacetDistribution::Kind, int lengths, int azimuths, float end);
};

/// The kind of boundary, and the light that counts towards the albedo.
enum class Boundary {
  mirror,      ///< F = 1
  dielectric,  ///< reflected and refracted light
  coat         ///< reflected light
};

/// 1 - E(v), with E the albedo of single scattering and v.z > 0; eta: index behind the surface over that in front.
float missing(Boundary, const MicrofacetDistribution&, const Slopes&, const Vector3& v, float eta);

}  // namespace etendue::albedo
