// PassThrough: an index-matched boundary, which light passes by null scattering.

#include "etendue/scatter_model.h"

namespace etendue {
namespace {

class PassThroughScatter final : public ScatterModel<PassThroughScatter> {
 public:
  static constexpr bool uses_choice = false;

  // With the frame of the geometric normal: null scattering does not depend on shading normals, and no light may be lost where
  // these disagree with the surface.
  explicit PassThroughScatter(const SurfacePoint& p) : ScatterModel(p, Frame(p.normal), null_scattering) {}

  Spectrum local_evaluate(const Vector3&, const Vector3&, Lobes) const { return {}; }
  float local_pdf(const Vector3&, const Vector3&, Lobes) const { return 0; }
  bool local_sample(const Vector3& out, float, Point2, Lobes, LocalSample& s) const {
    s.in = -out;
    s.value = Spectrum(1.0f);
    s.pdf = 1;
    s.lobe = null_scattering;
    s.eta = 1;
    return true;
  }
  Spectrum local_albedo(const Vector3&, Lobes lobes) const { return (lobes & null_scattering) ? Spectrum(1.0f) : Spectrum(); }
};

class PassThrough final : public Shader {
 public:
  static void describe(Description<PassThrough>& d) {
    d.summary(
        "Everything goes straight on, undiminished: the boundary of a medium that neither reflects nor refracts, such as "
        "that of a cloud. What lies inside has the index of what is around.");
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths&, Arena& arena) const override {
    return arena.make<PassThroughScatter>(p);
  }
  Lobes possible_lobes() const override { return null_scattering; }
};

const Register<PassThrough> registered;

}  // namespace
}  // namespace etendue
