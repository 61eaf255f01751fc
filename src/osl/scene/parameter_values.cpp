#include "parameter_values.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstring>
#include <filesystem>

#include "etendue/describe/color.h"
#include "etendue/describe/description.h"
#include "osl_class.h"

namespace etendue::osl {

namespace {

etendue::Value value_at(const Constant& c, const Member& m, size_t i) {
  const auto floats = [&](size_t n) {
    std::vector<double> f;
    for (size_t k = 0; k < n; ++k) f.push_back(std::stod(fmt::format("{}", c.at<float>(n * i + k))));  // 0.1f as 0.1
    return f;
  };
  switch (c.type.base) {
    case Base::int_: {
      const int x = c.at<int>(i);
      return m.kind == Kind::boolean ? etendue::Value(x != 0) : etendue::Value(Number{double(x)});
    }
    case Base::float_: return etendue::Value(Number{std::stod(fmt::format("{}", c.at<float>(i)))});
    case Base::string: return etendue::Value(c.at<const String*>(i)->text());
    case Base::color:
      if (m.kind == Kind::color || m.kind == Kind::component) {
        const auto f = floats(3);
        return etendue::Value(rgb_color("srgb", f[0], f[1], f[2]));
      }
      [[fallthrough]];
    case Base::point:
    case Base::vector:
    case Base::normal: return etendue::Value(Numbers{floats(3), 1, Dimension::none});
    case Base::matrix: {
      // Points are rows in the language, and columns in the description, whose matrices have no fourth row.
      Transform::DoubleMatrix matrix;
      for (size_t r = 0; r < 3; ++r)
        for (size_t k = 0; k < 4; ++k) matrix[4 * r + k] = double(c.at<float>(16 * i + 4 * k + r));
      return etendue::Value(Transform(matrix));
    }
    default: return etendue::Value();
  }
}

/// Appends values as they lie in memory.
class Bytes {
 public:
  explicit Bytes(Constant& c) : bytes_(c.bytes) {}
  template <class T>
  void add(const T& v) {
    const auto* p = reinterpret_cast<const std::byte*>(&v);
    bytes_.insert(bytes_.end(), p, p + sizeof(T));
  }

 private:
  std::vector<std::byte>& bytes_;
};

template <class T, class F>
void each(const etendue::Value& value, const Member& m, const F& f) {
  if constexpr (!std::is_same_v<T, bool>) {  // there are no lists of booleans
    if (m.list) {
      std::vector<T> list;
      detail::Convert<std::vector<T>>::read(value, m, list);
      for (const T& x : list) f(x);
      return;
    }
  }
  T x{};
  detail::Convert<T>::read(value, m, x);
  f(x);
}

/// The name by which a shader opens a file that a scene names. What is not there as the scene says it stays as it was written,
/// so that it is looked for beside the shader, too.
std::string texture_name(const FilePath& file) {
  if (file.empty()) return {};
  const std::string path = file.resolved();
  std::error_code ignored;
  const bool elsewhere = std::filesystem::path(file.text).is_relative() && file.text.find("<UDIM>") == std::string::npos &&
                         !std::filesystem::exists(path, ignored);
  return elsewhere ? file.text : path;
}

}  // namespace

bool is_color(const Constant& c) {
  for (size_t i = 0; i < c.bytes.size() / sizeof(float); ++i)
    if (!(c.at<float>(i) >= 0 && c.at<float>(i) < 1e6f)) return false;
  return true;
}

etendue::Value value_of(const Constant& c, const Member& m) {
  if (!m.list) return value_at(c, m, 0);
  if (m.kind == Kind::number || m.kind == Kind::integer || m.kind == Kind::vector3 || m.kind == Kind::point3) {
    std::vector<double> all;  // row after row
    for (size_t i = 0; i < c.bytes.size() / sizeof(float); ++i)
      all.push_back(m.kind == Kind::integer ? double(c.at<int>(i)) : double(c.at<float>(i)));
    return etendue::Value(Numbers{all, 1, Dimension::none});
  }
  etendue::Value::List list;
  for (size_t i = 0; i < size_t(c.type.elements()); ++i) list.push_back(value_at(c, m, i));
  return etendue::Value(std::move(list));
}

etendue::Value empty_value(const Member& m) {
  if (m.list) return etendue::Value(etendue::Value::List{});
  switch (m.kind) {
    case Kind::boolean: return etendue::Value(false);
    case Kind::integer:
    case Kind::number: return etendue::Value(Number{});
    case Kind::color: return etendue::Value(flat_spectrum(0));
    case Kind::component: return etendue::Value();
    case Kind::transform: return etendue::Value(Transform());
    case Kind::vector3:
    case Kind::point3: return etendue::Value(Numbers{{0, 0, 0}, 1, Dimension::none});
    default: return etendue::Value(m.choices.empty() ? std::string() : m.choices.front());
  }
}

Triple rgb_of(const SpectralFunction& f) {
  const std::string text = f.expression();
  float r = 0, g = 0, b = 0;
  int end = 0;
  if (std::sscanf(text.c_str(), "rgb(%f, %f, %f)%n", &r, &g, &b, &end) == 3 && size_t(end) == text.size()) return {r, g, b};
  end = 0;
  if (std::sscanf(text.c_str(), "%f%n", &r, &end) == 1 && size_t(end) == text.size()) return Triple(r);
  const RgbSpace& space = rgb_space("srgb");
  const Xyz c = to_xyz(f, ColorUse::reflectance, space.illuminant.get());
  const auto& m = space.from_xyz;
  const auto channel = [&](size_t i) { return float(m[3 * i] * c.x + m[3 * i + 1] * c.y + m[3 * i + 2] * c.z); };
  return {channel(0), channel(1), channel(2)};
}

Triple converted(const Triple& c, const RgbSpace& from, const RgbSpace& to) {
  double xyz[3];
  Triple out;
  for (size_t i = 0; i < 3; ++i)
    xyz[i] = from.to_xyz[3 * i] * double(c.x) + from.to_xyz[3 * i + 1] * double(c.y) + from.to_xyz[3 * i + 2] * double(c.z);
  for (size_t i = 0; i < 3; ++i)
    out[int(i)] = float(to.from_xyz[3 * i] * xyz[0] + to.from_xyz[3 * i + 1] * xyz[1] + to.from_xyz[3 * i + 2] * xyz[2]);
  return out;
}

Constant constant_of(const Type& type, const Member& m, const etendue::Value& value) {
  Constant c;
  c.type = type;
  Bytes bytes(c);
  int count = 0;
  const auto add = [&](const auto& v) {
    bytes.add(v);
    ++count;
  };
  switch (m.kind) {
    case Kind::boolean: each<bool>(value, m, [&](bool x) { add(int(x)); }); break;
    case Kind::integer: each<std::int64_t>(value, m, [&](std::int64_t x) { add(int(x)); }); break;
    case Kind::number: each<double>(value, m, [&](double x) { add(float(x)); }); break;
    case Kind::string:
    case Kind::choice: each<std::string>(value, m, [&](const std::string& x) { add(intern_string(x)); }); break;
    case Kind::file: each<FilePath>(value, m, [&](const FilePath& x) { add(intern_string(texture_name(x))); }); break;
    case Kind::color: each<Color>(value, m, [&](const Color& x) { add(x ? rgb_of(*x) : Triple(0)); }); break;
    case Kind::vector3: each<Vector3>(value, m, [&](const Vector3& x) { add(Triple(x.x, x.y, x.z)); }); break;
    case Kind::point3:
      each<DoublePoint3>(value, m, [&](const DoublePoint3& x) { add(Triple(float(x.x), float(x.y), float(x.z))); });
      break;
    case Kind::transform: {
      AnimatedTransform t;
      detail::Convert<AnimatedTransform>::read(value, m, t);
      const auto& from = t.keys().front().transform.matrix();
      Matrix to;
      for (size_t r = 0; r < 3; ++r)
        for (size_t k = 0; k < 4; ++k) to.m[k][r] = from[4 * r + k];
      to.m[3][3] = 1;
      add(to);
      break;
    }
    default: throw Error("has no value in the language");
  }
  if (type.is_array()) {
    if (type.array > 0 && count != type.array)
      throw Error(fmt::format("needs {} values, not {}", type.array, count), value.location);
    c.type = type.as_array(count);
  }
  return c;
}

Constant constant_number(const Type& type, float x) {
  Constant c;
  c.type = type;
  Bytes(c).add(x);
  return c;
}

Constant constant_color(const Type& type, const SpectralFunction& color) {
  Constant c;
  c.type = type;
  Bytes(c).add(rgb_of(color));
  return c;
}

}  // namespace etendue::osl
