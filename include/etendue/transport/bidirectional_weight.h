#pragma once
// Multiple importance sampling over the ways to build one path from both ends.
//
// A path x_0 (on a luminaire) … x_k (on the lens) can be made by k + 1 strategies: strategy j takes x_0 … x_{j-1} from a
// walk that began at the luminaire, the others from one that began at the lens, and connects the two. With L_i the density
// of x_i in the first kind of walk and E_i in the second, its density is
//     p_j = prod_{i<j} L_i  prod_{i>=j} E_i,
// so neighbouring strategies differ by p_{j+1} / p_j = L_j / E_j, and the weight of the strategy at hand, s, is
//     w_s = 1 / sum_j (p_j / p_s)^beta,   beta = 1 (balance) or 2 (power)            (Veach 1997, section 10.2).
// Strategy 1 does not take x_0 from a walk but samples a luminaire as seen from x_1, with a density D_0 of its own: in p_1,
// and there alone, D_0 stands for L_0.
// Merging (photon mapping as a strategy of the same path: Georgiev et al. 2012, "Light transport simulation with vertex
// connection and merging"; Hachisuka et al. 2012): both walks come to x_i, the one from the camera exactly, the other within a
// radius r of it. Of n light walks the density is
//     m_i = p_i n A L_i,   1 <= i < k,   A = pi r^2 on surfaces, V = 4/3 pi r^3 instead in media (Křivánek et al. 2014),
// as strategy i with the photon's place on top, and L_0 even for i = 1: the photon's walk began there.
// A strategy that would connect at a vertex whose scattering is specular, or meet a luminaire without extent, cannot
// happen and is left out, as is meeting the lens.

#include "etendue/transport/multiple_importance.h"
#include "etendue/transport/subpath.h"

namespace etendue {

/// How much light walks are merged: 0 where nothing is.
struct Merging {
  double surface = 0;  ///< n pi r^2 [m^2]
  double medium = 0;   ///< n 4/3 pi r^3 [m^3]
};

/// How strategies are weighted.
struct StrategyWeights {
  Heuristic heuristic = Heuristic::power;
  bool weighted = true;  ///< false: each shows all light it finds
  Merging merging = {};
};

/// A path: `light[0 … s-1]` from the luminaire, `camera[0 … t-1]` from the lens, and what the connection changes. The vertices
/// hold the densities of their own walks; those next to the connection are seen from the other side with these.
struct ConnectedPath {
  const SubpathVertex* light = nullptr;
  int s = 0;
  const SubpathVertex* camera = nullptr;
  int t = 0;
  float light_last_from_camera = 0;    ///< E of light[s-1]
  float light_before_from_camera = 0;  ///< E of light[s-2]
  float camera_last_from_light = 0;    ///< L of camera[t-1]
  float camera_before_from_light = 0;  ///< L of camera[t-2]
  float pdf_next_event = 0;            ///< D_0
  float pdf_emission_origin = 0;       ///< L_0
  bool emitter_can_be_hit = true;
  Merging merging = {};
};

/// Of the connection of light[s-1] and camera[t-1].
float bidirectional_weight(const ConnectedPath&, Heuristic);

/// What weights need of the light walk that brought a photon, so that the walk need not be kept. x_s is the photon.
struct PhotonWeight {
  float pdf_forward = 0;  ///< L_s
  float connecting = 0;  ///< (p_s / prod L E)^beta: of connecting to the photon's vertex before; (D_0 / L_0)^beta where that is
                         ///< the first, else 1; 0 where it cannot be
  double others = 0;  ///< of strategies with fewer vertices from the luminaire, over the power beta of the density [1/sr] with
                      ///< which a walk from the camera goes on from the photon to the vertex before it
};
/// `path.light[0 … s-1]` are the vertices the photon came by, without itself; of the camera's part nothing is looked at, and
/// light_last_from_camera is per unit of the density [1/sr] of that direction. `forward` is the photon's own L.
PhotonWeight photon_weight(const ConnectedPath& path, float pdf_forward, Heuristic);
/// Of merging a photon with camera[t-1]. Of the path's light part `merging` alone is looked at; `back` is the density [1/sr] of
/// the walk from camera[t-1] to the vertex that the photon came from.
float merging_weight(const ConnectedPath& path, const PhotonWeight&, float back, Heuristic);

}  // namespace etendue
