// Rows of the table: geometric functions.

#include "choose.h"
#include "numbers.h"
#include "parts.h"
#include "services.h"

namespace etendue::osl {

namespace {

// The functions below are templates over whether the result has derivatives: V is a triple, N a number, each of its kind.
template <bool D>
using V = Number<Triple, D>;
template <bool D>
using N = Number<float, D>;

struct Dot {
  template <bool D>
  static void evaluate(const Call& c) {
    c.give(dot(c.get<V<D>>(0), c.get<V<D>>(1)));
  }
};

struct Cross {
  template <bool D>
  static void evaluate(const Call& c) {
    c.give(cross(c.get<V<D>>(0), c.get<V<D>>(1)));
  }
};

struct Length {
  template <bool D>
  static void evaluate(const Call& c) {
    c.give(length(c.get<V<D>>(0)));
  }
};

struct Distance {
  template <bool D>
  static void evaluate(const Call& c) {
    c.give(length(c.get<V<D>>(0) - c.get<V<D>>(1)));
  }
};

/// From q to the segment from a to b.
struct DistanceToSegment {
  template <bool D>
  static void evaluate(const Call& c) {
    const V<D> a = c.get<V<D>>(0), b = c.get<V<D>>(1), q = c.get<V<D>>(2), d = b - a;
    const N<D> square = dot(d, d);
    if (value_of(square) == 0) return c.give(length(q - a));
    const N<D> t = clamped(N<D>(dot(q - a, d) / square), N<D>(0), N<D>(1));
    c.give(length(q - (a + t * d)));
  }
};

struct Normalize {
  template <bool D>
  static void evaluate(const Call& c) {
    c.give(normalized(c.get<V<D>>(0)));
  }
};

/// n, or -n if i.ref > 0.
struct FaceForward {
  template <bool D>
  static void evaluate(const Call& c) {
    const Triple reference = c.count() > 2 ? c.get<Triple>(2) : c.services.geometric_normal();
    const V<D> n = c.get<V<D>>(0);
    c.give(dot(c.get<Triple>(1), reference) > 0 ? -n : n);
  }
};

template <class Vector>
auto mirrored(const Vector& i, const Vector& n) {
  const auto twice = dot(n, i) + dot(n, i);
  return i - twice * n;
}

/// Snell's law; zero at total reflection.
template <class Vector, class Value>
Vector refracted(const Vector& i, const Vector& n, const Value& eta) {
  const Value cosine = dot(i, n), k = Value(1) - eta * eta * (Value(1) - cosine * cosine);
  if (value_of(k) < 0) return Vector(Triple(0));
  return eta * i - (eta * cosine + sqrt_or_zero(k)) * n;
}

struct Reflect {
  template <bool D>
  static void evaluate(const Call& c) {
    c.give(mirrored(c.get<V<D>>(0), c.get<V<D>>(1)));
  }
};

struct Refract {
  template <bool D>
  static void evaluate(const Call& c) {
    c.give(refracted(c.get<V<D>>(0), c.get<V<D>>(1), c.get<N<D>>(2)));
  }
};

/// The Fresnel equations for unpolarized light, and Snell's law: void fresnel(I, N, eta, output Kr, output Kt [, output R,
/// output T]). With c = |I.N| and g^2 = 1/eta^2 - 1 + c^2: Kr = 1/2 ((g - c)/(g + c))^2 (1 + ((c (g + c) - 1) / (c (g - c) +
/// 1))^2) (Cook and Torrance 1982), and Kt = (1 - Kr) eta^2.
void fresnel(const Call& call) {
  using D = Dual<float>;
  const Dual<Triple> i = call.get<Dual<Triple>>(0), n = call.get<Dual<Triple>>(1);
  const D eta = call.get<D>(2);
  D c = dot(i, n);
  if (c.value < 0) c = -c;
  const D square = D(1) / (eta * eta) - D(1) + c * c;
  D reflectance(1), transmittance(0);
  Dual<Triple> transmitted;
  if (square.value >= 0) {
    const D g = sqrt_or_zero(square), difference = g - c, sum = g + c;
    const D ratio = (c * sum - D(1)) / (c * difference + D(1)), quotient = difference / sum;
    reflectance = D(0.5f) * (D(1) + ratio * ratio) * (quotient * quotient);
    transmittance = (D(1) - reflectance) * (eta * eta);
    transmitted = refracted(i, n, eta);
  }
  call.give(3, reflectance);
  call.give(4, transmittance);
  if (call.count() > 5) {
    call.give(5, mirrored(i, n));
    call.give(6, transmitted);
  }
}

/// p turned by an angle about the axis through `from` (Rodrigues' formula):
/// v cos + (axis x v) sin + axis (axis.v) (1 - cos).
template <class Vector, class Value>
Vector rotated(const Vector& p, const Value& angle, const Vector& from, const Vector& along) {
  const Vector axis = normalized(along), v = p - from;
  Value sine, cosine;
  if constexpr (is_dual<Value>) {
    const float s = std::sin(angle.value), c = std::cos(angle.value);
    sine = chain(s, c, angle), cosine = chain(c, -s, angle);
  } else {
    sine = std::sin(angle), cosine = std::cos(angle);
  }
  return cosine * v + sine * cross(axis, v) + (dot(axis, v) * (Value(1) - cosine)) * axis + from;
}

struct RotateAboutAxis {
  template <bool D>
  static void evaluate(const Call& c) {
    c.give(rotated(c.get<V<D>>(0), c.get<N<D>>(1), V<D>(Triple(0)), c.get<V<D>>(2)));
  }
};

struct RotateAboutLine {
  template <bool D>
  static void evaluate(const Call& c) {
    const V<D> from = c.get<V<D>>(2);
    c.give(rotated(c.get<V<D>>(0), c.get<N<D>>(1), from, c.get<V<D>>(3) - from));
  }
};

constexpr Row rows[] = {
    {"float dot(vector a, vector b)", with_derivatives<Dot>},
    {"vector cross(vector a, vector b)", with_derivatives<Cross>},
    {"float length(vector v)", with_derivatives<Length>},
    {"float distance(point a, point b)", with_derivatives<Distance>},
    {"float distance(point a, point b, point q)", with_derivatives<DistanceToSegment>},
    {"normal normalize(normal v)", with_derivatives<Normalize>},
    {"vector normalize(vector v)", with_derivatives<Normalize>},
    {"vector faceforward(vector n, vector i, vector reference)", with_derivatives<FaceForward>},
    {"vector faceforward(vector n, vector i)", with_derivatives<FaceForward>, Derivatives::passed, 0, nullptr, false},
    {"vector reflect(vector i, vector n)", with_derivatives<Reflect>},
    {"vector refract(vector i, vector n, float eta)", with_derivatives<Refract>},
    {"void fresnel(vector i, normal n, float eta, output float kr, output float kt, output vector r, output vector t)",
     always<fresnel>},
    {"void fresnel(vector i, normal n, float eta, output float kr, output float kt)", always<fresnel>},
    {"point rotate(point p, float angle, point a, point b)", with_derivatives<RotateAboutLine>},
    {"point rotate(point p, float angle, vector axis)", with_derivatives<RotateAboutAxis>},
};

}  // namespace

std::span<const Row> geometry_rows() { return rows; }

}  // namespace etendue::osl
