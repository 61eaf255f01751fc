#include "rgl_data.h"

#include "etendue/core/error.h"
#include "etendue/describe/color.h"
#include "tensor_file.h"

namespace etendue {
namespace {

using Type = TensorFile::Type;

/// The angle between a unit vector and z, precise for small angles too.
float elevation(const Vector3& v) { return 2 * safe_asin(0.5f * length(v - Vector3{0, 0, 1})); }
float elevation_to_unit(float theta) { return std::sqrt(theta * (2 / pi)); }
float azimuth_to_unit(float phi) { return (phi + pi) * (inverse_pi / 2); }

/// dw_m / du [sr]
float half_vector_stretch(float u_x, float sine) { return std::max(2 * pi * pi * u_x * sine, 1e-20f); }

/// Reads the increasing values of a parameter.
std::vector<float> parameter(TensorFile& file, const std::string& name, size_t most) {
  const TensorFile::Field& field = file.field(name, Type::float32, 1);
  if (field.count > most) throw Error("field '" + name + "' has " + std::to_string(field.count) + " values");
  std::vector<float> values = file.floats(field);
  for (size_t i = 1; i < values.size(); ++i)
    if (!(values[i] > values[i - 1])) throw Error("the values of field '" + name + "' do not increase");
  return values;
}

constexpr std::uint64_t most_points = 1 << 14;  // along one side of a table

/// Reads tables over the unit square, the last two dimensions; `others` are the sizes that the other dimensions must have.
SquareTables tables(TensorFile& file, const std::string& name, const std::vector<std::uint64_t>& others) {
  const TensorFile::Field& field = file.field(name, Type::float32, others.size() + 2);
  for (size_t i = 0; i < others.size(); ++i)
    if (field.shape[i] != others[i])
      throw Error("field '" + name + "' has size " + std::to_string(field.shape[i]) + " in dimension " + std::to_string(i) +
                  " where " + std::to_string(others[i]) + " is expected");
  const std::uint64_t height = field.shape[others.size()], width = field.shape[others.size() + 1];
  if (width < 2 || height < 2 || width > most_points || height > most_points)
    throw Error("the tables of field '" + name + "' are of size " + std::to_string(width) + " x " + std::to_string(height));
  return {int(width), int(height), 1, file.floats(field)};
}

void require_at_least(float least, const SquareTables& t, const std::string& name) {
  for (const float v : t.values())
    if (!(v >= least))
      throw Error("field '" + name + "' holds " + std::to_string(v) + ", where nothing " +
                  (least > 0 ? "negative or zero" : "negative") + " makes sense");
}

/// Interleaves the channels of each point: in the file each channel has a table of its own.
SquareTables interleaved(SquareTables t, size_t channels) {
  const size_t points = t.points(), slices = t.values().size() / (points * channels);
  std::vector<float> values(t.values().size());
  for (size_t slice = 0; slice < slices; ++slice)
    for (size_t c = 0; c < channels; ++c)
      for (size_t i = 0; i < points; ++i)  // noise around zero may be negative
        values[(slice * points + i) * channels + c] = std::max(t.values()[(slice * channels + c) * points + i], 0.0f);
  return {t.width(), t.height(), int(channels), std::move(values)};
}

}  // namespace

RglData::RglData(const std::string& path, bool symmetric) : space_(&rgb_space("srgb")) {
  TensorFile file(path);
  for (const std::uint8_t c : file.bytes(file.field("description", Type::uint8, 1)))
    description_ += c < 32 || c > 126 ? '?' : char(c);

  const std::vector<float> phi = parameter(file, "phi_i", 4096), theta = parameter(file, "theta_i", 4096);
  if (phi.front() < -3.15f || phi.back() > 3.15f) throw Error("the angles of field 'phi_i' do not lie between -pi and pi");
  if (theta.front() < 0 || theta.back() > 1.58f) throw Error("the angles of field 'theta_i' do not lie between 0 and pi / 2");
  isotropic_ = phi.size() <= 2;
  if (!isotropic_) {
    const float fraction = 2 * pi / (phi.back() - phi.front());
    symmetry_ = int(std::lround(fraction));
    if (std::abs(fraction - float(symmetry_)) > 0.05f || (symmetry_ != 1 && symmetry_ != 2 && symmetry_ != 4))
      throw Error("the angles of field 'phi_i' cover neither a circle, a half nor a quarter of it");
    if (symmetry_ > 1 && (std::abs(phi.front() + pi) > 0.01f))
      throw Error("the angles of field 'phi_i', which cover a part of the circle, do not begin at -pi");
  }
  grid_ = ParameterGrid(phi, theta);
  const std::vector<std::uint64_t> slices = {phi.size(), theta.size()};

  const std::vector<std::uint8_t> jacobian = file.bytes(file.field("jacobian", Type::uint8, 1));
  jacobian_ = jacobian.front() != 0;
  ndf_ = tables(file, "ndf", {});
  sigma_ = tables(file, "sigma", {});
  SquareTables vndf = tables(file, "vndf", slices), luminance = tables(file, "luminance", slices);
  require_at_least(0, ndf_, "ndf");
  require_at_least(1e-6f, sigma_, "sigma");
  require_at_least(0, vndf, "vndf");
  require_at_least(0, luminance, "luminance");

  std::uint64_t channels = 3;
  const bool spectral = file.has("wavelengths");
  if (spectral) {
    wavelengths_ = parameter(file, "wavelengths", 4096);
    if (wavelengths_.size() < 2 || !(wavelengths_.front() > 100 && wavelengths_.back() < 1e5f))
      throw Error("the wavelengths do not look like such, in nanometres");
    channels = wavelengths_.size();
  }
  spectra_ = interleaved(tables(file, spectral ? "spectra" : "rgb", {phi.size(), theta.size(), channels}), channels);
  if (spectra_.width() != luminance.width() || spectra_.height() != luminance.height())
    throw Error("the spectra and the luminance are tabulated at different points");
  vndf_ = Warp2D(vndf.width(), vndf.height(), std::move(vndf.values()));
  luminance_ = Warp2D(luminance.width(), luminance.height(), std::move(luminance.values()));
  estimate_albedo(symmetric);
}

RglChannels RglData::channels(const Wavelengths& w) const {
  RglChannels c;
  c.spectral = !wavelengths_.empty();
  for (size_t i = 0; c.spectral && i < spectrum_size; ++i)
    std::tie(c.index[i], c.fraction[i]) = find_interval(wavelengths_, w[int(i)]);
  return c;
}

RglData::Incident RglData::incident(const Vector3& from) const {
  Incident i;
  i.direction = from;
  if (symmetry_ >= 2) {  // into the half circle y <= 0 by half a turn, or into the quarter x, y <= 0 by mirroring
    i.flip_y = from.y > 0 ? -1.0f : 1.0f;
    i.flip_x = symmetry_ == 2 ? i.flip_y : from.x > 0 ? -1.0f : 1.0f;
    i.direction = {i.flip_x * from.x, i.flip_y * from.y, from.z};
  }
  const float theta = elevation(i.direction);
  i.phi = std::atan2(i.direction.y, i.direction.x);
  if (symmetry_ >= 2 && i.phi > 0) i.phi -= 2 * pi;  // phi = pi, where y is 0
  i.blend = grid_.locate(i.phi, theta);
  if (jacobian_) i.area = sigma_.at({elevation_to_unit(theta), azimuth_to_unit(i.phi)}, {1, {0}, {1}});
  return i;
}

Point2 RglData::place(const Vector3& half, float phi_incident) const {
  const float v = azimuth_to_unit(std::atan2(half.y, half.x) - (isotropic_ ? phi_incident : 0));
  return {elevation_to_unit(elevation(half)), v - std::floor(v)};
}

RglData::Answer RglData::answer(const Vector3& from, const Vector3& to) const {
  const Incident i = incident(from);
  const Vector3 half = normalize(i.direction + Vector3{i.flip_x * to.x, i.flip_y * to.y, to.z});
  const Point2 u = place(half, i.phi);
  return {vndf_.invert(u, i.blend).point, jacobian_ ? ndf_.at(u, {1, {0}, {1}}) / (4 * i.area) : 1, i.blend};
}

Spectrum RglData::evaluate(const Vector3& from, const Vector3& to, const RglChannels& c, const Wavelengths& w) const {
  if (!(from.z > 0 && to.z > 0)) return {};
  const Answer a = answer(from, to);
  if (c.spectral) {
    Spectrum sum;
    spectra_.gather(a.place, a.blend, [&](const float* v, float weight) {
      detail::Lanes at;
      for (size_t i = 0; i < spectrum_size; ++i) at[i] = lerp(c.fraction[i], v[c.index[i]], v[c.index[i] + 1]);
      sum += weight * Spectrum(at);
    });
    return a.factor * sum;
  }
  float rgb[3] = {0, 0, 0};
  spectra_.gather(a.place, a.blend, [&](const float* v, float weight) {
    for (int k = 0; k < 3; ++k) rgb[k] += a.factor * weight * v[k];
  });
  return rgb_spectrum(*space_, rgb[0], rgb[1], rgb[2], ColorUse::coefficient, w);
}

float RglData::pdf(const Vector3& from, const Vector3& to) const {
  if (!(from.z > 0 && to.z > 0)) return 0;
  const Incident i = incident(from);
  const Vector3 half = normalize(i.direction + Vector3{i.flip_x * to.x, i.flip_y * to.y, to.z});
  const Point2 u = place(half, i.phi);
  const Warp2D::Placed s = vndf_.invert(u, i.blend);
  const float sine = std::sqrt(half.x * half.x + half.y * half.y);
  return luminance_.pdf(s.point, i.blend) * s.pdf /
         (half_vector_stretch(u.x, sine) * 4 * std::max(dot(i.direction, half), 1e-10f));
}

Vector3 RglData::sample(const Vector3& from, Point2 uniform) const {
  const Incident i = incident(from);
  const Point2 s = luminance_.sample(uniform, i.blend).point;
  const Point2 u = vndf_.sample(s, i.blend).point;
  const float theta = u.x * u.x * (pi / 2), phi = (2 * u.y - 1) * pi + (isotropic_ ? i.phi : 0);
  const Vector3 half{std::cos(phi) * std::sin(theta), std::sin(phi) * std::sin(theta), std::cos(theta)};
  const Vector3 to = normalize(2 * dot(i.direction, half) * half - i.direction);
  return {i.flip_x * to.x, i.flip_y * to.y, to.z};
}

// For each point of the parameter grid: the mean of f cos / pdf over a few samples, spread evenly.
void RglData::estimate_albedo(bool symmetric) {
  constexpr int side = 8;
  const size_t channels = size_t(spectra_.channels());
  albedo_.assign(grid_.size() * channels, 0);
  for (size_t table = 0; table < grid_.size(); ++table) {
    float* sum = &albedo_[table * channels];
    const auto add = [&](const Vector3& from, const Vector3& to, float factor) {
      const Answer a = answer(from, to);
      spectra_.gather(a.place, a.blend, [&](const float* v, float weight) {
        for (size_t c = 0; c < channels; ++c) sum[c] += factor * a.factor * weight * v[c];
      });
    };
    const float phi = grid_.first()[table / grid_.second().size()];
    const float theta = std::min(grid_.second()[table % grid_.second().size()], 1.565f);
    const Vector3 from{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    for (int n = 0; n < side * side; ++n) {
      const Vector3 to = sample(from, {(float(n % side) + 0.5f) / side, (float(n / side) + 0.5f) / side});
      if (!(to.z > 0)) continue;
      // Limits the weight of directions that are hardly ever sampled.
      const float factor = 1 / (side * side * std::max(pdf(from, to), 0.1f * inverse_pi * to.z));
      const float share = symmetric ? to.z / (from.z + to.z) : 1;
      add(from, to, factor * share);
      if (symmetric) add(to, from, factor * share);
    }
    for (size_t c = 0; c < channels; ++c) largest_albedo_ = std::max(largest_albedo_, sum[c]);
  }
}

Spectrum RglData::albedo(const Vector3& from, const RglChannels& c, const Wavelengths& w) const {
  const Incident i = incident(from);
  const size_t channels = size_t(spectra_.channels());
  Spectrum sum;
  float rgb[3] = {0, 0, 0};
  for (int k = 0; k < i.blend.count; ++k) {
    const float* v = &albedo_[i.blend.table[size_t(k)] * channels];
    const float weight = i.blend.weight[size_t(k)];
    for (size_t n = 0; n < spectrum_size && c.spectral; ++n)
      sum.set(int(n), sum[int(n)] + weight * lerp(c.fraction[n], v[c.index[n]], v[c.index[n] + 1]));
    for (size_t n = 0; n < 3 && !c.spectral; ++n) rgb[n] += weight * v[n];
  }
  return c.spectral ? sum : rgb_spectrum(*space_, rgb[0], rgb[1], rgb[2], ColorUse::coefficient, w);
}

}  // namespace etendue
