#pragma once
// How Scatter's public functions are computed from a model's local functions (scatter_model.h): the corrections for refraction
// and shading normals.
//
// Notation: a path came from the direction `out` and continues in the direction `in`. ng is the geometric normal, ns the
// shading normal, which interpolation or a map has tilted against ng. Public values contain the cosine: light that arrives from
// `in` is multiplied by them, per solid angle.
//
// Refraction (Veach 1997, section 5.2). A refracted beam keeps its power but not its solid angle:
//     n_o^2 cos_o dw_o = n_i^2 cos_i dw_i.
// Therefore radiance L_i that arrives in a medium of index n_i leaves into a medium of index n_o as
//     L_o = (1 - F) (n_o / n_i)^2 L_i                                       (eq. 5.2).
// On a path from the camera, light arrives from `in` and leaves to `out`: n_o is the index on the side of `out`, n_i that on
// the side of `in`, and with eta = n_i / n_o the factor is 1 / eta^2. A path from a light carries power, which does not change
// with the solid angle: f integrates over `in` to 1 - F, and there is no factor. The local functions use this second
// convention. The indices differ between wavelengths, and so does the factor. A specular refraction has the direction of one
// wavelength: where the indices differ only the hero wavelength continues, and only its factor matters.
//
// Shading normals, radiance. The model is defined by ns alone, but the side of the surface that a direction is on must be
// decided by ng, or light would leak through the surface. Where ns and ng disagree most renderers drop the light: a white
// surface darkens towards its silhouette, a glass ball loses 0.3 to 3 %. Here every direction on the wrong side is mirrored to
// the right side, which we call the mirrored shading-normal correction:
//   - seen(out): a viewer on the back of ns but on the front of ng (or the reverse) is replaced by its mirror image in the
//     plane perpendicular to ns;
//   - fold(w): a light direction w of the model on the wrong side of the surface is replaced by its mirror image in the tangent
//     plane of ng.
// Mirroring preserves solid angles and fold maps every w to some direction. So the light scattered towards `out` is
//     R(out, in) = sum over w with fold(w) = in of f(seen(out), w) |w . ns|     [1/sr],
// and the integral of R over `in` equals that of the model over all w, its albedo: a model that loses no energy loses none
// under any shading normal. At most two w are mapped to the same direction: the direction itself, and its image in the surface.
// Both mirrorings are the identity on their planes, so R is continuous there. An object may select to drop the light instead
// (ShadingNormals::clipped).
//
// Shading normals, importance. Multiplying the light from `in` by R corresponds to a surface with the BSDF R / |in . ng|, a
// function of the direction that light comes from. On a path from a light, light comes from `out`, and the true cosine is that
// of `in` with ng:
//     I(out, in) = R(in, out) |in . ng| / |out . ng|                        (Veach 1997, section 5.3, eq. 5.19).
// So the w are images of `out`, and the model is viewed from seen(in).
//
// Trapped light under total internal reflection. At a real boundary light that gets in also gets out. Under shading normals,
// light may enter along directions from which it cannot leave: it would be totally reflected along under the surface for ever
// (a hundredth of the light that enters bumped glass). But a real bumpy surface has as many facets that are tilted the opposite
// way. Therefore a viewer for whom there is total internal reflection at ns sees with opposite_facet_probability the facet with
// the opposite tilt, whose normal is 2 (ng . ns) ng - ns. It has the same model, mirrored across the tilt of ns. Facet in the
// code is the choice between these two.
//
// Models that are not reciprocal. On a path from a light, light comes from `out` and leaves to `in`: f is evaluated for
// (in, out). Directions are still sampled as for (out, in), which is similar, and the weight is computed with the value of f
// for (in, out).

#include "etendue/scatter_model.h"

namespace etendue {

/// Model is a final class with public local functions, which the compiler can inline.
template <class Model>
class ScatterCorrections {
  /// Up to two directions.
  struct Directions {
    Vector3 at[2];
    int count = 0;
    void add(const Vector3& v) { at[count++] = v; }
  };
  /// The facet with normal ns, or the one with the opposite tilt.
  enum class Facet : bool { own, opposite };

  static bool plain(const Model& m) { return m.normals_ == Scatter::Normals::same; }
  static bool folds(const Model& m) { return m.normals_ == Scatter::Normals::folded; }
  static constexpr bool has_total_internal_reflection() {
    return requires(const Model& m, const Vector3& v) { m.total_internal_reflection(v); };
  }
  static bool has_opposite_facet(const Model& m) { return has_total_internal_reflection() && folds(m); }
  /// Whether there is total internal reflection for a viewer in a local direction.
  static bool reflects_totally(const Model& m, const Vector3& o) {
    if constexpr (has_total_internal_reflection())
      return m.total_internal_reflection(o);
    else
      return false;
  }

  /// A direction mirrored in the plane perpendicular to the tilt of ns, t = ns - (ns . ng) ng. This maps the opposite facet to
  /// the one with normal ns.
  static Vector3 mirrored(const Model& m, const Vector3& v, Facet facet) {
    if (facet == Facet::own) return v;
    const Vector3 t = Vector3(m.frame_.n) - dot(m.frame_.n, m.normal_) * Vector3(m.normal_);
    return v - (2 * dot(t, v) / length_squared(t)) * t;
  }

  /// seen(v): the local direction, relative to a facet, from which the model is viewed by a viewer in the world direction `v`.
  /// Returns false if the facet is not visible from `v`.
  static bool seen(const Model& m, const Vector3& v, Vector3& local, Facet facet = Facet::own) {
    local = m.frame_.to_local(mirrored(m, v, facet));
    if (plain(m)) return local.z != 0;
    const float side = dot(m.normal_, v);
    if (side * local.z > 0) return true;
    if (!folds(m)) return false;
    local.z = -local.z;
    return side * local.z > 0;
  }
  /// The inverse of `seen`: the world directions from which the model is viewed from a given local direction of a facet.
  static Directions seers(const Model& m, const Vector3& local, Facet facet = Facet::own) {
    Directions found;
    const Vector3 v = m.frame_.to_world(local);
    const float side = plain(m) ? local.z : dot(m.normal_, v);
    if (!(side * local.z > 0)) return found;  // its image across ns is even farther on the wrong side
    found.add(mirrored(m, v, facet));
    if (folds(m) && (side - 2 * local.z * dot(m.frame_.n, m.normal_)) * local.z > 0)
      found.add(mirrored(m, v - 2 * local.z * Vector3(m.frame_.n), facet));
    return found;
  }

  /// fold(w): the world direction `v` of the light that the model receives from a local direction of a facet. `image`: whether
  /// it was mirrored in the surface. Returns false if light from there is dropped.
  static bool fold(const Model& m, const Vector3& local, Facet facet, Vector3& v, bool& image) {
    v = mirrored(m, m.frame_.to_world(local), facet);
    image = false;
    if (plain(m)) return true;
    const float side = dot(m.normal_, v);
    if (side * local.z > 0) return true;
    image = true;
    v = v - 2 * side * Vector3(m.normal_);
    return folds(m) && side != 0;
  }
  /// The inverse of `fold`: the local directions of a facet that are mapped to the world direction `v`, the unmirrored one
  /// first.
  static Directions unfolded(const Model& m, const Vector3& v, Facet facet = Facet::own) {
    Directions found;
    const Vector3 local = m.frame_.to_local(mirrored(m, v, facet));
    const float side = plain(m) ? local.z : dot(m.normal_, v);
    if (!(side * local.z > 0)) return found;  // its image in the surface is even farther behind ns
    found.add(local);
    if (folds(m) && (local.z - 2 * side * dot(m.frame_.n, m.normal_)) * side > 0)
      found.add(local - 2 * side * m.frame_.to_local(Vector3(m.normal_)));
    return found;
  }

  /// The probability with which a facet is seen from `v`. The opposite one is seen only in models with total internal
  /// reflection.
  static float visibility(const Model& m, const Vector3& v, Facet facet) {
    float opposite = 0;
    Vector3 own;
    if (has_opposite_facet(m) && seen(m, v, own) && reflects_totally(m, own)) opposite = opposite_facet_probability(m);
    return facet == Facet::opposite ? opposite : 1 - opposite;
  }
  /// Twice the sine of the tilt, at most 0.5. This releases light from bumped glass soonest, and is not noticeable where
  /// normals are tilted by a degree or two.
  static float opposite_facet_probability(const Model& m) {
    return std::min(0.5f, 2 * safe_sqrt(1 - square(dot(m.frame_.n, m.normal_))));
  }
  /// The probability with which sample_importance chooses a facet.
  static float facet_probability(const Model& m, Facet facet) {
    const float opposite = has_opposite_facet(m) ? 0.5f * opposite_facet_probability(m) : 0;
    return facet == Facet::opposite ? opposite : 1 - opposite;
  }

  static bool asked(const Vector3& a, const Vector3& b, Lobes lobes) {
    return (lobes & smooth_lobes & (a.z * b.z > 0 ? reflection_lobes : transmission_lobes)) != 0;
  }
  static Spectrum squared(const Spectrum& s) { return s * s; }

  /// f |w . ns| for radiance, of a viewer at `o` and light from `w`: with the factor 1 / eta^2 of refraction.
  static Spectrum refracted(const Model& m, const Spectrum& f, const Vector3& o, const Vector3& w) {
    const Spectrum value = f * std::abs(w.z);
    return o.z * w.z > 0 ? value : value / squared(m.relative_index(o, w));
  }
  /// The same for importance, on a path that came from `w`: without the factor 1 / eta^2 if the model is reciprocal.
  static Spectrum importance(const Model& m, const Vector3& w, const Vector3& o, Lobes lobes) {
    if (m.reciprocal()) return m.local_evaluate(w, o, lobes) * std::abs(w.z);
    return refracted(m, m.local_evaluate(o, w, lobes), o, w);
  }
  /// |in . ng| / |out . ng|.
  static float projected(const Model& m, const Vector3& out, const Vector3& in) {
    return std::abs(dot(m.normal_, in) / dot(m.normal_, out));
  }

  /// Whether null scattering must be sampled separately from other lobes. For importance the viewer is at the direction that
  /// the path continues in, which for null scattering is -out, and for the other lobes is not known before sampling.
  static bool straight_apart(const Model& m, Lobes lobes) {
    return folds(m) && (lobes & null_scattering) && (lobes & ~null_scattering);
  }

 public:
  static Spectrum evaluate(const Model& m, const Vector3& out, const Vector3& in, ScatterContext context) {
    const bool radiance = context.transport == Transport::radiance;
    Vector3 o;
    if (!seen(m, radiance ? out : in, o)) return {};
    const Directions light = unfolded(m, radiance ? in : out);
    Spectrum sum;
    for (int i = 0; i < light.count; ++i) {
      const Vector3& w = light.at[i];
      if (!asked(o, w, context.lobes)) continue;
      sum += radiance ? refracted(m, m.local_evaluate(o, w, context.lobes), o, w) : importance(m, w, o, context.lobes);
    }
    return radiance || light.count == 0 ? sum : sum * projected(m, out, in);
  }

  static float pdf(const Model& m, const Vector3& out, const Vector3& in, ScatterContext context) {
    const bool radiance = context.transport == Transport::radiance;
    Vector3 o;
    if (!seen(m, radiance ? out : in, o)) return 0;
    const Directions light = unfolded(m, radiance ? in : out);
    const bool apart = !radiance && straight_apart(m, context.lobes);
    const Lobes lobes = apart ? Lobes(context.lobes & ~null_scattering) : context.lobes;
    float sum = 0;
    for (int i = 0; i < light.count; ++i)
      if (const Vector3& w = light.at[i]; asked(o, w, lobes))
        sum += radiance ? m.local_pdf(o, w, lobes) : m.local_pdf(w, o, lobes);
    if (radiance || sum == 0) return sum;
    // Along the surface no direction may be left by rounding, and then none is sampled.
    const int to = seers(m, o).count;
    return to == 0 ? 0 : sum * (apart ? 0.5f : 1) / float(light.count * to);
  }

  static ScatterValue value_and_pdf(const Model& m, const Vector3& out, const Vector3& in, ScatterContext context) {
    if (context.transport == Transport::importance) return {evaluate(m, out, in, context), pdf(m, out, in, context)};
    Vector3 o;
    if (!seen(m, out, o)) return {};
    const Directions light = unfolded(m, in);
    ScatterValue sum;
    for (int i = 0; i < light.count; ++i) {
      const Vector3& w = light.at[i];
      if (!asked(o, w, context.lobes)) continue;
      const ScatterValue local = m.local_value_and_pdf(o, w, context.lobes);
      sum.value += refracted(m, local.value, o, w);
      sum.pdf += local.pdf;
    }
    return sum;
  }

  static std::optional<ScatterSample> sample(const Model& m, const Vector3& out, float choice, Point2 u,
                                             ScatterContext context) {
    if (context.transport == Transport::radiance) return sample_radiance(m, out, choice, u, context.lobes);
    if (context.lobes == null_scattering) return sample_straight(m, out, choice, u);
    if (!straight_apart(m, context.lobes)) return sample_importance(m, out, choice, u, context.lobes);
    const bool straight = take_choice(choice, 0.5f);
    std::optional<ScatterSample> s = straight ? sample_straight(m, out, choice, u)
                                              : sample_importance(m, out, choice, u, Lobes(context.lobes & ~null_scattering));
    if (!s) return s;
    s->weight *= 2;
    s->pdf *= 0.5f;
    return s;
  }

  static Spectrum albedo(const Model& m, const Vector3& out, Lobes lobes) {
    Vector3 o;
    seen(m, out, o);
    return m.local_albedo(o, lobes);
  }

 private:
  /// A sample of null scattering, whose direction does not depend on the normals.
  static ScatterSample straight_on(const Vector3& out, const LocalSample& local) {
    return {-out, local.value / local.pdf, local.pdf, null_scattering, 1, false};
  }
  static std::optional<ScatterSample> sample_straight(const Model& m, const Vector3& out, float choice, Point2 u) {
    Vector3 o;
    if (!seen(m, -out, o)) o = m.frame_.to_local(-out);
    LocalSample local;
    if (!m.local_sample(-o, choice, u, null_scattering, local) || !(local.pdf > 0)) return std::nullopt;
    return straight_on(out, local);
  }

  static std::optional<ScatterSample> sample_radiance(const Model& m, const Vector3& out, float choice, Point2 u, Lobes lobes) {
    Vector3 o;
    if (!seen(m, out, o) && (lobes &= null_scattering) == no_lobes) return std::nullopt;
    Facet facet = Facet::own;
    if (has_opposite_facet(m) && reflects_totally(m, o) && take_choice(choice, opposite_facet_probability(m)) &&
        !seen(m, out, o, facet = Facet::opposite))
      return std::nullopt;
    LocalSample local;
    if (!m.local_sample(o, choice, u, lobes, local) || !(local.pdf > 0)) return std::nullopt;
    if (local.lobe == null_scattering) return straight_on(out, local);
    ScatterSample s{{}, local.value / local.pdf, local.pdf, local.lobe, local.eta, local.dispersive};
    bool image;
    if (!fold(m, local.in, facet, s.direction, image)) return std::nullopt;
    if (s.transmitted()) s.weight = s.weight / squared(s.specular() ? Spectrum(local.eta) : m.relative_index(o, local.in));
    if (!folds(m) || s.specular()) return s;
    // The other local direction that is mapped to the same world direction could have been sampled as well.
    const Directions light = unfolded(m, s.direction);
    if (light.count < 2) return s;
    const Vector3& other = light.at[image ? 0 : 1];
    const ScatterValue v = m.local_value_and_pdf(o, other, lobes);
    s.weight = (s.weight * s.pdf + refracted(m, v.value, o, other)) / (s.pdf + v.pdf);
    s.pdf += v.pdf;
    return s;
  }

  // Chooses a facet, then uniformly one of the local directions w that are mapped to `out`, samples a local direction from w,
  // and chooses uniformly one of the world directions from which the model is viewed from there.
  static std::optional<ScatterSample> sample_importance(const Model& m, const Vector3& out, float choice, Point2 u,
                                                        Lobes lobes) {
    Facet facet = Facet::own;
    if (has_opposite_facet(m) && take_choice(choice, facet_probability(m, Facet::opposite))) facet = Facet::opposite;
    const Directions light = unfolded(m, out, facet);
    if (light.count == 0) return std::nullopt;
    const int k = light.count == 2 && take_choice(choice, 0.5f) ? 1 : 0;
    const Vector3 w = light.at[k];
    const bool second_seer = folds(m) && take_choice(choice, 0.5f);
    LocalSample local;
    if (!m.local_sample(w, choice, u, lobes, local) || !(local.pdf > 0)) return std::nullopt;
    if (local.lobe == null_scattering) return straight_on(out, local);
    const Vector3& o = local.in;
    const Directions to = seers(m, o, facet);
    if (to.count == 0) return std::nullopt;
    ScatterSample s{to.at[to.count == 2 && second_seer], {}, local.pdf, local.lobe, local.eta, local.dispersive};
    const bool as_drawn = s.specular() || m.reciprocal();
    Spectrum value = as_drawn ? local.value * std::abs(w.z / o.z) : importance(m, w, o, lobes);
    if (!s.specular() && light.count == 2) {
      const Vector3& other = light.at[1 - k];
      value += importance(m, other, o, lobes);
      s.pdf += m.local_pdf(other, o, lobes);
    }
    s.pdf *= facet_probability(m, facet) / float(light.count * to.count);
    const float visible = visibility(m, s.direction, facet);
    // In this order, as the product of the last two factors over a pdf of 1e-36 would overflow a float.
    s.weight = value / s.pdf * (visible * projected(m, out, s.direction));
    return visible > 0 ? std::optional(s) : std::nullopt;
  }

  /// Whether an event of the given probability happens. Rescales the random number `choice` to [0, 1), so that it can be used
  /// again.
  static bool take_choice(float& choice, float probability) {
    const bool chosen = choice < probability;
    choice = std::min(chosen ? choice / probability : (choice - probability) / (1 - probability), one_minus_epsilon);
    return chosen;
  }
};

}  // namespace etendue
