// Rows of the table: colours in named spaces, luminance, black bodies, spectral lines.

#include <fmt/format.h>

#include "choose.h"
#include "numbers.h"
#include "parts.h"
#include "services.h"

namespace etendue::osl {

namespace {

// The conversions are templates over C, Triple or Dual<Triple>, and its number N. hsv, hsl: Foley, van Dam, Feiner, Hughes:
// Computer Graphics, Principles and Practice, 13.3.
template <class C>
using NumberOf = std::conditional_t<is_dual<C>, Dual<float>, float>;

template <class N>
N divided(const N& a, const N& b) {
  if constexpr (is_dual<N>)
    return a / b;
  else
    return safe_divide(a, b);
}

template <class C>
C hsv_to_rgb(const C& c) {
  using N = NumberOf<C>;
  const N s = c[1], v = c[2];
  if (value_of(s) < 0.0001f) return make_triple(v, v, v);
  const N turns = c[0], sixths = N(6) * (turns - N(std::floor(value_of(turns))));
  const int sector = value_of(sixths) >= 0 && value_of(sixths) < 6 ? int(value_of(sixths)) : 0;  // 0 for what is no number
  const N f = sixths - N(float(sector)), p = v * (N(1) - s), q = v * (N(1) - s * f), t = v * (N(1) - s * (N(1) - f));
  switch (sector) {
    case 0: return make_triple(v, t, p);
    case 1: return make_triple(q, v, p);
    case 2: return make_triple(p, v, t);
    case 3: return make_triple(p, q, v);
    case 4: return make_triple(t, p, v);
    default: return make_triple(v, p, q);
  }
}

template <class C>
C rgb_to_hsv(const C& c) {
  using N = NumberOf<C>;
  const N r = c[0], g = c[1], b = c[2], low = minimum(r, minimum(g, b)), high = maximum(r, maximum(g, b)), range = high - low;
  const N s = value_of(high) > 0 ? divided(range, high) : N(0);
  N h(0);
  if (value_of(s) > 0) {
    if (value_of(r) >= value_of(high))
      h = divided(g - b, range);
    else if (value_of(g) >= value_of(high))
      h = N(2) + divided(b - r, range);
    else
      h = N(4) + divided(r - g, range);
    h = h * N(1.0f / 6);
    if (value_of(h) < 0) h = h + N(1);
  }
  return make_triple(h, s, high);
}

template <class C>
C hsl_to_rgb(const C& c) {
  using N = NumberOf<C>;
  const N h = c[0], s = c[1], l = c[2];
  const N v = value_of(l) <= 0.5f ? N(l * (N(1) + s)) : N(l * (N(1) - s) + s);
  if (value_of(v) <= 0) return make_triple(N(0), N(0), N(0));
  return hsv_to_rgb(make_triple(h, divided(N(v - (l + l - v)), v), v));
}

template <class C>
C rgb_to_hsl(const C& c) {
  using N = NumberOf<C>;
  const C hsv = rgb_to_hsv(c);
  const N low = minimum(N(c[0]), minimum(N(c[1]), N(c[2]))), high = hsv[2], l = N(0.5f) * (low + high);
  N s(0);
  if (value_of(low) != value_of(high))
    s = value_of(l) <= 0.5f ? divided(high - low, high + low) : divided(high - low, N(2) - high - low);
  return make_triple(N(hsv[0]), s, l);
}

/// A linear map, by its columns for the three components: c.x a + c.y b + c.z d.
template <class F>
Triple linear(const Triple& c, F&& f) {
  return f(c);
}
template <class F>
Dual<Triple> linear(const Dual<Triple>& c, F&& f) {
  return {f(c.value), f(c.dx), f(c.dy)};
}

// The NTSC's YIQ (FCC 1953), with the decimals of the reference implementation.
Triple yiq_to_rgb(const Triple& c) {
  return {c.x + 0.9557f * c.y + 0.6199f * c.z, c.x - 0.2716f * c.y - 0.6469f * c.z, c.x - 1.1082f * c.y + 1.7051f * c.z};
}
Triple rgb_to_yiq(const Triple& c) {
  return {0.299f * c.x + 0.587f * c.y + 0.114f * c.z, 0.596f * c.x - 0.275f * c.y - 0.321f * c.z,
          0.212f * c.x - 0.523f * c.y + 0.311f * c.z};
}

template <class C>
C xyy_to_xyz(const C& c) {
  using N = NumberOf<C>;
  const N x = c[0], y = c[1], luminance = c[2], scale = value_of(y) > 1e-6f ? divided(luminance, y) : N(0);
  return make_triple(N(scale * x), luminance, N(scale * (N(1) - x - y)));
}

template <class C>
C xyz_to_xyy(const C& c) {
  using N = NumberOf<C>;
  const N sum = N(c[0]) + N(c[1]) + N(c[2]);
  if (value_of(sum) < 1e-6f) return make_triple(N(0), N(0), N(c[1]));
  return make_triple(divided(N(c[0]), sum), divided(N(c[1]), sum), N(c[1]));
}

enum class Space { rgb, hsv, hsl, yiq, xyz, xyy, other };

Space space_of(const Services& services, const String* name) {
  static const String* const names[][2] = {{intern_string("rgb"), intern_string("RGB")},
                                           {intern_string("hsv"), nullptr},
                                           {intern_string("hsl"), nullptr},
                                           {intern_string("YIQ"), nullptr},
                                           {intern_string("XYZ"), nullptr},
                                           {intern_string("xyY"), nullptr}};
  for (std::size_t i = 0; i < std::size(names); ++i)
    if (name == names[i][0] || name == names[i][1]) return Space(i);
  return ColorSystem::named(name->view()) == &services.color_system() ? Space::rgb : Space::other;
}

template <class C>
C to_rgb(const ColorSystem& system, Space from, const C& c) {
  const auto from_xyz = [&](const Triple& t) { return system.from_xyz(t); };
  switch (from) {
    case Space::hsv: return hsv_to_rgb(c);
    case Space::hsl: return hsl_to_rgb(c);
    case Space::yiq: return linear(c, yiq_to_rgb);
    case Space::xyz: return linear(c, from_xyz);
    case Space::xyy: return linear(xyy_to_xyz(c), from_xyz);
    default: return c;
  }
}

template <class C>
C from_rgb(const ColorSystem& system, Space to, const C& c) {
  const auto to_xyz = [&](const Triple& t) { return system.to_xyz(t); };
  switch (to) {
    case Space::hsv: return rgb_to_hsv(c);
    case Space::hsl: return rgb_to_hsl(c);
    case Space::yiq: return linear(c, rgb_to_yiq);
    case Space::xyz: return linear(c, to_xyz);
    case Space::xyy: return xyz_to_xyy(linear(c, to_xyz));
    default: return c;
  }
}

/// Between two linear RGB spaces through XYZ, without adaptation of the white; false if one is none.
bool between_systems(const Services& services, const String* from, const String* to, const Triple& c, Triple& out) {
  const auto system = [&](const String* name) {
    return space_of(services, name) == Space::rgb ? &services.color_system() : ColorSystem::named(name->view());
  };
  const ColorSystem *a = system(from), *b = system(to);
  if (a && b) out = b->from_xyz(a->to_xyz(c));
  return a && b;
}

/// Through the renderer, which has more spaces; derivatives by a finite difference, as its maps are black boxes.
template <class C>
C by_renderer(const Call& call, const String* from, const String* to, const C& c) {
  const auto one = [&](const Triple& t, Triple& out) {
    return call.services.transform_color(from, to, t, out) || between_systems(call.services, from, to, t, out);
  };
  Triple value;
  if (!one(value_of(c), value)) {
    call.services.error(fmt::format("Unknown color space transformation \"{}\" -> \"{}\"", from->text(), to->text()),
                        call.types.place);
    return c;
  }
  if constexpr (is_dual<C>) {
    constexpr float step = 0.001f;
    Triple x = value, y = value;
    one(c.value + c.dx * step, x);
    one(c.value + c.dy * step, y);
    return C(value, (x - value) * (1 / step), (y - value) * (1 / step));
  } else {
    return value;
  }
}

template <class C>
C transform_color(const Call& call, const String* from, const String* to, const C& c) {
  const Space a = space_of(call.services, from), b = space_of(call.services, to);
  if (a == Space::other || b == Space::other) return by_renderer(call, from, to, c);
  const ColorSystem& system = call.services.color_system();
  return a == b ? c : from_rgb(system, b, to_rgb(system, a, c));
}

/// transformc(from, to, c), transformc(to, c)
struct TransformColor {
  template <bool D>
  static void evaluate(const Call& c) {
    static const String* const rgb = intern_string("rgb");
    const bool both = c.count() > 2;
    c.give(transform_color(c, both ? c.string(0) : rgb, c.string(both ? 1 : 0), c.get<Number<Triple, D>>(both ? 2 : 1)));
  }
};

/// color(space, r, g, b), color(space, f)
struct ColorIn {
  template <bool D>
  static void evaluate(const Call& c) {
    using Value = Number<float, D>;
    static const String* const rgb = intern_string("rgb");
    const Value x = c.get<Value>(1), y = c.count() > 2 ? c.get<Value>(2) : x, z = c.count() > 2 ? c.get<Value>(3) : x;
    c.give(transform_color(c, c.string(0), rgb, make_triple(x, y, z)));
  }
};

struct Luminance {
  template <bool D>
  static void evaluate(const Call& c) {
    const ColorSystem& system = c.services.color_system();
    const auto x = c.get<Number<Triple, D>>(0);
    if constexpr (D)
      c.give(Dual<float>(system.luminance(x.value), system.luminance(x.dx), system.luminance(x.dy)));
    else
      c.give(system.luminance(x));
  }
};

/// A function of a number by central difference over 1/1000 of it: its slope is smooth enough.
template <Triple (ColorSystem::*function)(float) const>
struct OfNumber {
  template <bool D>
  static void evaluate(const Call& c) {
    const ColorSystem& system = c.services.color_system();
    const auto x = c.get<Number<float, D>>(0);
    const Triple value = (system.*function)(value_of(x));
    if constexpr (D) {
      const float step = std::max(1e-3f * std::abs(x.value), 1e-3f);
      const Triple slope = ((system.*function)(x.value + step) - (system.*function)(x.value - step)) * (0.5f / step);
      c.give(Dual<Triple>(value, slope * x.dx, slope * x.dy));
    } else {
      c.give(value);
    }
  }
};

constexpr Derivatives passed = Derivatives::passed;

// They are not pure: the renderer's colour space decides.
constexpr Row rows[] = {
    {"color color(string space, float f)", with_derivatives<ColorIn>, passed, 0, nullptr, false},
    {"color color(string space, float r, float g, float b)", with_derivatives<ColorIn>, passed, 0, nullptr, false},
    {"float luminance(color c)", with_derivatives<Luminance>, passed, 0, nullptr, false},
    {"color blackbody(float kelvin)", with_derivatives<OfNumber<&ColorSystem::blackbody>>, passed, 0, nullptr, false},
    {"color wavelength_color(float nanometres)", with_derivatives<OfNumber<&ColorSystem::wavelength>>, passed, 0, nullptr,
     false},
    {"color transformc(string from, string to, color c)", with_derivatives<TransformColor>, passed, 0, nullptr, false},
    {"color transformc(string to, color c)", with_derivatives<TransformColor>, passed, 0, nullptr, false},
};

}  // namespace

std::span<const Row> color_rows() { return rows; }

}  // namespace etendue::osl
