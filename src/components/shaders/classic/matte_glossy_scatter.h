#pragma once
// MatteGlossyScatter: base class of models of a glossy lobe over a diffuse base, both in reflection.

#include "components/shaders/half_vector.h"
#include "components/shaders/joint_scatter.h"
#include "etendue/core/warp.h"

namespace etendue {

// Sampling chooses the lobe with a probability proportional to an estimate of its albedo, otherwise the base, whose directions
// have the pdf cos / pi. A model defines, for `out` and `in` on the same side:
//   Spectrum matte(out, in)          f of the base [1/sr]
//   ScatterValue glossy(out, in)     f of the lobe and the pdf with lobes it samples `in` [1/sr]
//   Spectrum matte_albedo(out), glossy_albedo(out)
//   float matte_weight(out), glossy_weight(out)    unnormalized probabilities of choosing each
template <class Model>
class MatteGlossyScatter : public JointScatter<Model> {
 public:
  ScatterValue local_value_and_pdf(const Vector3& out, const Vector3& in, Lobes lobes) const {
    if (!(out.z * in.z > 0)) return {};
    return combine(
        in, glossy_probability(out, lobes), lobes, [&] { return this->model().matte(out, in); },
        [&] { return this->model().glossy(out, in); });
  }
  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    Spectrum sum;
    if (lobes & diffuse_reflection) sum += this->model().matte_albedo(out);
    if (lobes & glossy_reflection) sum += this->model().glossy_albedo(out);
    return sum;
  }

 protected:
  using JointScatter<Model>::JointScatter;

  float glossy_probability(const Vector3& out, Lobes lobes) const {
    if (!(lobes & glossy_reflection)) return 0;
    if (!(lobes & diffuse_reflection)) return 1;
    const float glossy = this->model().glossy_weight(out);
    return glossy / (glossy + this->model().matte_weight(out));
  }
  /// Value and pdf of base and lobe together, where the lobe is chosen with probability `probability`.
  template <class Matte, class Glossy>
  static ScatterValue combine(const Vector3& in, float probability, Lobes lobes, const Matte& matte, const Glossy& glossy) {
    ScatterValue r;
    if (lobes & diffuse_reflection) {
      r.value = matte();
      r.pdf = (1 - probability) * std::abs(in.z) * inverse_pi;
    }
    if (lobes & glossy_reflection) {
      const ScatterValue lobe = glossy();
      r.value += lobe.value;
      r.pdf += probability * lobe.pdf;
    }
    return r;
  }
};

/// A MatteGlossyScatter whose lobe is sampled by the half-vector: the model also defines sample_half(u), a half-vector with z >
/// 0.
template <class Model>
class HalfVectorScatter : public MatteGlossyScatter<Model> {
 public:
  bool local_sample(const Vector3& out, float choice, Point2 u, Lobes lobes, LocalSample& s) const {
    const Model& model = this->model();
    const float probability = this->glossy_probability(out, lobes);
    if (choice < probability) {
      s.in = mirrored_at(model.sample_half(u), above(out));
      s.lobe = glossy_reflection;
    } else {
      s.in = warp::cosine_hemisphere(u);
      s.lobe = diffuse_reflection;
    }
    if (!(s.in.z > 0)) return false;
    if (out.z < 0) s.in.z = -s.in.z;
    return this->complete(
        s, this->combine(
               s.in, probability, lobes, [&] { return model.matte(out, s.in); }, [&] { return model.glossy(out, s.in); }));
  }

 protected:
  using MatteGlossyScatter<Model>::MatteGlossyScatter;
};

}  // namespace etendue
