// ThinFilm: interference in one film: oil on water, a soap bubble, the coating of a lens, the tarnish on steel.

#include "components/shaders/polarized_fresnel.h"
#include "components/shaders/scalar_map.h"
#include "etendue/describe/bands.h"
#include "etendue/object_map.h"
#include "etendue/scatter_model.h"
#include "etendue/transport/medium_stack.h"
#include "film_interference.h"

namespace etendue {
namespace {

// A film is thin if it is thinner than the light's coherence length: the reflections of its two faces then add up in amplitude,
// and depend on the wavelength. The reflectance is computed separately for each of the path's wavelengths. Belcour & Barla 2017
// prefilter it for RGB renderers, which is not needed here, but their colours must come out. Nothing is absorbed between
// dielectrics, so light that is not reflected is refracted as if the film were not there (its faces are parallel: Snell's law
// holds across it).
//
// Reflection is chosen with the mean of the reflectances over the path's wavelengths, not with the hero's alone, which may
// vanish where the others' do not. The weights R_i / mean R are then at most the number of wavelengths.
class ThinFilmScatter final : public ScatterModel<ThinFilmScatter>, public PolarizingScatter {
 public:
  struct Layers {
    Spectrum outside, film, base, absorbing;  ///< indices; the base's is base + i absorbing
    Spectrum thickness;                       ///< in wavelengths
    bool through = false;                     ///< light is refracted into the base
    bool dispersive = false, single = false;
  };

  ThinFilmScatter(const SurfacePoint& p, const Layers& layers)
      : ScatterModel(p, Lobes(specular_reflection | (layers.through ? Lobes(specular_transmission) : no_lobes))),
        layers_(layers) {
    if (layers.dispersive && layers.through) dispersed_lobes_ = specular_transmission;
  }

  Spectrum local_evaluate(const Vector3&, const Vector3&, Lobes) const { return {}; }
  float local_pdf(const Vector3&, const Vector3&, Lobes) const { return 0; }

  bool local_sample(const Vector3& out, float choice, Point2, Lobes lobes, LocalSample& s) const {
    const Spectrum reflected = reflectance(out);
    float reflect_probability = reflected.average();
    if (!(lobes & specular_transmission)) reflect_probability = 1;
    if (!(lobes & specular_reflection)) reflect_probability = 0;
    if (choice < reflect_probability) {
      s.in = {-out.x, -out.y, out.z};
      s.value = reflected;
      s.pdf = reflect_probability;
      s.lobe = specular_reflection;
      return true;
    }
    const float eta = towards(out), cosine2 = 1 - (1 - out.z * out.z) / (eta * eta);
    if (!(cosine2 > 0)) return false;  // total reflection of the hero, whose direction the path would take
    s.in = {-out.x / eta, -out.y / eta, out.z > 0 ? -std::sqrt(cosine2) : std::sqrt(cosine2)};
    s.value = Spectrum(1.0f) - reflected;
    s.pdf = 1 - reflect_probability;
    s.lobe = specular_transmission;
    s.eta = eta;
    s.dispersive = layers_.dispersive;
    return s.pdf > 0;
  }

  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    const Spectrum reflected = reflectance(out);
    Spectrum sum;
    if (lobes & specular_reflection) sum += reflected;
    if (lobes & specular_transmission) sum += Spectrum(1.0f) - reflected;
    return sum;
  }

  bool polarization(const Vector3& out, const Vector3& in, Lobes lobes, Polarization& event) const override {
    const bool inside = layers_.through && dot(normal_, out) < 0, reflects = (lobes & specular_reflection) != 0;
    const Vector3 s = common_perpendicular(out, in);
    event = {{}, s, s};
    const float cosine = reflects ? std::min(0.5f * length(out + in), 1.0f) : std::abs(dot(frame_.n, out));
    for (int i = 0; i < spectrum_size; ++i) {
      const float before = inside ? layers_.base[i] : layers_.outside[i],
                  behind = inside ? layers_.outside[i] : layers_.base[i];
      const FilmAmplitudes a =
          film_amplitudes(cosine, before, layers_.film[i], {behind, layers_.absorbing[i]}, layers_.thickness[i]);
      polarized::set_mueller(event.mueller, i,
                             reflects ? polarized::Amplitudes{a.reflected_s, a.reflected_p}
                                      : polarized::Amplitudes{a.transmitted_s, a.transmitted_p});
    }
    return true;
  }

 private:
  /// The hero's index behind the film over that in front, seen from `out`.
  float towards(const Vector3& out) const {
    const float eta = layers_.base[0] / layers_.outside[0];
    return out.z > 0 ? eta : 1 / eta;
  }
  Spectrum reflectance(const Vector3& out) const {
    const bool inside = layers_.through && out.z < 0;
    const float cosine = std::abs(out.z);
    Spectrum r;
    for (int i = 0; i < spectrum_size; ++i) {
      const float before = inside ? layers_.base[i] : layers_.outside[i],
                  behind = inside ? layers_.outside[i] : layers_.base[i];
      // Beyond the critical angle of the base all is reflected, exactly.
      const bool total = layers_.absorbing[i] == 0 && square(before) * (1 - cosine * cosine) >= square(behind);
      r.set(i, total ? 1
                     : film_fractions(cosine, before, layers_.film[i], {behind, layers_.absorbing[i]}, layers_.thickness[i])
                           .reflected);
      if (layers_.single) return Spectrum(r[0]);
    }
    return r;
  }

  Layers layers_;
};

class ThinFilm final : public Shader, public NeedsWavelengths {
 public:
  static void describe(Description<ThinFilm>& d) {
    d.summary(
         "A transparent film, about as thick as light waves are long, on glass or metal: interference colours. With a base of "
         "the index of what is around it is a soap film.",
         "Born & Wolf 1999, Principles of Optics, section 1.6.4; Belcour & Barla 2017, A practical extension to microfacet "
         "theory for the modeling of varying iridescence")
        .member<&ThinFilm::thickness>("thickness", "nm", "of the film", Meaning::number, soft(50, 2000), logarithmic)
        .member<&ThinFilm::film_ior>("film_ior", "1", "index of refraction of the film", Meaning::index)
        .member<&ThinFilm::base_ior>(
            "base_ior", "1", "index of refraction of what the film lies on; complex for a metal: metal(\"Al\")", Meaning::index)
        .member<&ThinFilm::opaque>("opaque", "",
                                   "whether light that gets into the base is absorbed there, as by a metal it is");
  }

  void prepare() override {
    require_scalar(*this, "thickness", thickness, 0, thickest);
    check_index("film_ior", film_ior);
    check_index("base_ior", base_ior);
    if (film_ior->imaginary())
      fail("film_ior", "the film is a dielectric: its index is real, and this one is complex (a metal's)");
    const Color k = base_ior->imaginary();
    for (float lambda = wavelength_low; k && lambda <= wavelength_high; lambda += 5)
      if (!(k->at(lambda, ColorUse::coefficient) >= 0 && k->at(lambda, ColorUse::coefficient) < 100))
        fail("base_ior", "the imaginary part of an index of refraction lies between 0 and 100");
  }

  void refuse_bands() const override { fail("thickness", "a thin film interferes wavelength by wavelength"); }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    ThinFilmScatter::Layers layers;
    layers.outside = MediumStack::index(p.media && p.object ? p.media->outside_of(*p.object) : nullptr, w);
    layers.film = film_ior->evaluate(w, ColorUse::coefficient);
    layers.base = base_ior->evaluate(w, ColorUse::coefficient);
    if (const Color k = base_ior->imaginary()) layers.absorbing = k->evaluate(w, ColorUse::coefficient);
    const float nanometres = scalar_at(*thickness, p, 0, thickest);
    for (int i = 0; i < spectrum_size; ++i) layers.thickness.set(i, nanometres / w[i]);
    layers.through = through();
    layers.single = w.single();
    const Spectrum eta = layers.base / layers.outside;
    layers.dispersive = eta.minimum() != eta.maximum() && !w.single();
    return arena.make<ThinFilmScatter>(p, layers);
  }

  Lobes possible_lobes() const override {
    return Lobes(specular_reflection | (through() ? Lobes(specular_transmission) : no_lobes));
  }
  Spectrum interior_index(const Wavelengths& w) const override {
    return through() ? base_ior->evaluate(w, ColorUse::coefficient) : Spectrum(1.0f);
  }
  bool lossless() const override { return through(); }

  Ref<ObjectMap> thickness = constant(400.0f);
  Color film_ior = flat_spectrum(1.33f), base_ior = flat_spectrum(1.5f);
  bool opaque = false;

 private:
  static constexpr float thickest = 1e5f;  // [nm]; more than the coherence length of any lamp

  bool through() const { return !opaque && !base_ior->imaginary(); }

  void check_index(const char* member, const Color& index) const {
    if (!index) fail(member, "an index of refraction is needed");
    for (float lambda = wavelength_low; lambda <= wavelength_high; lambda += 5) {
      const float n = index->at(lambda, ColorUse::coefficient);
      if (!(n > 0 && n < 100))
        fail(member, "an index of refraction lies between 0 and 100, and this is " + std::to_string(n) + " at " +
                         std::to_string(int(lambda)) + " nm");
    }
  }
};

const Register<ThinFilm> registered;

}  // namespace
}  // namespace etendue
