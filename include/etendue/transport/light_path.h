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
// Specular vertices. Between two places that scatter smoothly, a towards the luminaire and b towards the camera, there may be a
// chain of mirrors and clear surfaces s_1 … s_m. Where it leads from b follows from the direction at b, which s_m stands for:
// s_m has an area measure, and s_1 … s_{m-1} and a have none, being given. s of a specular vertex is the fraction of light that
// it sends on, c_i / d_i^2 is left out where x_{i+1} is specular, and E_i is then the probability with which a walk takes the
// lobe (delta distributions, on both sides of all ratios, are left out: Veach & Guibas 1997, section 5.3). A walk from the
// luminaire has a density in the direction at a instead. A beam through the chain has
//     dA_a cos_a dw_a  prod_i (importance's weight at s_i / radiance's)  =  dA_b cos_b dw_b
// (etendue, with the squares of indices and what shading normals change in it, is what the two weights differ by), so
//     L(s_1) … L(b) = p(w_a) prod q_i  J c(s_m) / d(s_m)^2,   J = (cos_b / cos_a) prod_i (radiance's weight / importance's),
// with q_i the probabilities of its lobes. Walks from both sides can be joined between vertices that scatter smoothly alone.
//
// No vertex is in a medium or a body that light goes through, and luminaires have an area.

#include <span>
#include <vector>

#include "etendue/core/arena.h"
#include "etendue/transport/metropolis.h"
#include "etendue/transport/subpath.h"

namespace etendue {

struct ChainVertex : SubpathVertex {
  double from_light = 0, from_camera = 0;  ///< L and E
  // Of a specular one:
  Lobe lobe = specular_reflection;  ///< by which light is sent on
  Spectrum fraction;                ///< of light that it sends on, as radiance
  double beam = 1;                  ///< radiance's weight over importance's; 0: walks from luminaires do not come this way
  double lobe_from_light = 0, lobe_from_camera = 0;  ///< probabilities of the lobe
};

struct LightPath {
  std::vector<ChainVertex> x;  ///< `out` is unit, from each but the last to the next
  Wavelengths wavelengths;     ///< those it began with
  Wavelengths seen;            ///< those that are left: the hero alone where a vertex is dispersive
  Spectrum f;                  ///< times `scale`, which keeps it in the range of floats
  double scale = 1;
  Point2 film;
  Point2 lens;             ///< the numbers that gave the point of the lens
  Arena* arena = nullptr;  ///< holds what the vertices point to; its owner's, who empties it when no path needs it any more

  int length() const { return int(x.size()) - 1; }
  bool specular(int i) const { return x[size_t(i)].specular; }
  /// The last vertex before x_i that is not specular.
  int smooth_before(int i) const;
  /// Of x_i that is not specular: the solid angle of directions at that vertex which lead here, over the measure of what they
  /// lead to: J c / d^2, or without a chain |cos| at x_i over the squared distance [sr/m^2].
  double light_angle(int i) const;
  /// Of x_i seen from x_{i+1}: c_i / d_i^2 [sr/m^2].
  double camera_angle(int i) const;
  /// The specular lobes along a chain, from x_i to x_j, against the order of vertices if j < i.
  std::vector<Lobe> lobes(int i, int j) const;
};

/// Where paths are made, and changed into others.
class PathSpace {
 public:
  using Walk = std::vector<ChainVertex>;
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
  ChainVertex lens(const LightPath& y) const;

  /// What a ray meets that leaves a vertex in a direction. False: nothing that scatters.
  bool follow(const ChainVertex& from, const Vector3& direction, LightPath& y, ChainVertex& to) const;
  /// The direction of the camera ray through a film point.
  Vector3 camera_direction(Point2 film, const LightPath& y) const;
  /// Follows a ray that leaves the last vertex of `walk` in a direction by these specular lobes, adds what it meets, and
  /// returns in which direction it leaves the last of that. Empty: it does not come so far.
  std::optional<Vector3> follow_lobes(Walk& walk, const Vector3& direction, std::span<const Lobe>, Transport,
                                      LightPath& y) const;
  /// Follows a ray that leaves the last vertex of `walk` in a direction by these specular lobes, and adds all that it meets, to
  /// a vertex that scatters smoothly, or, against light, to a luminaire that the path begins at.
  bool follow_chain(Walk& walk, const Vector3& direction, std::span<const Lobe>, Transport, LightPath& y,
                    bool to_luminaire = false) const;
  /// The same of the camera ray through a film point, by the lobes of x there. `walk` holds the lens.
  bool follow_from_camera(Walk& walk, Point2 film, const LightPath& x, LightPath& y) const;
  /// Lets a walk go on by so many vertices, from the last of `walk`: along with light or against it. Before it stands the
  /// vertex that it came from, if any; a walk that is empty begins at a luminaire, one that holds the lens alone with a camera
  /// ray. `to_luminaire`: the last vertex must lie on one, and is the path's beginning.
  /// False: it came to its end before, at the last of what `walk` then holds, which may scatter nothing.
  bool walk(Walk& walk, int count, Transport, ChoiceNumbers&, LightPath& y, bool to_luminaire = false) const;
  /// Whether nothing lies between x_i and x_{i+1}, both of which scatter smoothly.
  bool visible(const LightPath&, int i) const;
  /// Fills in all that follows from the places of vertices: directions, densities, f and the film point. False: f is 0.
  bool complete(LightPath&) const;

  /// The density of x_l … x_{l+r-1}, when some number b of them, all alike likely, comes from a walk that goes on from x_{l-1},
  /// or begins at a luminaire if l = 0, when b > 0, and the others from one that goes on from x_{l+r}. Those two scatter
  /// smoothly.
  static double pdf(const LightPath&, int l, int r);
  /// Such vertices between the last of y and the first of `rest`, and the rest. False: there are none, or f is 0.
  bool join(LightPath& y, const std::vector<ChainVertex>& rest, int r, ChoiceNumbers&) const;
  /// A walk from a luminaire and one from the lens, both as long as they go, and the paths that they make in all ways, of
  /// `shortest` to `longest` segments: `visit(path, likely)` hears of each that brings light. With D the density of a path that
  /// one way makes, all being alike likely, the expectation of the sum of h(path) / (likely D(path)) is the integral of h, for
  /// any h: many paths for the price of two walks (the balance heuristic of Veach & Guibas 1995). The longer paths are, the
  /// smaller the part of them that is looked at. y is begun, and is the path that is visited.
  template <class Visit>
  void all_ways(LightPath& y, int shortest, int longest, ChoiceNumbers& choices, const Visit& visit) const {
    const auto longer = int(6 / std::max(choices.next(), 1e-3));  // at least k with the probability min(1, 6 / k)
    Walk light, camera{lens(y)};
    walk(light, std::min(longest, longer), Transport::importance, choices, y);
    walk(camera, std::min(longest, longer), Transport::radiance, choices, y);
    for (int k = shortest; k <= std::min(longest, longer); ++k)
      for (int b = std::max(0, k + 1 - int(camera.size())); b <= std::min(k, int(light.size())); ++b) {
        const double looked_at = std::min(1.0, 4.0 / (k + 1));
        if (choices.next() < looked_at && joined(y, light, b, camera, k + 1 - b))
          visit(y, std::min(1.0, 6.0 / k) * looked_at * (k + 1));
      }
  }

 private:
  /// The first b of one walk and the first c of the other as a path. False: there is none, or f is 0.
  bool joined(LightPath& y, const Walk& light, int b, const Walk& camera, int c) const;
  bool fill_specular(LightPath&, int i) const;
  bool weigh_camera(LightPath&, const Ray&) const;
};

}  // namespace etendue
