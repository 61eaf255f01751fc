#include "values.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdlib>

#include "etendue/describe/color.h"

namespace etendue::mitsuba {

namespace {

constexpr const char* separators = " \t\r\n,";
constexpr size_t most_numbers = 1'000'000;

std::string_view trimmed(std::string_view s) {
  const size_t first = s.find_first_not_of(" \t\r\n");
  return first == std::string_view::npos ? std::string_view{} : s.substr(first, s.find_last_not_of(" \t\r\n") + 1 - first);
}

std::string shortened(std::string_view s) { return s.size() > 40 ? std::string(s.substr(0, 37)) + "..." : std::string(s); }

double one_number(std::string_view s, Location at) {
  std::string_view digits = trimmed(s);
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0;
  const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (code == std::errc::invalid_argument || end != digits.data() + digits.size())
    throw Error(fmt::format("a number is expected, not '{}'", shortened(s)), at);
  // from_chars does not distinguish overflow from underflow; underflow gives 0.
  if (code == std::errc::result_out_of_range && std::abs(std::strtod(std::string(digits).c_str(), nullptr)) < 1) return 0;
  if (code != std::errc{} || !std::isfinite(value) || std::abs(value) > 1e38)
    throw Error(fmt::format("'{}' is not a number that can be used: it must be finite and below 1e38", shortened(s)), at);
  return value;
}

std::vector<std::string_view> split(std::string_view s, const char* at) {
  std::vector<std::string_view> words;
  for (size_t from = s.find_first_not_of(at); from != std::string_view::npos; from = s.find_first_not_of(at, from)) {
    const size_t to = std::min(s.find_first_of(at, from), s.size());
    words.push_back(s.substr(from, to - from));
    from = to;
  }
  return words;
}

}  // namespace

double parse_number(const Text& t) { return one_number(t.text, t.at); }

std::int64_t parse_integer(const Text& t) {
  std::string_view s = trimmed(t.text);
  if (s.starts_with('+')) s.remove_prefix(1);
  std::int64_t value = 0;
  const auto [end, code] = std::from_chars(s.data(), s.data() + s.size(), value);
  if (code != std::errc{} || end != s.data() + s.size() || std::abs(double(value)) > 1e15)
    throw Error(fmt::format("an integer is expected, not '{}'", shortened(t.text)), t.at);
  return value;
}

bool parse_boolean(const Text& t) {
  const std::string_view s = trimmed(t.text);
  if (s == "true" || s == "True" || s == "1") return true;
  if (s == "false" || s == "False" || s == "0") return false;
  throw Error(fmt::format("true or false is expected, not '{}'", shortened(s)), t.at);
}

std::vector<double> parse_numbers(const Text& t) {
  std::vector<double> numbers;
  for (const std::string_view word : split(t.text, separators)) {
    numbers.push_back(one_number(word, t.at));
    if (numbers.size() > most_numbers) throw Error(fmt::format("more than {} numbers", most_numbers), t.at);
  }
  return numbers;
}

ColorValue parse_rgb(const Text& t, bool encoded) {
  ColorValue c;
  const std::string_view s = trimmed(t.text);
  if (s.starts_with('#')) {
    unsigned value = 0;
    const auto [end, code] = std::from_chars(s.data() + 1, s.data() + s.size(), value, 16);
    if (s.size() != 7 || code != std::errc{} || end != s.data() + s.size())
      throw Error(fmt::format("a colour such as '#ff8000' is expected, not '{}'", shortened(s)), t.at);
    for (int i = 0; i < 3; ++i) c.rgb[i] = double(value >> (16 - 8 * i) & 255) / 255;
  } else {
    const std::vector<double> numbers = parse_numbers(t);
    if (numbers.size() != 1 && numbers.size() != 3)
      throw Error(fmt::format("a colour has one number or three, not {}", numbers.size()), t.at);
    for (size_t i = 0; i < 3; ++i) c.rgb[i] = numbers[numbers.size() == 1 ? 0 : i];
  }
  if (encoded)
    for (double& x : c.rgb) x = decode_transfer("srgb", x);
  c.color = rgb_color("srgb", c.rgb[0], c.rgb[1], c.rgb[2]);
  return c;
}

ColorValue parse_xyz(const Text& t) {
  const std::vector<double> xyz = parse_numbers(t);
  if (xyz.size() != 3) throw Error(fmt::format("a colour in XYZ has three numbers, not {}", xyz.size()), t.at);
  const std::array<double, 9>& m = rgb_space("srgb").from_xyz;
  ColorValue c;
  for (size_t i = 0; i < 3; ++i) c.rgb[i] = std::max(m[3 * i] * xyz[0] + m[3 * i + 1] * xyz[1] + m[3 * i + 2] * xyz[2], 0.0);
  c.color = rgb_color("srgb", c.rgb[0], c.rgb[1], c.rgb[2]);
  return c;
}

ColorValue constant_spectrum(double value) {
  ColorValue c;
  c.kind = ColorValue::Kind::flat;
  c.color = flat_spectrum(float(value));
  for (double& x : c.rgb) x = value;
  return c;
}

ColorValue parse_spectrum(const Text& t) {
  if (t.text.find(':') == std::string::npos) {
    const std::vector<double> numbers = parse_numbers(t);
    if (numbers.size() == 3) return parse_rgb(t, false);  // Mitsuba before 2 reads three numbers as red, green and blue
    if (numbers.size() != 1)
      throw Error(fmt::format("a spectrum is one number or pairs of wavelength and value such as '400:0.1, 700:0.9', not '{}'",
                              shortened(t.text)),
                  t.at);
    return constant_spectrum(numbers[0]);
  }
  std::vector<float> wavelengths, values;
  for (const std::string_view word : split(t.text, separators)) {
    const size_t colon = word.find(':');
    if (colon == std::string_view::npos)
      throw Error(fmt::format("wavelength and value are expected, such as '400:0.1', not '{}'", shortened(word)), t.at);
    wavelengths.push_back(float(one_number(word.substr(0, colon), t.at)));
    values.push_back(float(one_number(word.substr(colon + 1), t.at)));
    if (values.size() > most_numbers) throw Error(fmt::format("more than {} numbers", most_numbers), t.at);
  }
  try {
    ColorValue c;
    c.kind = ColorValue::Kind::table;
    c.color = table_spectrum(std::move(wavelengths), std::move(values));
    return c;
  } catch (const Error& error) {
    throw Error(error.what(), t.at);
  }
}

ColorValue file_spectrum_value(const std::string& path, Location at) {
  try {
    ColorValue c;
    c.kind = ColorValue::Kind::table;
    c.color = file_spectrum({path, {}});
    return c;
  } catch (const Error& error) {
    throw Error(error.what(), at);
  }
}

FrameAbout frame_about(const DoubleVector3& way) {
  const double l = length(way);
  const DoubleVector3 n{way.x / l, way.y / l, way.z / l};
  const double sign = std::copysign(1.0, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
  return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

DoubleVector3 parse_vector(const pugi::xml_node& node, const Attributes& attribute, const PlaceOf& place, double otherwise) {
  if (const auto text = attribute(node, "value")) {
    const std::vector<double> n = parse_numbers(*text);
    if (n.size() == 1) return {n[0], n[0], n[0]};
    if (n.size() == 3) return {n[0], n[1], n[2]};
    throw Error(fmt::format("one number or three are expected, not {}", n.size()), text->at);
  }
  double v[3] = {otherwise, otherwise, otherwise};
  bool any = false;
  for (int i = 0; i < 3; ++i) {
    const char name[2] = {char('x' + i), 0};
    if (const auto text = attribute(node, name)) v[i] = parse_number(*text), any = true;
  }
  if (!any) throw Error(fmt::format("<{}> has neither a value nor x, y or z", node.name()), place(node));
  return {v[0], v[1], v[2]};
}

namespace {

Transform matrix_of(const Text& text) {
  const std::vector<double> m = parse_numbers(text);
  if (m.size() == 9) return Transform(Transform::DoubleMatrix{m[0], m[1], m[2], 0, m[3], m[4], m[5], 0, m[6], m[7], m[8], 0});
  if (m.size() != 16) throw Error(fmt::format("a matrix has 9 or 16 numbers, not {}", m.size()), text.at);
  if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] == 0)
    throw Error("the last row of a matrix must be 0 0 0 1: projections are not read", text.at);
  Transform::DoubleMatrix rows;
  for (size_t i = 0; i < 12; ++i) rows[i] = m[i] / m[15];
  return Transform(rows);
}

/// Rodrigues' formula with the axis unnormalized: Mitsuba 2 and 3 do not normalize it, unlike earlier versions. With an axis of
/// another length the result is no rotation but also scales.
Transform rotation_as_there(double radians, const DoubleVector3& a) {
  if (std::abs(length(a) - 1) < 1e-6) return Transform::rotate(radians, a);
  const double s = std::sin(radians), c = std::cos(radians), d = 1 - c;
  return Transform(Transform::DoubleMatrix{c + d * a.x * a.x, d * a.x * a.y - s * a.z, d * a.x * a.z + s * a.y, 0,
                                           d * a.x * a.y + s * a.z, c + d * a.y * a.y, d * a.y * a.z - s * a.x, 0,
                                           d * a.x * a.z - s * a.y, d * a.y * a.z + s * a.x, c + d * a.z * a.z, 0});
}

TransformValue::LookAt look_at_of(const pugi::xml_node& node, const Attributes& attribute, const PlaceOf& place) {
  const auto three = [&](const char* name) -> std::optional<DoubleVector3> {
    const auto text = attribute(node, name);
    if (!text) return std::nullopt;
    const std::vector<double> n = parse_numbers(*text);
    if (n.size() != 3) throw Error(fmt::format("'{}' has three numbers, not {}", name, n.size()), text->at);
    return DoubleVector3{n[0], n[1], n[2]};
  };
  const auto from = three("origin"), to = three("target");
  if (!from || !to) throw Error("<lookat> needs an origin and a target", place(node));
  const DoubleVector3 way{to->x - from->x, to->y - from->y, to->z - from->z};
  if (!(length(way) > 0)) throw Error("the target of <lookat> is its origin", place(node));
  DoubleVector3 up = three("up").value_or(DoubleVector3{0, 0, 0});
  if (length(up) == 0) up = frame_about(way).u;
  if (!(length(cross(way, up)) > 1e-9 * length(way) * length(up)))
    throw Error("'up' of <lookat> points along the line of sight", place(node));
  return {{from->x, from->y, from->z}, {to->x, to->y, to->z}, up};
}

}  // namespace

TransformValue parse_transform(const pugi::xml_node& node, const Attributes& attribute, const PlaceOf& place, bool old) {
  Transform all;
  std::optional<TransformValue::LookAt> look_at;
  int count = 0;
  for (const pugi::xml_node& child : node.children()) {
    if (child.type() != pugi::node_element) continue;
    const std::string_view tag = child.name();
    Transform step;
    if (tag == "translate") {
      step = Transform::translate(parse_vector(child, attribute, place, 0));
    } else if (tag == "scale") {
      step = Transform::scale(parse_vector(child, attribute, place, 1));
    } else if (tag == "rotate") {
      const auto angle = attribute(child, "angle");
      if (!angle) throw Error("<rotate> needs an angle", place(child));
      const DoubleVector3 axis = parse_vector(child, attribute, place, 0);
      const double radians = parse_number(*angle) * std::numbers::pi / 180;
      // Programs write rotations by angle 0 without an axis, which Mitsuba 3.9 refuses. With another angle a missing axis is an
      // error.
      if (!(length(axis) > 0) && radians != 0) throw Error("<rotate> needs an axis other than zero", place(child));
      step = radians == 0 ? Transform() : old ? Transform::rotate(radians, axis) : rotation_as_there(radians, axis);
    } else if (tag == "matrix") {
      const auto value = attribute(child, "value");
      if (!value) throw Error("<matrix> needs a value", place(child));
      step = matrix_of(*value);
    } else if (tag == "lookat" || tag == "lookAt" || tag == "look_at") {
      look_at = look_at_of(child, attribute, place);
      step = Transform::look_at(look_at->from, look_at->to, look_at->up);
    } else {
      throw Error(fmt::format("<{}> is no transform{}", tag,
                              suggestion(std::string(tag), {"translate", "scale", "rotate", "matrix", "lookat"})),
                  place(child));
    }
    all = step * all;
    ++count;
  }
  TransformValue value{all, std::nullopt};
  if (count == 1) value.look_at = look_at;
  return value;
}

}  // namespace etendue::mitsuba
