// MapVolume: a medium whose coefficients are maps through space.

#include <fmt/format.h>

#include "bounded_map.h"
#include "etendue/core/transform.h"
#include "phased_volume.h"

namespace etendue {
namespace {

// With the density d and the maps' coefficients a and s, the absorption coefficient is d a and the scattering coefficient d s.
// The emission per distance is
//     d e + d a B,
// with e the map `emission` and B the map `glow`. A purely absorbing medium of uniform temperature and thickness t then has the
// radiance B (1 - exp(-d a t)): B is the radiance of the medium where it is opaque (Kirchhoff's law, when B is Planck's
// radiance).
//
// Tracking needs a majorant of the extinction. It is computed from the upper bounds of the maps (bounded_map.h), as the product
// for density and coefficient and the sum for absorption and scattering; or it is the member `bound`. An extinction above
// `bound` is reduced to `bound`, so that the majorant holds for any map and the picture is not wrong.
class MapVolume final : public PhasedVolume {
 public:
  static void describe(Description<MapVolume>& d) {
    d.summary(
        "A medium whose coefficients are maps, looked up at points of space (GridMap, CloudMap, noise, formulas). "
        "Maps over surface coordinates see u = v = 0; what maps "
        "take for the coordinates of the whole scene are those of the object here; no footprint is averaged over.");
    d.group("Density")
        .member<&MapVolume::density>("density", "1", "what all coefficients are multiplied by; below 0 it is 0",
                                     Meaning::number)
        .member<&MapVolume::bound>("bound", "1/m",
                                   "a bound of the extinction, for maps that know none themselves: denser matter is made as "
                                   "dense as this; the closer to the largest there is, the faster. 0: none",
                                   at_least(0), soft(0, 1000))
        .group("Coefficients")
        .member<&MapVolume::absorption>("absorption", "1/m", "absorption coefficient, per wavelength, where the density is 1",
                                        Meaning::coefficient, soft(0.001, 1000), logarithmic, unless("extinction"))
        .member<&MapVolume::scattering>("scattering", "1/m", "scattering coefficient, per wavelength, where the density is 1",
                                        Meaning::coefficient, soft(0.001, 1000), logarithmic, unless("extinction"))
        .member<&MapVolume::extinction>(
            "extinction", "1/m",
            "instead of these, both together, per wavelength, where the density is 1; `albedo` says "
            "how much of it scatters; none: they are used",
            Meaning::coefficient)
        .member<&MapVolume::albedo>("albedo", "1", "the part of the extinction that scatters, per wavelength",
                                    Meaning::reflectance, when("extinction"))
        .group("Light")
        .member<&MapVolume::emission>("emission", "W m^-3 sr^-1 nm^-1",
                                      "radiance the medium adds per distance where the density is 1, whatever it absorbs",
                                      Meaning::radiance, soft(0.001, 1000), logarithmic)
        .member<&MapVolume::glow>("glow", "W m^-2 sr^-1 nm^-1",
                                  "radiance of matter that nothing is seen through: the medium adds, per distance, this times "
                                  "its absorption, as hot gas does (BlackbodyMap)",
                                  Meaning::radiance, soft(0.001, 1000), logarithmic)
        .group("Place")
        .member<&MapVolume::placement>(
            "placement", "",
            "from the coordinates that maps are looked up in to those of the object whose inside the "
            "medium fills")
        .member<&MapVolume::limited>("limited", "", "whether there is matter only in the box from `low` to `high`")
        .member<&MapVolume::low>("low", "m", "a corner of that box, in the coordinates of the maps", when("limited"))
        .member<&MapVolume::high>("high", "m", "the corner across from it", when("limited"));
    describe_phase(d);
  }

  void prepare() override {
    check("density", density);
    check("absorption", absorption);
    check("scattering", scattering);
    check("albedo", albedo);
    check("emission", emission);
    check("glow", glow);
    if (extinction) {
      check("extinction", extinction);
      if (!black(*absorption) || !black(*scattering))
        fail("extinction", "is given besides absorption or scattering; only one way of saying it can count");
    }
    check_phase();
    if (!placement.valid()) fail("placement", "must be finite, and have an inverse");
    if (!is_finite(low - Point3{}) || !is_finite(high - Point3{})) fail("high", "must be finite numbers");
    emits_ = !black(*emission);
    glows_ = !black(*glow);
    density_bound_ = bound_of(*density);
    if (bound > 0) {
      if (bound > most_extinction) fail("bound", fmt::format(too_dense, bound));
      return;
    }
    for (const auto& [name, map] : {std::pair("density", &density),
                                    {"extinction", &extinction},
                                    {"absorption", &absorption},
                                    {"scattering", &scattering}})
      if (*map && (!extinction || (map != &absorption && map != &scattering)) && !(bound_of(**map) < infinity))
        fail(name, fmt::format("how large the values of this {} may become is not known: give the medium a `bound`",
                               (*map)->class_info().name));
    const float most = density_bound_ * (extinction ? bound_of(*extinction) : bound_of(*absorption) + bound_of(*scattering));
    if (most > most_extinction) fail("density", fmt::format(too_dense, most));
  }

  bool homogeneous() const override { return false; }
  bool emits() const override { return emits_ || glows_; }

  VolumeCoefficients coefficients(const Point3& point, float time, const Wavelengths& w) const override {
    SurfacePoint p;
    p.position = p.object_position = placement.animated() ? placement.written(time).back(point) : placement.still().back(point);
    if (limited && !in_box(p.position)) return {};
    p.normal = p.shading_normal = p.object_normal = {0, 0, 1};
    p.time = time;
    const float d = density->scalar(p);
    if (!(d > 0)) return {};
    VolumeCoefficients c;
    if (extinction) {
      const Spectrum whole = max(extinction->color(p, w, ColorUse::coefficient), 0);
      c.scattering = whole * albedo->reflectance(p, w);
      c.absorption = max(whole - c.scattering, 0);
    } else {
      c.absorption = max(absorption->color(p, w, ColorUse::coefficient), 0);
      c.scattering = max(scattering->color(p, w, ColorUse::coefficient), 0);
    }
    c.absorption *= d;
    c.scattering *= d;
    if (bound > 0) thin(c);
    if (emits_) c.emission = d * max(emission->color(p, w, ColorUse::radiance), 0);
    if (glows_) c.emission += c.absorption * max(glow->color(p, w, ColorUse::radiance), 0);
    return c;
  }

  Spectrum majorant(const Wavelengths& w) const override {
    Spectrum most = extinction ? most_of(*extinction, w) : most_of(*absorption, w) + most_of(*scattering, w);
    // 0 times infinity is 0 here: there is no matter.
    most = map(most, [this](float m) { return m > 0 && density_bound_ > 0 ? m * density_bound_ * 1.00001f : 0; });
    if (bound > 0) most = map(most, [this](float m) { return std::min(m, bound * 1.00001f); });
    return most;
  }

  Ref<ObjectMap> density = constant(1), absorption = constant(0), scattering = constant(0), extinction,
                 albedo = constant(0.75f), emission = constant(0), glow = constant(0);
  float bound = 0;
  AnimatedTransform placement;
  bool limited = false;
  Point3 low{0, 0, 0}, high{1, 1, 1};

 private:
  void check(const char* member, const Ref<ObjectMap>& map) const {
    if (!map) fail(member, "a number, a colour or a map is needed");
    const Color all = map->constant();
    if (!all) return;
    if (all->imaginary()) fail(member, "must be real; this is a complex index of refraction");
    const ValueRange range = range_of(*all, ColorUse::coefficient);
    if (!(range.least >= 0 && range.most < infinity)) fail(member, "must be neither negative nor infinite");
    if (map == albedo && range_of(*all, ColorUse::reflectance).most > 1.0001f) fail(member, "lies between 0 and 1");
  }
  static bool black(const ObjectMap& map) {
    const Color all = map.constant();
    return all && !(range_of(*all, ColorUse::radiance).most > 0);
  }
  static Spectrum most_of(const ObjectMap& map, const Wavelengths& w) {
    const Color all = map.constant();
    return all ? all->evaluate(w, ColorUse::coefficient) : Spectrum(bound_of(map));
  }
  bool in_box(const Point3& p) const {
    for (int k = 0; k < 3; ++k)
      if (!((p[k] >= low[k] && p[k] <= high[k]) || (p[k] >= high[k] && p[k] <= low[k]))) return false;
    return true;
  }
  /// Scales the coefficients down to an extinction of `bound` where it would be larger.
  void thin(VolumeCoefficients& c) const {
    const Spectrum left = map(c.extinction(), [this](float s) { return s > bound ? bound / s : 1.0f; });
    c.absorption *= left;
    c.scattering *= left;
  }

  bool emits_ = false, glows_ = false;
  float density_bound_ = 1;
};

const Register<MapVolume> registered;

}  // namespace
}  // namespace etendue
