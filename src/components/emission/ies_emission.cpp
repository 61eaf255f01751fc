// IesEmission: the measured light of a lamp, from an IES photometric file.

#include "direction_table.h"
#include "ies_file.h"
#include "shaped_emission.h"

namespace etendue {
namespace {

constexpr double pi_exactly = 3.14159265358979323846, degree = pi_exactly / 180;

// The file gives the intensity I(w) [cd]. The colour M has the luminance l = 683.002 integral of M V dlambda. The profile
// (ShapedEmission) of a point is f = I / l [1], as its intensity is M f * 1 m^2, with Omega = flux / l.
//
// A surface of area A whose normal is the lamp's axis (`about: normal`) emits the file's distribution if each part of it emits
// this distribution in proportion to its area:
//     L = I / (A |n . w|),   f = I / (l A |n . w|),   K = (flux to the sides that emit) / (l A).
// The whole object then has the intensities of the file if it is flat, and the flux of the file if it is not. Cosines below
// 1e-3 (the last 0.06 degrees) are replaced by 1e-3, so that the radiance stays finite.
//
// With `about: axis` every point of a surface has the radiance L = I / (1 m^2), as in UsdLux: f = I / l, and K is computed by
// quadrature over directions.
//
// Directions are sampled from a table over the file's own grid, subdivided to steps of 2 degrees of the polar angle and 5 of
// the azimuth. In a cell the intensity is bilinear in the angles; the cell's importance is the mean intensity at four points
// near its corners, which is positive if the intensity is positive anywhere in the cell.
class IesEmission final : public ShapedEmission {
 public:
  static void describe(Description<IesEmission>& d) {
    d.summary(
         "The light of a lamp as measured, from an IES photometric file (LM-63-1986 to -2019; types A, B and C; TILT=NONE or "
         "INCLUDE). On a Point a lamp that hangs there; on a surface a luminous area that sends it out about its normal. As "
         "strong as the file says, multiplied by `multiplier`, unless an amount is given. What lies behind a surface that "
         "emits "
         "to the front only is left out.",
         "ANSI/IESNA LM-63-02, Standard file format for the electronic transfer of photometric data")
        .group("Light")
        .member<&IesEmission::file>("file", "", "the .ies file", required)
        .member<&IesEmission::map>("color", "1", "the spectrum's shape; the same everywhere", Meaning::radiance);
    describe_amounts(d);
    d.group("Lamp")
        .member<&IesEmission::multiplier>("multiplier", "1", "multiplies the file's candelas", at_least(0), soft(0.01, 100),
                                          logarithmic, unless("power"), unless("luminous_flux"), unless("luminous_intensity"),
                                          unless("illuminance"))
        .member<&IesEmission::normalized>(
            "normalized", "", "whether the file's candelas are divided by its lumens, so that only its shape counts",
            unless("power"), unless("luminous_flux"), unless("luminous_intensity"), unless("illuminance"))
        .member<&IesEmission::about>(
            "about", "",
            "of a surface; normal: each part of it is a part of the lamp, turned to its normal; axis: "
            "the lamp's axis is the same everywhere, and the file's candelas are the luminance [cd/m^2]",
            choices("normal", "axis"))
        .member<&IesEmission::axis>(
            "axis", "1",
            "of a Point: where vertical angle 0 of type C points, or the beam of types A and B, in the "
            "object's own coordinates; of any length. On a surface the normal takes its place, unless it is about "
            "the axis")
        .member<&IesEmission::across>("across", "1",
                                      "a direction across the axis: where horizontal angle 0 of type C lies, or vertical angle "
                                      "90 of types A and B; only what is perpendicular to the axis counts")
        .member<&IesEmission::tilt>("tilt", "deg",
                                    "by how much the lamp is tilted, for files with TILT=INCLUDE, which say how that changes "
                                    "its light; the axis is turned separately",
                                    range(0, 180));
  }

  void prepare() override {
    try {
      ies_ = read_ies_file(file.resolved());
    } catch (const Error& e) {
      fail("file", e.what());
    }
    axis_ = checked_direction(axis, "axis");
    across_ = checked_direction(across, "across");
    if (!(length(cross(axis_, across_)) > 1e-3f)) fail("across", "must not be along the axis");
    prepare_amounts("color");
    const Color colour = map->constant();
    if (!colour) fail("color", "must be the same everywhere");
    const double luminance =
        integrate_spectrum(Quantity::flux, [&](float lambda) { return colour->at(lambda, ColorUse::radiance); });
    if (!(luminance > 0)) fail("color", "is black to the eye, so it cannot have the shape of a lamp's spectrum");
    const double reference_lumens = normalized ? ies_.lumens() : 1;
    if (!(reference_lumens > 0)) fail("normalized", "the file's lamp gives no light");
    const double factor = ies_.tilt_factor(double(tilt)) * (amount_asked() ? 1 : double(multiplier) / reference_lumens);
    per_candela_ = float(factor / luminance);
    flux_ = ies_.lumens() * factor / luminance;
    front_ = front_lumens() * factor / luminance;

    const std::vector<double> polar = subdivide(ies_.polar, 2), azimuth = subdivide(ies_.azimuth, 5);
    table_.build(polar, azimuth, [&](size_t row, size_t column) {
      double sum = 0;
      for (const double s : {0.001, 0.999})
        for (const double t : {0.001, 0.999})
          sum += double(ies_.at(std::lerp(polar[row], polar[row + 1], s), std::lerp(azimuth[column], azimuth[column + 1], t)));
      return sum;
    });
  }

  Spectrum radiance(const SurfacePoint& p, const Vector3& direction, const Wavelengths& w) const override {
    if (!emits(p, direction)) return {};
    const float f = profile(p, direction);
    return f > 0 ? scaled(p, w, f) : Spectrum();
  }

  // A part of the light may lie on a side that does not emit: samples of this part have pdf 0.
  DirectionSample sample(const SurfacePoint& p, Point2 u) const override {
    const DirectionSample s = table_.sample(u);
    const Vector3 direction = frame(p).to_world(s.direction);
    return {direction, emits(p, direction) ? s.pdf : 0};
  }
  float pdf(const SurfacePoint& p, const Vector3& direction) const override {
    return emits(p, direction) ? table_.pdf(frame(p).to_local(direction)) : 0;
  }

  Spectrum power(const SceneObject& object, const Wavelengths& w) const override {
    if (object.infinite()) fail("file", "a lamp belongs on a Point or on a surface, not at infinity");
    return ShapedEmission::power(object, w);
  }

  FilePath file;
  enum class About : std::uint8_t { normal, axis };
  About about = About::normal;
  bool normalized = false;
  float multiplier = 1, tilt = 0;
  Vector3 axis{0, -1, 0}, across{1, 0, 0};

 protected:
  float profile(const SurfacePoint& p, const Vector3& direction) const override {
    const Vector3 local = frame(p).to_local(direction);
    const double r = std::sqrt(double(local.x) * double(local.x) + double(local.y) * double(local.y));
    const float f =
        per_candela_ * ies_.at(std::atan2(r, double(local.z)) / degree, std::atan2(double(local.y), double(local.x)) / degree);
    if (!about_normal(p)) return f;
    const float area = p.object ? p.object->area(p.time) : 1;
    return f / (area * std::max(std::abs(dot(p.normal, direction)), 1e-3f));
  }
  double solid_angle() const override { return flux_; }
  double surface_share(const SurfacePoint& p) const override {
    if (about == About::axis) return share_about_axis(p);
    const double area = p.object ? double(p.object->area(p.time)) : 1;
    return ((sides != Sides::back ? front_ : 0) + (sides != Sides::front ? flux_ - front_ : 0)) / area;
  }
  bool same_on_surfaces() const override { return about == About::normal; }
  Vector3 own_axis(const SurfacePoint& p) const override { return about_normal(p) ? Vector3{} : turned(p, axis_); }

 private:
  bool about_normal(const SurfacePoint& p) const { return about == About::normal && !(p.normal == Normal3{}); }

  /// K: the integral of f |n . w| over the sides that emit, by the midpoint rule.
  double share_about_axis(const SurfacePoint& p) const {
    constexpr int rows = 48, columns = 48;
    const Frame own = frame(p);
    double sum = 0;
    for (int i = 0; i < rows; ++i) {
      const double theta = pi_exactly * (i + 0.5) / rows;
      for (int k = 0; k < columns; ++k) {
        const double phi = 2 * pi_exactly * (k + 0.5) / columns;
        const Vector3 w = own.to_world(
            {float(std::sin(theta) * std::cos(phi)), float(std::sin(theta) * std::sin(phi)), float(std::cos(theta))});
        if (emits(p, w)) sum += double(profile(p, w)) * double(std::abs(dot(p.normal, w))) * std::sin(theta);
      }
    }
    return sum * (pi_exactly / rows) * (2 * pi_exactly / columns);
  }

  /// The axes x, y, z of the file's grid in world space; z is its pole.
  Frame frame(const SurfacePoint& p) const {
    const Vector3 a = about_normal(p) ? Vector3(p.normal) : turned(p, axis_);
    Vector3 s = turned(p, across_);
    s = s - dot(s, a) * a;
    // If the normal is parallel to `across`, any perpendicular direction is taken.
    const float l = length(s);
    s = l > 1e-4f ? s / l : Frame(Normal3(a)).s;
    Frame f;
    switch (ies_.type) {
      case Photometry::c: f.s = s, f.t = cross(s, a), f.n = Normal3(a); break;  // counter-clockwise from above
      case Photometry::a: f.s = a, f.t = cross(a, s), f.n = Normal3(s); break;  // pole up
      case Photometry::b: f.s = a, f.t = s, f.n = Normal3(cross(a, s)); break;  // pole to the right
    }
    // For a mirrored object the distribution is mirrored too: the axis computed by a cross product is reversed. Whether the
    // object is mirrored is a property of its transform, not of the normal that the distribution may be about.
    if (dot(turned(p, cross(axis, across)), cross(turned(p, axis_), turned(p, across_))) < 0) {
      if (ies_.type == Photometry::b)
        f.n = -f.n;
      else
        f.t = -f.t;
    }
    return f;
  }

  /// The flux within 90 degrees of the axis [lm].
  double front_lumens() const {
    if (ies_.type == Photometry::c) return ies_.lumens(0, 90);
    // Azimuths of types A and B are within 90 degrees of the axis, so all of the flux is in front.
    return ies_.lumens();
  }

  IesDistribution ies_;
  DirectionTable table_;
  Vector3 axis_{0, -1, 0}, across_{1, 0, 0};
  float per_candela_ = 0;        // f per candela, 1 / l [1/cd]
  double flux_ = 0, front_ = 0;  // flux over the colour's luminance l [sr]: all (Omega), and within 90 degrees of the axis
};

const Register<IesEmission> registered;

}  // namespace
}  // namespace etendue
