// Quadric: spheres, cones, cylinders, paraboloids and hyperboloids in general position, clipped to a box.

#include "implicit_object.h"

namespace etendue {
namespace {

// q(x) = x.S x + l.x + c with S symmetric. Along a ray q is a polynomial of degree 2 in t.
class Quadric final : public ImplicitObject {
 public:
  static void describe(Description<Quadric>& d) {
    d.summary(
         "A general quadric in a box: the solid where a x^2 + b y^2 + c z^2 + d y z + e z x + f x y + g x + h y + i z + j < 0. "
         "By "
         "default the unit sphere. Surface coordinates are those of the face of the box the surface faces most, from 0 to 1 as "
         "on a Box.")
        .group("Shape")
        .member<&Quadric::squares>("squares", "1", "the factors a, b, c of x^2, y^2 and z^2", Effect::rebuild)
        .member<&Quadric::products>("products", "1", "the factors d, e, f of y z, z x and x y", Effect::rebuild)
        .member<&Quadric::linear>("linear", "1", "the factors g, h, i of x, y and z, in m", Effect::rebuild)
        .member<&Quadric::constant>("constant", "1", "the term j", Effect::rebuild)
        .group("Box")
        .member<&Quadric::low>("low", "m", "the corner of the box with the lowest coordinates", Effect::rebuild)
        .member<&Quadric::high>("high", "m", "the corner with the highest", Effect::rebuild)
        .member<&Quadric::capped>("capped", "",
                                  "whether the solid has faces where the box cuts it, and so is closed; else it is open there",
                                  Effect::rebuild);
  }

  void prepare() override {
    bool any = false;
    const auto check = [&](const Vector3& v, const char* name) {
      if (!is_finite(v)) fail(name, "must be finite");
      any = any || v != Vector3{};
    };
    check(squares, "squares");
    check(products, "products");
    check(linear, "linear");
    if (!std::isfinite(constant)) fail("constant", "must be finite");
    if (!any) fail("squares", "a quadric needs a factor that is not 0 in 'squares', 'products' or 'linear'");
    settle(low, high, capped, "squares");
  }

  Vector3 squares{1, 1, 1}, products{0, 0, 0}, linear{0, 0, 0};
  float constant = -1;
  Point3 low{-1, -1, -1}, high{1, 1, 1};
  bool capped = true;

 protected:
  double field(const Place& x) const override {
    const Place s = times_matrix(x);
    double q = double(constant);
    for (int k = 0; k < 3; ++k) q += x[size_t(k)] * (s[size_t(k)] + double(linear[k]));
    return q;
  }
  Place gradient(const Place& x) const override {
    const Place s = times_matrix(x);
    return {2 * s[0] + double(linear.x), 2 * s[1] + double(linear.y), 2 * s[2] + double(linear.z)};
  }

  bool next_crossing(const DoubleRay& r, double from, double to, bool& inside, double& t) const override {
    // f(s) with s from 0 to 1 over the range is b0 (1 - s)^2 + 2 b1 s (1 - s) + b2 s^2 = a s^2 + 2 h s + b0.
    const Place d{r.direction[0] * (to - from), r.direction[1] * (to - from), r.direction[2] * (to - from)};
    const Place x{r.at(from, 0), r.at(from, 1), r.at(from, 2)}, g = gradient(x), sd = times_matrix(d);
    const double b0 = field(x), h = 0.5 * (g[0] * d[0] + g[1] * d[1] + g[2] * d[2]);
    const double a = d[0] * sd[0] + d[1] * sd[1] + d[2] * sd[2], b1 = b0 + h, b2 = a + 2 * h + b0;
    const bool negative = b0 < 0;
    double s = 0;
    if (negative == inside) {  // otherwise rounding moved the start across the surface
      const bool end_differs = (b2 < 0) != negative;
      if (!end_differs && (b1 < 0) == negative) return false;
      const double discriminant = h * h - a * b0;
      if (!end_differs && !(discriminant > 0)) return false;
      // Where f first changes its sign, f' = 2 (a s + h) = -+2 root. Of the two forms of each root the one without cancellation
      // is used.
      const double root = std::sqrt(std::max(discriminant, 0.0));
      if (negative)
        s = h >= 0 ? -b0 / (h + root) : (root - h) / a;
      else
        s = h <= 0 ? b0 / (root - h) : -(h + root) / a;
      if (!end_differs && !(s > 0 && s < 1)) return false;  // both roots lie outside the range
      s = s >= 0 && s <= 1 ? s : std::clamp(s == s ? s : 1.0, 0.0, 1.0);
    }
    inside = !inside;
    t = from + s * (to - from);
    return true;
  }

  /// In a box with centre m and half edges r, |q - q(m)| <= |grad q(m)|.r + r.|S| r.
  bool may_cross(const Place& from, const Place& to) const override {
    Place m, r;
    for (size_t k = 0; k < 3; ++k) {
      m[k] = 0.5 * (from[k] + to[k]);
      r[k] = 0.5 * (to[k] - from[k]);
    }
    const Place g = gradient(m);
    double most = r[1] * r[2] * std::abs(double(products.x)) + r[2] * r[0] * std::abs(double(products.y)) +
                  r[0] * r[1] * std::abs(double(products.z));
    for (int k = 0; k < 3; ++k) most += r[size_t(k)] * (std::abs(g[size_t(k)]) + r[size_t(k)] * std::abs(double(squares[k])));
    return std::abs(field(m)) <= most * (1 + 1e-9);
  }

 private:
  Place times_matrix(const Place& x) const {
    const double dx = 0.5 * double(products.x), dy = 0.5 * double(products.y), dz = 0.5 * double(products.z);
    return {double(squares.x) * x[0] + dz * x[1] + dy * x[2], dz * x[0] + double(squares.y) * x[1] + dx * x[2],
            dy * x[0] + dx * x[1] + double(squares.z) * x[2]};
  }
};

const Register<Quadric> registered;

}  // namespace
}  // namespace etendue
