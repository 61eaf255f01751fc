#include "etendue/transport/fluorescence.h"

#include "etendue/core/warp.h"
#include "etendue/dye.h"
#include "etendue/shader.h"
#include "transport/medium_interval.h"

namespace etendue {
namespace {

/// A BSDF times a factor for each wavelength.
class ScaledScatter final : public Scatter {
 public:
  ScaledScatter(const SurfacePoint& point, const Scatter& whole, const Spectrum& factor)
      : Scatter(point, whole.frame(), whole.lobes()), whole_(whole), factor_(factor) {
    has_choice_ = whole.has_choice();
    dispersed_lobes_ = whole.dispersed_lobes();
  }
  ScatterValue world_value_and_pdf(const Vector3& out, const Vector3& in, ScatterContext context) const override {
    const ScatterValue v = whole_.value_and_pdf(out, in, context);
    return {v.value * factor_, v.pdf};
  }
  float world_pdf(const Vector3& out, const Vector3& in, ScatterContext context) const override {
    return whole_.pdf(out, in, context);
  }
  std::optional<ScatterSample> world_sample(const Vector3& out, float choice, Point2 u, ScatterContext context) const override {
    std::optional<ScatterSample> s = whole_.sample(out, choice, u, context);
    if (s) s->weight *= factor_;
    return s;
  }
  Spectrum world_albedo(const Vector3& out, Lobes lobes) const override { return whole_.albedo(out, lobes) * factor_; }

 private:
  const Scatter& whole_;
  const Spectrum factor_;
};

/// q is at least this where both outcomes are possible, and at most 1 minus it: the light that arrives may be of other
/// wavelengths than most is expected from.
constexpr float least_share = 1.0f / 16;

/// The number of lanes whose values matter.
int lanes(const Wavelengths& w) { return w.single() ? 1 : spectrum_size; }

/// The new wavelengths of a walk, and for each lane the absorbed and the emitted one, and the pdf of the absorbed one.
struct NewWavelengths {
  Wavelengths wavelengths;
  std::array<float, spectrum_size> absorbed{}, emitted{}, pdf{};
};

/// `sample_absorbed(emitted, u, pdf)` is asked where there are no levels.
template <class SampleAbsorbed>
NewWavelengths new_wavelengths(const Wavelengths& now, NumberStream& numbers, const WavelengthStep& step,
                               const SampleAbsorbed& sample_absorbed) {
  NewWavelengths all{now};
  const bool from_camera = step.transport == Transport::radiance;
  const float u = step.levels ? 0 : numbers.next();
  for (size_t i = 0; i < size_t(lanes(now)); ++i) {
    const int lane = int(i);
    if (step.levels) {
      const Wavelengths& next = (*step.levels)[step.next()];
      all.absorbed[i] = from_camera ? next[lane] : now[lane];
      all.emitted[i] = from_camera ? now[lane] : next[lane];
      all.pdf[i] = from_camera ? next.pdf(lane) : now.pdf(lane);
      all.wavelengths.place(lane, next[lane], next.pdf(lane));
    } else {
      // Stratified over the lanes; each lane has the pdf p.
      const float own = u + float(i) / spectrum_size;
      all.emitted[i] = now[lane];
      all.absorbed[i] = sample_absorbed(now[lane], std::min(own - std::floor(own), one_minus_epsilon), all.pdf[i]);
      all.wavelengths.place(lane, all.absorbed[i], all.pdf[i]);
    }
  }
  return all;
}

/// Phi / p in each lane.
template <class Phi>
Spectrum over_pdf(const NewWavelengths& w, const Phi& phi) {
  Spectrum factor;
  for (size_t i = 0; i < size_t(spectrum_size); ++i)
    if (w.pdf[i] > 0) factor.set(int(i), phi(w.absorbed[i], w.emitted[i]) / w.pdf[i]);
  return factor;
}

}  // namespace

WavelengthLevels::WavelengthLevels(const Wavelengths& film, int most, NumberStream numbers, Arena& arena) {
  most = std::clamp(most, 0, limit);
  count_ = std::min(int(std::log(1 - numbers.next()) / std::log(another)), most);
  // `most` has the rest of the probability: a path has no more vertices.
  weight_ = 1 / (std::pow(another, float(count_)) * (count_ < most ? 1 - another : 1));
  levels_[0] = arena.make<Wavelengths>(film);
  constexpr float range = wavelength_high - wavelength_low;
  for (int m = 1; m <= count_; ++m) {
    auto* const level = arena.make<Wavelengths>();
    const float u = numbers.next();
    for (int i = 0; i < spectrum_size; ++i) {
      const float own = u + float(i) / spectrum_size;
      level->place(i, wavelength_low + range * (own - std::floor(own)), 1 / range);
    }
    levels_[size_t(m)] = level;
  }
}

ChosenScatter choose_reradiation(const SurfacePoint& point, const Vector3& out, const Scatter* elastic,
                                 const Spectrum& throughput, SampleContext& sample, const WavelengthStep& step) {
  const SceneObject& object = *point.object;
  const FluorescentSurface* const surface = fluorescent(object.shader.get());
  if (!surface || !step.goes_on()) return {elastic};
  const bool black = object.sides != Sides::both && (dot(point.normal, out) > 0) != (object.sides == Sides::front);
  const Reradiation* const reradiation = black ? nullptr : surface->bind_reradiation(point, sample.arena);
  if (!reradiation) return {elastic};

  const Wavelengths& now = sample.wavelengths;
  const Spectrum albedo = elastic ? elastic->albedo(out) : Spectrum();
  float changed = 0, kept = 0;
  for (int i = 0; i < lanes(now); ++i) {
    changed +=
        throughput[i] * (step.transport == Transport::radiance ? reradiation->received(now[i]) : reradiation->given(now[i]));
    kept += throughput[i] * albedo[i];
  }
  if (!(changed > 0)) return {elastic};
  const float q = elastic ? clamp(changed / (changed + kept), least_share, 1 - least_share) : 1;
  if (elastic && sample.numbers.next() >= q) return {sample.arena.make<ScaledScatter>(point, *elastic, Spectrum(1 / (1 - q)))};

  const NewWavelengths next = new_wavelengths(
      now, sample.numbers, step, [&](float l, float u, float& pdf) { return reradiation->sample_absorbed(l, u, pdf); });
  const Spectrum factor = over_pdf(next, [&](float a, float e) { return reradiation->value(a, e); });
  sample.wavelengths = next.wavelengths;
  return {sample.arena.make<ScaledScatter>(point, reradiation->directions(), factor / q), true};
}

namespace {

/// Distances along a segment of the length d: half of them uniform, half by the extinction s_k of a lane k, which is chosen
/// with the probability w_k. Without an end, all by the extinction:
///     p(t) = h / d + (1 - h) sum_k w_k s_k exp(-s_k t) / (1 - exp(-s_k d)).
class DyeDistance {
 public:
  DyeDistance(const Spectrum& extinction, const Spectrum& throughput, float d) : s_(extinction), d_(d) {
    float sum = 0;
    for (int i = 0; i < spectrum_size; ++i)
      if (s_[i] > 0) sum += throughput[i];
    h_ = std::isfinite(d) ? (sum > 0 ? 0.5f : 1) : 0;
    for (int i = 0; i < spectrum_size; ++i) w_.set(i, sum > 0 && s_[i] > 0 ? throughput[i] / sum : 0);
    possible_ = d > 0 && (std::isfinite(d) || sum > 0);
  }
  bool possible() const { return possible_; }

  float sample(float choice, float u) const {
    if (choice < h_) return u * d_;
    float rest = (choice - h_) / (1 - h_);
    int k = 0, last = 0;
    for (; k < spectrum_size; ++k) {
      if (!(w_[k] > 0)) continue;
      last = k;
      if (rest < w_[k]) break;
      rest -= w_[k];
    }
    const float s = s_[std::min(k, last)];
    return std::min(-std::log1p(u * std::expm1(-s * d_)) / s, d_);
  }
  float pdf(float t) const {
    float p = std::isfinite(d_) ? h_ / d_ : 0;
    for (int i = 0; i < spectrum_size; ++i)
      if (w_[i] > 0) p += (1 - h_) * w_[i] * s_[i] * std::exp(-s_[i] * t) / -std::expm1(-s_[i] * d_);
    return p;
  }

 private:
  const Spectrum s_;
  const float d_;
  float h_ = 0;
  Spectrum w_;
  bool possible_ = false;
};

/// Matter that scatters alike in all directions.
class EvenVolume final : public VolumeShader {
 public:
  VolumeCoefficients coefficients(const Point3&, float, const Wavelengths&) const override { return {}; }
  bool homogeneous() const override { return true; }
  Spectrum majorant(const Wavelengths&) const override { return {}; }
  float phase(const Point3&, const Vector3&, const Vector3&) const override { return warp::sphere_pdf; }
  Vector3 sample_phase(const Point3&, const Vector3&, Point2 u, float& pdf) const override {
    pdf = warp::sphere_pdf;
    return warp::sphere(u);
  }
};

}  // namespace

DyeFlight sample_dye(const Medium& medium, const Ray& ray, float reach, const Spectrum& throughput, SampleContext& sample,
                     const WavelengthStep& step) {
  DyeFlight flight{false, reach, Spectrum(1.0f)};
  const DyedVolume* const with_dye = dyed(medium.volume);
  if (!with_dye || !step.goes_on()) return flight;
  const VolumeShader& volume = *medium.volume;
  const Dye& dye = *with_dye->dye();
  const MediumInterval there = medium_interval(medium, ray, reach);
  const Wavelengths& now = sample.wavelengths;
  const bool from_camera = step.transport == Transport::radiance;
  float changed = 0, kept = 0;
  for (int i = 0; i < lanes(now); ++i) {
    changed += throughput[i] * (from_camera ? dye.received(now[i]) : dye.given(now[i]) * dye.absorption()(now[i]));
    kept += throughput[i];
  }
  if (!(changed > 0)) return flight;
  // The extinction that the distance is sampled by need not be that at the place: in a heterogeneous medium it is an upper
  // bound.
  const Spectrum extinction =
      volume.homogeneous() ? volume.coefficients(ray.origin, ray.time, now).extinction() : volume.majorant(now);
  const DyeDistance distance(extinction, throughput, there.length());
  if (!distance.possible()) return flight;
  const float most = with_dye->most_dye();
  const float depth = std::isfinite(there.length()) ? -std::expm1(-most * there.length()) : 1;
  const float q = clamp(changed * depth / (changed * depth + kept), least_share, 0.5f);
  if (sample.numbers.next() >= q) {
    flight.weight = Spectrum(1 / (1 - q));
    return flight;
  }
  const float choice = sample.numbers.next(), t = distance.sample(choice, sample.numbers.next()), p = distance.pdf(t);
  flight.absorbed = true;
  flight.distance = there.begin + t;
  const float amount = volume.homogeneous() ? most : with_dye->dye_amount(medium.own(ray(flight.distance), ray.time), ray.time);
  if (!(p > 0) || !(amount > 0)) {
    flight.weight = {};
    return flight;
  }
  const Spectrum clear = transmittance(medium, ray, flight.distance, now, sample.numbers);
  const NewWavelengths next =
      new_wavelengths(now, sample.numbers, step, [&](float, float u, float& pdf) { return dye.absorption().sample(u, pdf); });
  flight.weight =
      clear * over_pdf(next, [&](float a, float e) { return dye.absorption()(a) * dye.yield(a, e); }) * (amount / (q * p));
  sample.wavelengths = next.wavelengths;
  return flight;
}

Medium emitting_dye(const Medium& medium) {
  static const Ref<EvenVolume> even = make<EvenVolume>();
  return {even.get(), medium.object};
}

}  // namespace etendue
