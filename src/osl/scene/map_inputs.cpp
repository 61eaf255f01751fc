#include "map_inputs.h"

#include <fmt/format.h>

#include <array>

#include "components/maps/footprint.h"
#include "components/maps/rgb_source.h"
#include "etendue/describe/color.h"
#include "parameter_values.h"

namespace etendue::osl {

namespace {

/// A spectrum's colour, from its values at evenly spaced wavelengths: the weights of each wavelength for red, green and blue,
/// under the space's white, so that a perfect white is exactly 1, 1, 1.
class SampledColor {
 public:
  static constexpr int groups = 4;
  SampledColor() {
    const RgbSpace& space = rgb_space("srgb");
    constexpr int count = groups * spectrum_size;
    constexpr float low = 380, high = 720;  // outside the eye's response is below 1/1000 of its maximum
    for (int g = 0; g < groups; ++g) {
      std::array<float, spectrum_size> lambda, pdf;
      for (int i = 0; i < spectrum_size; ++i) {
        lambda[size_t(i)] = low + (high - low) * (float(g + groups * i) + 0.5f) / count;
        pdf[size_t(i)] = 1 / (high - low);
        const Xyz eye = observer(lambda[size_t(i)]);
        const float light = space.illuminant->at(lambda[size_t(i)], ColorUse::radiance);
        for (size_t c = 0; c < 3; ++c)
          weights_[size_t(g)][size_t(i)][int(c)] =
              light * float(space.from_xyz[3 * c] * double(eye.x) + space.from_xyz[3 * c + 1] * double(eye.y) +
                            space.from_xyz[3 * c + 2] * double(eye.z));
      }
      wavelengths_[size_t(g)] = Wavelengths(lambda, pdf);
    }
    Triple sum(0);
    for (const auto& group : weights_)
      for (const Triple& w : group) sum = sum + w;
    for (auto& group : weights_)
      for (Triple& w : group)
        for (int c = 0; c < 3; ++c) w[c] /= sum[c];
  }

  Triple of(const ObjectMap& map, const SurfacePoint& p) const {
    Triple rgb(0);
    for (size_t g = 0; g < groups; ++g) {
      const Spectrum s = map.color(p, wavelengths_[g], ColorUse::coefficient);
      for (int i = 0; i < spectrum_size; ++i) rgb = rgb + weights_[g][size_t(i)] * s[i];
    }
    return rgb;
  }

 private:
  Wavelengths wavelengths_[groups];
  std::array<std::array<Triple, spectrum_size>, groups> weights_;
};

Triple rgb_at(const ObjectMap& map, const SurfacePoint& p) {
  if (const RgbSource* source = rgb_source(map)) {
    float c[3];
    source->rgb(p, c);
    const std::string space = source->rgb_space_name();
    return space == "srgb" ? Triple(c[0], c[1], c[2]) : converted({c[0], c[1], c[2]}, rgb_space(space), rgb_space("srgb"));
  }
  static const SampledColor sampled;
  return sampled.of(map, p);
}

/// The point that lies an axis of the footprint away, on the plane that touches the surface.
SurfacePoint moved(const SurfacePoint& p, const Vector3& object_axis, const Vector3& axis, const Vector2& uv) {
  SurfacePoint q = p;
  q.position = q.position + axis;
  q.object_position = q.object_position + object_axis;
  q.uv.x += uv.x;
  q.uv.y += uv.y;
  return q;
}

template <class T, class F>
Dual<T> with_derivatives(const SurfacePoint& p, bool derivatives, const F& value) {
  Dual<T> d(value(p));
  if (!derivatives || !(p.footprint > 0)) return d;
  const Footprint world = footprint_of(p), object = object_footprint(p);
  const UvFootprint uv = uv_footprint(p);
  d.dx = value(moved(p, object.longer, world.longer, uv.longer)) - d.value;
  d.dy = value(moved(p, object.shorter, world.shorter, uv.shorter)) - d.value;
  return d;
}

}  // namespace

const String* MapInputs::add(Ref<ObjectMap> map) {
  const String* name = intern_string(fmt::format("etendue:map {}", maps_.size()));
  maps_.emplace_back(name, std::move(map));
  return name;
}

Dual<float> number_of(const ObjectMap& map, const SurfacePoint& p, bool derivatives) {
  return with_derivatives<float>(p, derivatives, [&](const SurfacePoint& at) { return map.scalar(at); });
}

Dual<Triple> color_of(const ObjectMap& map, const SurfacePoint& p, bool derivatives) {
  return with_derivatives<Triple>(p, derivatives, [&](const SurfacePoint& at) { return rgb_at(map, at); });
}

}  // namespace etendue::osl
