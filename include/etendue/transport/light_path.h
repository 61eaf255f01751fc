#pragma once
// LightPath: a whole path, as the state of Metropolis light transport in path space (Veach 1997, chapters 8 and 11), and
// PathSpace, which makes and changes paths. ChainVertex adds to a vertex what specular chains need.
//
// A path is x_0 … x_k, with x_0 on a luminaire and x_k on the lens. With c_i the cosine at x_i between its normal and the
// segment to x_{i+1}, and d_i the length of that segment, its contribution to the film is, per area at each of x_0 … x_{k-1},
//     f = L_e(x_0, x_1)  prod_{0<i<k} s(x_i)  prod_{i<k-1} c_i / d_i^2  E_{k-1},   s = scattering towards x_{i+1} with |cos| at
//     x_i,
// where E_{k-1} is the pdf [1/m^2] with which a camera ray through a uniform film point hits x_{k-1}: f over that pdf is
// radiance. L_i is the pdf [1/m^2] of x_i for a walk from the luminaire that comes from x_{i-1}, and E_i for a walk from the
// camera that comes from x_{i+1}.
//
// Specular vertices. Between two smooth vertices, a towards the luminaire and b towards the camera, there may be a chain of
// specular vertices s_1 … s_m. The direction at b determines the whole chain, and s_m stands for this direction: s_m has an
// area measure, and s_1 … s_{m-1} and a have none, as they follow from it. s of a specular vertex is the fraction of light that
// it scatters, c_i / d_i^2 is left out where x_{i+1} is specular, and E_i is then the probability with which a walk samples the
// lobe (delta distributions, which are equal on both sides of all ratios, are left out: Veach & Guibas 1997, section 5.3). A
// walk from the luminaire has a pdf of the direction at a instead. A beam through the chain satisfies
//     dA_a cos_a dw_a  prod_i (importance's weight at s_i / radiance's)  =  dA_b cos_b dw_b
// (conservation of etendue: the two weights differ by the squares of the refractive indices and the corrections for shading
// normals), so
//     L(s_1) … L(b) = p(w_a) prod q_i  J c(s_m) / d(s_m)^2,   J = (cos_b / cos_a) prod_i (radiance's weight / importance's),
// with q_i the probabilities of the lobes of the chain. Walks from both ends can be connected between two smooth vertices only.
//
// No vertex is in a medium, media do not absorb, paths contain neither subsurface nor null scattering, and luminaires have an
// area. So a segment is either clear or occluded, and nothing on it is a factor of f.

#include <span>
#include <vector>

#include "etendue/core/arena.h"
#include "etendue/transport/metropolis.h"
#include "etendue/transport/subpath.h"

namespace etendue {

struct ChainVertex : SubpathVertex {
  double from_light = 0, from_camera = 0;  ///< L and E
  // For a specular vertex:
  Lobe lobe = specular_reflection;  ///< that scatters the light
  Spectrum fraction;                ///< of light that the lobe scatters, as radiance
  double beam = 1;                  ///< weight for radiance over weight for importance; 0: walks from luminaires cannot pass
                                    ///< the vertex
  double lobe_from_light = 0, lobe_from_camera = 0;  ///< probabilities with which walks sample the lobe
};

struct LightPath {
  std::vector<ChainVertex> x;  ///< `out` of each vertex but the last is unit, towards the next
  Wavelengths wavelengths;     ///< at the start of the path
  Wavelengths seen;            ///< without those that were dropped: the hero alone if a vertex is dispersive
  Spectrum f;                  ///< divided by `scale`, which keeps it in the range of floats
  double scale = 1;
  Point2 film;
  Point2 lens;             ///< the primary samples of the lens point
  Arena* arena = nullptr;  ///< holds the objects that the vertices point to. Its owner empties it when no path needs it any
                           ///< more

  int length() const { return int(x.size()) - 1; }
  bool specular(int i) const { return x[size_t(i)].leaves_specularly; }
  /// The index of the last vertex before x_i that is not specular.
  int smooth_before(int i) const;
  /// For a smooth x_i, seen from the previous smooth vertex: the solid angle of directions there per measure of the vertices
  /// that they lead to: J c / d^2, or without a chain |cos| at x_i over the squared distance [sr/m^2].
  double light_angle(int i) const;
  /// The solid angle of x_i seen from x_{i+1}, per area: c_i / d_i^2 [sr/m^2].
  double camera_angle(int i) const;
  /// The specular lobes along a chain, from x_i to x_j, in reverse order of the vertices if j < i.
  std::vector<Lobe> lobes(int i, int j) const;
};

/// Makes paths, and changes them into others.
class PathSpace {
 public:
  using Walk = std::vector<ChainVertex>;
  PathSpace(const RenderContext& context_, const LightSampler& lights_)
      : context(context_), lights(lights_), time(context_.camera.shutter_open) {}

  const RenderContext& context;
  const LightSampler& lights;
  const float time;

  /// Starts y with the lens point and wavelengths of x, and with its first vertices, unchanged.
  void begin(LightPath& y, const LightPath& x, int vertices) const;
  /// Allocates the objects that a path's vertices point to again, in another arena.
  void move(LightPath&, Arena& to) const;
  /// The lens vertex of y.
  ChainVertex lens(const LightPath& y) const;

  /// Traces a ray that leaves a vertex in a direction to the next surface. False: there is none.
  bool follow(const ChainVertex& from, const Vector3& direction, LightPath& y, ChainVertex& to) const;
  /// The direction of the camera ray through a film point.
  Vector3 camera_direction(Point2 film, const LightPath& y) const;
  /// Traces a ray that leaves the last vertex of `walk` in a direction through surfaces that scatter it by these specular
  /// lobes, adds these vertices, and returns the direction in which the ray leaves the last one. Empty: a surface is missing or
  /// lacks the lobe.
  std::optional<Vector3> follow_lobes(Walk& walk, const Vector3& direction, std::span<const Lobe>, Transport,
                                      LightPath& y) const;
  /// The same, and adds the next vertex, which must have smooth lobes, or with `to_luminaire` (against the direction of light)
  /// lie on a luminaire, where the path starts. False: it does not.
  bool follow_chain(Walk& walk, const Vector3& direction, std::span<const Lobe>, Transport, LightPath& y,
                    bool to_luminaire = false) const;
  /// The same for the camera ray through a film point, with the specular lobes by which x is seen. `walk` holds the lens
  /// vertex.
  bool follow_from_camera(Walk& walk, Point2 film, const LightPath& x, LightPath& y) const;
  /// Extends a walk by `count` vertices from the last of `walk`, with the light (importance) or against it (radiance). The
  /// vertex before the last one, if any, is the one that the walk came from. An empty walk starts on a luminaire, one that
  /// holds the lens alone with a camera ray. `to_luminaire`: the last vertex must lie on a luminaire, and is the start of the
  /// path. False: the walk ended earlier, at the last vertex in `walk`, which may have no lobes.
  bool walk(Walk& walk, int count, Transport, ChoiceNumbers&, LightPath& y, bool to_luminaire = false) const;
  /// Whether nothing occludes the segment between x_i and x_{i+1}, both of which are smooth. Surfaces hidden by priority do
  /// not; those with null scattering do, as walks cannot pass them either and `pdf` assumes that all ways make the same paths.
  bool visible(const LightPath&, int i) const;
  /// Computes all quantities that follow from the positions of the vertices: directions, pdfs, f and the film point. False: f
  /// is 0.
  bool complete(LightPath&) const;

  /// The pdf of x_l … x_{l+r-1} if a number b of them, uniform in 0 … r, is sampled by a walk that continues from x_{l-1} (or,
  /// if l = 0 and b > 0, starts on a luminaire), and the others by a walk that continues from x_{l+r}. Those two vertices are
  /// smooth.
  static double pdf(const LightPath&, int l, int r);
  /// Samples r such vertices between the last vertex of y and the first of `rest`, and appends `rest`. False: no path was
  /// found, or f is 0.
  bool join(LightPath& y, const std::vector<ChainVertex>& rest, int r, ChoiceNumbers&) const;
  /// Traces a walk from a luminaire and one from the lens, both until they end, and connects them in all ways to paths of
  /// `shortest` to `longest` segments: `visit(path, factor)` is called for each path that carries light. With D the pdf of a
  /// path averaged over all such ways, the expectation of the sum of h(path) / (factor D(path)) is the integral of h, for any
  /// h: many paths for the cost of two walks (the balance heuristic of Veach & Guibas 1995). The longer the paths, the smaller
  /// the part of them that is evaluated. y must have been started with `begin`, and is the path that is visited.
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
  /// Connects the first b vertices of one walk and the first c of the other to a path. False: there is none, or f is 0.
  bool joined(LightPath& y, const Walk& light, int b, const Walk& camera, int c) const;
  bool fill_specular(LightPath&, int i) const;
  bool weigh_camera(LightPath&, const Ray&) const;
};

}  // namespace etendue
