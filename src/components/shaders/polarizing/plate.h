#pragma once
// Plate: the scattering of a thin plate that light passes straight on, and that treats two polarizations differently: that
// along an axis of the plate and that across it.
//
// Light along the axis keeps the fraction a of its power, light across it b, and the phase of the first leads that of the
// second by phi. So with the axis as the reference direction the Mueller matrix is (Goldstein 2003, Polarized light, chapter 5)
//     1/2 ( a + b   a - b     0             0
//           a - b   a + b     0             0
//             0       0    2 g cos phi   2 g sin phi
//             0       0   -2 g sin phi   2 g cos phi ),       g = sqrt(a b).
// Unpolarized light keeps (a + b) / 2.
//
// At a slant. The component of the field that the plate takes for "across" lies in the plane of the ray and of the direction
// across the axis, as a sheet polarizer's molecules absorb along themselves: the axis is replaced by the normal of that plane
// (Korger et al. 2013, The polarization properties of a tilted polarizer). Fractions and phase stay those along the normal.

#include "components/shaders/tangent_frame.h"
#include "etendue/polarizing_scatter.h"
#include "etendue/scatter_model.h"

namespace etendue {

class Plate final : public ScatterModel<Plate>, public PolarizingScatter {
 public:
  static constexpr bool uses_choice = false;

  struct Matter {
    Spectrum along{1.0f}, across{1.0f};  ///< a, b
    Spectrum phase{};                    ///< phi [rad]
  };
  /// `angle` [rad]: of the axis from the surface's u direction, counter-clockwise seen from the front.
  Plate(const SurfacePoint& p, float angle, const Matter& matter)
      : ScatterModel(p, Frame(p.normal), null_scattering), matter_(matter) {
    const Frame frame = tangent_frame(p);
    across_ = std::cos(angle) * frame.t - std::sin(angle) * frame.s;
  }

  Spectrum local_evaluate(const Vector3&, const Vector3&, Lobes) const { return {}; }
  float local_pdf(const Vector3&, const Vector3&, Lobes) const { return 0; }
  bool local_sample(const Vector3& out, float, Point2, Lobes, LocalSample& s) const {
    s.in = -out;
    s.value = through();
    s.pdf = 1;
    s.lobe = null_scattering;
    s.eta = 1;
    return true;
  }
  Spectrum local_albedo(const Vector3&, Lobes lobes) const { return (lobes & null_scattering) ? through() : Spectrum(); }

  bool polarization(const Vector3& out, const Vector3&, Lobes, Polarization& event) const override {
    event.x_in = event.x_out = common_perpendicular(out, across_);
    Mueller& m = event.mueller = Mueller();
    const Spectrum scale = map(through(), [](float all) { return all > 0 ? 1 / all : 0; }),
                   both = sqrt(matter_.along * matter_.across) * scale;
    m(0, 0) = m(1, 1) = Spectrum(1.0f);
    m(0, 1) = m(1, 0) = 0.5f * (matter_.along - matter_.across) * scale;
    m(2, 2) = m(3, 3) = both * map(matter_.phase, [](float x) { return std::cos(x); });
    m(2, 3) = both * map(matter_.phase, [](float x) { return std::sin(x); });
    m(3, 2) = -m(2, 3);
    return true;
  }

 private:
  Spectrum through() const { return 0.5f * (matter_.along + matter_.across); }

  Matter matter_;
  Vector3 across_;
};

}  // namespace etendue
