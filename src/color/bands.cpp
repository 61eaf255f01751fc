// Colours and spectra in the bands of an RGB space.

#include "etendue/describe/bands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "etendue/core/error.h"
#include "etendue/describe/component.h"
#include "tables.h"

namespace etendue {

namespace {

/// The spaces that have a name, in the order of their numbers.
const std::vector<const RgbSpace*>& numbered_spaces() {
  static const std::vector<const RgbSpace*> spaces = [] {
    std::vector<const RgbSpace*> all;
    for (const std::string& name : rgb_space_names()) all.push_back(&rgb_space(name));
    return all;
  }();
  return spaces;
}

using Vector = std::array<double, 3>;
using Matrix = std::array<double, 9>;

Vector operator*(const Matrix& m, const Vector& v) {
  return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
          m[6] * v[0] + m[7] * v[1] + m[8] * v[2]};
}

/// X Y Z under one white to those that look the same under another, by Bradford's cone responses (Lam 1985; ICC.1:2022, annex
/// E.3).
Vector adapted(const Vector& xyz, const Vector& from, const Vector& to) {
  constexpr Matrix cones{0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296};
  constexpr Matrix back{0.9869929, -0.1470543, 0.1599627, 0.4323053, 0.5183603, 0.0492912, -0.0085287, 0.0400428, 0.9684867};
  Vector seen = cones * xyz;
  const Vector before = cones * from, after = cones * to;
  for (size_t i = 0; i < 3; ++i) seen[i] *= after[i] / before[i];
  return back * seen;
}

Vector white_of(const RgbSpace& space) { return space.to_xyz * Vector{1, 1, 1}; }

/// What a spectrum's components would be without the limits of its use.
Vector components_of(const SpectralFunction& spectrum, ColorUse use, const RgbSpace& space) {
  const auto rgb = [&](const Xyz& c) { return space.from_xyz * Vector{c.x, c.y, c.z}; };
  if (use == ColorUse::radiance) return rgb(to_xyz(spectrum, use));
  // A tabulated white misses the nominal one by 1e-4: what is 1 everywhere is divided by itself.
  Vector v = rgb(to_xyz(spectrum, use, space.illuminant.get()));
  const Vector one = rgb(to_xyz(*space.illuminant, ColorUse::radiance));
  for (size_t i = 0; i < 3; ++i) v[i] /= one[i];
  return v;
}

/// The components of a colour within the limits of its use. NaN stays.
Spectrum within(const Vector& rgb, ColorUse use) {
  float values[3];
  for (size_t i = 0; i < 3; ++i) {
    const auto x = float(rgb[i]);
    values[i] = x < 0 ? 0 : use == ColorUse::reflectance && x > 1 ? 1 : x;
  }
  return band_spectrum(values[0], values[1], values[2]);
}

}  // namespace

Wavelengths bands_of(const RgbSpace& space) {
  const auto& all = numbered_spaces();
  const auto found = std::find(all.begin(), all.end(), &space);
  if (found == all.end()) throw Error("there are no bands of the RGB space '" + space.name + "', which has no name of its own");
  const auto number = float(found - all.begin());
  return {detail::Lanes{} - 1 - number, detail::Lanes{} + 1};
}

const RgbSpace& space_of_bands(const Wavelengths& w) { return *numbered_spaces()[size_t(-1 - w.hero())]; }

Spectrum rgb_in_bands(const RgbSpace& from, float r, float g, float b, ColorUse use, const Wavelengths& bands) {
  const RgbSpace& to = space_of_bands(bands);
  if (&from == &to) return within({double(r), double(g), double(b)}, use);
  Vector xyz = from.to_xyz * Vector{double(r), double(g), double(b)};
  if (use != ColorUse::radiance && from.white != to.white) xyz = adapted(xyz, white_of(from), white_of(to));
  return within(to.from_xyz * xyz, use);
}

Spectrum xyz_in_bands(const Xyz& c, ColorUse use, const Wavelengths& bands) {
  return within(space_of_bands(bands).from_xyz * Vector{c.x, c.y, c.z}, use);
}

Spectrum equal_energy_in_bands(const Wavelengths& bands) {
  static const Xyz color = [] {
    Xyz sum;
    for (const auto& row : tables::observer) sum += 1 / observer_y_integral() * Xyz{row[0], row[1], row[2]};
    return sum;
  }();
  return xyz_in_bands(color, ColorUse::radiance, bands);
}

BandValues::~BandValues() {
  for (const Entry* e = first_.load(); e;) {
    const Entry* const next = e->next;
    delete e;
    e = next;
  }
}

Spectrum BandValues::of(const SpectralFunction& spectrum, ColorUse use, const Wavelengths& bands) const {
  const RgbSpace* const space = &space_of_bands(bands);
  const Entry* const first = first_.load(std::memory_order_acquire);
  for (const Entry* e = first; e; e = e->next)
    if (e->space == space && e->use == use) return e->values;

  Vector v = components_of(spectrum, use, *space);
  const ValueRange range = range_of(spectrum, use);
  if (range.least == range.most && use != ColorUse::radiance) v.fill(double(range.least));
  const double largest = std::max({v[0], v[1], v[2], 1e-30});
  const double least = std::min({v[0], v[1], v[2]});
  if (least < -1e-3 * largest || (use == ColorUse::reflectance && largest > 1.001)) {
    std::string text = spectrum.expression();
    if (text.size() > 70) text = text.substr(0, 67) + "...";
    warn(fmt::format("in the bands of {}, {} is ({:.4g}, {:.4g}, {:.4g}), of which what is less than 0{} is cut off",
                     space->name, text, v[0], v[1], v[2], use == ColorUse::reflectance ? " or more than 1" : ""));
  }
  // Of two threads that compute the same, both enter it: the values are equal.
  auto* const made = new Entry{space, use, within(v, use), first};
  while (!first_.compare_exchange_weak(made->next, made, std::memory_order_acq_rel)) {
  }
  return made->values;
}

}  // namespace etendue
