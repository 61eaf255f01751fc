#include <algorithm>

#include "etendue/core/error.h"
#include "etendue/describe/sensor_curves.h"
#include "named.h"
#include "stepped_table.h"
#include "tables.h"

namespace etendue {

namespace {

class SensorCurve final : public SpectralFunction {
 public:
  SensorCurve(const tables::Camera& camera, size_t channel) : camera_(camera.name), channel_(sensor_channels[channel]) {
    std::vector<float> wavelengths, values;
    for (size_t i = 0; i < camera.rows.size(); ++i) {
      wavelengths.push_back(float(camera.low + camera.step * double(i)));
      values.push_back(float(camera.rows[i][channel]));
    }
    table_ = SteppedTable(std::move(wavelengths), std::move(values));
  }
  Spectrum evaluate(const Wavelengths& wavelengths, ColorUse) const override { return table_.evaluate(wavelengths); }
  float at(float wavelength, ColorUse) const override { return float(table_.exact(double(wavelength))); }
  std::vector<float> corners() const override { return table_.corners(); }
  std::string expression() const override { return "sensor(" + quoted(camera_) + ", " + quoted(channel_) + ")"; }

 private:
  std::string camera_, channel_;
  SteppedTable table_;
};

}  // namespace

Color sensor_curve(const std::string& camera, const std::string& channel) {
  const tables::Camera& found = find_named(tables::cameras, "sensor", camera);
  const auto* const at = std::ranges::find_if(sensor_channels, [&](const char* name) { return is_named(channel, name, ""); });
  if (at == sensor_channels.end())
    fail_unknown("channel", channel, std::vector<std::string>(sensor_channels.begin(), sensor_channels.end()));
  return Color(new SensorCurve(found, size_t(at - sensor_channels.begin())));
}

std::vector<std::string> sensor_names() { return names_of(tables::cameras); }

}  // namespace etendue
