// DisneyThin: Disney's principled material of 2015 for thin sheets.

#include "components/shaders/fresnel.h"
#include "components/shaders/joint_scatter.h"
#include "components/shaders/microfacet/roughness.h"
#include "components/shaders/reflectance.h"
#include "components/shaders/tangent_frame.h"
#include "disney_lobes.h"
#include "etendue/core/warp.h"

namespace etendue {
namespace {

struct SheetParts {
  Spectrum color, tint = Spectrum(1.0f);
  float roughness, spec_tint, sheen, sheen_tint, flatness, eta, clear,
      through;  ///< clear: fraction that is not diffuse; through: transmitted fraction of the diffuse part
  MicrofacetDistribution front, behind;  ///< for reflection, and for transmission through both faces
};

// The same from both sides. With `in` mirrored at the sheet for transmission, and h, u, D and G1 as in disney_principled.cpp:
//   f = (1 - clear) ((1 - through) (color diffuse / pi + sheen (1 - u)^5 tint) or, transmitted, through color / pi)
//     + clear D(h) G1(out) G1(in) / (4 |out.z in.z|) (F(u) or, transmitted, color (1 - F(u)))
// where the facets of transmission are rougher or smoother, their alpha being multiplied by (0.65 eta - 0.35)^2 (Burley 2015,
// figure 15).
class SheetScatter final : public JointScatter<SheetScatter> {
 public:
  SheetScatter(const SurfacePoint& p, const Frame& frame, const SheetParts& parts)
      : JointScatter(p, frame,
                     Lobes((parts.clear > 0 ? glossy_reflection | glossy_transmission : 0) |
                           (parts.clear < 1 && parts.through < 1 ? diffuse_reflection : 0) |
                           (parts.clear < 1 && parts.through > 0 ? diffuse_transmission : 0))),
        d_(parts) {}

  ScatterValue local_value_and_pdf(const Vector3& out, const Vector3& in, Lobes lobes) const {
    if (out.z == 0 || in.z == 0) return {};
    const bool reflected = out.z * in.z > 0;
    const Vector3 v = above(out), w = above(in);
    const auto [h, u] = half_vector(v, w);
    const Lobe diffuse = reflected ? diffuse_reflection : diffuse_transmission;
    const Lobe glossy = reflected ? glossy_reflection : glossy_transmission;
    const Shares chances = chances_of(v, lobes);
    ScatterValue r;
    if (lobes & diffuse) {
      r.value += reflected ? d_.color * (body() * inverse_pi * disney::diffuse(v.z, w.z, u, d_.roughness, d_.flatness)) +
                                 sheen() * schlick_growth(u)
                           : d_.color * ((1 - d_.clear) * d_.through * inverse_pi);
      r.pdf += (reflected ? chances.diffuse : chances.diffuse_through)[0] * w.z * inverse_pi;
    }
    if (lobes & glossy) {
      const MicrofacetDistribution& d = reflected ? d_.front : d_.behind;
      const float f = fresnel_dielectric(u, d_.eta);
      const Spectrum factor = reflected ? fresnel(f, u) : d_.color * (1 - f);
      r.value += factor * (d_.clear * d.D(h) * d.G2_through(v, w) / (4 * v.z * w.z));
      r.pdf += (reflected ? chances.shine : chances.shine_through)[0] * d.visible_pdf(v, h) * reflection_jacobian(u);
    }
    const Spectrum a = scale_of(shares(v)), b = scale_of(shares(w));
    const detail::Lanes x = a.lanes(), y = b.lanes();
    r.value *= Spectrum(x < y ? x : y);
    return r;
  }

  bool local_sample(const Vector3& out, float choice, Point2 u, Lobes lobes, LocalSample& s) const {
    if (out.z == 0) return false;
    const Vector3 v = above(out);
    const Shares c = chances_of(v, lobes);
    const float ends[] = {c.diffuse[0], c.diffuse_through[0], c.shine[0], c.shine_through[0]};
    constexpr Lobe choices[] = {diffuse_reflection, diffuse_transmission, glossy_reflection, glossy_transmission};
    int k = 0;
    for (float rest = choice - ends[0]; rest >= 0 && k < 3; rest -= ends[k]) ++k;
    while (k > 0 && !(ends[k] > 0)) --k;  // by rounding
    if (!(ends[k] > 0)) return false;
    s.lobe = choices[k];
    if (k < 2) {
      s.in = warp::cosine_hemisphere(u);
    } else {
      s.in = reflect(v, (k == 2 ? d_.front : d_.behind).sample_visible(v, u));
      if (!(s.in.z > 0)) return false;  // blocked by another facet
    }
    if (k % 2) s.in.z = -s.in.z;
    if (out.z < 0) s.in.z = -s.in.z;
    return complete(s, local_value_and_pdf(out, s.in, lobes));
  }

  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    const Shares a = shares(above(out));
    Spectrum sum;
    if (lobes & diffuse_reflection) sum += a.diffuse;
    if (lobes & diffuse_transmission) sum += a.diffuse_through;
    if (lobes & glossy_reflection) sum += a.shine;
    if (lobes & glossy_transmission) sum += a.shine_through;
    return sum * scale_of(a);
  }

 private:
  struct Shares {
    Spectrum diffuse, diffuse_through, shine, shine_through;
  };

  float body() const { return (1 - d_.clear) * (1 - d_.through); }
  Spectrum sheen() const { return disney::mix(d_.sheen_tint, Spectrum(1.0f), d_.tint) * (d_.sheen * body()); }
  Spectrum tinted_f0() const { return d_.tint * square((d_.eta - 1) / (d_.eta + 1)); }
  Spectrum fresnel(float f, float u) const {
    return disney::mix(d_.spec_tint, Spectrum(f), disney::schlick(tinted_f0(), u, d_.eta));
  }

  Shares shares(const Vector3& v) const {
    Shares a;
    const float shine = disney::dielectric_albedo(d_.front, v, d_.eta).greatest;
    Spectrum reflected(shine);
    if (d_.spec_tint > 0) {
      const float whole = disney::whole_albedo(d_.front, v).greatest,
                  grazing = disney::grazing_albedo(d_.front, v, d_.eta).greatest;
      reflected = disney::mix(d_.spec_tint, reflected, tinted_f0() * std::max(whole - grazing, 0.0f) + Spectrum(grazing));
    }
    a.shine = reflected * d_.clear;
    const float behind =
        std::max(disney::whole_albedo(d_.behind, v).greatest - disney::dielectric_albedo(d_.behind, v, d_.eta).least, 0.0f);
    a.shine_through = d_.color * (d_.clear * behind);
    a.diffuse =
        d_.color * (body() * disney::diffuse_albedo(v.z, d_.roughness, d_.flatness)) + sheen() * disney::sheen_albedo(v.z);
    a.diffuse_through = d_.color * ((1 - d_.clear) * d_.through);
    return a;
  }
  static Spectrum scale_of(const Shares& a) {
    return map(a.diffuse + a.diffuse_through + a.shine + a.shine_through, [](float x) { return x > 1 ? 1 / x : 1; });
  }
  /// Probabilities of choosing the lobes, in element 0 of each spectrum.
  Shares chances_of(const Vector3& v, Lobes lobes) const {
    const Shares a = shares(v);
    const auto chance = [&](Lobe lobe, const Spectrum& share) {
      return (lobes & lobe) ? std::max(share.average(), 0.01f) : 0.0f;
    };
    const float p[] = {chance(diffuse_reflection, a.diffuse), chance(diffuse_transmission, a.diffuse_through),
                       chance(glossy_reflection, a.shine), chance(glossy_transmission, a.shine_through)};
    const float sum = p[0] + p[1] + p[2] + p[3];
    if (!(sum > 0)) return {};
    return {Spectrum(p[0] / sum), Spectrum(p[1] / sum), Spectrum(p[2] / sum), Spectrum(p[3] / sum)};
  }

  SheetParts d_;
};

class DisneyThin final : public Shader {
 public:
  static void describe(Description<DisneyThin>& d) {
    d.summary(
         "Disney's principled material for thin sheets (leaves, paper, panes of frosted glass), as Mitsuba's `principledthin` "
         "has "
         "it. Where its parts together would send away more light than arrives they are scaled down.",
         "Burley 2015, Extending the Disney BRDF to a BSDF with integrated subsurface scattering")
        .group("Base")
        .member<&DisneyThin::base_color>("base_color", "1", "the colour", Meaning::reflectance)
        .member<&DisneyThin::roughness>("roughness", "1", "the root of alpha", Meaning::number, soft(0, 1))
        .member<&DisneyThin::anisotropic>("anisotropic", "1", "how much rougher along u than across", Meaning::number,
                                          soft(0, 1))
        .member<&DisneyThin::spec_trans>("spec_trans", "1", "how much of it is clear, and not diffuse", Meaning::number,
                                         soft(0, 1))
        .member<&DisneyThin::diff_trans>("diff_trans", "1",
                                         "how much of what is diffuse goes through: 0 none, 1 half, 2 all of it",
                                         Meaning::number, soft(0, 2))
        .member<&DisneyThin::ior>("ior", "1", "index of refraction", Meaning::number, soft(1, 2.5))
        .member<&DisneyThin::spec_tint>("spec_tint", "1", "how much the shine has the base's colour", Meaning::number,
                                        soft(0, 1))
        .member<&DisneyThin::flatness>("flatness", "1", "how much of the diffuse part looks like subsurface scattering",
                                       Meaning::number, soft(0, 1))
        .group("Sheen")
        .member<&DisneyThin::sheen>("sheen", "1", "as of cloth, at grazing angles", Meaning::number, soft(0, 1))
        .member<&DisneyThin::sheen_tint>("sheen_tint", "1", "how much it has the base's colour", Meaning::number, soft(0, 1),
                                         when("sheen"));
  }

  void prepare() override {
    require_reflectance(*this, "base_color", base_color);
    const std::pair<const char*, const Ref<ObjectMap>&> numbers[] = {{"roughness", roughness},   {"anisotropic", anisotropic},
                                                                     {"spec_trans", spec_trans}, {"spec_tint", spec_tint},
                                                                     {"flatness", flatness},     {"sheen", sheen},
                                                                     {"sheen_tint", sheen_tint}};
    for (const auto& [name, map] : numbers) require_scalar(*this, name, map);
    require_scalar(*this, "diff_trans", diff_trans, 0, 2);
    require_scalar(*this, "ior", ior, 1, 4);
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    SheetParts d;
    d.color = reflectance_at(*base_color, p, w);
    d.roughness = scalar_at(*roughness, p);
    d.spec_tint = scalar_at(*spec_tint, p);
    d.sheen = scalar_at(*sheen, p);
    d.sheen_tint = scalar_at(*sheen_tint, p);
    d.flatness = scalar_at(*flatness, p);
    d.eta = scalar_at(*ior, p, 1, 4);
    d.clear = scalar_at(*spec_trans, p);
    d.through = scalar_at(*diff_trans, p, 0, 2) / 2;
    if (d.spec_tint > 0 || (d.sheen > 0 && d.sheen_tint > 0)) d.tint = disney::tint_of(*base_color, d.color, p);
    const float stretch = scalar_at(*anisotropic, p);
    d.front = disney::facets(d.roughness, stretch);
    d.behind = disney::facets((0.65f * d.eta - 0.35f) * d.roughness, stretch);
    return arena.make<SheetScatter>(p, stretch > 0 ? tangent_frame(p) : Frame(p.shading_normal), d);
  }
  /// The lobes' shares are upper bounds, and the factor that keeps the sum at most 1 is taken for `out` alone.
  float albedo_error() const override { return 0.3f; }
  Lobes possible_lobes() const override {
    return Lobes(diffuse_reflection | (everywhere(diff_trans, 0) ? 0 : diffuse_transmission) |
                 (everywhere(spec_trans, 0) ? 0 : glossy_reflection | glossy_transmission));
  }
  bool transmits() const override { return false; }

  Ref<ObjectMap> base_color = constant(0.5f), roughness = constant(0.5f), anisotropic = constant(0.0f),
                 spec_trans = constant(0.0f), diff_trans = constant(0.0f), ior = constant(1.5f), spec_tint = constant(0.0f),
                 flatness = constant(0.0f), sheen = constant(0.0f), sheen_tint = constant(0.0f);
};

const Register<DisneyThin> registered;

}  // namespace
}  // namespace etendue
