// Shaders with one fault each, which `etendue conform` must find.

#include "etendue/core/warp.h"
#include "etendue/object_map.h"
#include "etendue/scatter_model.h"

namespace etendue {
namespace {

/// The base of models that are diffuse on both sides, correct except for the functions that a model replaces.
template <class Model>
class MattModel : public ScatterModel<Model> {
 public:
  MattModel(const SurfacePoint& p, float reflectance, Lobes lobes = diffuse_reflection)
      : ScatterModel<Model>(p, lobes), reflectance_(reflectance) {}

  Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes) const {
    return out.z * in.z > 0 ? Spectrum(reflectance_ * inverse_pi) : Spectrum();
  }
  float local_pdf(const Vector3& out, const Vector3& in, Lobes) const {
    return out.z * in.z > 0 ? std::abs(in.z) * inverse_pi : 0;
  }
  bool local_sample(const Vector3& out, float, Point2 u, Lobes lobes, LocalSample& s) const {
    s.in = warp::cosine_hemisphere(u);
    if (out.z < 0) s.in.z = -s.in.z;
    s.lobe = diffuse_reflection;
    s.pdf = this->model().local_pdf(out, s.in, lobes);
    s.value = this->model().local_evaluate(out, s.in, lobes) * std::abs(s.in.z);
    return s.pdf > 0;
  }
  Spectrum local_albedo(const Vector3&, Lobes lobes) const { return this->has(lobes) ? Spectrum(reflectance_) : Spectrum(); }

 protected:
  float reflectance_;
};

class Matt final : public MattModel<Matt> {
 public:
  using MattModel::MattModel;
};

/// The members and lobes that all these shaders have.
template <class S>
class MattShader : public Shader {
 public:
  const Scatter* bind(const SurfacePoint& p, const Wavelengths&, Arena& arena) const override {
    return arena.make<S>(p, reflectance);
  }
  Lobes possible_lobes() const override { return diffuse_reflection; }

  float reflectance = 0.7f;

 protected:
  template <class T>
  static void describe_as(Description<T>& d, const char* fault) {
    d.summary(fault).template member<&T::reflectance>("reflectance", "1", "fraction of light reflected", range(0.2, 1));
  }
};

// ---- a pdf without the cosine ------------------------------------------------------------------------------------------
class DensityScatter final : public MattModel<DensityScatter> {
 public:
  using MattModel::MattModel;

  float local_pdf(const Vector3& out, const Vector3& in, Lobes) const { return out.z * in.z > 0 ? warp::hemisphere_pdf : 0; }
};
class WrongDensityShader final : public MattShader<DensityScatter> {
 public:
  static void describe(Description<WrongDensityShader>& d) { describe_as(d, "Directions by cosine, densities without it."); }
};
const Register<WrongDensityShader> pdf;

// ---- reciprocal at the hero wavelength only ----------------------------------------------------------------------------
/// Diffuse transmission: f(front to back) / f(back to front) must be the squared relative index of each wavelength.
class HeroIndexScatter final : public ScatterModel<HeroIndexScatter> {
 public:
  HeroIndexScatter(const SurfacePoint& p, const Spectrum& eta) : ScatterModel(p, diffuse_transmission), eta_(eta) {}

  Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes) const {
    return out.z * in.z < 0 ? Spectrum(0.4f * inverse_pi * towards(out)) : Spectrum();
  }
  float local_pdf(const Vector3& out, const Vector3& in, Lobes) const {
    return out.z * in.z < 0 ? std::abs(in.z) * inverse_pi : 0;
  }
  bool local_sample(const Vector3& out, float, Point2 u, Lobes lobes, LocalSample& s) const {
    s.in = warp::cosine_hemisphere(u);
    if (out.z > 0) s.in.z = -s.in.z;
    s.lobe = diffuse_transmission;
    s.pdf = local_pdf(out, s.in, lobes);
    s.value = local_evaluate(out, s.in, lobes) * std::abs(s.in.z);
    s.eta = towards(out);
    return s.pdf > 0;
  }
  Spectrum local_albedo(const Vector3& out, Lobes) const { return 0.4f * towards(out); }
  Spectrum relative_index(const Vector3& out, const Vector3&) const { return out.z > 0 ? eta_ : Spectrum(1.0f) / eta_; }

 private:
  float towards(const Vector3& out) const { return out.z > 0 ? eta_[0] : 1 / eta_[0]; }

  Spectrum eta_;
};
class HeroIndexShader final : public MattShader<Matt> {
 public:
  static void describe(Description<HeroIndexShader>& d) { describe_as(d, "Takes every wavelength for the hero."); }
  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    Spectrum eta;
    for (int i = 0; i < spectrum_size; ++i) eta.set(i, 1.2f + 1e-3f * (w[i] - wavelength_low));
    return arena.make<HeroIndexScatter>(p, eta);
  }
  Lobes possible_lobes() const override { return diffuse_transmission; }
};
const Register<HeroIndexShader> hero_index;

// ---- an albedo that is not that of the scattered light -----------------------------------------------------------------
class AlbedoScatter final : public MattModel<AlbedoScatter> {
 public:
  AlbedoScatter(const SurfacePoint& p, float reflectance, float factor) : MattModel(p, reflectance), factor_(factor) {}

  Spectrum local_albedo(const Vector3& out, Lobes lobes) const { return MattModel::local_albedo(out, lobes) * factor_; }

 private:
  float factor_;
};
class DimAlbedoShader final : public MattShader<Matt> {
 public:
  static void describe(Description<DimAlbedoShader>& d) { describe_as(d, "Its albedo is 20 % below what it scatters."); }
  const Scatter* bind(const SurfacePoint& p, const Wavelengths&, Arena& arena) const override {
    return arena.make<AlbedoScatter>(p, reflectance, 0.8f);
  }
};
const Register<DimAlbedoShader> dim_albedo;

/// An albedo estimate may be off, but by no more than albedo_error().
class WildAlbedoShader final : public MattShader<Matt> {
 public:
  static void describe(Description<WildAlbedoShader>& d) { describe_as(d, "Its albedo is 60 % off, and said to be 20 % off."); }
  const Scatter* bind(const SurfacePoint& p, const Wavelengths&, Arena& arena) const override {
    return arena.make<AlbedoScatter>(p, reflectance, 1.6f);
  }
  float albedo_error() const override { return 0.2f; }
};
const Register<WildAlbedoShader> wild_albedo;

class BoundlessAlbedoShader final : public MattShader<Matt> {
 public:
  static void describe(Description<BoundlessAlbedoShader>& d) { describe_as(d, "Its albedo may be anything, it says."); }
  float albedo_error() const override { return 10; }
};
const Register<BoundlessAlbedoShader> boundless_albedo;

// ---- more light than arrives -------------------------------------------------------------------------------------------
class EnergyScatter final : public MattModel<EnergyScatter> {
 public:
  EnergyScatter(const SurfacePoint& p, float reflectance) : MattModel(p, 1 + 0.1f * reflectance) {}

  Spectrum local_albedo(const Vector3&, Lobes lobes) const { return (lobes & diffuse_reflection) ? 1.0f : 0.0f; }
};
class GainingShader final : public MattShader<EnergyScatter> {
 public:
  static void describe(Description<GainingShader>& d) { describe_as(d, "Reflects up to 110 % of what arrives."); }
};
const Register<GainingShader> gaining;

// ---- not reciprocal ----------------------------------------------------------------------------------------------------
class OneWayScatter final : public MattModel<OneWayScatter> {
 public:
  using MattModel::MattModel;

  Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes lobes) const {
    return MattModel::local_evaluate(out, in, lobes) * (0.5f + 0.5f * std::abs(out.z));
  }
  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    return MattModel::local_albedo(out, lobes) * (0.5f + 0.5f * std::abs(out.z));
  }
};
class OneWayShader final : public MattShader<OneWayScatter> {
 public:
  static void describe(Description<OneWayShader>& d) {
    describe_as(d, "Darker towards grazing viewers, not from grazing lamps.");
  }
};
const Register<OneWayShader> one_way;

// ---- a weight that is not value times cosine over pdf ------------------------------------------------------------------
class WeightScatter final : public MattModel<WeightScatter> {
 public:
  using MattModel::MattModel;

  bool local_sample(const Vector3& out, float choice, Point2 u, Lobes lobes, LocalSample& s) const {
    const bool sampled = MattModel::local_sample(out, choice, u, lobes, s);
    s.value *= 1.03f;
    return sampled;
  }
};
class WrongWeightShader final : public MattShader<WeightScatter> {
 public:
  static void describe(Description<WrongWeightShader>& d) { describe_as(d, "Samples weigh 3 % too much."); }
};
const Register<WrongWeightShader> weight;

// ---- two lobes, one of which ignores the lobe mask ---------------------------------------------------------------------
class MaskScatter final : public MattModel<MaskScatter> {
 public:
  MaskScatter(const SurfacePoint& p, float reflectance)
      : MattModel(p, reflectance, diffuse_reflection | diffuse_transmission) {}

  // Half of the light is reflected and half transmitted; but reflection is sampled even if the mask excludes it.
  Spectrum local_evaluate(const Vector3&, const Vector3&, Lobes) const { return reflectance_ / 2 * inverse_pi; }
  float local_pdf(const Vector3& out, const Vector3& in, Lobes lobes) const {
    if (lobes == diffuse_reflection) return out.z * in.z > 0 ? std::abs(in.z) * inverse_pi : 0;
    return std::abs(in.z) * inverse_pi / 2;
  }
  bool local_sample(const Vector3& out, float choice, Point2 u, Lobes lobes, LocalSample& s) const {
    s.in = warp::cosine_hemisphere(u);
    const bool through = (lobes & diffuse_transmission) != 0 && choice < 0.5f;
    if ((out.z < 0) != through) s.in.z = -s.in.z;
    s.lobe = through ? diffuse_transmission : diffuse_reflection;
    s.pdf = local_pdf(out, s.in, lobes);
    s.value = local_evaluate(out, s.in, lobes) * std::abs(s.in.z);
    return s.pdf > 0;
  }
  Spectrum local_albedo(const Vector3&, Lobes lobes) const {
    return reflectance_ * ((lobes & diffuse_reflection ? 0.5f : 0) + (lobes & diffuse_transmission ? 0.5f : 0));
  }
};
class MaskIgnoringShader final : public MattShader<MaskScatter> {
 public:
  static void describe(Description<MaskIgnoringShader>& d) {
    describe_as(d, "Reflects although only transmission was asked for.");
  }
  Lobes possible_lobes() const override { return diffuse_reflection | diffuse_transmission; }
};
const Register<MaskIgnoringShader> mask;

// ---- NaN where the cosine vanishes -------------------------------------------------------------------------------------
class GrazingScatter final : public MattModel<GrazingScatter> {
 public:
  using MattModel::MattModel;

  Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes lobes) const {
    // sqrt of a negative number just above the horizon.
    return MattModel::local_evaluate(out, in, lobes) * std::sqrt(std::abs(in.z) - 0.001f) / std::sqrt(std::abs(in.z) - 0.001f);
  }
};
class GrazingShader final : public MattShader<GrazingScatter> {
 public:
  static void describe(Description<GrazingShader>& d) { describe_as(d, "Not a number at grazing angles."); }
};
const Register<GrazingShader> grazing;

// ---- a member that has an effect although its condition says that it has none -------------------------------------------
class AlwaysPaintedShader final : public Shader {
 public:
  static void describe(Description<AlwaysPaintedShader>& d) {
    d.summary("Has its paint even when it says that there is none.")
        .member<&AlwaysPaintedShader::painted>("painted", "", "whether there is paint")
        .member<&AlwaysPaintedShader::paint>("paint", "1", "fraction of light it reflects", range(0.2, 1), when("painted"));
  }
  const Scatter* bind(const SurfacePoint& p, const Wavelengths&, Arena& arena) const override {
    return arena.make<Matt>(p, paint);
  }
  Lobes possible_lobes() const override { return diffuse_reflection; }

  bool painted = false;
  float paint = 0.7f;
};
const Register<AlwaysPaintedShader> always_painted;

// ---- a reflectance that is evaluated as another quantity ---------------------------------------------------------------
class MisreadShader final : public Shader {
 public:
  static void describe(Description<MisreadShader>& d) {
    d.summary("Asks for its reflectance as a coefficient.")
        .member<&MisreadShader::color>("color", "1", "fraction of light it reflects", Meaning::reflectance);
  }
  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    return arena.make<Matt>(p, clamp(color->color(p, w, ColorUse::coefficient)[0], 0, 0.9f));
  }
  Lobes possible_lobes() const override { return diffuse_reflection; }

  Ref<ObjectMap> color = constant(0.5f);
};
const Register<MisreadShader> misread;

}  // namespace
}  // namespace etendue
