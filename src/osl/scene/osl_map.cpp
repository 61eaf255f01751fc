#include "osl_map.h"

#include <fmt/format.h>

#include "osl_part.h"

namespace etendue::osl {

namespace {

float positive(float x) { return x > 0 ? x : 0; }

/// What a shader computes without a number, of points far away for example, is 0.
Triple finite(Triple c) {
  for (int i = 0; i < 3; ++i)
    if (!std::isfinite(c[i])) c[i] = 0;
  return c;
}

}  // namespace

void GroupMap::build_map(const Component& self, Network network, const std::string& last, const std::string& wanted) {
  displaces_ = wanted.empty();
  build_group(self, std::move(network), last, displaces_ ? std::vector<std::string>{} : std::vector{wanted});
  const Type& t = output().type;
  if (displaces_ || (!t.is_array() && (t.is_float() || t.is_int() || t.is_triple()))) return;
  // As a layer of an OslGroup it is of use; what takes its value as a map's hears of it.
  no_value_ = fmt::format(
      "{}: the output '{}' is a {}, and a map is a number or a color: it can be connected to a parameter of "
      "another shader only",
      name(), wanted, t.name());
  place_ = self.location_of();
}

Spectrum GroupMap::color(const SurfacePoint& p, const Wavelengths& w, ColorUse use) const {
  const Triple c = value_at(p, &w);
  if (single()) return Spectrum(use == ColorUse::reflectance ? clamp(c.x, 0, 1) : c.x);
  return rgb_spectrum(space(), positive(c.x), positive(c.y), positive(c.z), use, w);
}

float GroupMap::scalar(const SurfacePoint& p) const {
  const Triple c = value_at(p, nullptr);
  return single() ? c.x : (c.x + c.y + c.z) / 3;
}

void GroupMap::rgb(const SurfacePoint& p, float out[3]) const {
  const Triple c = value_at(p, nullptr);
  for (int i = 0; i < 3; ++i) out[i] = c[i];
}

Triple GroupMap::value_at(const SurfacePoint& p, const Wavelengths* w) const {
  if (!no_value_.empty()) throw Error(no_value_, place_);
  return finite(value(Run(*this, p, w)));
}

Triple GroupMap::value(const Run& run) const {
  if (displaces_) {
    // P was seen from the front or from behind, and so was N; the displacement is that along the front's normal.
    const float d = dot(run.globals().P.value - run.P_before(), run.N_before());
    return Triple(run.from_behind() ? -d : d);
  }
  if (output().type.is_triple()) return *reinterpret_cast<const Triple*>(run.output());
  if (output().type.is_int()) return Triple(float(*reinterpret_cast<const int*>(run.output())));
  return Triple(*reinterpret_cast<const float*>(run.output()));
}

namespace {

class OslMap final : public GroupMap, public OslPart {
 public:
  explicit OslMap(const ClassInfo& info) : OslPart(info) {}
  const ClassInfo& class_info() const override { return info(); }
  const Component& component() const override { return *this; }

  std::string map_output() const override {
    if (osl_class().outputs.empty()) return {};
    std::string wanted = osl_class().outputs.front();
    if (const auto given = declared_values.find("output"); given != declared_values.end())
      if (const auto* text = given->second.as<std::string>()) wanted = *text;
    const bool displaces = osl_class().shader->kind == Shader::Kind::displacement && wanted == "displacement";
    return displaces ? std::string() : wanted;
  }

  void prepare() override {
    const std::string wanted = map_output();
    Network network;
    const std::string layer = network.add(*this);
    build_map(*this, std::move(network), layer, wanted.empty() ? wanted : layer + "." + wanted);
  }
};

}  // namespace

Ref<etendue::Component> make_map(const ClassInfo& info) { return Ref<etendue::Component>(etendue::make<OslMap>(info)); }

}  // namespace etendue::osl
