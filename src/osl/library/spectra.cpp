// Rows of the table: functions of the spectral extension. All act on the values at the path's wavelengths. Spectra carry no
// derivatives.

#include <fmt/format.h>

#include <cstring>

#include "choose.h"
#include "etendue/describe/bands.h"
#include "numbers.h"
#include "parts.h"
#include "services.h"

namespace etendue::osl {

namespace {

constexpr int size = spectrum_size;

void give_spectrum(const Call& c, const Spectrum& s) {
  float* to = static_cast<float*>(c.result);
  for (int i = 0; i < size; ++i) to[i] = s[i];
  detail::no_derivatives(c);
}

/// The value of argument k at wavelength i: a spectrum's or the one float.
float value(const Call& c, int k, int i) {
  const float* p = static_cast<const float*>(c.arguments[k]);
  return c.type(k).base == Base::spectrum ? p[i] : *p;
}

template <float (*f)(float)>
void of_one(const Call& c) {
  float* to = static_cast<float*>(c.result);
  for (int i = 0; i < size; ++i) to[i] = f(value(c, 0, i));
  detail::no_derivatives(c);
}
template <float (*f)(float, float)>
void of_two(const Call& c) {
  float* to = static_cast<float*>(c.result);
  for (int i = 0; i < size; ++i) to[i] = f(value(c, 0, i), value(c, 1, i));
  detail::no_derivatives(c);
}
template <float (*f)(float, float, float)>
void of_three(const Call& c) {
  float* to = static_cast<float*>(c.result);
  for (int i = 0; i < size; ++i) to[i] = f(value(c, 0, i), value(c, 1, i), value(c, 2, i));
  detail::no_derivatives(c);
}

float sine(float x) { return std::sin(x); }
float cosine(float x) { return std::cos(x); }
float exponential(float x) { return std::exp(x); }
float absolute(float x) { return std::abs(x); }
float root(float x) { return sqrt_or_zero(x); }
float logarithm(float x) { return safe_log(x); }
float power(float x, float y) { return safe_pow(x, y); }
float smaller(float a, float b) { return std::min(a, b); }
float larger(float a, float b) { return std::max(a, b); }
float limited(float x, float a, float b) { return std::max(std::min(x, b), a); }
float mixture(float a, float b, float t) { return a * (1 - t) + b * t; }
float smooth_step(float a, float b, float x) {
  const float t = std::clamp(safe_divide(x - a, b - a), 0.0f, 1.0f);
  return a == b ? (x < a ? 0.0f : 1.0f) : (3 - 2 * t) * t * t;
}

void wavelength(const Call& c) {
  Spectrum s;
  for (int i = 0; i < size; ++i) s.set(i, c.services.wavelengths()[i]);
  give_spectrum(c, s);
}

/// spectrum("metal Au")
void named(const Call& c) {
  Spectrum s;
  if (!c.services.named_spectrum(c.string(0), s))
    c.services.error(fmt::format("Unknown spectrum \"{}\"", c.string(0)->text()), c.types.place);
  give_spectrum(c, s);
}

void flat(const Call& c) { give_spectrum(c, Spectrum(c.at<float>(0))); }

template <bool light>
void of_color(const Call& c) {
  give_spectrum(c, c.services.color_spectrum(c.at<Triple>(0), light));
}

/// The radiant exitance per wavelength of a black body [W/m^2/nm].
void blackbody(const Call& c) {
  const double kelvin = double(c.at<float>(0));
  const auto exitance = [kelvin](float nanometres) {
    const double metres = double(nanometres) * 1e-9;
    return 1e-9 * 3.741771852e-16 * std::pow(metres, -5) / std::expm1(1.438776877e-2 / (metres * kelvin));
  };
  const Wavelengths& w = c.services.wavelengths();
  Spectrum s;
  if (kelvin > 0 && in_bands(w))
    s = projected(exitance, ColorUse::radiance, w);
  else
    for (int i = 0; i < size && kelvin > 0; ++i) s.set(i, float(exitance(w[i])));
  give_spectrum(c, s);
}

constexpr Derivatives none = Derivatives::none;

constexpr Row rows[] = {
    {"spectrum wavelength()", always<wavelength>, none, 0, nullptr, false},
    {"spectrum spectrum(string words)", always<named>, none, 0, nullptr, false},
    {"spectrum spectrum(float f)", always<flat>, none},
    {"spectrum spectrum(color reflectance)", always<of_color<false>>, none, 0, nullptr, false},
    {"spectrum light(color radiance)", always<of_color<true>>, none, 0, nullptr, false},
    {"spectrum blackbody_spectrum(float kelvin)", always<blackbody>, none, 0, nullptr, false},
    {"spectrum sin(spectrum x)", always<of_one<sine>>, none},
    {"spectrum cos(spectrum x)", always<of_one<cosine>>, none},
    {"spectrum exp(spectrum x)", always<of_one<exponential>>, none},
    {"spectrum log(spectrum x)", always<of_one<logarithm>>, none},
    {"spectrum sqrt(spectrum x)", always<of_one<root>>, none},
    {"spectrum abs(spectrum x)", always<of_one<absolute>>, none},
    {"spectrum pow(spectrum x, spectrum y)", always<of_two<power>>, none},
    {"spectrum pow(spectrum x, float y)", always<of_two<power>>, none},
    {"spectrum min(spectrum a, spectrum b)", always<of_two<smaller>>, none},
    {"spectrum max(spectrum a, spectrum b)", always<of_two<larger>>, none},
    {"spectrum clamp(spectrum x, spectrum low, spectrum high)", always<of_three<limited>>, none},
    {"spectrum mix(spectrum a, spectrum b, spectrum t)", always<of_three<mixture>>, none},
    {"spectrum mix(spectrum a, spectrum b, float t)", always<of_three<mixture>>, none},
    {"spectrum smoothstep(spectrum low, spectrum high, spectrum x)", always<of_three<smooth_step>>, none},
    {"spectrum smoothstep(float low, float high, spectrum x)", always<of_three<smooth_step>>, none},
};

}  // namespace

std::span<const Row> spectrum_rows() { return rows; }

}  // namespace etendue::osl
