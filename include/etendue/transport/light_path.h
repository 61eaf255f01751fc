#pragma once
// Whole paths of light, as Metropolis algorithms in path space hold and change them (Veach 1997, chapters 8 and 11).
//
// A path is x_0 … x_k, x_0 on a luminaire and x_k on the lens. With c_i the cosine at x_i between its normal and the segment to
// x_{i+1}, and d_i the length of that, what it brings to the film is, per area at each of x_0 … x_{k-1},
//     f = L_e(x_0, x_1)  prod_{0<i<k} s(x_i)  prod_{i<k-1} c_i / d_i^2  E_{k-1},   s = scattering towards x_{i+1} with |cos| at
//     x_i,
// E_{k-1} being the density [1/m^2] of x_{k-1} as what a camera ray through a uniform film point meets: light over that density
// is radiance. x_i has the density L_i when a walk from the luminaire comes from x_{i-1}, and E_i when one from the camera
// comes from x_{i+1} [1/m^2].
//
// Here all vertices are on surfaces that scatter smoothly: neither mirrors, nor media, nor bodies that light goes through; and
// luminaires have an area.

#include <vector>

#include "etendue/core/arena.h"
#include "etendue/transport/kept_walk.h"
#include "etendue/transport/metropolis.h"

namespace etendue {

struct LightPath {
  std::vector<KeptVertex> x;  ///< `forward` is L, `reverse` is E; `out` is unit, from each but the last to the next
  Wavelengths wavelengths;
  Spectrum f;
  Point2 film;
  Point2 lens;             ///< the numbers that gave the point of the lens
  Arena* arena = nullptr;  ///< holds what the vertices point to; its owner's, who empties it when no path needs it any more

  int length() const { return int(x.size()) - 1; }
  /// |cos| at x_i of the direction from x_{i-1}, over the squared distance: [sr/m^2]
  float solid_angle(int i) const;
};

/// Where paths are made, and changed into others.
class PathSpace {
 public:
  PathSpace(const RenderContext& c, const LightSampler& l) : context(c), lights(l), time(c.camera.shutter_open) {}

  const RenderContext& context;
  const LightSampler& lights;
  const float time;

  /// Begins y with the same lens and wavelengths as x, and its first vertices, which may be taken over as they are, as all of
  /// x.
  void begin(LightPath& y, const LightPath& x, int vertices) const;
  /// Makes anew, in another arena, what a path's vertices point to.
  void move(LightPath&, Arena& to) const;
  /// The lens of y.
  KeptVertex lens(const LightPath& y) const;

  /// What a ray meets that leaves a vertex in a direction. False: nothing that scatters smoothly.
  bool follow(const KeptVertex& from, const Vector3& direction, LightPath& y, KeptVertex& to) const;
  /// What the camera ray through a film point meets.
  bool follow_camera(Point2 film, LightPath& y, KeptVertex& to) const;
  /// Lets a walk go on by so many vertices, from the last of `walk`: along with light or against it. Before it stands the
  /// vertex that it came from, if any; a walk that is empty begins at a luminaire, one that holds the lens alone with a camera
  /// ray.
  bool walk(std::vector<KeptVertex>& walk, int count, Transport, ChoiceNumbers&, LightPath& y) const;
  /// Whether nothing lies between x_i and x_{i+1}.
  bool visible(const LightPath&, int i) const;
  /// Fills in all that follows from the places of vertices: directions, densities, f and the film point. False: f is 0.
  bool complete(LightPath&) const;

  /// The density of x_l … x_{l+r-1}, when some number b of them, all alike likely, comes from a walk that goes on from x_{l-1},
  /// or begins at a luminaire if l = 0, when b > 0, and the others from one that goes on from x_{l+r}.
  static double density(const LightPath&, int l, int r);
  /// Such vertices between the last of y and the first of `rest`, and the rest. False: there are none, or f is 0.
  bool join(LightPath& y, const std::vector<KeptVertex>& rest, int r, ChoiceNumbers&) const;
};

}  // namespace etendue
