// DiffractionGrating: a mirror with fine parallel grooves, which reflects each wavelength into its own directions.

#include "components/shaders/reflectance.h"
#include "components/shaders/scalar_map.h"
#include "components/shaders/tangent_frame.h"
#include "etendue/describe/bands.h"
#include "etendue/scatter_model.h"

namespace etendue {
namespace {

// Grooves of spacing d run along x; y lies across them. Diffraction order m of wavelength lambda leaves in the direction whose
// tangential component is
//     in_t = -out_t + m lambda / d y                                    (Born & Wolf 1999, section 8.6.1, eq. 8)
// with all directions pointing away; m = 0 is the mirror direction. Where |in_t| > 1 the order is evanescent: it does not
// exist. The fraction e_m of the light (the efficiency) goes into order m, the same at all angles; that of an evanescent order
// is lost (absorbed, as by the surface waves it becomes). It is not redistributed to the other orders, because that would break
// reciprocity: with fixed e_m the grating is reciprocal. Exchanging `in` and `out` in the equation above gives the same
// equation and the same m. The step from one to the other is a translation in the plane of tangential components, whose area
// element is cos dw, so f(out, in) = e_m delta(in_t + out_t - m lambda / d y) is symmetric.
//
// Sampling: one of the orders that exist for the hero wavelength is drawn, in proportion to e_m. All but order 0 have a
// direction that holds for the hero only and are marked dispersive: the path drops its other wavelengths.
class DiffractionGratingScatter final : public ScatterModel<DiffractionGratingScatter> {
 public:
  /// `steps`: lambda / d of each wavelength; `efficiency`: of the orders 0, ±1, ±2, …
  DiffractionGratingScatter(const SurfacePoint& p, const Frame& frame, Spectrum reflectance, Spectrum steps,
                            const std::vector<float>& efficiency, bool single)
      : ScatterModel(p, frame, specular_reflection),
        reflectance_(reflectance),
        steps_(steps),
        efficiency_(efficiency.data()),
        last_(int(efficiency.size()) - 1),
        single_(single) {}

  Spectrum local_evaluate(const Vector3&, const Vector3&, Lobes) const { return {}; }
  float local_pdf(const Vector3&, const Vector3&, Lobes) const { return 0; }

  bool local_sample(const Vector3& out, float choice, Point2, Lobes, LocalSample& s) const {
    const float total = propagating(out, steps_[0]);
    if (!(total > 0)) return false;
    float before = 0;
    for (int m = -last_; m <= last_; ++m) {
      const float e = efficiency_[std::abs(m)];
      Vector3 in;
      if (!(e > 0) || !leaves(out, m, steps_[0], in)) continue;
      s.in = in;
      s.value = reflectance_ * e;
      s.pdf = e / total;
      s.lobe = specular_reflection;
      s.dispersive = m != 0 && !single_;
      before += e;
      if (choice * total < before) return true;
    }
    return true;  // reached by rounding only: the last order
  }

  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    if (!(lobes & specular_reflection)) return {};
    return reflectance_ * map(steps_, [&](float step) { return propagating(out, step); });
  }

 private:
  bool leaves(const Vector3& out, int m, float step, Vector3& in) const {
    in = {-out.x, -out.y + float(m) * step, out.z};
    if (m == 0) return true;
    const float z2 = 1 - in.x * in.x - in.y * in.y;
    if (!(z2 > 1e-10f)) return false;
    in.z = std::copysign(std::sqrt(z2), out.z);
    return true;
  }

  /// The sum of the efficiencies of all orders that are not evanescent.
  float propagating(const Vector3& out, float step) const {
    float sum = 0;
    Vector3 unused;
    for (int m = -last_; m <= last_; ++m)
      if (leaves(out, m, step, unused)) sum += efficiency_[std::abs(m)];
    return sum;
  }

  Spectrum reflectance_, steps_;
  const float* efficiency_;
  int last_;
  bool single_;
};

class DiffractionGrating final : public Shader, public NeedsWavelengths {
 public:
  static void describe(Description<DiffractionGrating>& d) {
    d.summary(
         "A mirror with fine parallel grooves, as on a compact disc: spectra on both sides of the mirror image. The part of "
         "orders that do not exist at an angle is absorbed.",
         "Born & Wolf 1999, Principles of Optics, section 8.6.1; Stam 1999, Diffraction shaders")
        .member<&DiffractionGrating::lines>("lines", "1", "grooves per millimetre", more_than(0), soft(10, 2000), logarithmic)
        .member<&DiffractionGrating::efficiency>("efficiency", "1",
                                                 "fractions of the light that go into order 0 (the mirror image), into each of "
                                                 "+1 and -1, each of +2 and -2, and so on",
                                                 range(0, 1))
        .member<&DiffractionGrating::rotation>(
            "rotation", "turn", "turns the grooves from the direction of u, counter-clockwise seen from the front",
            Meaning::number, soft(0, 1))
        .member<&DiffractionGrating::color>("color", "1", "fraction of light reflected into all orders, per wavelength",
                                            Meaning::reflectance);
  }

  void prepare() override {
    require_reflectance(*this, "color", color);
    if (!rotation) fail("rotation", "a map or a number is needed");
    if (!(lines > 0 && lines < 1e6f)) fail("lines", "must be more than 0 and below a million");
    if (efficiency.empty() || efficiency.size() > 64) fail("efficiency", "between 1 and 64 numbers are needed");
    double sum = 0;
    for (size_t i = 0; i < efficiency.size(); ++i) {
      if (!(efficiency[i] >= 0 && efficiency[i] <= 1)) fail("efficiency", "each must be from 0 to 1");
      sum += (i == 0 ? 1 : 2) * double(efficiency[i]);
    }
    if (sum > 1 + 1e-5)
      fail("efficiency", "all orders together would reflect " + fmt::format("{:.4g}", sum) +
                             " of the light (that of order 0, and twice that of each other)");
  }

  void refuse_bands() const override { fail("lines", "a grating diffracts each wavelength into directions of its own"); }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    const Spectrum reflectance = reflectance_at(*color, p, w);
    if (reflectance.black()) return nullptr;
    Spectrum steps;
    for (int i = 0; i < spectrum_size; ++i) steps.set(i, w[i] * 1e-6f * lines);
    return arena.make<DiffractionGratingScatter>(p, tangent_frame(p, rotation->scalar(p)), reflectance, steps, efficiency,
                                                 w.single());
  }
  Lobes possible_lobes() const override { return specular_reflection; }

  float lines = 625;
  std::vector<float> efficiency{0.3f, 0.25f, 0.1f};
  Ref<ObjectMap> rotation = constant(0.0f), color = constant(1.0f);
};

const Register<DiffractionGrating> registered;

}  // namespace
}  // namespace etendue
