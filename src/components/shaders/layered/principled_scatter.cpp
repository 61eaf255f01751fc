// PrincipledScatter: its lobes, their sum and their sampling.
//
// Layers, from the top (OpenPBR Surface 1.1, "Reduction to a mixture of lobes"), with fractions of the surface F (fuzz), C
// (coat), and of the base M (metal), T (clear), O (opaque), M + T + O = 1; T_x(v) = 1 - E_x(v) is the transmittance of layer x:
//   f = F f_fuzz + t_F [C f_coat + t_C (M f_metal + T f_clear + O (f_gloss + f_matt))].
// OpenPBR leaves open how f is kept reciprocal. Here
//   t_x(out, in) = min(1 - x E_x(out), 1 - x E_x(in))   over facets (see through_upper),
//   f_matt = f_EON t(out) t(in) / mean t,   t = T_gloss (1 - C E_coat) (1 - F E_fuzz),
// with the mean under diffuse light. For a Lambertian body of albedo rho, f_matt has exactly the albedo rho t(out): light that
// the layers above do not reflect reaches the body, and the fraction rho of it leaves (Kelemen & Szirmay-Kalos 2001).
//
// Seen from inside a refracting body, only the clear fraction is a refracting boundary; the others are the same from both
// sides.
//
// Sampling is a mixture of strategies, each with a pdf of its own; a smooth sample's pdf is the sum over all of them.
//   fuzz: uniform; coat: visible normals; base: visible normals, then reflection or refraction by the facet's fractions;
//   matt: cosine, for the diffuse body and for multiple scattering between facets; through: the same in transmission.
// Refraction with dispersion is sampled as in RoughDielectric: any of the path's wavelengths may choose the direction.

#include "principled_scatter.h"

#include "components/shaders/fresnel.h"
#include "components/shaders/part_choice.h"
#include "etendue/core/warp.h"

namespace etendue {

Lobes PrincipledScatter::lobes_of(const PrincipledLayers& l) {
  Lobes r = no_lobes;
  const auto add = [&r](bool there, Lobe lobe) {
    if (there) r = Lobes(r | lobe);
  };
  const bool there = l.opacity > 0, smooth = l.facets.smooth();
  add(there && l.fuzz > 0, glossy_reflection);
  add(there && l.coat > 0, l.coat_facets.smooth() ? specular_reflection : glossy_reflection);
  add(there, smooth ? specular_reflection : glossy_reflection);
  add(there && l.clear > 0, smooth ? specular_transmission : glossy_transmission);
  add(there && l.opaque > 0 && !l.diffuse_color.black(), diffuse_reflection);
  add(there && l.opaque > 0 && !l.diffuse_through_color.black(), diffuse_transmission);
  add(l.opacity < 1, null_scattering);
  return r;
}

PrincipledScatter::Plan PrincipledScatter::plan(const Vector3& out, Lobes lobes) const {
  const PrincipledLayers& l = layers_;
  const float front = fronting(out);
  Plan r;
  if ((lobes & glossy_reflection) && l.fuzz > 0) r.fuzz = front * (1 - fuzz_passed(out)) * l.fuzz_color.average();
  if ((lobes & coat_reflection()) && l.coat > 0) r.coat = front * (1 - coat_passed(out));
  const float upper = upper_passed(out);
  if (lobes & (base_reflection() | base_transmission())) {
    const Facets f = facets_at(std::abs(out.z), inside(out));
    // A fraction that is 0 at this angle may be positive at a facet's angle.
    constexpr float unforeseen = 0.01f;
    const float reflected = f.metal.average() + f.opaque.average() + (l.metal + l.opaque + l.clear) * unforeseen;
    const float through = f.through.average() + l.clear * unforeseen;
    if (lobes & base_reflection()) r.base = upper * reflected + (inside(out) ? 1 : upper) * f.clear.average();
    if ((lobes & base_transmission()) && l.clear > 0) r.base += upper * through;
  }
  if ((lobes & diffuse_reflection) && l.opaque > 0) r.matt = matt_passed(out) * l.opaque * l.diffuse_color.average();
  if ((lobes & diffuse_transmission) && l.opaque > 0)
    r.through = matt_passed(out) * l.opaque * l.diffuse_through_color.average();
  if (multiple_) {
    const float missing = upper * multiple_->missing(out), sheet = l.clear * missing;
    if (lobes & glossy_reflection) r.matt_glossy = l.metal * missing * metal_more_.average() + sheet * sheet_back_.average();
    if (lobes & glossy_transmission) r.through_glossy = sheet * sheet_through_.average();
  }
  if (clear_more_ > 0) {
    const float missing = l.clear * clear_more_ * clear_multiple_->missing(out),
                share = clear_multiple_->transmitted_share(out);
    if (lobes & glossy_reflection) r.matt_glossy += missing * (1 - share);
    if (lobes & glossy_transmission) r.through_glossy += missing * share;
  }
  if (lobes & null_scattering) r.straight = 1 - l.opacity;

  const float there = r.fuzz + r.coat + r.base + r.matt + r.matt_glossy + r.through + r.through_glossy;
  const float sum = there * l.opacity + r.straight;
  if (!(sum > 0)) return {};
  const float norm = l.opacity / sum;
  for (float* x : {&r.fuzz, &r.coat, &r.base, &r.matt, &r.matt_glossy, &r.through, &r.through_glossy}) *x *= norm;
  r.straight /= sum;
  return r;
}

ScatterValue PrincipledScatter::combine(const Vector3& out, const Vector3& in, Lobes lobes, const Plan& plan) const {
  ScatterValue r;
  if (out.z == 0 || in.z == 0) return r;
  if (out.z * in.z > 0)
    reflection(out, in, lobes, plan, r);
  else
    transmission(out, in, lobes, plan, r);
  r.value *= layers_.opacity;
  return r;
}

void PrincipledScatter::reflection(const Vector3& out, const Vector3& in, Lobes lobes, const Plan& plan,
                                   ScatterValue& r) const {
  const PrincipledLayers& l = layers_;
  const float front = fronting(out);
  const Spectrum upper = through_upper(out, in);
  if (lobes & glossy_reflection) {
    const Vector3 m = reflection_half_vector(out, in);
    const float out_m = std::abs(dot(out, m)), jacobian = reflection_jacobian(out_m);
    if (l.fuzz > 0) {
      r.value += l.fuzz_color * (front * l.fuzz * l.fuzz_lobe.value(out, in));
      r.pdf += plan.fuzz * warp::hemisphere_pdf;
    }
    if (l.coat > 0 && !coat_smooth_) {
      const float below_fuzz = std::min(fuzz_passed(out), fuzz_passed(in));
      r.value += Spectrum(front * l.coat * below_fuzz * fresnel_dielectric(out_m, l.coat_eta) * l.coat_facets.D(m) *
                          l.coat_facets.visibility(out, in));
      r.pdf += plan.coat * l.coat_facets.visible_pdf(out, m) * jacobian;
    }
    if (!smooth_) {
      const Facets f = facets_at(out_m, inside(out));
      const Spectrum clear = inside(out) ? f.clear : f.clear * upper;
      r.value += ((f.metal + f.opaque) * upper + clear) * (l.facets.D(m) * l.facets.visibility(out, in));
      r.pdf += plan.base * reflect_probability(f, lobes) * l.facets.visible_pdf(out, m) * jacobian;
      if (multiple_) r.value += (metal_more_ * l.metal + sheet_back_ * l.clear) * upper * multiple_->value(out, in);
      if (clear_more_ > 0)
        r.value += (inside(out) ? Spectrum(1.0f) : l.specular_color * upper) *
                   (l.clear * clear_more_ * clear_multiple_->value(out, in));
    }
  }
  if ((lobes & diffuse_reflection) && l.opaque > 0) {
    const Spectrum coat = coat_absorption(inverse_cosine_in_coat(out) + inverse_cosine_in_coat(in));
    r.value += matt_.value(out, in) * l.matt_darkening * coat * (l.opaque * matt_passed(out) * matt_passed(in) / matt_mean_);
  }
  r.pdf += (plan.matt + plan.matt_glossy) * std::abs(in.z) * inverse_pi;
}

void PrincipledScatter::transmission(const Vector3& out, const Vector3& in, Lobes lobes, const Plan& plan,
                                     ScatterValue& r) const {
  const PrincipledLayers& l = layers_;
  r.pdf = (plan.through + plan.through_glossy) * std::abs(in.z) * inverse_pi;
  if (l.thin_walled) return thin_transmission(out, in, lobes, plan, r);
  if (smooth_ || !(lobes & glossy_transmission)) return;

  const Vector3& outside = out.z > 0 ? out : in;
  const float front = l.facets.G2_through(out, in) / std::abs(out.z * in.z);
  for (int i = 0; i < (disperses_ ? spectrum_size : 1); ++i) {
    const float eta = towards(out, l.eta[i]);
    const Vector3 m = refraction_half_vector(out, in, eta);
    const float out_m = dot(out, m), in_m = dot(in, m);
    if (!(out_m * out.z > 0 && in_m * in.z > 0)) continue;
    const Facets f = facets_at(std::abs(out_m), inside(out));
    const float jacobian = refraction_jacobian(out_m, in_m, eta);
    const Spectrum value = f.through * once_through_upper(outside, std::abs(out.z > 0 ? out_m : in_m)) *
                           (front * l.facets.D(m) * std::abs(out_m) * jacobian);
    if (disperses_)
      r.value.set(i, value[i]);
    else
      r.value = value;
    if (i < choosing_)
      r.pdf += plan.base * (1 - reflect_probability(f, lobes)) * l.facets.visible_pdf(out, m) * jacobian / float(choosing_);
  }
  if (clear_more_ > 0)
    r.value += l.transmission_color * once_through_upper(outside, 1) *
               (l.clear * clear_more_ * clear_multiple_->value(out, in)) *
               (relative_index(out, in) / towards(out, l.eta[0]));  // as in RoughDielectric
}

// A sheet's rough transmission is modelled as its reflection mirrored at the sheet, for lobes facets lose no energy
// (prepare_multiple). Two surfaces with independent facets would spread light by (eta - 1) / sqrt(2) of that.
void PrincipledScatter::thin_transmission(const Vector3& out, const Vector3& in, Lobes lobes, const Plan& plan,
                                          ScatterValue& r) const {
  const PrincipledLayers& l = layers_;
  const Vector3 turned{in.x, in.y, -in.z};
  const Spectrum coat = coat_absorption(inverse_cosine_in_coat(out) + inverse_cosine_in_coat(in));
  if (!smooth_ && l.clear > 0 && (lobes & glossy_transmission)) {
    const Vector3 m = reflection_half_vector(out, turned);
    const float out_m = std::abs(dot(out, m));
    const Facets f = facets_at(out_m, false);
    r.value += (f.through * (l.facets.D(m) * l.facets.visibility(out, turned)) +
                sheet_through_ * (l.clear * multiple_->value(out, turned))) *
               through_upper(out, turned);
    r.pdf += plan.base * (1 - reflect_probability(f, lobes)) * l.facets.visible_pdf(out, m) * reflection_jacobian(out_m);
  }
  if ((lobes & diffuse_transmission) && l.opaque > 0)
    r.value += matt_through_.value(out, turned) * l.matt_darkening * coat *
               (l.opaque * matt_passed(out) * matt_passed(in) / matt_mean_);
}

bool PrincipledScatter::local_sample(const Vector3& out, float choice, Point2 u, Lobes lobes, LocalSample& s) const {
  const PrincipledLayers& l = layers_;
  if (out.z == 0) return false;
  const Plan plan = this->plan(out, lobes);
  // Whether `choice` selects a strategy of this probability; the rest of it is rescaled to [0, 1) for further choices.
  const auto chosen = [&choice](float probability) {
    if (choice < probability) {
      choice = clamp(choice / probability, 0, one_minus_epsilon);
      return true;
    }
    choice -= probability;
    return false;
  };
  if (chosen(plan.straight)) {
    s.in = -out;
    s.value = Spectrum(1 - l.opacity);
    s.pdf = plan.straight;
    s.lobe = null_scattering;
    return true;
  }
  if (chosen(plan.base)) {
    if (!sample_base(out, choice, u, lobes, plan, s)) return false;
    if (smooth_) return s.pdf > 0;
  } else if (chosen(plan.coat)) {
    if (coat_smooth_) {
      s.in = {-out.x, -out.y, out.z};
      s.value = Spectrum(l.opacity * fronting(out) * (1 - coat_passed(out)) * fuzz_passed(out));
      s.pdf = plan.coat;
      s.lobe = specular_reflection;
      return true;
    }
    s.in = reflect(out, l.coat_facets.sample_visible(out, u));
    s.lobe = glossy_reflection;
    if (!(s.in.z * out.z > 0)) return false;
  } else {
    const bool through = chosen(plan.through + plan.through_glossy);
    const bool fuzz = !through && chosen(plan.fuzz);
    s.in = fuzz ? warp::hemisphere(u) : warp::cosine_hemisphere(u);
    if ((out.z < 0) != through) s.in.z = -s.in.z;
    const float glossy = through ? plan.through_glossy : plan.matt_glossy, diffuse = through ? plan.through : plan.matt;
    const bool is_glossy = fuzz || !(diffuse > 0) || choice * (glossy + diffuse) < glossy;
    s.lobe = through ? (is_glossy ? glossy_transmission : diffuse_transmission)
                     : (is_glossy ? glossy_reflection : diffuse_reflection);
    if (through) s.eta = hero_index(out, s.in);
  }
  return complete(s, combine(out, s.in, lobes, plan));
}

/// Samples the base: the whole sample for a smooth base, the direction and lobe for a rough one.
bool PrincipledScatter::sample_base(const Vector3& out, float choice, Point2 u, Lobes lobes, const Plan& plan,
                                    LocalSample& s) const {
  const PrincipledLayers& l = layers_;
  int wavelength = 0;
  if (!smooth_) {
    choice *= float(choosing_);
    wavelength = std::min(int(choice), choosing_ - 1);
    choice -= float(wavelength);
  }
  const Vector3 m = smooth_ ? Vector3{0, 0, 1} : l.facets.sample_visible(out, u);
  const float cosine = std::abs(dot(out, m));
  const Facets f = facets_at(cosine, inside(out));
  const float reflect_p = reflect_probability(f, lobes);
  if (choice < reflect_p) {
    if (!(lobes & base_reflection())) return false;  // only refraction was requested, and there is none
    s.in = reflect(out, m);
    s.lobe = base_reflection();
    if (!smooth_) return s.in.z * out.z > 0;
    const Spectrum upper = through_upper(out, s.in);
    s.value = (f.metal + f.opaque) * upper + (inside(out) ? f.clear : f.clear * upper);
    s.pdf = plan.base * reflect_p;
  } else {
    float cosine_behind = 0;
    if (l.thin_walled) {
      s.in = reflect(out, m);
      if (!(s.in.z * out.z > 0)) return false;
      s.in.z = -s.in.z;
    } else {
      const float eta = towards(out, l.eta[wavelength]);
      if (fresnel_dielectric(cosine, eta, cosine_behind) >= 1) return false;
      s.in = refract(out, m, eta, cosine_behind);
      if (!(s.in.z * out.z < 0)) return false;  // blocked by another facet
    }
    s.lobe = base_transmission();
    s.eta = hero_index(out, s.in);
    if (!smooth_) return true;
    const Vector3& outside = out.z > 0 ? out : s.in;
    s.value = f.through * (l.thin_walled ? through_upper(out, s.in) : once_through_upper(outside, std::abs(outside.z)));
    s.pdf = plan.base * (1 - reflect_p);
    s.dispersive = disperses_ && !l.single;
  }
  s.value *= l.opacity;
  return true;
}

}  // namespace etendue
