#pragma once
// Multiple importance sampling weights of bidirectional path tracing and of vertex connection and merging: the weight of one
// strategy among all that can make the same path. These are always emitter hits, next event estimation, connections and the
// lens, and merging where its factor (Merging) is more than 0: an algorithm that leaves one of them out has no weights that sum
// to 1, and must take each strategy in full (StrategyWeights::weighted = false).
//
// A path x_0 (on a luminaire) … x_k (on the lens) can be made by k + 1 strategies: strategy j takes x_0 … x_{j-1} from a light
// subpath and the other vertices from a camera subpath, and connects the two. With L_i the pdf of x_i as sampled by a light
// subpath and E_i by a camera subpath, the pdf of strategy j is
//     p_j = prod_{i<j} L_i  prod_{i>=j} E_i,
// so neighbouring strategies differ by p_{j+1} / p_j = L_j / E_j, and the weight of the strategy that made the path, s, is
//     w_s = 1 / sum_j (p_j / p_s)^beta,   beta = 1 (balance) or 2 (power)            (Veach 1997, section 10.2).
// Strategy 1 does not take x_0 from a light subpath but samples a luminaire as seen from x_1 (next event estimation), with the
// pdf D_0: in p_1, and only there, D_0 replaces L_0.
//
// Merging is photon mapping as a strategy for the same path (Georgiev et al. 2012, "Light transport simulation with vertex
// connection and merging"; Hachisuka et al. 2012): both subpaths sample x_i, the camera subpath exactly, the light subpath
// within a radius r of it. With n light subpaths the pdf is
//     m_i = p_i n A L_i,   1 <= i < k,   A = pi r^2 on surfaces, V = 4/3 pi r^3 instead in media (Křivánek et al. 2014):
// that of strategy i, times that of the photon at x_i. It has L_0 even for i = 1, since the subpath of the photon started
// there.
//
// Strategies that cannot make the path are left out: those that connect at a vertex with specular scattering, that hit a delta
// light, or that hit the lens.

#include "etendue/transport/multiple_importance.h"
#include "etendue/transport/subpath.h"

namespace etendue {

/// The merging factors of m_i; 0: nothing is merged.
struct Merging {
  double surface = 0;  ///< n pi r^2 [m^2]
  double medium = 0;   ///< n 4/3 pi r^3 [m^3]
};

/// How the strategies of a path are weighted.
struct StrategyWeights {
  Heuristic heuristic = Heuristic::power;
  bool weighted = true;  ///< false: all weights are 1, so that each strategy shows all light it finds
  Merging merging = {};
};

/// A path: `light[0 … s-1]` from the luminaire, `camera[0 … t-1]` from the lens, and the pdfs that depend on the connection.
/// The vertices hold the pdfs of their own subpaths; the members below are the pdfs of the vertices next to the connection as
/// sampled from the other end.
struct ConnectedPath {
  const SubpathVertex* light = nullptr;
  int s = 0;
  const SubpathVertex* camera = nullptr;
  int t = 0;
  float light_last_from_camera = 0;    ///< E of light[s-1]
  float light_before_from_camera = 0;  ///< E of light[s-2]
  float camera_last_from_light = 0;    ///< L of camera[t-1]
  float camera_before_from_light = 0;  ///< L of camera[t-2]
  float next_event_point_pdf = 0;      ///< D_0: pdf of x_0 by next event estimation
  float pdf_emission_origin = 0;       ///< L_0: pdf of x_0 as the origin of a light subpath
  bool emitter_can_be_hit = true;
  Merging merging = {};
};

/// The weight of the connection of light[s-1] and camera[t-1] (s = 0: of the emitter hit).
float bidirectional_weight(const ConnectedPath&, Heuristic);

/// How large the second moment of a path's contribution would be if the strategies of path tracing alone, emitter hits and next
/// event estimation, made the path. With p_j the pdfs of strategies, f the contribution of the path x and power weights, the
/// second moment of path tracing is
///     int sum_{j=0,1} (w_j f / p_j)^2 p_j dx = int f^2 (p_0^3 + p_1^3) / (p_0^2 + p_1^2)^2 dx,
/// and int f^2 / (p_0 + p_1) dx with balance weights. With C = f / p_s for a path that strategy s has made, and w_s its weight
/// among all, w_s C^2 G is an unbiased estimate of it (Grittmann et al. 2022, "Efficiency-aware multiple importance sampling
/// for bidirectional rendering algorithms", section 4), so that a bidirectional path tells of the error of path tracing even
/// where that has not found the light yet. Returns G; 0 if neither strategy can make the path.
double path_tracing_moment(const ConnectedPath&, Heuristic);

/// The part of a merging weight that depends on the light subpath of a photon alone, so that the subpath need not be stored.
/// The photon is x_s.
struct PhotonWeight {
  float pdf_forward = 0;  ///< L_s
  float connecting = 0;  ///< the term of strategy s, which connects x_s to the vertex before it: (p_s / prod L E)^beta. This is
                         ///< (D_0 / L_0)^beta if that vertex is the first (next event estimation), else 1; 0 if they cannot be
                         ///< connected
  double others = 0;     ///< the sum of the terms of all strategies with fewer vertices from the luminaire, divided by p^beta,
                         ///< with p [1/sr] the pdf of the direction in which a camera subpath continues from the photon to the
                         ///< vertex before it
};
/// `path.light[0 … s-1]` are the vertices before the photon. No vertex of the camera subpath is read, and
/// light_last_from_camera is given per unit of the pdf [1/sr] of the direction from the photon. `pdf_forward` is the photon's
/// own L.
PhotonWeight photon_weight(const ConnectedPath& path, float pdf_forward, Heuristic);
/// The weight of merging a photon with camera[t-1]. Of the light subpath only `merging` and camera_last_from_light are read;
/// `back` is the pdf [1/sr] of the direction in which the camera subpath continues from camera[t-1] to the vertex before the
/// photon.
float merging_weight(const ConnectedPath& path, const PhotonWeight&, float back, Heuristic);

}  // namespace etendue
