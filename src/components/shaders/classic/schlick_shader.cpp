// SchlickShader: one or two layers, each from specular through glossy to diffuse by its roughness.

#include "components/shaders/joint_scatter.h"
#include "components/shaders/reflectance.h"
#include "components/shaders/scalar_map.h"
#include "components/shaders/tangent_frame.h"
#include "etendue/core/warp.h"
#include "schlick_lobe.h"

namespace etendue {
namespace {

// Schlick 1994, An inexpensive BRDF model for physically-based rendering. A layer of roughness r reflects
//   R = S(u) (d / pi + g D + s delta / v'),   S(u) = C + (1 - C)(1 - u)^5,
// where the fraction g = 4 r (1 - r) goes to the glossy lobe D of schlick_lobe.h and the rest to the delta lobe of a mirror (s
// = 1 - g, for r < 1/2) or to a diffuse lobe (d = 1 - g, otherwise). Since S <= 1, d + g + s = 1 and no lobe has an albedo
// above 1, no layer has; all lobes are reciprocal.
//
// Two changes to the paper keep the albedo at most 1. First, the paper adds to G G' Z A the light that G and G' mask, (1 - G
// G') / (4 pi v v'): the albedo of this term grows without bound towards grazing angles (as 1 / (2 v)), so masked light is
// absorbed here. Second, the paper gives the lower layer the factor 1 - S(u), as [1 - S(u)] S'(u) D': over a specular first
// layer, light at grazing angles would be reflected entirely by the first layer and almost entirely by a diffuse second one.
// Here the second layer is seen through
//   T(v) = (1 - C) (1 - (1 - m(v))^5),   m(v) = (sqrt(1 + v) - sqrt(1 - v)) / 2,
// where m(v) is the least u that any direction has with `out`, so that S(u) <= 1 - T(v). The first layer's albedo is then at
// most 1 - T(v), and that of the second, with the factor min(T(v), T(v')), at most T(v). The factor never exceeds the paper's.
struct Layer {
  Layer() = default;
  Layer(Spectrum color, float roughness, float isotropy) : c(color) {
    const float r = roughness < 1e-4f ? 0 : roughness;
    g = 4 * r * (1 - r);
    (r < 0.5f ? s : d) = 1 - g;
    if (g > 0) lobe = SchlickLobe(r, isotropy);
    shape = {std::sqrt(std::sqrt(r)), std::cbrt(isotropy)};
  }
  Spectrum fresnel(float growth) const { return c + (Spectrum(1.0f) - c) * growth; }

  Spectrum c;
  float d = 0, g = 0, s = 0;
  Point2 shape;
  SchlickLobe lobe;
};

/// Means of the glossy sampling weight, and of that weight times (1 - u)^5, for `out` in the azimuth of x and then of y;
/// tabulated by the fourth root of r and the third root of p.
using Table = AlbedoTable<4>;
const Table& albedo_table() {
  const auto lobe = [](float roughness, float isotropy) {
    return SchlickLobe(std::max(square(square(roughness)), 1e-4f), std::max(isotropy * isotropy * isotropy, 1e-3f));
  };
  static const Table table([lobe](float roughness, float isotropy, Point2 u) { return lobe(roughness, isotropy).sample(u); },
                           [lobe](float roughness, float isotropy, const Vector3& h, float cosine) {
                             const SchlickLobe shape = lobe(roughness, isotropy);
                             const Vector3 out = towards_x(cosine);
                             Table::Value mean{};
                             for (const size_t k : {size_t(0), size_t(2)}) {
                               const float towards_h = out.x * (k == 0 ? h.x : h.y) + out.z * h.z,
                                           v = 2 * towards_h * h.z - cosine;
                               if (v <= 0) continue;
                               mean[k] = shape.weight(cosine, v, towards_h, h.z);
                               mean[k + 1] = mean[k] * schlick_growth(towards_h);
                             }
                             return mean;
                           });
  return table;
}

class SchlickScatter final : public JointScatter<SchlickScatter> {
 public:
  /// With one layer, `base` has no lobes.
  SchlickScatter(const SurfacePoint& p, const Frame& frame, const Layer& top, const Layer& base, const Table& table)
      : JointScatter(p, frame, lobes_of(top) | lobes_of(base)), top_(top), base_(base), table_(&table) {}

  static Lobes lobes_of(const Layer& l) {
    return Lobes((l.d > 0 ? diffuse_reflection : 0) | (l.g > 0 ? glossy_reflection : 0) | (l.s > 0 ? specular_reflection : 0));
  }

  ScatterValue local_value_and_pdf(const Vector3& out, const Vector3& in, Lobes lobes) const {
    return out.z * in.z > 0 ? value_and_pdf_of(out, in, shares(out, lobes), lobes) : ScatterValue();
  }
  bool local_sample(const Vector3& out, float choice, Point2 u, Lobes lobes, LocalSample& s) const {
    const Shares share = shares(out, lobes);
    if (choice < share.specular) {
      s.in = {-out.x, -out.y, out.z};
      s.value = mirrored(std::abs(out.z));
      s.pdf = share.specular;
      s.lobe = specular_reflection;
      return true;
    }
    choice -= share.specular;
    if (choice < share.glossy[0] + share.glossy[1]) {
      const Layer& layer = choice < share.glossy[0] ? top_ : base_;
      s.in = mirrored_at(layer.lobe.sample(u), above(out));
      s.lobe = glossy_reflection;
    } else {
      s.in = warp::cosine_hemisphere(u);
      s.lobe = diffuse_reflection;
    }
    if (!(s.in.z > 0)) return false;
    if (out.z < 0) s.in.z = -s.in.z;
    return complete(s, value_and_pdf_of(out, s.in, share, lobes));
  }
  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    Spectrum sum;
    const float v = std::abs(out.z);
    if (lobes & diffuse_reflection) sum += diffuse_albedo(v);
    if (lobes & glossy_reflection) sum += glossy_albedo(top_, out) + through(v) * glossy_albedo(base_, out);
    if (lobes & specular_reflection) sum += mirrored(v);
    return sum;
  }

 private:
  struct Shares {
    float specular, glossy[2], diffuse;
  };
  Shares shares(const Vector3& out, Lobes lobes) const {
    Shares r{};
    const float v = std::abs(out.z);
    if (lobes & specular_reflection) r.specular = mirrored(v).average();
    if (lobes & glossy_reflection) {
      r.glossy[0] = std::max(glossy_albedo(top_, out).average(), 1e-4f * top_.g);
      // The floor keeps the probability from vanishing at grazing angles, where the transmittance is small.
      if (base_.g > 0) r.glossy[1] = (max(through(v), 0.05f) * glossy_albedo(base_, out)).average();
    }
    if (lobes & diffuse_reflection) r.diffuse = std::max(diffuse_albedo(v).average(), 1e-4f);
    const float scale = 1 / std::max(r.specular + r.glossy[0] + r.glossy[1] + r.diffuse, 1e-30f);
    return {r.specular * scale, {r.glossy[0] * scale, r.glossy[1] * scale}, r.diffuse * scale};
  }

  /// T(v).
  Spectrum through(float v) const {
    const float least = 0.5f * (std::sqrt(1 + v) - safe_sqrt(1 - v));
    return (Spectrum(1.0f) - top_.c) * (1 - schlick_growth(least));
  }
  Spectrum mirrored(float v) const {
    const float growth = schlick_growth(v);
    return top_.fresnel(growth) * top_.s + through(v) * base_.fresnel(growth) * base_.s;
  }
  Spectrum glossy_albedo(const Layer& layer, const Vector3& out) const {
    if (layer.g == 0) return {};
    const Table::Value mean = (*table_)(out.z, layer.shape.x, layer.shape.y);
    const float s2 = out.x * out.x + out.y * out.y, x2 = s2 > 0 ? out.x * out.x / s2 : 0.5f;
    const float level = lerp(x2, mean[2], mean[0]), growth = lerp(x2, mean[3], mean[1]);
    return (layer.c * level + (Spectrum(1.0f) - layer.c) * growth) * layer.g;
  }
  /// Under diffuse illumination the means of (1 - u)^5, and of min(T(v), T(v')) over 1 - C, are fits to their integrals, within
  /// 1e-4 and 0.015.
  Spectrum diffuse_albedo(float v) const {
    const float x = 1 - v, growth = x * (0.0044f + x * (-0.0020f + x * 0.0257f)), passed = 0.842f * (1 - x * x * x);
    return top_.fresnel(growth) * top_.d + (Spectrum(1.0f) - top_.c) * base_.fresnel(growth) * (passed * base_.d);
  }

  ScatterValue value_and_pdf_of(const Vector3& out, const Vector3& in, const Shares& share, Lobes lobes) const {
    const HalfVector half = half_vector(out, in);
    const float v_out = std::abs(out.z), v_in = std::abs(in.z), growth = schlick_growth(half.u);
    float top = 0, base = 0;
    ScatterValue r;
    if (lobes & diffuse_reflection) {
      top += top_.d * inverse_pi;
      base += base_.d * inverse_pi;
      r.pdf += share.diffuse * v_in * inverse_pi;
    }
    if (lobes & glossy_reflection) {
      if (top_.g > 0) {
        top += top_.g * top_.lobe.value(v_out, v_in, half);
        r.pdf += share.glossy[0] * top_.lobe.pdf(half) / (4 * half.u);
      }
      if (base_.g > 0) {
        base += base_.g * base_.lobe.value(v_out, v_in, half);
        r.pdf += share.glossy[1] * base_.lobe.pdf(half) / (4 * half.u);
      }
    }
    r.value = top_.fresnel(growth) * top;
    if (base > 0) r.value += through(std::min(v_out, v_in)) * base_.fresnel(growth) * base;
    return r;
  }

  Layer top_, base_;
  const Table* table_;
};

class SchlickShader final : public Shader {
 public:
  static void describe(Description<SchlickShader>& d) {
    d.summary(
         "One layer, or two when base_color is given, each of lobes goes from a mirror through gloss to matt as its roughness "
         "grows, with Fresnel reflection and scratches. What would create energy in the paper is bounded.",
         "Schlick 1994, An inexpensive BRDF model for physically-based rendering")
        .group("Layer")
        .member<&SchlickShader::color>("color", "1", "fraction the surface reflects at normal incidence, per wavelength",
                                       Meaning::reflectance)
        .member<&SchlickShader::roughness>("roughness", "1", "from 0 (a mirror) to 1 (matt)", Meaning::number, soft(0, 1))
        .member<&SchlickShader::isotropy>("isotropy", "1", "from 0.001 (scratches along u) to 1 (isotropic)", Meaning::number,
                                          soft(0.001, 1), logarithmic)
        .group("Layer below")
        .member<&SchlickShader::base_color>("base_color", "1", "colour of the layer below; without it there is one layer",
                                            Meaning::reflectance)
        .member<&SchlickShader::base_roughness>("base_roughness", "1", "roughness of the layer below", Meaning::number,
                                                soft(0, 1), when("base_color"))
        .member<&SchlickShader::base_isotropy>("base_isotropy", "1", "isotropy of the layer below", Meaning::number,
                                               soft(0.001, 1), logarithmic, when("base_color"))
        .group("Direction")
        .member<&SchlickShader::rotation>("rotation", "turn", "by how many turns the scratches are rotated against u",
                                          Meaning::number, soft(0, 1));
  }
  void prepare() override {
    require_reflectance(*this, "color", color);
    require_scalar(*this, "roughness", roughness);
    require_scalar(*this, "isotropy", isotropy, least_isotropy);
    if (base_color) require_reflectance(*this, "base_color", base_color);
    require_scalar(*this, "base_roughness", base_roughness);
    require_scalar(*this, "base_isotropy", base_isotropy, least_isotropy);
    if (!rotation) fail("rotation", "a map or a number is needed");
    table_ = &albedo_table();
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    const float p1 = scalar_at(*isotropy, p, least_isotropy), p2 = scalar_at(*base_isotropy, p, least_isotropy);
    const bool anisotropic = p1 < 1 || (base_color && p2 < 1);
    const Frame frame = anisotropic ? tangent_frame(p, rotation->scalar(p)) : Frame(p.shading_normal);
    const Layer top(reflectance_at(*color, p, w), scalar_at(*roughness, p), p1);
    Layer base;
    if (base_color) base = Layer(reflectance_at(*base_color, p, w), scalar_at(*base_roughness, p), p2);
    return arena.make<SchlickScatter>(p, frame, top, base, *table_);
  }
  /// Interpolation error of the albedo table.
  float albedo_error() const override { return 0.05f; }
  Lobes possible_lobes() const override { return reflection_lobes; }

  Ref<ObjectMap> color = constant(0.5f), roughness = constant(0.3f), isotropy = constant(1.0f), base_color,
                 base_roughness = constant(0.9f), base_isotropy = constant(1.0f), rotation = constant(0.0f);

 private:
  static constexpr float least_isotropy = 0.001f;
  const Table* table_ = nullptr;
};

const Register<SchlickShader> registered;

}  // namespace
}  // namespace etendue
