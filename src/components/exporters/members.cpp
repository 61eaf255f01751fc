#include "components/exporters/members.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <regex>

#include "asked_members.h"
#include "etendue/describe/description.h"
#include "etendue/describe/registry.h"
#include "etendue/phase_function.h"

namespace etendue {

namespace {

double shortest(double value) { return double(float(value)) == value ? std::stod(fmt::format("{}", float(value))) : value; }

}  // namespace

Value value_of(const Component& of, std::string_view member) {
  AskedMembers::note(of, member);
  return get(of, member);
}

double number_of(const Component& of, std::string_view member) {
  const Value value = value_of(of, member);
  const Number* n = value.as<Number>();
  if (!n) return 0;
  // Angles are stored in radians, and were floats in degrees.
  return n->dimension == Dimension::angle ? shortest(double(float(n->value * 180 / std::numbers::pi))) : shortest(n->value);
}
bool truth_of(const Component& of, std::string_view member) {
  const Value value = value_of(of, member);
  const bool* is = value.as<bool>();
  return is && *is;
}
std::string word_of(const Component& of, std::string_view member) {
  const Value value = value_of(of, member);
  if (const FilePath* path = value.as<FilePath>()) return path->empty() ? "" : path->resolved();
  const std::string* text = value.as<std::string>();
  return text ? *text : std::string();
}
Ref<Component> part_of(const Component& of, std::string_view member) {
  const Value value = value_of(of, member);
  const Ref<Component>* found = value.as<Ref<Component>>();
  return found ? *found : nullptr;
}
std::vector<double> numbers_of(const Component& of, std::string_view member) {
  const Value value = value_of(of, member);
  const Numbers* found = value.as<Numbers>();
  std::vector<double> all = found ? found->values : std::vector<double>();
  for (double& x : all) x = shortest(x);
  return all;
}
Color color_of(const Component& of, std::string_view member) {
  const Value value = value_of(of, member);
  if (const Color* found = value.as<Color>()) return *found;
  const Number* n = value.as<Number>();
  return n ? flat_spectrum(float(n->value)) : nullptr;
}
AnimatedTransform transform_of(const Component& of, std::string_view member) {
  const Value value = value_of(of, member);
  if (const auto* moving = value.as<AnimatedTransform>()) return *moving;
  const auto* still = value.as<Transform>();
  return still ? AnimatedTransform(*still) : AnimatedTransform();
}
const std::string& class_of(const Component& c) { return c.class_info().name; }

bool holds(const Component* part, std::initializer_list<std::string_view> classes) {
  if (!part) return false;
  if (std::ranges::find(classes, class_of(*part)) != classes.end()) return true;
  for (const Member& m : part->class_info().members)
    if (m.kind == Kind::component && !m.list)
      if (const Value value = get(*part, m.name); const auto* inner = value.as<Ref<Component>>())
        if (holds(inner->get(), classes)) return true;
  return false;
}

bool textured(const Component* shader) { return holds(shader, {"ImageMap", "CheckerMap", "UvTransformMap"}); }

Color constant_of(const Component& map) { return class_of(map) == "ConstantMap" ? color_of(map, "value") : nullptr; }

std::optional<std::array<double, 3>> written_rgb(const Color& c) {
  static const std::regex form(R"((?:([-+0-9.e]+) \* )?rgb\(([-+0-9.e]+), ([-+0-9.e]+), ([-+0-9.e]+)\))");
  std::smatch match;
  const std::string text = c->expression();
  if (!std::regex_match(text, match, form)) return std::nullopt;
  const double factor = match[1].matched ? std::stod(match[1]) : 1;
  return std::array<double, 3>{factor * std::stod(match[2]), factor * std::stod(match[3]), factor * std::stod(match[4])};
}

std::vector<std::pair<int, double>> sampled(const Color& c, ColorUse use) {
  std::vector<std::pair<int, double>> all;
  for (int nm = 360; nm <= 830; nm += 5) all.emplace_back(nm, double(c->at(float(nm), use)));
  return all;
}

std::array<double, 3> rgb_of(const Color& c, ColorUse use) {
  if (const auto written = written_rgb(c)) return *written;
  const Color white = illuminant_spectrum("D65");
  const Xyz xyz = to_xyz(*c, use, use == ColorUse::radiance ? nullptr : white.get());
  const auto& m = rgb_space("srgb").from_xyz;
  const double x = double(xyz.x), y = double(xyz.y), z = double(xyz.z);
  return {m[0] * x + m[1] * y + m[2] * z, m[3] * x + m[4] * y + m[5] * z, m[6] * x + m[7] * y + m[8] * z};
}

double field_of_view(const Component& camera) {
  const double focal_length = number_of(camera, "focal_length");
  if (!(focal_length > 0)) return number_of(camera, "fov");
  return 2 * std::atan(number_of(camera, "sensor_size") / 2 / focal_length) * 180 / std::numbers::pi;
}

bool is_spot(const Component& emission) {
  return class_of(emission) == "SpotEmission" || class_of(emission) == "ForeignSpotEmission";
}

std::string spot_edge(const Component& spot) { return class_of(spot) == "SpotEmission" ? "smooth" : word_of(spot, "edge"); }

bool turns_by_anisotropy_alone(const Component& medium) {
  const Ref<Component> phase = part_of(medium, "phase");
  return !phase || class_of(*phase) == "HenyeyGreensteinPhase";
}

double mean_cosine(const Component& medium) {
  const Ref<Component> phase = part_of(medium, "phase");
  return phase ? mean_cosine_of(*phase) : number_of(medium, "anisotropy");
}

double mean_cosine_of(const Component& phase_function) {
  if (class_of(phase_function) == "HenyeyGreensteinPhase") return number_of(phase_function, "anisotropy");
  // The mean cosine of samples with evenly spaced primary samples. A prepared copy is sampled, since exported components are
  // not prepared.
  const Ref<PhaseFunction> phase = ref_cast<PhaseFunction>(copy(phase_function));
  prepare_tree(*phase);
  constexpr int samples = 1 << 16;
  double sum = 0;
  for (int i = 0; i < samples; ++i) sum += 1 - double(phase->sample((float(i) + 0.5f) / samples));
  return sum / samples;
}

}  // namespace etendue
