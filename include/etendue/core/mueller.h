#pragma once
// Stokes vectors and Mueller matrices: polarized light, for the wavelengths of a path.
//
// A Stokes vector S = (S0, S1, S2, S3) describes light that travels in a direction d, relative to a reference direction x
// perpendicular to d. With y = d x x (so that x, y and d are right-handed) and the complex amplitudes E_x, E_y of the field,
//     S0 = <|E_x|^2 + |E_y|^2>,    S1 = <|E_x|^2 - |E_y|^2>,    S2 + i S3 = 2 <E_y E_x*>,
// where the field is the real part of E e^(i w t). S0 is the radiance; S1 is positive if light is polarized along x rather than
// y; S2 if along the diagonal of x and y rather than that of x and -y. Who looks towards the light sees x to the right and y
// up: angles are counter-clockwise for the receiver. S3 is positive if he sees the field turn clockwise: right circular light.
// These are the conventions of Collett 2005 (Field guide to polarization) and Goldstein 2003 (Polarized light, chapter 4), and
// of Mitsuba 3. Wilkie & Weidlich 2012 (Polarised light in computer graphics) tell of other ones.
//
// A Mueller matrix M is what matter does to light, S_out = M S_in, relative to a reference direction for the light that arrives
// and one for that which leaves.

#include "etendue/core/spectrum.h"
#include "etendue/core/vector.h"

namespace etendue {

/// The cosine and sine of twice an angle: Stokes vectors turn by twice the angle of their reference direction.
struct DoubleAngle {
  float cosine = 1, sine = 0;
};
/// Of the angle from x to x2, both perpendicular to the direction d in which light travels, counter-clockwise for the receiver.
inline DoubleAngle double_angle(const Vector3& x, const Vector3& x2, const Vector3& d) {
  const float c = dot(x, x2), s = dot(cross(d, x), x2), both = c * c + s * s;
  return both > 0 ? DoubleAngle{(c * c - s * s) / both, 2 * c * s / both} : DoubleAngle{};
}

class Mueller {
 public:
  /// 0: black.
  Mueller() = default;
  /// Nothing changes.
  static Mueller identity() { return diagonal(1, 1, 1); }
  /// The light is unpolarized.
  static Mueller depolarizer() { return diagonal(0, 0, 0); }
  static Mueller diagonal(float m11, float m22, float m33) {
    Mueller m;
    m(0, 0) = Spectrum(1.0f);
    m(1, 1) = Spectrum(m11);
    m(2, 2) = Spectrum(m22);
    m(3, 3) = Spectrum(m33);
    return m;
  }

  Spectrum& operator()(int row, int column) { return m_[row][column]; }
  const Spectrum& operator()(int row, int column) const { return m_[row][column]; }

  /// First b, then a.
  friend Mueller operator*(const Mueller& a, const Mueller& b) {
    Mueller product;
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 4; ++j) product.m_[i][j] += a.m_[i][k] * b.m_[k][j];
    return product;
  }
  Mueller& operator*=(const Spectrum& factor) {
    for (auto& row : m_)
      for (Spectrum& x : row) x *= factor;
    return *this;
  }
  Mueller& operator+=(const Mueller& b) {
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) m_[i][j] += b.m_[i][j];
    return *this;
  }

  /// The same relative to another reference direction of the light that arrives: `to_old` is the angle from the new to the old
  /// one. The product M R with the matrix R that turns Stokes vectors,
  ///     S1' = S1 cos + S2 sin,    S2' = S2 cos - S1 sin      (of twice the angle).
  Mueller& turn_in(const DoubleAngle& to_old) {
    for (auto& row : m_) {
      const Spectrum a = row[1], b = row[2];
      row[1] = a * to_old.cosine - b * to_old.sine;
      row[2] = a * to_old.sine + b * to_old.cosine;
    }
    return *this;
  }
  /// The same for the light that leaves: R M. `to_new` is the angle from the old reference direction to the new one.
  Mueller& turn_out(const DoubleAngle& to_new) {
    for (int j = 0; j < 4; ++j) {
      const Spectrum a = m_[1][j], b = m_[2][j];
      m_[1][j] = a * to_new.cosine + b * to_new.sine;
      m_[2][j] = b * to_new.cosine - a * to_new.sine;
    }
    return *this;
  }

 private:
  Spectrum m_[4][4];
};

/// A unit vector perpendicular to a unit vector.
inline Vector3 any_perpendicular(const Vector3& d) { return Frame(Normal3(d)).s; }
/// A unit vector perpendicular to two unit vectors, the normal of the plane that they span; any, if they span none.
inline Vector3 common_perpendicular(const Vector3& a, const Vector3& b) {
  const Vector3 normal = cross(a, b);
  const float square = length_squared(normal);
  return square > 1e-12f ? normal / std::sqrt(square) : any_perpendicular(a);
}

/// What one event does to the polarization of light that arrives from the direction `in` (it travels along -in) and leaves
/// towards `out`: a Mueller matrix over its first element, which is the scattering of unpolarized light and known from
/// elsewhere (Scatter, VolumeShader).
struct Polarization {
  Mueller mueller;  ///< mueller(0, 0) = 1
  Vector3 x_in;     ///< the reference direction of the light that arrives,
  Vector3 x_out;    ///< and of that which leaves
};

/// The mean of what several events do that happen to parts of the light: the weights are the scattering of each.
class PolarizationMean {
 public:
  PolarizationMean(const Vector3& out, const Vector3& in) : out_(out), in_(in) {}

  void add(const Spectrum& weight, Polarization part) {
    part.mueller *= weight;
    if (!begun_) {
      sum_ = part;
      begun_ = true;
      return;
    }
    part.mueller.turn_in(double_angle(sum_.x_in, part.x_in, -in_)).turn_out(double_angle(part.x_out, sum_.x_out, out_));
    sum_.mueller += part.mueller;
  }
  /// Light that is unpolarized afterwards.
  void add_unpolarized(const Spectrum& weight) { unpolarized_ += weight; }

  /// False: all of the light is unpolarized afterwards.
  bool mean(Polarization& mean) const {
    if (!begun_) return false;
    mean = sum_;
    mean.mueller(0, 0) += unpolarized_;
    mean.mueller *= map(mean.mueller(0, 0), [](float all) { return all > 0 ? 1 / all : 0; });
    return true;
  }

 private:
  const Vector3 out_, in_;
  Polarization sum_;
  Spectrum unpolarized_;
  bool begun_ = false;
};

/// The product of the Mueller matrices of the events along a path, from a receiver on: relative to a fixed reference direction
/// of the light that leaves to the receiver, and to one of the light that arrives at the last event, which changes. It is over
/// its first element, that is the part of the throughput that polarization contributes, and returned by `append`.
class MuellerProduct {
 public:
  /// `x`: the reference direction of the receiver.
  explicit MuellerProduct(const Vector3& x) : product_{Mueller::identity(), x, x} {}

  /// Appends the next event, which light leaves towards `out`. Returns the factor by which the throughput of unpolarized light
  /// differs from the product of the scattering of unpolarized light.
  Spectrum append(const Polarization& event, const Vector3& out) {
    product_.mueller.turn_in(double_angle(event.x_out, product_.x_in, out));
    product_.mueller = product_.mueller * event.mueller;
    product_.x_in = event.x_in;
    const Spectrum factor = max(product_.mueller(0, 0), 0);
    product_.mueller *= map(factor, [](float f) { return f > 0 ? 1 / f : 0; });
    return factor;
  }
  /// The same for an event that leaves no polarization of the light that arrives from `in`.
  void append_depolarizer(const Vector3& in) {
    for (int i = 0; i < 4; ++i)
      for (int j = 1; j < 4; ++j) product_.mueller(i, j) = {};
    product_.x_in = any_perpendicular(in);
  }

  /// The product as one event.
  const Polarization& whole() const { return product_; }
  /// S1, S2 and S3 over S0 at the receiver if unpolarized light arrives at the last event.
  const Spectrum& stokes(int i) const { return product_.mueller(i, 0); }

 private:
  Polarization product_;
};

}  // namespace etendue
