// LayerStack::albedo: an estimate of the light that two layers reflect and transmit.

#include "layer_stack.h"

namespace etendue {
namespace {

constexpr Lobes specular_out = specular_transmission | null_scattering;

}  // namespace

// Averages by 4-point Gauss quadrature with weight c. The reflectance from inside has an edge at the critical angle, which four
// points miss. The transmittance seen from outside has none: by reciprocity its mean over the squared index is the mean
// transmittance of diffuse light from inside. The rest, minus the face's absorption, is reflected back.
const LayerStack::Diffuse& LayerStack::diffuse(int which) const {
  Diffuse& d = diffuse_[which];
  if (d.known) return d;
  d.known = true;
  constexpr float cosines[] = {0.13975986434f, 0.41640956763f, 0.72315698637f, 0.94289580388f};
  constexpr float weights[] = {0.06236194190f, 0.25969509522f, 0.40692913604f, 0.27101382684f};
  const Scatter& s = face(which);
  const Frame frame(shading_normal_);
  const float up = which == 0 ? 1 : -1;
  const auto through = s.sample(frame.to_world({0, 0, up}), 0.5f, {0.5f, 0.5f}, {Transport::importance, transmission_lobes});
  const float denser = through ? square(through->eta) : 1;
  Spectrum lost, some, some_clear;
  for (int i = 0; i < 4; ++i) {
    const float sine = std::sqrt(1 - cosines[i] * cosines[i]);
    const Vector3 outside = frame.to_world({sine, 0, up * cosines[i]});
    const Spectrum r = s.albedo(-outside, reflection_lobes), t = s.albedo(-outside, transmission_lobes);
    const Spectrum a = exp(medium_.absorption * -slant(outside));
    const float cosine_inside = denser > 1 ? std::sqrt(1 - sine * sine / denser) : cosines[i];
    const Spectrum leave = denser > 1 ? s.albedo(outside, transmission_lobes) / denser : t;
    lost += weights[i] * max(Spectrum(1.0f) - r - t, 0);
    some += weights[i] * r;
    some_clear += weights[i] * r * a * a;
    d.leave += weights[i] * leave;
    d.leave_clear += weights[i] * leave * exp(medium_.absorption * (-1 / cosine_inside));
    d.absorbed += weights[i] * a;
  }
  d.back = max(Spectrum(1.0f) - d.leave - lost, 0);
  d.back_clear = d.back * some_clear / max(some, 1e-6f);
  return d;
}

// Without scattering in the medium: light crosses to N, which reflects r and transmits t. The specular or glossy part of r
// keeps its angle; the diffuse part is averaged over the cosine. The round trips between N and E are a geometric series. Light
// that E transmits diffusely is averaged from the beginning. With much scattering all light between is diffuse, and the medium
// is a layer of two-stream reflectance and transmittance (Kubelka & Munk 1931; K = 2 absorption, S = 3/4 (1 - g) scattering),
// combined with the faces by the same series. The two results are blended by the fraction of unscattered light. No energy is
// lost where nothing absorbs.
LayerStack::Albedo LayerStack::albedo(const Vector3& out) const {
  Albedo result;
  const int near = side(out);
  const Scatter &entering = face(near), &behind = face(1 - near);
  const auto inside = entering.sample(out, 0.5f, {0.5f, 0.5f}, {Transport::importance, transmission_lobes});
  if (!inside) return result;
  const Vector3 w = inside->direction;
  const Diffuse &e = diffuse(near), &n = diffuse(1 - near);
  const Spectrum one(1.0f);
  const auto series = [&](const Spectrum& round) { return one / max(one - round, 1e-4f); };
  const Spectrum in = entering.albedo(out, transmission_lobes), in_diffuse = entering.albedo(out, diffuse_transmission);

  const Spectrum r = behind.albedo(-w, reflection_lobes), t = behind.albedo(-w, transmission_lobes);
  const Spectrum mirrored = behind.albedo(-w, specular_reflection | glossy_reflection), scattered = r - mirrored;
  const Spectrum r_near = entering.albedo(w, reflection_lobes), t_near = entering.albedo(w, transmission_lobes);
  const Spectrum a = exp(medium_.absorption * -slant(w));
  const Spectrum sharp = series(a * a * r * r_near), soft = series(e.back_clear * n.back);
  const Spectrum one_way = in - in_diffuse;
  Spectrum reflected = one_way * a * (mirrored * a * t_near * sharp + scattered * e.leave_clear * soft) +
                       in_diffuse * e.absorbed * n.back * e.leave_clear * soft;
  Spectrum transmitted = one_way * a * (t + mirrored * a * a * r_near * t * sharp + scattered * e.back_clear * n.leave * soft) +
                         in_diffuse * n.leave_clear * soft;

  if (medium_.scatters()) {
    const Spectrum absorbing = 2 * medium_.absorption, turning = 0.75f * (1 - medium_.mean_cosine) * medium_.scattering;
    Spectrum r_medium, t_medium;
    for (int i = 0; i < spectrum_size; ++i) {
      // R = S / (K + S + b coth b), T = (b / sinh b) / (K + S + b coth b), b^2 = K (K + 2 S).
      const float K = absorbing[i], S = turning[i], b = std::sqrt(K * (K + 2 * S)), decay = std::exp(-2 * b);
      const bool some = b > 1e-3f;
      const float b_coth = some ? b * (1 + decay) / (1 - decay) : 1,
                  b_over_sinh = some ? 2 * b * std::exp(-b) / (1 - decay) : 1;
      r_medium.set(i, S / (K + S + b_coth));
      t_medium.set(i, b_over_sinh / (K + S + b_coth));
    }
    const Spectrum round = series(r_medium * n.back), below = r_medium + t_medium * t_medium * n.back * round;
    const Spectrum rounds = series(below * e.back);
    const Spectrum unscattered = exp(medium_.scattering * (-(1 - medium_.mean_cosine) * slant(w)));
    reflected = unscattered * reflected + (one - unscattered) * (in * below * e.leave * rounds);
    transmitted = unscattered * transmitted + (one - unscattered) * (in * t_medium * n.leave * round * rounds);
  }

  const Spectrum clear = transmittance(w, 1), in_specular = entering.albedo(out, specular_out);
  const Spectrum mirror = clear * clear * behind.albedo(-w, specular_reflection);
  const Spectrum round = in_specular * series(mirror * entering.albedo(w, specular_reflection));
  result.specular[0] = round * mirror * entering.albedo(w, specular_out);
  result.specular[1] = round * clear * behind.albedo(-w, specular_out);
  result.smooth[0] = max(reflected - result.specular[0], 0);
  result.smooth[1] = max(transmitted - result.specular[1], 0);
  return result;
}

}  // namespace etendue
