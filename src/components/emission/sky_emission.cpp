// SkyEmission: a clear sky with its sun.

#include "at_infinity.h"
#include "direction_table.h"
#include "etendue/emission_shader.h"
#include "etendue/scene_object.h"
#include "quantity.h"
#include "sky_model.h"
#include "sun_position.h"

namespace etendue {
namespace {

// Directions are in object space: x east, y up, z south. Below the horizon the radiance is 0: a scene has to model its own
// ground.
//
// Importance sampling mixes two pdfs over directions,
//     p = P_sun [within the disc] / Omega_sun + (1 - P_sun) p_sky   [1/sr],
// a uniform one over the sun's disc, and for the sky a table that is finer around the sun and near the horizon. P_sun is the
// sun's share of all light, clamped to [0.1, 0.9] so that neither pdf is undersampled. Light is weighted here by
// xbar + ybar + zbar.
class SkyEmission final : public EmissionShader {
 public:
  static void describe(Description<SkyEmission>& d) {
    d.summary(
         "A clear sky and the sun, for an Environment: measured atmospheres' spectral radiance, from 360 to 720 nm (beyond, as "
         "a "
         "black body's falls). Up is +y, north -z, east +x. Below the horizon it is black, and there is no night.",
         "Hosek & Wilkie 2012, An analytic model for full spectral sky-dome radiance; 2013, Adding a solar-radiance function "
         "to "
         "the Hosek-Wilkie skylight model; the sun's place: Astronomical Almanac")
        .group("Place of the sun")
        .member<&SkyEmission::to_sun>("sun_direction", "1",
                                      "from the ground towards the sun, of any length; used without a time", unless("time"))
        .member<&SkyEmission::time>(
            "time", "", "universal time, \"2024-06-21T12:00:00Z\": the sun stands where it does then, seen from the place")
        .member<&SkyEmission::latitude>("latitude", "deg", "of the place, north of the equator", range(-90, 90), when("time"))
        .member<&SkyEmission::longitude>("longitude", "deg", "of the place, east of Greenwich", range(-180, 180), when("time"))
        .group("Sky")
        .member<&SkyEmission::turbidity>("turbidity", "1",
                                         "how hazy the air is: 2 very clear, 3 clear, 6 warm and moist, 10 hazy", range(1, 10))
        .member<&SkyEmission::ground_albedo>(
            "ground_albedo", "1", "reflectance of the ground all around, which brightens the sky", Meaning::reflectance)
        .member<&SkyEmission::sun>("sun", "", "whether the sun's disc is there")
        .member<&SkyEmission::sun_diameter>("sun_diameter", "deg",
                                            "angle across the sun's disc; a larger one is as much darker as it is larger",
                                            Range{0, 20, true}, soft(0.1, 5), logarithmic, when("sun"))
        .group("Amount")
        .member<&SkyEmission::scale>("scale", "1", "multiplies the radiance", at_least(0), soft(0.01, 100), logarithmic)
        .member<&SkyEmission::lux>("illuminance", "lx", "on level ground, sun and sky together; 0: as the model says",
                                   at_least(0), soft(1, 100000), logarithmic);
  }

  void prepare() override {
    place_sun();
    if (!ground_albedo) fail("ground_albedo", "a colour is needed");
    std::array<float, SkyModel::channels> albedo;
    for (int c = 0; c < SkyModel::channels; ++c) {
      const float value = ground_albedo->at(SkyModel::wavelength(c), ColorUse::reflectance);
      if (!(value >= 0 && value <= 1)) fail("ground_albedo", "must lie within 0 and 1, and is " + fmt::format("{}", value));
      albedo[size_t(c)] = value;
    }
    if (!(turbidity >= 1 && turbidity <= 10)) fail("turbidity", "must lie within 1 and 10");
    elevation_ = safe_asin(sun_.y);
    model_ = SkyModel(turbidity, albedo, elevation_);
    const auto height = [](double degrees) { return 2 * std::pow(std::sin(degrees * (3.14159265358979323846 / 360)), 2); };
    height_ = float(height(double(sun_diameter) / 2));
    if (!(height_ > 0)) fail("sun_diameter", "is too small to count with");
    sun_angle_ = 2 * pi * height_;
    disc_ = float(height(true_diameter / 2) / double(height_));
    factor_ = scale;
    integrate();
    build();
  }

  Spectrum radiance(const SurfacePoint& p, const Vector3&, const Wavelengths& w) const override {
    return seen(p.object_position - Point3{}, w);
  }

  DirectionSample sample(const SurfacePoint& p, Point2) const override { return sample_at_infinity(p); }
  float pdf(const SurfacePoint&, const Vector3&) const override { return 1; }

  /// The power that enters the scene through the object's area [W/nm]: pi * area * mean radiance.
  Spectrum power(const SceneObject& object, const Wavelengths& w) const override {
    return SkyModel::between_channels(w, [&](int c) { return all_[size_t(c)]; }) * (factor_ * object.area() / 4);
  }

  bool only_at_infinity() const override { return true; }
  bool knows_incident() const override { return true; }
  DirectionSample sample_incident(Point2 u) const override {
    Vector3 d;
    if (u.x < sun_share_) {
      const float h = height_ * std::min(u.x / sun_share_, one_minus_epsilon), r = safe_sqrt(h * (2 - h));
      float sine = 0, cosine = 0;
      sin_cos_turn(u.y, sine, cosine);
      d = Frame(Normal3(sun_)).to_world({r * cosine, r * sine, 1 - h});
    } else {
      u.x = std::min((u.x - sun_share_) / (1 - sun_share_), one_minus_epsilon);
      const Vector3 local = table_.sample(u).direction;
      d = {local.y, local.z, local.x};
    }
    return {d, incident_pdf(d)};
  }
  float incident_pdf(const Vector3& towards) const override {
    const float disc = in_disc(towards) ? sun_share_ / sun_angle_ : 0;
    return disc + (1 - sun_share_) * table_.pdf({towards.z, towards.x, towards.y});
  }

  int most_incident_places() const override { return 2; }
  IncidentPlaces incident_places(const Vector3& towards) const override {
    IncidentPlaces places;
    if (in_disc(towards) && sun_share_ > 0) {
      const Vector3 d = Frame(Normal3(sun_)).to_local(towards);
      float turn = std::atan2(d.y, d.x) / (2 * pi);
      if (turn < 0) turn += 1;
      places.add({sun_share_ * std::min(polar_height(d) / height_, one_minus_epsilon), std::min(turn, one_minus_epsilon)},
                 sun_share_ / sun_angle_);
    }
    const Vector3 local{towards.z, towards.x, towards.y};
    if (const float pdf = (1 - sun_share_) * table_.pdf(local); pdf > 0) {
      const Point2 u = table_.place(local);
      places.add({std::min(sun_share_ + (1 - sun_share_) * u.x, one_minus_epsilon), u.y}, pdf);
    }
    return places;
  }

  static constexpr double true_diameter = 0.53313;  // [deg]: 959.63 arc seconds of radius, at the mean distance
  Vector3 to_sun{1, 1, 1};
  std::string time;
  float latitude = 0, longitude = 0, turbidity = 3;
  Color ground_albedo = flat_spectrum(0.3f);
  bool sun = true;
  float sun_diameter = float(true_diameter), scale = 1;
  double lux = 0;

 private:
  void place_sun() {
    const char* member = time.empty() ? "sun_direction" : "time";
    if (time.empty()) {
      const double x = double(to_sun.x), y = double(to_sun.y), z = double(to_sun.z), l = std::sqrt(x * x + y * y + z * z);
      if (!(l > 0 && std::isfinite(l))) fail(member, "must be finite and not zero");
      sun_ = normalize(Vector3{float(x / l), float(y / l), float(z / l)});
    } else {
      try {
        sun_ = sun_direction(parse_time(time), double(latitude), double(longitude));
      } catch (const Error& e) {
        fail(member, e.what());
      }
    }
    if (sun_.y < 0)
      fail(member, fmt::format("the sun is {:.1f} degrees below the horizon, and the model is one of the day",
                               degrees(safe_asin(-sun_.y))));
  }

  bool in_disc(const Vector3& towards) const { return sun && length_squared(towards - sun_) / 2 <= height_; }

  Spectrum seen(const Vector3& towards, const Wavelengths& w) const {
    if (towards.y < 0) return {};
    const float chord = length(towards - sun_), h = square(chord) / 2;
    Spectrum value = model_.sky(towards.y, 2 * safe_asin(chord / 2), w);
    if (sun && h <= height_) value += in_sun(towards, h, w);
    return value * factor_;
  }

  /// The radiance of the sun's disc at h = 1 - cos of the angle from its middle.
  Spectrum in_sun(const Vector3& towards, float h, const Wavelengths& w) const {
    // The sine of the angle from the disc's middle over the sine of the disc's angular radius is sin(psi), with psi the angle
    // at the sun's centre (SkyModel::sun).
    const float sines = h * (2 - h) / (height_ * (2 - height_));
    return model_.sun(safe_asin(towards.y), safe_sqrt(1 - sines), w) * disc_;
  }

  using OfChannels = std::array<double, SkyModel::channels>;
  /// Integrates over the part of the sun's disc above the horizon: adds the integral of radiance to `all`, and that of radiance
  /// times the cosine to the zenith, the irradiance of level ground, to `level`.
  void integrate_sun(OfChannels& all, OfChannels& level) const {
    constexpr int rings = 64, sectors = 32;
    const Frame frame{Normal3(sun_)};
    for (int first = 0; first < SkyModel::channels; first += spectrum_size) {
      Wavelengths w;
      const int count = std::min(spectrum_size, SkyModel::channels - first);
      for (int i = 0; i < spectrum_size; ++i) w.place(i, SkyModel::wavelength(first + std::min(i, count - 1)), 1);
      for (int k = 0; k < rings * sectors; ++k) {
        const float h = height_ * (float(k % rings) + 0.5f) / rings, r = safe_sqrt(h * (2 - h));
        float sine = 0, cosine = 0;
        sin_cos_turn((float(k / rings) + 0.5f) / sectors, sine, cosine);
        const Vector3 d = frame.to_world({r * cosine, r * sine, 1 - h});
        if (d.y < 0) continue;
        const Spectrum light = in_sun(d, h, w) * (sun_angle_ / (rings * sectors));
        for (int i = 0; i < count; ++i) {
          all[size_t(first + i)] += double(light[i]);
          level[size_t(first + i)] += double(light[i] * d.y);
        }
      }
    }
  }

  /// Integrals over directions at each channel, by steps of 1 degree from the zenith and 2 around it. Only one half of the sky
  /// is summed, as it is symmetric to both sides of the sun.
  void integrate() {
    constexpr int rows = 90, columns = 90;
    const double step = 3.14159265358979323846 / 180;
    OfChannels level{}, of_sun{};
    all_ = {};
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        const double theta = (row + 0.5) * step, phi = (column + 0.5) * 2 * step,
                     solid_angle = 4 * std::sin(theta) * step * step;
        const float cosine = float(std::cos(theta));
        const float gamma = safe_acos(sun_.y * cosine + safe_sqrt(1 - square(sun_.y)) * float(std::sin(theta) * std::cos(phi)));
        for (int c = 0; c < SkyModel::channels; ++c) {
          const double value = double(model_.sky(c, cosine, gamma)) * solid_angle;
          all_[size_t(c)] += float(value);
          level[size_t(c)] += value * double(cosine);
        }
      }
    if (sun) integrate_sun(of_sun, level);
    double sky_light = 0, sun_light = 0;
    for (int c = 0; c < SkyModel::channels; ++c) {
      sky_light += tristimulus(c) * double(all_[size_t(c)]);
      sun_light += tristimulus(c) * of_sun[size_t(c)];
      all_[size_t(c)] += float(of_sun[size_t(c)]);
    }
    sun_share_ = sun ? float(std::clamp(sun_light / (sun_light + sky_light), 0.1, 0.9)) : 0;
    if (!(lux > 0)) return;
    const double given = integrate_wavelengths(Quantity::illuminance, [&](const Wavelengths& w) {
      return SkyModel::between_channels(w, [&](int c) { return float(level[size_t(c)]); });
    });
    factor_ *= float(lux / given);
  }
  static double tristimulus(int channel) {
    const Xyz o = observer(SkyModel::wavelength(channel));
    return o.x + o.y + o.z;
  }

  /// The table's z is up, its longitude from south by east.
  void build() {
    const double zenith = degrees(safe_acos(sun_.y)), towards = degrees(std::atan2(sun_.x, sun_.z));
    std::vector<double> polar, azimuth;
    for (double a = 0; a < 90;) {
      polar.push_back(a);
      a += a >= 80 || std::abs(a + 0.5 - zenith) < 7 ? 1 : 2;
    }
    polar.push_back(90);
    for (double a = -180; a < 180; a += std::abs(a + 0.5) < 12 ? 1 : 4) azimuth.push_back(towards + a);
    azimuth.push_back(towards + 180);
    table_.build(polar, azimuth, [&](size_t row, size_t column) {
      double sum = 0;
      for (const double s : {0.2, 0.8})
        for (const double t : {0.2, 0.8}) {
          const double theta = std::lerp(polar[row], polar[row + 1], s),
                       phi = std::lerp(azimuth[column], azimuth[column + 1], t);
          const float sine = std::sin(radians(float(theta))), cosine = std::cos(radians(float(theta)));
          const Vector3 d{sine * std::sin(radians(float(phi))), cosine, sine * std::cos(radians(float(phi)))};
          const float gamma = 2 * safe_asin(length(d - sun_) / 2);
          for (const int c : {2, 5, 7})  // 440, 560 and 640 nm stand for all
            sum += tristimulus(c) * double(model_.sky(c, std::max(cosine, 0.0f), gamma));
        }
      return sum + 1e-6;  // where the fit is 0 at these channels, it may be positive at others
    });
  }

  SkyModel model_;
  DirectionTable table_;
  Vector3 sun_{0, 1, 0};                         // unit
  float elevation_ = 0;                          // [rad]
  float height_ = 0;                             // 1 - cos of the disc's radius
  float sun_angle_ = 0;                          // the disc's solid angle [sr]
  float disc_ = 1;                               // factor of the disc's radiance that keeps the irradiance at any diameter
  float sun_share_ = 0;                          // P_sun
  float factor_ = 1;                             // multiplies all radiance
  std::array<float, SkyModel::channels> all_{};  // integral of radiance over directions [W m^-2 nm^-1]
};

const Register<SkyEmission> registered;

}  // namespace
}  // namespace etendue
