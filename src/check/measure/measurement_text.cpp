// Measurements as tables and as JSON.

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "measure.h"

namespace etendue::measure {
namespace {

/// "683.21 ± 0.45", with as many digits as the error leaves.
std::string text(const Reading& r) {
  if (!(r.error > 0) || !(std::abs(r.value) > 0)) return fmt::format("{:.7g}", r.value);
  const double digits = std::floor(std::log10(std::abs(r.value))) - std::floor(std::log10(r.error)) + 2;
  return fmt::format("{:.{}g} ± {:.2g}", r.value, int(std::clamp(digits, 2.0, 12.0)), r.error);
}

/// "W/(m2 sr)" to "W/(m2 sr nm)", "W/m2" to "W/(m2 nm)".
std::string per_nanometre(const std::string& unit) {
  if (unit.ends_with(')')) return unit.substr(0, unit.size() - 1) + " nm)";
  const size_t slash = unit.find('/');
  return unit.substr(0, slash + 1) + "(" + unit.substr(slash + 1) + " nm)";
}

nlohmann::ordered_json json(const Reading& r) { return {{"value", r.value}, {"error", r.error}}; }

}  // namespace

std::string measurement_text(const Measurement& m) {
  const MeterQuantity& q = m.quantity;
  const bool edges = !m.bands.empty() && m.bands[0].high > 0;
  std::string out = fmt::format("{:<14} {} {}\n", q.photometric, text(m.photometric), q.photometric_unit);
  if (edges)
    out += fmt::format("{:<14} {} {}   ({:g} to {:g} nm)\n", q.name, text(m.total), q.unit, m.bands.front().low,
                       m.bands.back().high);
  if (m.photometric.value > 0) out += fmt::format("{:<14} x {}, y {}   (CIE 1931)\n", "chromaticity", text(m.x), text(m.y));
  out += fmt::format("\n{:<20} {:>15} {:>15}\n", edges ? "band [nm]" : "response", per_nanometre(q.unit), "standard error");
  for (const BandReading& b : m.bands)
    out += fmt::format("{:<20} {:>15.6g} {:>15.2g}\n",
                       edges ? fmt::format("{:g} to {:g}", b.low, b.high) : b.channel.substr(b.channel.find('.') + 1),
                       b.reading.value, b.reading.error);
  out += fmt::format("\n{} samples in {} independent renders", m.samples, m.renders);
  if (m.bad_samples > 0) out += fmt::format("; {} were negative or not finite and count as black", m.bad_samples);
  if (!m.bias.empty()) out += "; the renderer is biased, which the errors do not contain: " + m.bias;
  return out + "\n";
}

std::string measurement_json(const Measurement& m) {
  const MeterQuantity& q = m.quantity;
  nlohmann::ordered_json bands = nlohmann::ordered_json::array();
  for (const BandReading& b : m.bands) {
    nlohmann::ordered_json band = {{"channel", b.channel}};
    if (b.high > 0) band.update({{"low", b.low}, {"high", b.high}});
    band.update(json(b.reading));
    bands.push_back(band);
  }
  const bool edges = !m.bands.empty() && m.bands[0].high > 0;
  nlohmann::ordered_json all = {{"quantity", q.name}, {"unit", q.unit}};
  if (edges) all["total"] = json(m.total);
  all[q.photometric] = json(m.photometric);
  all[q.photometric]["unit"] = q.photometric_unit;
  all["x"] = json(m.x);
  all["y"] = json(m.y);
  all["bands"] = bands;
  all["samples"] = m.samples;
  all["renders"] = m.renders;
  all["bad_samples"] = m.bad_samples;
  all["bias"] = m.bias;
  return all.dump(2) + "\n";
}

}  // namespace etendue::measure
