// Curve: strands of hair, grass, wire or pipe.

#include "curve_pieces.h"
#include "curve_ribbon.h"
#include "curve_tube.h"
#include "geometry/inner_origin.h"
#include "geometry/numbered_parts.h"

namespace etendue {
namespace {

// A hit's primitive is four times a piece's number, plus a tube's face.
class Curve final : public PlacedObject, public Pieces, public NumberedParts {
 public:
  enum class Form { tube, ribbon };

  static void describe(Description<Curve>& d) {
    d.summary(
         "Strands along splines: round tubes with flat ends, which enclose a volume, or flat ribbons. u goes along each "
         "strand from 0 to 1, evenly in the spline's parameter; v around a tube, or across a ribbon. A tube's flat ends have "
         "coordinates of their own. The first strand's v begins anywhere, that of the following ones by the golden section "
         "further on, so that what v does to many hairs is as if it was random.",
         "frames: Wang et al. 2008, \"Computation of rotation minimizing frames\"; cones that fit: Monge's theorem on quadrics")
        .group("Shape")
        .member<&Curve::points>("points", "m", "the control points of all strands, one strand after the other", Effect::rebuild)
        .member<&Curve::radius>("radius", "m",
                                "half of the thickness of a tube or the width of a ribbon: one number, or one for each of the "
                                "points, interpolated as they are",
                                at_least(0), Effect::rebuild, soft(0.00001, 1), logarithmic)
        .member<&Curve::counts>("counts", "1", "how many of the points belong to each strand; none: all to one", at_least(1),
                                Effect::rebuild)
        .group("Form")
        .member<&Curve::basis>("basis", "",
                               "what runs between the points: straight lines; cubic Bezier curves, with two handles between "
                               "the points that are run through; a uniform cubic B-spline, which only comes near them; a "
                               "Catmull-Rom spline through all of them",
                               choices("linear", "bezier", "b_spline", "catmull_rom"), Effect::rebuild)
        .member<&Curve::form>("form", "", "a tube is round; a ribbon is flat and has a front", choices("tube", "ribbon"),
                              Effect::rebuild)
        .member<&Curve::normals>("normals", "", "where a ribbon's front faces: one, or one for each of the points",
                                 Effect::rebuild, when("form", "ribbon"))
        .member<&Curve::turn>("turn", "deg",
                              "splines are cut into straight pieces that turn by about so much from one to the next: they are "
                              "off by turn^2 / 8 of the radius of curvature, 0.14 % at 6 degrees",
                              range(0.5, 45), Effect::rebuild, unless("basis", "linear"));
  }

  /// Only building the shape takes time, and changes of emission do not affect it.
  void prepare_again() override {}
  void prepare() override {
    check();
    vertices_.clear();
    pieces_.clear();
    transform.set_inner_origin(inner_origin_for(points));
    const std::vector<Point3> shifted = relative_to(transform.inner_origin(), points);
    std::vector<StrandPoint> flat;
    size_t first = 0, dropped = 0, cuts = 0;
    const size_t strands = counts.empty() ? 1 : counts.size();
    for (size_t i = 0; i < strands; ++i) {
      const size_t n = counts.empty() ? points.size() : counts[i];
      const auto part = [&](const auto& list) {
        using Item = typename std::decay_t<decltype(list)>::value_type;
        return list.size() > 1 && list.size() == points.size() ? std::span<const Item>(list).subspan(first, n)
                                                               : std::span<const Item>(list);
      };
      flat.clear();
      // A tube may have any number of normals; they are ignored.
      const std::span<const Normal3> fronts = form == Form::ribbon ? part(normals) : std::span<const Normal3>();
      flatten({std::span<const Point3>(shifted).subspan(first, n), part(radius), fronts}, basis, double(radians(turn)), flat);
      const size_t kept = clean(flat, i);
      dropped += kept < 2;
      if (kept >= 2) {
        flat.resize(kept);
        add_strand(flat, i, cuts);
      }
      first += n;
    }
    if (pieces_.empty()) fail("points", "no strand has a length and a radius");
    const std::string name = origin && !origin->name.empty() ? origin->name : "Curve";
    if (dropped > 0) warn(name + ": left out " + std::to_string(dropped) + " strands without length or radius");
    if (cuts > 0)
      warn(name + ": in " + std::to_string(cuts) + " places a tube bends too sharply for its radius and was cut there");
    measure();
    hierarchy_ = std::make_unique<PieceHierarchy>(*this, std::uint32_t(pieces_.size()));
    place();
  }

  bool closed() const override { return form == Form::tube; }
  std::uint64_t part_count() const override { return 4 * std::uint64_t(pieces_.size()); }  // with ends and joints

  std::vector<DoublePoint3> points{{0, 0, 0}, {0, 0, 1}};
  std::vector<float> radius{0.05f};
  std::vector<std::uint32_t> counts;
  CurveBasis basis = CurveBasis::linear;
  Form form = Form::tube;
  std::vector<Normal3> normals{{0, 1, 0}};
  float turn = 6;

 protected:
  Bounds3 local_bounds() const override { return own_bounds_; }
  bool local_intersect(const Ray& ray, Hit& hit) const override { return hierarchy_->nearest(ray, hit); }
  bool local_occludes(const Ray& ray) const override { return hierarchy_->any(ray); }

  void local_point(const Ray&, const Hit& hit, LocalPoint& p) const override { point_at(hit.primitive, hit.u, hit.v, p); }

  double local_area() const override { return area_until_.back(); }
  float local_area_error() const override { return area_error_; }

  float local_sample(Point2 u, LocalPoint& p) const override {
    // Adds pseudo-random bits below the float's precision: there may be more pieces than a float in [0, 1) has values.
    const std::uint64_t bits = (std::uint64_t(std::bit_cast<std::uint32_t>(u.x)) << 32) | std::bit_cast<std::uint32_t>(u.y);
    const double fine = double(u.x) + double(mix_bits(bits + 0x9e3779b97f4a7c15ull) >> 11) * 0x1p-77;
    const double x = fine * area_until_.back();
    const size_t i =
        std::min(size_t(std::upper_bound(area_until_.begin(), area_until_.end(), x) - area_until_.begin()), pieces_.size() - 1);
    const double below = i > 0 ? area_until_[i - 1] : 0;
    double rest = std::max(x - below, 0.0);
    const std::uint32_t number = 4 * std::uint32_t(i);
    if (form == Form::ribbon) {
      const Point2 at = ribbon(i).sample({fraction(rest, area_until_[i] - below), u.y});
      point_at(number, at.x, at.y, p);
    } else {
      const TubePiece piece = tube(i);
      TubePiece::Face face = TubePiece::round;
      double size = piece.area(face);
      for (const TubePiece::Face next : {TubePiece::begin, TubePiece::end}) {
        if (rest < size || !piece.has(next)) continue;
        rest -= size;
        face = next;
        size = piece.area(face);
      }
      const Point2 at = piece.sample(face, {fraction(rest, size), u.y});
      point_at(number + face, at.x, at.y, p);
    }
    return pdf(p.primitive, p.u, p.v);
  }

  float local_pdf(const SurfacePoint& p) const override { return pdf(p.primitive, p.u, p.v); }

 private:
  void check() {
    if (points.empty()) fail("points", "there are none");
    for (size_t i = 0; i < points.size(); ++i)
      if (!(length(points[i] - DoublePoint3{}) < 1e15)) fail("points", "point " + std::to_string(i) + " is not finite");
    if (radius.size() != 1 && radius.size() != points.size())
      fail("radius", std::to_string(radius.size()) + " radii for " + std::to_string(points.size()) + " points");
    for (const float r : radius)
      if (!(r >= 0 && r < 1e15f)) fail("radius", "every radius must be finite and at least 0");
    if (form == Form::ribbon) {
      if (normals.size() != 1 && normals.size() != points.size())
        fail("normals", std::to_string(normals.size()) + " normals for " + std::to_string(points.size()) + " points");
      for (const Normal3& n : normals)
        if (!is_finite(Vector3(n)) || n == Normal3{}) fail("normals", "every normal must be finite and not zero");
    }
    size_t sum = 0;
    const StrandSize size = strand_size(basis);
    const auto fits = [&](size_t n) { return n >= size.least && (n - size.least) % size.step == 0; };
    const std::string wanted =
        basis == CurveBasis::bezier ? "4, 7, 10 and so on for Bezier curves" : "at least " + std::to_string(size.least);
    for (size_t i = 0; i < counts.size(); ++i) {
      sum += counts[i];
      if (!fits(counts[i]))
        fail("counts",
             "strand " + std::to_string(i) + " has " + std::to_string(counts[i]) + " points, which should be " + wanted);
    }
    if (counts.empty() && !fits(points.size()))
      fail("points", "there are " + std::to_string(points.size()) + ", which should be " + wanted);
    if (!counts.empty() && sum != points.size())
      fail("counts", "they add up to " + std::to_string(sum) + ", but there are " + std::to_string(points.size()) + " points");
  }

  /// Removes points that coincide with the previous one in float precision, and pieces of radius zero at either end. Returns
  /// the number of points left; the elements behind them are invalid.
  size_t clean(std::vector<StrandPoint>& s, size_t strand) const {
    const auto rounded = [](const StrandPoint& p) {
      return Point3{float(p.position[0]), float(p.position[1]), float(p.position[2])};
    };
    size_t kept = 0;
    for (size_t i = 0; i < s.size(); ++i) {
      if (kept > 0) {
        const Point3 a = rounded(s[kept - 1]), b = rounded(s[i]);
        const float size = std::max(max_component(abs(a - Point3{})), max_component(abs(b - Point3{})));
        if (!(distance(a, b) > 4e-7f * size)) continue;
        if (s[kept - 1].radius == 0 && s[i].radius == 0) {  // the piece between them is empty
          if (kept > 1) fail("radius", "strand " + std::to_string(strand) + " has a piece without a radius");
          --kept;
        }
      }
      s[kept++] = s[i];
    }
    if (kept == 1 || (kept == 2 && s[0].radius == 0 && s[1].radius == 0)) return 0;
    for (size_t i = 0; form == Form::tube && i + 1 < kept; ++i) {
      const float length = distance(rounded(s[i]), rounded(s[i + 1]));
      if (!(std::abs(float(s[i].radius) - float(s[i + 1].radius)) < 0.99f * length))
        fail("radius", "in strand " + std::to_string(strand) +
                           " the radius changes by more than the length of a piece, near (" +
                           fmt::format("{:.4g}, {:.4g}, {:.4g})", s[i].position[0], s[i].position[1], s[i].position[2]));
    }
    return kept;
  }

  void add_strand(const std::vector<StrandPoint>& s, size_t strand, size_t& cuts) {
    const size_t first = vertices_.size();
    if (form == Form::tube) {
      const double turned = double(strand) * 0.6180339887498949;
      cuts += append_tube(s, 2 * M_PI * (turned - std::floor(turned)), vertices_);
    } else if (const size_t bad = append_ribbon(s, vertices_); bad < s.size()) {
      fail("normals", "strand " + std::to_string(strand) + " runs along its normal at u = " + fmt::format("{:.3g}", s[bad].u));
    }
    if (vertices_.size() >= size_t(1) << 30) fail("points", "there are more than 2^30 pieces");
    for (size_t i = first; i + 1 < vertices_.size(); ++i)  // no piece between two flat ends at one position
      if (vertices_[i].u < vertices_[i + 1].u) pieces_.push_back(std::uint32_t(i));
  }

  void measure() {
    double sum = 0, error = 0;
    own_bounds_ = {};
    area_until_.clear();
    area_until_.reserve(pieces_.size());
    for (size_t i = 0; i < pieces_.size(); ++i) {
      own_bounds_.add(piece_bounds(std::uint32_t(i)));
      if (form == Form::ribbon) {
        const double fine = ribbon(i).area(3);
        error += std::abs(fine - ribbon(i).area(2));
        sum += fine;
      } else {
        const TubePiece piece = tube(i);
        const double round = piece.area(TubePiece::round);
        error += round * piece.area_error();
        sum += round;
        for (const TubePiece::Face face : {TubePiece::begin, TubePiece::end})
          if (piece.has(face)) sum += piece.area(face);
      }
      area_until_.push_back(sum);
    }
    area_error_ = float(error / sum);
  }

  TubePiece tube(size_t i) const { return {vertices_[pieces_[i]], vertices_[pieces_[i] + 1]}; }
  RibbonPiece ribbon(size_t i) const { return {vertices_[pieces_[i]], vertices_[pieces_[i] + 1]}; }

  Bounds3 piece_bounds(std::uint32_t i) const override { return form == Form::ribbon ? ribbon(i).bounds() : tube(i).bounds(); }

  bool intersect_piece(std::uint32_t i, const DoubleRay& ray, float maximum, Hit& hit) const override {
    float t = 0, u = 0, v = 0;
    TubePiece::Face face = TubePiece::round;
    if (!(form == Form::ribbon ? ribbon(i).intersect(ray, maximum, t, u, v) : tube(i).intersect(ray, maximum, t, face, u, v)))
      return false;
    hit.distance = t;
    hit.primitive = 4 * i + face;
    hit.u = u;
    hit.v = v;
    return true;
  }

  void point_at(std::uint32_t primitive, float u, float v, LocalPoint& p) const {
    p.primitive = primitive;
    if (form == Form::ribbon)
      ribbon(primitive / 4).point(u, v, p);
    else
      tube(primitive / 4).point(TubePiece::Face(primitive % 4), u, v, basis != CurveBasis::linear, p);
  }

  /// The pdf [1/m^2] of local_sample: a piece or its face is chosen in proportion to its area.
  float pdf(std::uint32_t primitive, float u, float v) const {
    const size_t i = primitive / 4;
    double area = area_until_[i] - (i > 0 ? area_until_[i - 1] : 0), there = 0;
    if (form == Form::ribbon) {
      there = ribbon(i).pdf(u, v);
    } else {
      const TubePiece piece = tube(i);
      const auto face = TubePiece::Face(primitive % 4);
      area = piece.area(face);
      there = piece.pdf(face, u, v);
    }
    return float(area / area_until_.back() * there);
  }

  static float fraction(double part, double whole) { return whole > 0 ? std::min(float(part / whole), one_minus_epsilon) : 0; }

  std::vector<CurveVertex> vertices_;
  std::vector<std::uint32_t> pieces_;  // the first vertex of each
  std::vector<double> area_until_;     // cumulative area of the pieces, with their flat ends
  std::unique_ptr<PieceHierarchy> hierarchy_;
  Bounds3 own_bounds_;
  float area_error_ = 0;
};

const Register<Curve> registered;

}  // namespace
}  // namespace etendue
