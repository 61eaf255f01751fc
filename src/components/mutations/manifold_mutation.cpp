// The manifold mutation (Jakob & Marschner 2012, "Manifold exploration: a Markov chain Monte Carlo technique for rendering
// scenes with difficult specular transport"): the film point moves by a small distance, which gives a new smooth vertex b. The
// smooth vertex a, from which light comes to b through specular vertices, stays fixed, and a new specular chain between them is
// found. The caustic and multi-chain perturbations rotate a direction there instead, and miss a if it is small or far away.
//
// The chain is a root: with w the direction at b, and e(w) the point where the chain that starts with w hits the tangent plane
// at a, e(w) = a (the specular manifold, with w as its coordinates). The root is found by Newton's method, starting with the
// direction to the first vertex of the old chain. Derivatives of e are differences between rays that are traced at small angles
// to either side: so they exist for all shapes, bump maps and media, even if the derivatives of the normals are unknown. Where
// the two sides give different derivatives, at edges and borders of shadows, nothing is proposed.
//
// The measure of a path's chain is that of its vertex s next to b (transport/light_path.h), and the mutation keeps a. With c /
// d^2 the solid angle of s at b over its area and D = |de/dw| [m^2/sr], the density per area of s is
//     dA_s / dA_a = 1 / (D c / d^2)
// times that per area of a, in which T is the pdf of b alone, so that
//     T(y -> x) / T(x -> y) = E_{k-1}(x) D(x) (c / d^2)(x) / (E_{k-1}(y) D(y) (c / d^2)(y)).
// The same steps from y must lead back to x: a curved reflector may have several chains between b and a, and Newton's method
// selects one of them.

#include "etendue/transport/mutation.h"

namespace etendue {
namespace {

/// The specular chain from b to a.
class Chain {
 public:
  Chain(const PathSpace& space, LightPath& y, const ChainVertex& b, const ChainVertex& a, std::span<const Lobe> lobes)
      : space_(space), y_(y), a_(a), lobes_(lobes), plane_(a.point.normal), walk_{b} {}

  /// The end of a chain: its offset from a, along two axes of the tangent plane there [m].
  struct End {
    double x = 0, y = 0;
    double off() const { return std::hypot(x, y); }
  };
  /// The derivatives of the end with respect to the direction at b, along two axes perpendicular to it [m].
  struct Derivatives {
    End u, v;
    double determinant() const { return u.x * v.y - u.y * v.x; }
  };

  /// Empty: a ray does not reach the plane by these lobes.
  std::optional<End> end(const Vector3& direction) {
    walk_.resize(1);
    const std::optional<Vector3> way = space_.follow_lobes(walk_, direction, lobes_, Transport::radiance, y_);
    if (!way) return {};
    const Point3 from = walk_.back().point.position;
    const float along = dot(plane_.n, *way), t = dot(plane_.n, a_.point.position - from) / along;
    if (!(t > 0) || !std::isfinite(t)) return {};
    // Differences first: the coordinates of a may be large.
    const Vector3 off = (from - a_.point.position) + t * *way;
    return End{double(dot(plane_.s, off)), double(dot(plane_.t, off))};
  }

  /// By central differences. Empty: the one-sided differences disagree.
  std::optional<Derivatives> derivatives(const Vector3& direction) {
    const ArenaScope memory(*y_.arena);
    const Frame across{Normal3(direction)};
    const std::optional<End> here = end(direction);
    if (!here) return {};
    std::array<End, 2> d;
    for (int axis = 0; axis < 2; ++axis) {
      const Vector3 side = axis == 0 ? Vector3(across.s) : Vector3(across.t);
      const auto more = end(normalize(direction + step * side)), less = end(normalize(direction - step * side));
      if (!more || !less) return {};
      const End up{more->x - here->x, more->y - here->y}, down{here->x - less->x, here->y - less->y};
      const double differ = std::hypot(up.x - down.x, up.y - down.y);
      if (differ > 0.2 * (up.off() + down.off())) return {};
      d[size_t(axis)] = {(up.x + down.x) / (2 * double(step)), (up.y + down.y) / (2 * double(step))};
    }
    return Derivatives{d[0], d[1]};
  }

  /// A direction that leads to a, and the derivatives of the end there.
  struct Solution {
    Vector3 direction;
    Derivatives derivatives;
  };
  /// Newton's method from `guess`. Empty: no root was found.
  std::optional<Solution> solve(const Vector3& guess) {
    Vector3 direction = guess;
    double largest = 0.1;  // maximum step [rad]: a shape may look different farther away
    std::optional<Trial> here = trial(direction);
    std::optional<Derivatives> d;  // at `here`, once they have been computed
    for (int i = 0; i <= most_steps && here; ++i) {
      const bool near = here->end.off() < tolerance * here->reach;
      if (!near && i == most_steps) return {};
      if (!d) d = derivatives(direction);
      if (!d || d->determinant() == 0) return {};
      const double u = -(here->end.x * d->v.y - here->end.y * d->v.x) / d->determinant(),
                   v = -(d->u.x * here->end.y - d->u.y * here->end.x) / d->determinant();
      const double length = std::hypot(u, v), part = std::min(1.0, largest / length);
      const Frame across{Normal3(direction)};
      const Vector3 next = normalize(direction + float(part * u) * Vector3(across.s) + float(part * v) * Vector3(across.t));
      const std::optional<Trial> there = trial(next);
      const bool nearer = there && there->end.off() < here->end.off();
      // The last step leaves only rounding errors, by which two searches from different guesses may differ at one solution.
      if (near) return Solution{nearer ? next : direction, *d};
      if (nearer) {
        direction = next;
        here = there;
        d.reset();
      } else {
        largest = std::min(largest, length) / 4;
      }
    }
    return {};
  }

  /// [rad]: the rays diverge by more than their rounding errors, and by less than the detail of shapes.
  static constexpr float step = 5e-4f;

 private:
  struct Trial {
    End end;
    double reach;  ///< distance from the last vertex before a to a [m]
  };
  std::optional<Trial> trial(const Vector3& direction) {
    const ArenaScope memory(*y_.arena);
    const std::optional<End> e = end(direction);
    if (!e) return {};
    return Trial{*e, double(length(a_.point.position - walk_.back().point.position))};
  }

  static constexpr double tolerance = 3e-5;  ///< relative to the distance of the last vertex [rad]
  static constexpr int most_steps = 12;

  const PathSpace& space_;
  LightPath& y_;
  const ChainVertex& a_;
  const std::span<const Lobe> lobes_;
  const Frame plane_;
  PathSpace::Walk walk_;
};

}  // namespace

class ManifoldMutation final : public Mutation {
  float smallest = 0.3f, largest = 0.1f;

 public:
  static void describe(Description<ManifoldMutation>& d) {
    d.summary(
         "Moves a path's place on the film, and finds the way through mirrors and glass anew by which light comes there "
         "from the same place as before.",
         "Jakob & Marschner 2012, Manifold exploration")
        .member<&ManifoldMutation::smallest>("smallest", "1", "least distance on the film [pixels]", more_than(0),
                                             soft(0.01, 10), logarithmic)
        .member<&ManifoldMutation::largest>("largest", "1", "greatest distance, over the width of the film", range(1e-4, 1));
  }

  std::optional<double> propose(const PathSpace& space, const LightPath& x, LightPath& y,
                                ChoiceNumbers& choices) const override {
    const int k = x.length(), b = x.smooth_before(k);
    if (b == 0 || !x.specular(b - 1)) return {};  // no specular vertex behind the one that is seen: see LensMutation
    const int a = x.smooth_before(b);
    const std::optional<Point2> film = moved_on_film(space, x.film, smallest, largest, choices);
    if (!film) return {};
    space.begin(y, x, a + 1);
    const std::vector<Lobe> lobes = x.lobes(b - 1, a + 1);
    const auto at = [](const LightPath& path, int i) -> const ChainVertex& { return path.x[size_t(i)]; };

    PathSpace::Walk walk{x.x.back()};
    if (!space.follow_from_camera(walk, *film, x, y)) return {};
    const ChainVertex there = walk.back();
    Chain proposed(space, y, there, at(x, a), lobes), back(space, y, at(x, b), at(x, a), lobes);
    const auto way = proposed.solve(normalize(at(x, b - 1).point.position - there.point.position));
    if (!way || !space.follow_lobes(walk, way->direction, lobes, Transport::radiance, y) || !arrives(space, walk, at(x, a), y))
      return {};

    const Vector3 began = -at(x, b - 1).out;
    const auto again = back.solve(normalize(walk[walk.size() - lobes.size()].point.position - at(x, b).point.position));
    if (!again || !(length(again->direction - began) < same_way)) return {};
    y.x.insert(y.x.end(), walk.rbegin(), walk.rend());
    if (!space.complete(y)) return {};
    return at(x, k - 1).from_camera / at(y, k - 1).from_camera *
           std::abs(again->derivatives.determinant() / way->derivatives.determinant()) * x.camera_angle(b - 1) /
           y.camera_angle(b - 1);
  }

 private:
  /// Whether the ray from the last vertex of a walk to a is unoccluded.
  static bool arrives(const PathSpace& space, const PathSpace::Walk& walk, const ChainVertex& a, LightPath& y) {
    const Vector3 way = a.point.position - walk.back().point.position;
    ChainVertex met;
    return space.follow(walk.back(), normalize(way), y, met) && met.point.object == a.point.object &&
           length(met.point.position - a.point.position) < 1e-3f * length(way);
  }

  /// Directions closer than this are one solution [rad]. Between two solutions the derivative of e changes its sign, or e has
  /// an edge; if they are closer than about a step, the one-sided differences disagree, and nothing is proposed.
  static constexpr float same_way = Chain::step;
};

static const Register<ManifoldMutation> registered;

}  // namespace etendue
