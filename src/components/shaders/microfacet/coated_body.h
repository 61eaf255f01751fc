#pragma once
// CoatedBodyScatter: base class of models of a diffuse body under a dielectric coat, polished or rough, as Plastic.

#include "components/shaders/fresnel.h"
#include "components/shaders/joint_scatter.h"
#include "etendue/core/warp.h"
#include "microfacet.h"

namespace etendue {

// Sampling chooses the coat with a probability P that the model defines, and there a visible normal of its facets (or the
// mirror direction of a polished coat); otherwise the body, whose directions have the pdf cos / pi. A model defines, with T the
// coat's transmittance:
//   const MicrofacetDistribution& facets()
//   float eta()                               index of the coat over that in front
//   float through(v)                          T(v)
//   Spectrum body()                           f of the body times pi / (T(out) T(in))
//   Spectrum coat(out, in, fresnel, density)  f of a rough coat [1/sr]; fresnel and density: F and D of the facet
//   Spectrum mirrored(out, through)           the fraction of light that a polished coat reflects
//   float coat_share(out, through)            P where both coat and body are sampled
template <class Model>
class CoatedBodyScatter : public JointScatter<Model> {
 public:
  ScatterValue local_value_and_pdf(const Vector3& out, const Vector3& in, Lobes lobes) const {
    if (!(out.z * in.z > 0)) return {};
    const float through = model().through(out), coat_probability = probability_of_coat(out, through, lobes);
    ScatterValue r;
    if (lobes & diffuse_reflection) {
      r.value = model().body() * (through * model().through(in) * inverse_pi);
      r.pdf = (1 - coat_probability) * std::abs(in.z) * inverse_pi;
    }
    if (lobes & glossy_reflection) {
      const MicrofacetDistribution& facets = model().facets();
      const Vector3 m = reflection_half_vector(out, in);
      const float cosine = std::abs(dot(out, m));
      r.value += model().coat(out, in, fresnel_dielectric(cosine, model().eta()), facets.D(m));
      r.pdf += coat_probability * facets.visible_pdf(out, m) * reflection_jacobian(cosine);
    }
    return r;
  }

  bool local_sample(const Vector3& out, float choice, Point2 u, Lobes lobes, LocalSample& s) const {
    const float through = model().through(out), coat_probability = probability_of_coat(out, through, lobes);
    if (choice < coat_probability) {
      if (lobes & specular_reflection) {
        s.in = {-out.x, -out.y, out.z};
        s.value = model().mirrored(out, through);
        s.pdf = coat_probability;
        s.lobe = specular_reflection;
        return true;
      }
      s.in = reflect(out, model().facets().sample_visible(out, u));
      s.lobe = glossy_reflection;
    } else {
      s.in = warp::cosine_hemisphere(u);
      if (out.z < 0) s.in.z = -s.in.z;
      s.lobe = diffuse_reflection;
    }
    return this->complete(s, local_value_and_pdf(out, s.in, lobes));
  }

 protected:
  using JointScatter<Model>::JointScatter;

 private:
  using JointScatter<Model>::model;

  float probability_of_coat(const Vector3& out, float through, Lobes lobes) const {
    if (!(lobes & diffuse_reflection)) return 1;
    if (!(lobes & (glossy_reflection | specular_reflection))) return 0;
    return model().coat_share(out, through);
  }
};

}  // namespace etendue
