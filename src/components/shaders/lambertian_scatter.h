#pragma once
// Diffuse reflection, with equal radiance in all directions on the side the light came from.

#include "etendue/core/warp.h"
#include "etendue/scatter_model.h"

namespace etendue {

// f = rho / pi [1/sr], so that the integral of f cos over the hemisphere is rho. Directions are sampled with the pdf cos / pi,
// so f cos / pdf = rho for every sample.
class LambertianScatter final : public ScatterModel<LambertianScatter> {
 public:
  static constexpr bool uses_choice = false;

  LambertianScatter(const SurfacePoint& p, Spectrum reflectance)
      : ScatterModel(p, diffuse_reflection), reflectance_(reflectance) {}

  Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes) const {
    return out.z * in.z > 0 ? reflectance_ * inverse_pi : Spectrum();
  }
  float local_pdf(const Vector3& out, const Vector3& in, Lobes) const {
    return out.z * in.z > 0 ? std::abs(in.z) * inverse_pi : 0;
  }
  ScatterValue local_value_and_pdf(const Vector3& out, const Vector3& in, Lobes) const {
    if (!(out.z * in.z > 0)) return {};
    return {reflectance_ * inverse_pi, std::abs(in.z) * inverse_pi};
  }
  bool local_sample(const Vector3& out, float, Point2 u, Lobes, LocalSample& s) const {
    s.in = warp::cosine_hemisphere(u);
    s.pdf = s.in.z * inverse_pi;
    s.value = reflectance_ * s.pdf;
    s.lobe = diffuse_reflection;
    if (out.z < 0) s.in.z = -s.in.z;
    return s.pdf > 0;
  }
  Spectrum local_albedo(const Vector3&, Lobes lobes) const { return (lobes & diffuse_reflection) ? reflectance_ : Spectrum(); }

 private:
  Spectrum reflectance_;
};

}  // namespace etendue
