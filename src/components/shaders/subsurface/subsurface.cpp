// Subsurface: a body that scatters light inside, such as skin, wax, milk or marble.
//
// A smooth dielectric boundary reflects the fraction F of the incident light and transmits 1 - F. Transmitted light spreads
// inside and leaves elsewhere, over the hemisphere: from `in` at x' to `out` at x the body has the BSSRDF
//     S = (1 - F(out)) A R(x, x') (1 - F(in)) / (c pi)     [1/(m^2 sr)],
// where A R (by a profile, or by a random walk) is the fraction of light that gets from x to x', per area, and c = 1 - the mean
// of F over diffuse light makes the last factor, times cos(in), integrate to 1 (Jensen et al. 2001, "A practical model for
// subsurface light transport"; normalized as in Christensen & Burley 2015). Both ends are on the same side of the boundary, so
// no squared indices remain. A body of colour 1 returns all light: F + (1 - F) A = 1.
//
// To renderers, light enters by specular transmission, since it enters in no other way than by sample_exit; the index does not
// change along the path, as the path leaves the body again.

#include "albedo_inversion.h"
#include "components/shaders/fresnel.h"
#include "components/shaders/reflectance.h"
#include "etendue/core/warp.h"
#include "etendue/describe/color.h"
#include "etendue/scatter_model.h"
#include "etendue/transport/medium_stack.h"
#include "subsurface_exit.h"

namespace etendue {
namespace {

Spectrum reflectance_of(float cosine, const Spectrum& eta) {
  return map(eta, [cosine](float e) { return fresnel_dielectric(cosine, e); });
}

/// The boundary, for incident light. Reflection or entry is chosen by the mean of F over the path's wavelengths. The reflected
/// direction is the same for all wavelengths and the refracted one is not used, so all wavelengths are kept. The same on both
/// sides.
class BoundaryScatter final : public ScatterModel<BoundaryScatter> {
 public:
  BoundaryScatter(const SurfacePoint& p, Spectrum eta)
      : ScatterModel(p, specular_reflection | specular_transmission), eta_(eta) {}

  Spectrum local_evaluate(const Vector3&, const Vector3&, Lobes) const { return {}; }
  float local_pdf(const Vector3&, const Vector3&, Lobes) const { return 0; }

  bool local_sample(const Vector3& out, float choice, Point2, Lobes lobes, LocalSample& s) const {
    const Spectrum reflected = reflectance_of(std::abs(out.z), eta_);
    float probability = reflected.average();
    if (!(lobes & specular_transmission)) probability = 1;
    if (!(lobes & specular_reflection)) probability = 0;
    if (choice < probability) {
      s.in = {-out.x, -out.y, out.z};
      s.value = reflected;
      s.pdf = probability;
      s.lobe = specular_reflection;
    } else {
      s.in = -out;
      s.value = Spectrum(1.0f) - reflected;
      s.pdf = 1 - probability;
      s.lobe = specular_transmission;
    }
    return true;
  }
  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    const Spectrum reflected = reflectance_of(std::abs(out.z), eta_);
    Spectrum sum;
    if (lobes & specular_reflection) sum += reflected;
    if (lobes & specular_transmission) sum += Spectrum(1.0f) - reflected;
    return sum;
  }

 private:
  Spectrum eta_;
};

/// Light that leaves the body: f = (1 - F(in)) / (c pi) [1/sr], sampled with the pdf cos / pi.
class ExitScatter final : public ScatterModel<ExitScatter> {
 public:
  static constexpr bool uses_choice = false;

  ExitScatter(const SurfacePoint& p, Spectrum eta)
      : ScatterModel(p, diffuse_reflection),
        eta_(eta),
        scale_(map(eta, [](float e) { return 1 / (1 - mean_fresnel_dielectric(e)); })) {}

  Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes) const {
    return out.z * in.z > 0 ? passed(std::abs(in.z)) * inverse_pi : Spectrum();
  }
  float local_pdf(const Vector3& out, const Vector3& in, Lobes) const {
    return out.z * in.z > 0 ? std::abs(in.z) * inverse_pi : 0;
  }
  bool local_sample(const Vector3& out, float, Point2 u, Lobes, LocalSample& s) const {
    s.in = warp::cosine_hemisphere(u);
    s.pdf = s.in.z * inverse_pi;
    s.value = passed(s.in.z) * s.pdf;
    s.lobe = diffuse_reflection;
    if (out.z < 0) s.in.z = -s.in.z;
    return s.pdf > 0;
  }
  Spectrum local_albedo(const Vector3&, Lobes lobes) const {
    return (lobes & diffuse_reflection) ? Spectrum(1.0f) : Spectrum();
  }

 private:
  Spectrum passed(float cosine) const { return (Spectrum(1.0f) - reflectance_of(cosine, eta_)) * scale_; }

  Spectrum eta_, scale_;
};

enum class Method : std::uint8_t { diffusion, random_walk };

class Subsurface final : public Shader {
 public:
  static void describe(Description<Subsurface>& d) {
    d.summary(
         "A body that scatters light inside: light leaves it near where it entered, under a smooth dielectric boundary. The "
         "random "
         "walk needs a closed object; on others the diffusion profile is used.",
         "Christensen & Burley 2015, Approximate reflectance profiles for efficient subsurface scattering; Chiang, Kutz & "
         "Burley 2016, Practical and controllable subsurface scattering for production path tracing")
        .member<&Subsurface::color>("color", "1", "fraction of the light let in that leaves again, per wavelength",
                                    Meaning::reflectance)
        .member<&Subsurface::mean_free_path>(
            "mean_free_path", "m",
            "how far light goes before it forgets its direction (transport mean free path), per wavelength",
            Meaning::coefficient, soft(0.0001, 1), logarithmic)
        .member<&Subsurface::ior>("ior", "1", "index of refraction: a number or a spectrum", Meaning::index)
        .member<&Subsurface::anisotropy>("anisotropy", "1",
                                         "mean cosine of the scattering angle; for random_walk, hardly changes the look",
                                         range(-0.95, 0.95))
        .member<&Subsurface::method>(
            "method", "",
            "diffusion: a profile fitted to flat bodies, fast; random_walk: light is followed inside, exact for any shape",
            choices("diffusion", "random_walk"));
  }

  void prepare() override {
    require_reflectance(*this, "color", color);
    if (!mean_free_path) fail("mean_free_path", "a length is needed");
    if (!ior) fail("ior", "an index of refraction is needed");
    if (ior->imaginary()) fail("ior", "the index of a body that light enters is real; this one is complex (a metal's)");
    for (float lambda = wavelength_low; lambda <= wavelength_high; lambda += 5) {
      const std::string where = " at " + std::to_string(int(lambda)) + " nm";
      const float n = ior->at(lambda, ColorUse::coefficient), l = mean_free_path->at(lambda, ColorUse::coefficient);
      if (!(n > 0.1f && n < 10))
        fail("ior", "an index of refraction lies between 0.1 and 10, and this is " + std::to_string(n) + where);
      if (!(l > 1e-9f && l < 1e9f))
        fail("mean_free_path",
             "a mean free path lies between 1e-9 m and 1e9 m, and this is " + std::to_string(l) + " m" + where);
    }
    constexpr float middle = 550;  // [nm]
    if (method == Method::random_walk)
      inversion_ = AlbedoInversion(double(anisotropy), double(ior->at(middle, ColorUse::coefficient)));
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    return arena.make<BoundaryScatter>(p, relative_index(p, w));
  }
  Lobes possible_lobes() const override { return specular_reflection | specular_transmission; }
  /// A path that enters leaves at once by sample_exit, so its media and indices do not nest.
  bool transmits() const override { return false; }
  bool has_subsurface_exit() const override { return true; }

  std::optional<SubsurfaceExit> sample_exit(const SurfacePoint& p, const Scene& scene, const Wavelengths& w,
                                            NumberStream& random, Arena& arena) const override {
    SubsurfaceBody body;
    body.returned = reflectance_at(*color, p, w);
    if (body.returned.black()) return std::nullopt;
    body.mean_free_path = max(mean_free_path->evaluate(w, ColorUse::coefficient), 1e-9f);
    body.eta = relative_index(p, w);
    body.anisotropy = anisotropy;
    body.single_wavelength = w.single();

    SubsurfaceExit exit;
    if (method == Method::random_walk && p.object && p.object->closed()) {
      body.single_albedo = map(body.returned, [this](float c) { return inversion_.albedo(c); });
      if (!exit_by_random_walk(body, p, scene, random, exit.point, exit.weight)) return std::nullopt;
    } else {
      if (!exit_by_diffusion(body, p, scene, random, exit.point, exit.weight)) return std::nullopt;
    }
    exit.point.media = p.media;
    exit.scatter = arena.make<ExitScatter>(exit.point, body.eta);
    return exit;
  }

  // Skin: Jensen et al. 2001, table 1 (skin1), s_s' and s_a of its red, green and blue.
  Ref<ObjectMap> color = constant(0.5f);
  Color mean_free_path = rgb_color("srgb", 1.3e-3, 0.95e-3, 0.67e-3);
  Color ior = flat_spectrum(1.4f);
  float anisotropy = 0;
  Method method = Method::diffusion;

 private:
  /// Index inside over that of the surrounding medium.
  Spectrum relative_index(const SurfacePoint& p, const Wavelengths& w) const {
    const SceneObject* outside = p.media && p.object ? p.media->outside_of(*p.object) : nullptr;
    const Spectrum inside = ior->evaluate(w, ColorUse::coefficient);
    return outside ? inside / MediumStack::index(outside, w) : inside;
  }

  AlbedoInversion inversion_;
};

const Register<Subsurface> registered;

}  // namespace
}  // namespace etendue
