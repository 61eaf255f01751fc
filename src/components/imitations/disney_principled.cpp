// DisneyPrincipled: one shader for most materials, as Disney had it in 2012 and 2015.

#include "components/shaders/fresnel.h"
#include "components/shaders/joint_scatter.h"
#include "components/shaders/layered/principled_scatter.h"
#include "components/shaders/microfacet/roughness.h"
#include "components/shaders/reflectance.h"
#include "components/shaders/tangent_frame.h"
#include "disney_lobes.h"
#include "etendue/core/warp.h"
#include "etendue/transport/medium_stack.h"

namespace etendue {
namespace {

/// The parameters at a point. `body` and `glass` are the weights of the diffuse and of the refracting part.
struct DisneyParts {
  Spectrum color, tint = Spectrum(1.0f);
  float roughness, metallic, spec_tint, sheen, sheen_tint, flatness, clearcoat, coat_alpha, eta, body, glass;
  bool opaque;  ///< no light goes through anywhere on the surface
  MicrofacetDistribution facets;
};

/// What is done about energy that the added lobes would create or lose.
enum class Energy : std::uint8_t { limited, kept };

// The same material as energy-conserving layers (principled_scatter.cpp): light that the specular lobe reflects does not reach
// the body, multiple scattering between facets is added, and light that hits the body from inside the glass is scattered there.
PrincipledLayers layers_of(const DisneyParts& d) {
  constexpr float rough = 1.01f * MicrofacetDistribution::smooth_below, highest_ratio = 4;
  PrincipledLayers l;
  l.facets = d.facets;
  l.facets.alpha_x = std::max(l.facets.alpha_x, rough);
  l.facets.alpha_y = std::max(l.facets.alpha_y, rough);
  l.metal = d.metallic;
  l.clear = d.glass;
  l.opaque = std::max(1 - l.metal - l.clear, 0.0f);
  l.metal_normal = l.diffuse_color = d.color;
  l.specular_color = clamp(disney::mix(d.spec_tint, Spectrum(1.0f), d.tint), 0, 1);
  l.transmission_color = map(d.color, [](float c) { return std::sqrt(c); });
  const float eta = clamp(d.eta, 1 / highest_ratio, highest_ratio);
  l.eta = Spectrum(eta);
  l.reflect_eta = Spectrum(std::max(eta, 1 / eta));
  l.fuzz = d.sheen * (1 - d.metallic);
  l.fuzz_color = clamp(disney::mix(d.sheen_tint, Spectrum(1.0f), d.tint), 0, 1);
  if (d.clearcoat > 0) {
    l.coat = 0.25f * d.clearcoat;  // Burley 2012, section 5.6
    l.coat_facets = {MicrofacetDistribution::ggx, std::max(d.coat_alpha, rough)};
    l.coat_eta = 1.5f;
  }
  return l;
}

// With h the half-vector, u its cosine with either direction and D, G1 those of GGX:
//   f = body color diffuse / pi + sheen (1 - metallic) (1 - u)^5 tint
//     + F(u) D(h) G1(out) G1(in) / (4 |out.z in.z|) + clearcoat / 4 (0.04 + 0.96 (1 - u)^5) D1(h) G1'(out) G1'(in)
// from the front, F being a mixture of a dielectric's, a tinted and a metal's reflectance; from behind only the dielectric's,
// with the factor glass F. Refraction is that of a rough dielectric times glass sqrt(color). D1 is GTR with exponent 1 (Burley
// 2012, eq. 4), and G1' that of GGX with alpha 1/4. As in Mitsuba 3, the clear coat has no 1 / (4 |out.z in.z|).
class DisneyScatter final : public JointScatter<DisneyScatter> {
 public:
  DisneyScatter(const SurfacePoint& p, const Frame& frame, const DisneyParts& parts)
      : JointScatter(p, frame, lobes_of(parts)), d_(parts), root_(map(parts.color, [](float c) { return std::sqrt(c); })) {}

  static Lobes lobes_of(const DisneyParts& parts) {
    return Lobes(glossy_reflection | (parts.body > 0 ? diffuse_reflection : 0) | (parts.glass > 0 ? glossy_transmission : 0));
  }

  ScatterValue local_value_and_pdf(const Vector3& out, const Vector3& in, Lobes lobes) const {
    if (out.z == 0 || in.z == 0) return {};
    if (turned(out)) return local_value_and_pdf(mirrored(out), mirrored(in), lobes);
    const Chances chances = chances_of(out, lobes);
    const bool front = out.z > 0;
    if (!front && !(d_.glass > 0)) return {};
    if (out.z * in.z < 0) return refracted(out, in, lobes, chances);
    ScatterValue r;
    const Vector3 h = reflection_half_vector(out, in);
    const float u = std::abs(dot(out, h));
    if (lobes & glossy_reflection) {
      const float f = fresnel_dielectric(u, towards(out));
      r.value += fresnel(f, u, front) * (d_.facets.D(h) * d_.facets.G2_through(out, in) / (4 * std::abs(out.z * in.z)));
      r.pdf += chances.facets * reflect_chance(f, u, front, lobes) * d_.facets.visible_pdf(out, h) * reflection_jacobian(u);
    }
    if (!front) return r;
    if (lobes & diffuse_reflection) {
      r.value += d_.color * (d_.body * inverse_pi * disney::diffuse(out.z, in.z, u, d_.roughness, d_.flatness)) +
                 sheen() * schlick_growth(u);
      r.pdf += chances.diffuse * in.z * inverse_pi;
    }
    if ((lobes & glossy_reflection) && d_.clearcoat > 0) {
      const MicrofacetDistribution masking(MicrofacetDistribution::ggx, 0.25f);
      r.value += Spectrum(0.25f * d_.clearcoat * disney::schlick(Spectrum(0.04f), u, d_.eta)[0] * coat_D(h) *
                          masking.G2_through(out, in));
      r.pdf += chances.coat * coat_D(h) * h.z * reflection_jacobian(u);
    }
    r.value *= kept(out, in);
    return r;
  }

  bool local_sample(const Vector3& out, float choice, Point2 u, Lobes lobes, LocalSample& s) const {
    if (turned(out)) {
      const bool drawn = local_sample(mirrored(out), choice, u, lobes, s);
      s.in = mirrored(s.in);
      return drawn;
    }
    if (out.z == 0 || (out.z < 0 && !(d_.glass > 0))) return false;
    const Chances chances = chances_of(out, lobes);
    s.lobe = glossy_reflection;
    if (choice < chances.diffuse) {
      s.in = warp::cosine_hemisphere(u);
      s.lobe = diffuse_reflection;
    } else if (choice < chances.diffuse + chances.coat) {
      // cos^2 of h by inversion (Burley 2012, appendix B.2).
      const float a2 = square(d_.coat_alpha), cosine = std::sqrt(clamp((1 - std::pow(a2, 1 - u.y)) / (1 - a2), 0, 1));
      float sine = 0, turn = 0;
      sin_cos_turn(u.x, sine, turn);
      const float r = safe_sqrt(1 - cosine * cosine);
      s.in = reflect(out, {r * turn, r * sine, cosine});
    } else {
      if (!(chances.facets > 0)) return false;
      choice = std::min((choice - chances.diffuse - chances.coat) / chances.facets, one_minus_epsilon);
      const Vector3 m = d_.facets.sample_visible(out, u);
      float behind = 0;
      const float c = std::abs(dot(out, m)), f = fresnel_dielectric(c, towards(out), behind);
      if (choice < reflect_chance(f, c, out.z > 0, lobes)) {
        s.in = reflect(out, m);
      } else {
        if (f >= 1) return false;
        s.in = refract(out, m, towards(out), behind);
        s.lobe = glossy_transmission;
        s.eta = towards(out);
      }
    }
    if ((s.in.z * out.z > 0) == (s.lobe == glossy_transmission)) return false;  // blocked by another facet
    return complete(s, local_value_and_pdf(out, s.in, lobes));
  }

  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    if (turned(out)) return local_albedo(mirrored(out), lobes);
    const Shares a = shares(out, Near::middle);
    Spectrum sum;
    if (lobes & diffuse_reflection) sum += a.diffuse;
    if (lobes & glossy_reflection) sum += a.facets + Spectrum(a.coat);
    if (lobes & glossy_transmission) sum += a.refracted;
    return out.z > 0 ? sum * scale_of(a) : sum;
  }
  Spectrum relative_index(const Vector3& out, const Vector3& in) const { return Spectrum(out.z * in.z > 0 ? 1 : towards(out)); }

 private:
  /// What `shares` returns: upper bounds of the albedos, or the middle between the greatest and the least.
  enum class Near : std::uint8_t { bound, middle };
  struct Shares {
    Spectrum diffuse, facets, refracted;
    float coat = 0;
  };
  struct Chances {
    float diffuse = 0, coat = 0, facets = 0;
  };

  /// An opaque surface looks the same from both sides; the back of glass is the boundary seen from inside.
  bool turned(const Vector3& out) const { return d_.opaque && out.z < 0; }
  static Vector3 mirrored(const Vector3& v) { return {v.x, v.y, -v.z}; }
  float towards(const Vector3& out) const { return out.z > 0 ? d_.eta : 1 / d_.eta; }
  Spectrum sheen() const { return disney::mix(d_.sheen_tint, Spectrum(1.0f), d_.tint) * (d_.sheen * (1 - d_.metallic)); }
  /// The Fresnel factor of a facet of lobes `f` is the dielectric's reflectance.
  Spectrum fresnel(float f, float u, bool front) const {
    if (!front) return Spectrum(d_.glass * f);
    Spectrum sum((1 - d_.metallic) * (1 - d_.spec_tint) * f);
    if (d_.metallic > 0) sum += disney::schlick(d_.color, u, d_.eta) * d_.metallic;
    if (d_.spec_tint > 0) sum += disney::schlick(tinted_f0(), u, d_.eta) * ((1 - d_.metallic) * d_.spec_tint);
    return sum;
  }
  Spectrum tinted_f0() const { return d_.tint * square((d_.eta - 1) / (d_.eta + 1)); }
  float coat_D(const Vector3& h) const {
    const float a2 = square(d_.coat_alpha);
    return (a2 - 1) * inverse_pi / (std::log(a2) * (1 + (a2 - 1) * h.z * h.z));
  }

  Shares shares(const Vector3& out, Near near = Near::bound) const {
    Shares a;
    const bool bound = near == Near::bound;
    const auto of = [bound](const disney::Bounds& b) { return bound ? b.greatest : 0.5f * (b.least + b.greatest); };
    // The fraction that is not lost to masking by other facets.
    const float kept = bound ? 1 : 1 - MultipleReflection(d_.facets).missing(out);
    const disney::Bounds reflected = disney::dielectric_albedo(d_.facets, out, towards(out));
    const float dielectric = of(reflected) * kept;
    a.refracted = root_ * (d_.glass * (1 - (bound ? reflected.least : of(reflected))) * kept);
    if (out.z < 0) {
      a.facets = Spectrum(d_.glass * dielectric);
      return a;
    }
    a.facets = Spectrum((1 - d_.metallic) * (1 - d_.spec_tint) * dielectric);
    if (d_.metallic > 0 || d_.spec_tint > 0) {
      const float whole = of(disney::whole_albedo(d_.facets, out)),
                  grazing = of(disney::grazing_albedo(d_.facets, out, d_.eta));
      const auto shared = [&](Spectrum f0) { return f0 * std::max(whole - grazing, 0.0f) + Spectrum(grazing); };
      a.facets += shared(d_.color) * d_.metallic + shared(tinted_f0()) * ((1 - d_.metallic) * d_.spec_tint);
    }
    if (d_.body > 0)
      a.diffuse = d_.color * (d_.body * disney::diffuse_albedo(out.z, d_.roughness, d_.flatness)) +
                  sheen() * disney::sheen_albedo(out.z);
    // Towards a lower index, slightly steeper facets may be beyond the critical angle.
    const float steeper = safe_sqrt(1 - square(d_.coat_alpha)) * out.z - d_.coat_alpha * safe_sqrt(1 - out.z * out.z);
    const float u = d_.eta < 1 ? std::max(steeper, 0.0f) : out.z;
    a.coat = d_.clearcoat * disney::schlick(Spectrum(0.04f), u, d_.eta)[0] * square(out.z);
    return a;
  }
  static Spectrum scale_of(const Shares& a) {
    return map(a.diffuse + a.facets + a.refracted + Spectrum(a.coat), [](float x) { return x > 1 ? 1 / x : 1; });
  }
  /// The factor min(s(out), s(in)) of disney_lobes.h. From behind there is only the dielectric, and s = 1.
  Spectrum kept(const Vector3& out, const Vector3& in) const {
    const Spectrum a = out.z > 0 ? scale_of(shares(out)) : Spectrum(1.0f), b = in.z > 0 ? scale_of(shares(in)) : Spectrum(1.0f);
    const detail::Lanes x = a.lanes(), y = b.lanes();
    return Spectrum(x < y ? x : y);
  }

  Chances chances_of(const Vector3& out, Lobes lobes) const {
    const Shares a = shares(out);
    Chances c;
    if (out.z > 0 && (lobes & diffuse_reflection)) c.diffuse = a.diffuse.average();
    if (out.z > 0 && (lobes & glossy_reflection) && d_.clearcoat > 0) c.coat = std::max(a.coat, 0.02f * d_.clearcoat);
    c.facets =
        ((lobes & glossy_reflection) ? a.facets.average() : 0) + ((lobes & glossy_transmission) ? a.refracted.average() : 0);
    if (lobes & (glossy_reflection | glossy_transmission)) c.facets = std::max(c.facets, 0.02f);
    const float sum = c.diffuse + c.coat + c.facets;
    if (!(sum > 0)) return {};
    return {c.diffuse / sum, c.coat / sum, c.facets / sum};
  }
  /// The probability that a facet reflects rather than refracts.
  float reflect_chance(float f, float u, bool front, Lobes lobes) const {
    if (!(lobes & glossy_reflection)) return 0;
    if (!(lobes & glossy_transmission) || f >= 1) return 1;
    const float r = fresnel(f, u, front).average(), t = d_.glass * (1 - f) * root_.average();
    return r + t > 0 ? r / (r + t) : 1;
  }

  ScatterValue refracted(const Vector3& out, const Vector3& in, Lobes lobes, const Chances& chances) const {
    if (!(lobes & glossy_transmission)) return {};
    const float eta = towards(out);
    const Vector3 m = refraction_half_vector(out, in, eta);
    const float out_m = dot(out, m), in_m = dot(in, m);
    if (!(out_m * out.z > 0 && in_m * in.z > 0)) return {};
    const float f = fresnel_dielectric(std::abs(out_m), eta), jacobian = refraction_jacobian(out_m, in_m, eta);
    ScatterValue r;
    r.value = root_ * (d_.glass * (1 - f) * d_.facets.D(m) * d_.facets.G2_through(out, in) * std::abs(out_m) * jacobian /
                       std::abs(out.z * in.z));
    r.value *= kept(out, in);
    r.pdf =
        chances.facets * (1 - reflect_chance(f, std::abs(out_m), out.z > 0, lobes)) * d_.facets.visible_pdf(out, m) * jacobian;
    return r;
  }

  DisneyParts d_;
  Spectrum root_;  ///< square root of the colour: light passes two surfaces of a body
};

class DisneyPrincipled final : public Shader {
 public:
  static void describe(Description<DisneyPrincipled>& d) {
    d.summary(
         "The principled material of Disney, as Mitsuba's `principled` has it, to reproduce pictures made with that. "
         "Principled is the newer model.",
         "Burley 2012, Physically based shading at Disney; Burley 2015, Extending the Disney BRDF to a BSDF with integrated "
         "subsurface scattering")
        .group("Base")
        .member<&DisneyPrincipled::base_color>("base_color", "1", "the colour of the body, or of the metal",
                                               Meaning::reflectance)
        .member<&DisneyPrincipled::roughness>("roughness", "1", "the root of alpha", Meaning::number, soft(0, 1))
        .member<&DisneyPrincipled::anisotropic>("anisotropic", "1", "how much rougher along u than across", Meaning::number,
                                                soft(0, 1))
        .member<&DisneyPrincipled::metallic>("metallic", "1", "how much of it is a metal", Meaning::number, soft(0, 1))
        .member<&DisneyPrincipled::spec_trans>("spec_trans", "1", "how much of what is no metal is glass", Meaning::number,
                                               soft(0, 1))
        .member<&DisneyPrincipled::ior>(
            "ior", "1", "index of refraction inside; of a `specular` s of Disney it is 2 / (1 - sqrt(0.08 s)) - 1",
            Range{0.25, 4}, soft(1, 2.5))
        .member<&DisneyPrincipled::spec_tint>("spec_tint", "1", "how much the shine of what is no metal has the base's colour",
                                              Meaning::number, soft(0, 1))
        .member<&DisneyPrincipled::flatness>("flatness", "1", "how much of the diffuse part looks like subsurface scattering",
                                             Meaning::number, soft(0, 1), when("energy", "limited"))
        .member<&DisneyPrincipled::energy>(
            "energy", "",
            "limited: the parts are added as Disney has them, scaled down where together they would send away more light than "
            "arrives, and what they lose is lost; kept: they are layers as those of Principled, of lobes a white one returns "
            "all "
            "light",
            choices("limited", "kept"))
        .group("Upper layers")
        .member<&DisneyPrincipled::sheen>("sheen", "1", "as of cloth, at grazing angles", Meaning::number, soft(0, 1))
        .member<&DisneyPrincipled::sheen_tint>("sheen_tint", "1", "how much it has the base's colour", Meaning::number,
                                               soft(0, 1), when("sheen"))
        .member<&DisneyPrincipled::clearcoat>("clearcoat", "1", "a second shine", Meaning::number, soft(0, 1))
        .member<&DisneyPrincipled::clearcoat_gloss>("clearcoat_gloss", "1", "0: satin, 1: gloss", Meaning::number, soft(0, 1),
                                                    when("clearcoat"));
  }

  void prepare() override {
    require_reflectance(*this, "base_color", base_color);
    const std::pair<const char*, const Ref<ObjectMap>&> numbers[] = {
        {"roughness", roughness}, {"anisotropic", anisotropic},
        {"metallic", metallic},   {"spec_trans", spec_trans},
        {"spec_tint", spec_tint}, {"flatness", flatness},
        {"sheen", sheen},         {"sheen_tint", sheen_tint},
        {"clearcoat", clearcoat}, {"clearcoat_gloss", clearcoat_gloss}};
    for (const auto& [name, map] : numbers) require_scalar(*this, name, map);
    opaque_ = everywhere(spec_trans, 0);
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    DisneyParts d;
    d.color = reflectance_at(*base_color, p, w);
    d.roughness = scalar_at(*roughness, p);
    d.metallic = scalar_at(*metallic, p);
    d.spec_tint = scalar_at(*spec_tint, p);
    d.sheen = scalar_at(*sheen, p);
    d.sheen_tint = scalar_at(*sheen_tint, p);
    d.flatness = scalar_at(*flatness, p);
    d.clearcoat = scalar_at(*clearcoat, p);
    d.coat_alpha = lerp(scalar_at(*clearcoat_gloss, p), 0.1f, 0.001f);
    const float glass = scalar_at(*spec_trans, p);
    d.body = (1 - d.metallic) * (1 - glass);
    d.glass = (1 - d.metallic) * glass;
    d.opaque = opaque_;
    d.eta = ior;
    if (const SceneObject* outside = p.media && p.object ? p.media->outside_of(*p.object) : nullptr)
      d.eta /= MediumStack::index(outside, w).average();
    if (d.glass > 0 && std::abs(d.eta - 1) < 1e-3f) d.eta = 1.001f;  // facets that do not refract light give it no pdf
    if (d.spec_tint > 0 || (d.sheen > 0 && d.sheen_tint > 0)) d.tint = disney::tint_of(*base_color, d.color, p);
    const float stretch = scalar_at(*anisotropic, p);
    d.facets = disney::facets(d.roughness, stretch);
    if (energy == Energy::kept)
      return arena.make<PrincipledScatter>(p, stretch > 0 ? tangent_frame(p) : Frame(p.shading_normal), layers_of(d));
    return arena.make<DisneyScatter>(p, stretch > 0 ? tangent_frame(p) : Frame(p.shading_normal), d);
  }
  /// The lobes' shares are the middle between bounds, and the factor that keeps the sum at most 1 is taken for `out` alone.
  float albedo_error() const override { return 0.3f; }
  Lobes possible_lobes() const override {
    return Lobes(diffuse_reflection | glossy_reflection | (everywhere(spec_trans, 0) ? 0 : glossy_transmission));
  }
  Spectrum interior_index(const Wavelengths&) const override { return Spectrum(everywhere(spec_trans, 0) ? 1 : ior); }

  Ref<ObjectMap> base_color = constant(0.5f), roughness = constant(0.5f), anisotropic = constant(0.0f),
                 metallic = constant(0.0f), spec_trans = constant(0.0f), spec_tint = constant(0.0f), flatness = constant(0.0f),
                 sheen = constant(0.0f), sheen_tint = constant(0.0f), clearcoat = constant(0.0f),
                 clearcoat_gloss = constant(0.0f);
  float ior = 1.5f;
  Energy energy = Energy::limited;

 private:
  bool opaque_ = true;
};

const Register<DisneyPrincipled> registered;

}  // namespace
}  // namespace etendue
