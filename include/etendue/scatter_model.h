#pragma once
// ScatterModel: the base of a BSDF model, which is written in local directions: z is along the shading normal on the front side
// of the surface. A model is a final class with public functions, all const:
//
//   Spectrum local_evaluate(out, in, lobes)    f [1/sr] without the cosine, as for importance: without the factor 1 / eta^2 of
//                                              refracted radiance
//   float local_pdf(out, in, lobes)            the pdf [1/sr] with which local_sample samples `in`, without specular lobes
//   bool local_sample(out, choice, u, lobes, LocalSample&)    false: the sample is absorbed
//   Spectrum local_albedo(out, lobes)          as Scatter::albedo
//
// `out` is the direction the path came from, `in` the one it continues in, and `lobes` holds all requested lobes that are
// present: those of reflection and transmission, specular ones too, so that the probabilities of choosing between lobes are the
// same in all functions. Whether a pair of directions is reflection or transmission follows from the signs of z, which agree
// with the geometric sides. The four functions must agree: local_sample samples with exactly the pdf that local_pdf returns,
// and the pdf of a smooth lobe includes every requested lobe that could have generated the direction. The functions with
// defaults are documented below. There is one function without a default: a specular boundary without smooth lobes may have
// `bool total_internal_reflection(out)`, which returns whether there is total internal reflection for a viewer in that
// direction.
//
// A white diffuse surface, for example:
//
//   class White final : public ScatterModel<White> {
//    public:
//     explicit White(const SurfacePoint& p) : ScatterModel(p, diffuse_reflection) {}
//     Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes) const { return out.z * in.z > 0 ? inverse_pi : 0; }
//     float local_pdf(const Vector3& out, const Vector3& in, Lobes) const {
//       return out.z * in.z > 0 ? std::abs(in.z) * inverse_pi : 0;
//     }
//     bool local_sample(const Vector3& out, float, Point2 u, Lobes lobes, LocalSample& s) const {
//       s.in = warp::cosine_hemisphere(u);
//       if (out.z < 0) s.in.z = -s.in.z;
//       s.value = s.pdf = local_pdf(out, s.in, lobes);
//       s.lobe = diffuse_reflection;
//       return s.pdf > 0;
//     }
//     Spectrum local_albedo(const Vector3&, Lobes) const { return Spectrum(1.0f); }
//   };
//
// scatter_corrections.h computes the public functions of Scatter from these.

#include "etendue/shader.h"

namespace etendue {

template <class Model>
class ScatterCorrections;

/// A sample in local directions.
struct LocalSample {
  Vector3 in;
  Spectrum value;  ///< f |cos| for smooth lobes, summed over all requested ones; for a specular lobe its reflectance or
                   ///< transmittance
  float pdf = 0;   ///< [1/sr] for smooth lobes, of all requested ones together; for a specular lobe its discrete probability
  Lobe lobe = diffuse_reflection;
  float eta = 1;  ///< at the hero wavelength, as in ScatterSample
  bool dispersive = false;
};

/// The curiously recurring template pattern: each public function of Scatter is a single virtual call, into which the compiler
/// inlines the local functions. A model replaces a default below by declaring the same name.
template <class Model>
class ScatterModel : public Scatter {
 public:
  /// Both of local_evaluate and local_pdf; declared by a model that computes them together faster.
  ScatterValue local_value_and_pdf(const Vector3& out, const Vector3& in, Lobes lobes) const {
    return {model().local_evaluate(out, in, lobes), model().local_pdf(out, in, lobes)};
  }
  /// For smooth transmission lobes: the index on the side of `in` over that on the side of `out`, per wavelength; 1 without
  /// refraction.
  Spectrum relative_index(const Vector3& /*out*/, const Vector3& /*in*/) const { return Spectrum(1.0f); }
  /// False for a model whose f changes when `out` and `in` are exchanged. Then the argument `out` of local_evaluate is the
  /// direction that light leaves in, for importance too; local_sample and local_pdf still get the direction the path came from.
  /// A model for which it depends on a parameter declares a function that is not static.
  static constexpr bool reciprocal() { return true; }
  /// False for a model whose local_sample never uses `choice`, which saves a random number. A model for which it depends on a
  /// parameter sets has_choice_ in its constructor.
  static constexpr bool uses_choice = true;

 protected:
  ScatterModel(const SurfacePoint& p, Lobes lobes) : Scatter(p, lobes) { has_choice_ = Model::uses_choice; }
  ScatterModel(const SurfacePoint& p, const Frame& frame, Lobes lobes) : Scatter(p, frame, lobes) {
    has_choice_ = Model::uses_choice;
  }
  ~ScatterModel() = default;

  const Model& model() const { return static_cast<const Model&>(*this); }

 private:
  using Corrections = ScatterCorrections<Model>;

  Spectrum world_evaluate(const Vector3& out, const Vector3& in, ScatterContext context) const final {
    return Corrections::evaluate(model(), out, in, context);
  }
  float world_pdf(const Vector3& out, const Vector3& in, ScatterContext context) const final {
    return Corrections::pdf(model(), out, in, context);
  }
  ScatterValue world_value_and_pdf(const Vector3& out, const Vector3& in, ScatterContext context) const final {
    return Corrections::value_and_pdf(model(), out, in, context);
  }
  std::optional<ScatterSample> world_sample(const Vector3& out, float choice, Point2 u, ScatterContext context) const final {
    return Corrections::sample(model(), out, choice, u, context);
  }
  Spectrum world_albedo(const Vector3& out, Lobes lobes) const final { return Corrections::albedo(model(), out, lobes); }
};

}  // namespace etendue

#include "etendue/scatter_corrections.h"
