// Tube: a thick-walled pipe, open at both ends.

#include "geometry/axial_view.h"
#include "geometry/double_ray.h"
#include "geometry/quadric_roots.h"
#include "geometry/visible_directions.h"

namespace etendue {
namespace {

// The solid inside the outer cylinder and a slab, but outside the inner cylinder: on a ray at most two intervals.
class Tube final : public PlacedObject {
 public:
  static void describe(Description<Tube>& d) {
    d.summary(
         "A pipe with a thick wall, about the z axis from -height/2 to height/2: a closed solid. On its sides u goes around "
         "from +x towards +y and v up, or down inside; on its ends they are as on a Disc of the outer radius, u backwards on "
         "the "
         "lower one.",
         "intersection with quadrics: Hearn & Baker 2004")
        .group("Shape")
        .member<&Tube::inner_radius>("inner_radius", "m", "of its bore", more_than(0), Effect::rebuild, soft(0.01, 100),
                                     logarithmic)
        .member<&Tube::radius>("radius", "m", "its outer radius", more_than(0), Effect::rebuild, soft(0.01, 100), logarithmic)
        .member<&Tube::height>("height", "m", "its length along z", more_than(0), Effect::rebuild, soft(0.01, 100),
                               logarithmic);
  }

  void prepare() override {
    if (!(radius > 0 && radius < infinity)) fail("radius", "must be positive and finite");
    if (!(height > 0 && height < infinity)) fail("height", "must be positive and finite");
    if (!(inner_radius > 0 && inner_radius < radius)) fail("inner_radius", "must be positive and smaller than radius");
    // A thinner wall would be lost in rounding.
    if (!(radius - inner_radius > 1e-5f * radius)) fail("inner_radius", "the wall is too thin");
    r_[0] = double(radius);
    r_[1] = double(inner_radius);
    half_ = 0.5 * double(height);
    areas_[outer] = 4 * M_PI * r_[0] * half_;
    areas_[inner] = 4 * M_PI * r_[1] * half_;
    areas_[low_end] = areas_[high_end] = M_PI * (r_[0] - r_[1]) * (r_[0] + r_[1]);
    if (!(float(local_area()) > 0 && float(local_area()) < infinity)) fail("radius", "the tube is too small or too large");
    place();
  }

  bool closed() const override { return true; }

  SurfaceSample sample_visible(const Point3& from, Point2 u, float time) const override {
    Transform scratch;
    const Transform& t = placed(transform, time, scratch);
    const Seen seen(*this, t.back(from));
    if (!seen.within_wall()) return AxialDirections(seen).sample(*this, t, from, u, time);
    return sample_by_both(*this, everywhere, from, u, time, none, no_pdf);
  }

  float visible_pdf(const Point3& from, const Vector3& direction, const SurfacePoint& p) const override {
    Transform scratch;
    const Transform& t = placed(transform, p.time, scratch);
    const Seen seen(*this, t.back(from));
    if (!seen.within_wall()) return AxialDirections(seen).pdf(t, from, direction, p);
    return pdf_by_both(everywhere, from, direction, p, no_pdf);
  }

  float inner_radius = 0.75f, radius = 1, height = 2;

 protected:
  Bounds3 local_bounds() const override {
    Bounds3 box;
    box.add(Point3{-radius, -radius, -0.5f * height});
    box.add(Point3{radius, radius, 0.5f * height});
    return box;
  }

  bool local_intersect(const Ray& ray, Hit& hit) const override {
    const NearRay near(ray, 0);
    const SlabInside slab(near, -half_, half_);
    const QuadricInside round = near.inside(0, 0, r_[0] * r_[0]);
    const bool by_side = round.low > slab.enter, out_by_side = round.high < slab.leave;
    const double enter = by_side ? round.low : slab.enter, leave = out_by_side ? round.high : slab.leave;
    if (!(enter < leave)) return false;
    const Part first = by_side ? outer : (slab.upwards ? low_end : high_end);
    const Part last = out_by_side ? outer : (slab.upwards ? high_end : low_end);
    const QuadricInside bore = near.inside(0, 0, r_[1] * r_[1]);
    const auto solid = [&](double low, Part in, double high, Part out) {
      return low < high && (take_hit(ray, near.start + low, in, hit) || take_hit(ray, near.start + high, out, hit));
    };
    if (!(bore.low < bore.high) || bore.low >= leave || bore.high <= enter) return solid(enter, first, leave, last);
    return solid(enter, first, bore.low, inner) || solid(bore.high, inner, leave, last);
  }

  void local_point(const Ray& ray, const Hit& hit, LocalPoint& p) const override {
    const DoubleRay r(ray);
    const double t = exact_distance(hit), x = r.at(t, 0), y = r.at(t, 1);
    if (hit.primitive == outer || hit.primitive == inner) {
      // Projects the point onto the side: t may have the rounding error of a longer ray, if the tube is an operand of a solid.
      const double around = std::sqrt(x * x + y * y), scale = around > 0 ? r_[hit.primitive] / around : 1;
      side_point(int(hit.primitive), scale * x, scale * y, within(r.at(t, 2), -half_, half_), p);
    } else
      end_point(int(hit.primitive), x, y, p);
  }

  double local_area() const override { return areas_[outer] + areas_[inner] + areas_[low_end] + areas_[high_end]; }

  Seams local_seams() const override {
    const double area = local_area(), until_side = areas_[low_end] + areas_[outer], until_bore = until_side + areas_[high_end];
    return {{}, {areas_[low_end] / area, until_side / area, until_bore / area}};
  }

  float local_sample(Point2 u, LocalPoint& p) const override {
    // Runs once around the profile: outwards on the low end, up the outer side, inwards on the high end and down the bore.
    const double area = local_area();
    double y = double(u.y) * area;
    constexpr Part order[] = {low_end, outer, high_end, inner};
    int k = 0;
    while (k < parts - 1 && y >= areas_[order[k]]) y -= areas_[order[k++]];
    const double share = std::min(y / areas_[order[k]], 1.0);
    point_on(order[k], 2 * M_PI * double(u.x), order[k] == high_end || order[k] == inner ? 1 - share : share, p);
    return float(1 / area);
  }

 private:
  enum Part { outer, inner, low_end, high_end };
  static constexpr int parts = 4;

  /// The tube as seen from outside or from its bore, for AxialDirections.
  struct Seen {
    const Tube& tube;
    AxialView view;

    Seen(const Tube& object, const Point3& own) : tube(object), view(own, -object.half_, object.half_, object.r_[0]) {}

    /// Whether the point is inside the wall, from where all surfaces may be visible.
    bool within_wall() const { return view.side() == 0 && view.around() > tube.r_[1] && view.around() < tube.r_[0]; }

    Elevations at(double sine, double cosine) const {
      const double across = view.around() * sine, toward = view.around() * cosine;
      // Distances at which the half plane of the azimuth enters and leaves the circles about the axis.
      const auto squared = [&](double r) { return r * r - across * across; };
      const double outer_far = toward + std::sqrt(std::max(0.0, squared(tube.r_[0])));
      const double outer_near = (view.around() - tube.r_[0]) * (view.around() + tube.r_[0]) / outer_far;
      const double bore = squared(tube.r_[1]), inner_far = toward + std::sqrt(std::max(0.0, bore));
      const double inner_near = (view.around() - tube.r_[1]) * (view.around() + tube.r_[1]) / inner_far;
      Elevations seen;
      if (view.side() == 0) {  // one side is visible; the wall hides the other
        const double s = view.around() < tube.r_[1] ? inner_far : outer_near;
        seen.add(view.elevation(s, -tube.half_), view.elevation(s, tube.half_));
        return seen;
      }
      // From the far rim of the outer side, or straight up or down, to the far edge of the nearer end, excluding the directions
      // in which one looks through the bore.
      const double near_end = view.side() * tube.half_, far_end = -near_end;
      const double begin = outer_near > 0 ? view.elevation(outer_near, far_end) : view.pole(-view.side());
      const double end = view.elevation(outer_far, near_end);
      if (bore <= 0 || inner_far <= 0) {
        seen.add(begin, end);
      } else {
        if (inner_near > 0) seen.add(begin, view.elevation(inner_near, near_end));
        seen.add(view.elevation(inner_far, far_end), end);
      }
      return seen;
    }

    bool sees(const Point3&, const Vector3& direction, const SurfacePoint& p) const {
      if (!(dot(p.normal, direction) < 0)) return false;
      if (p.primitive != inner || (view.side() == 0 && view.around() < tube.r_[1])) return true;
      return view.side() != 0 && view.through(p.object_position, view.side() * tube.half_, tube.r_[1]);
    }
  };
  /// From inside the wall all samples are by direction.
  static constexpr DirectionShare everywhere{1, false};
  static bool none(Point2, SurfaceSample&) { return false; }
  static float no_pdf(const SurfacePoint&) { return 0; }

  void point_on(int part, double phi, double share, LocalPoint& p) const {
    const double cosine = std::cos(phi), sine = std::sin(phi);
    if (part == outer || part == inner) {
      side_point(part, r_[part] * cosine, r_[part] * sine, within((2 * share - 1) * half_, -half_, half_), p);
    } else {
      const double r = std::sqrt(r_[1] * r_[1] + share * (r_[0] - r_[1]) * (r_[0] + r_[1]));
      end_point(part, r * cosine, r * sine, p);
    }
  }

  void side_point(int part, double x, double y, double z, LocalPoint& p) const {
    const double out = part == outer ? 1 : -1, r = out / std::sqrt(x * x + y * y);
    p.position = {float(x), float(y), float(z)};
    p.normal = {float(x * r), float(y * r), 0};
    const double v = 0.5 * (1 + out * z / half_);
    p.uv = {std::min(positive_atan2(float(y), float(x)) / (2 * pi), 1.0f), clamp(float(v), 0, 1)};
    p.dpdu = {float(-2 * M_PI * y), float(2 * M_PI * x), 0};
    p.dpdv = {0, 0, float(out * 2 * half_)};
    p.primitive = std::uint32_t(part);
    const Vector3 here{std::abs(p.position.x), std::abs(p.position.y), 0};
    p.error = rounding_bound(3) * (along(p.normal, here) + float(least_extent()));
  }

  void end_point(int part, double x, double y, LocalPoint& p) const {
    const double around = std::sqrt(x * x + y * y), inward = around > 0 ? within(around, r_[1], r_[0]) / around : 1;
    flat_point(inward * x, inward * y, part == high_end ? half_ : -half_, r_[0], part == high_end, least_extent(), p);
    p.primitive = std::uint32_t(part);
  }

  /// The smaller of radius and height: see RevolvedQuadric.
  double least_extent() const { return std::min(r_[0], 2 * half_); }

  double r_[2]{1, 0.75}, half_ = 1;  // outer and inner radius, half of the height
  double areas_[parts]{};
};

const Register<Tube> registered;

}  // namespace
}  // namespace etendue
