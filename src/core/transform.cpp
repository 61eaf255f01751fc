// Affine transforms and their interpolation over time.

#include "etendue/core/transform.h"

#include "etendue/core/error.h"

namespace etendue {
namespace {

using Matrix3 = std::array<double, 9>;

double determinant_of(const Matrix3& a) {
  return a[0] * (a[4] * a[8] - a[5] * a[7]) - a[1] * (a[3] * a[8] - a[5] * a[6]) + a[2] * (a[3] * a[7] - a[4] * a[6]);
}

/// The inverse by cofactors; the determinant must not be zero.
Matrix3 inverse_of(const Matrix3& a) {
  const double s = 1 / determinant_of(a);
  return {s * (a[4] * a[8] - a[5] * a[7]), s * (a[2] * a[7] - a[1] * a[8]), s * (a[1] * a[5] - a[2] * a[4]),
          s * (a[5] * a[6] - a[3] * a[8]), s * (a[0] * a[8] - a[2] * a[6]), s * (a[2] * a[3] - a[0] * a[5]),
          s * (a[3] * a[7] - a[4] * a[6]), s * (a[1] * a[6] - a[0] * a[7]), s * (a[0] * a[4] - a[1] * a[3])};
}

Matrix3 linear_part(const Transform::DoubleMatrix& m) { return {m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]}; }

/// The product of the lengths of the columns: the largest determinant columns of these lengths can have.
double column_product(const Matrix3& a) {
  double product = 1;
  for (size_t c = 0; c < 3; ++c) product *= std::sqrt(a[c] * a[c] + a[3 + c] * a[3 + c] + a[6 + c] * a[6 + c]);
  return product;
}

/// The unit quaternion (x y z w) of a rotation matrix, from its largest component so that nothing cancels.
std::array<double, 4> quaternion_of(const Matrix3& r) {
  const double trace = r[0] + r[4] + r[8];
  if (trace > 0) {
    const double s = 2 * std::sqrt(trace + 1);
    return {(r[7] - r[5]) / s, (r[2] - r[6]) / s, (r[3] - r[1]) / s, s / 4};
  }
  const size_t i = r[0] > r[4] ? (r[0] > r[8] ? 0 : 2) : (r[4] > r[8] ? 1 : 2);
  const size_t j = (i + 1) % 3, k = (i + 2) % 3;
  const double s = 2 * std::sqrt(std::max(0.0, 1 + r[4 * i] - r[4 * j] - r[4 * k]));
  std::array<double, 4> q{};
  q[i] = s / 4;
  q[j] = (r[3 * j + i] + r[3 * i + j]) / s;
  q[k] = (r[3 * k + i] + r[3 * i + k]) / s;
  q[3] = (r[3 * k + j] - r[3 * j + k]) / s;
  return q;
}

Matrix3 rotation_of(const std::array<double, 4>& q) {
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  return {1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), 2 * (x * y + z * w),    1 - 2 * (x * x + z * z),
          2 * (y * z - x * w),     2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)};
}

double dot4(const std::array<double, 4>& a, const std::array<double, 4>& b) {
  double sum = 0;
  for (size_t i = 0; i < 4; ++i) sum += a[i] * b[i];
  return sum;
}

/// Interpolation along the great circle (Shoemake 1985); linear where the two nearly agree.
std::array<double, 4> slerp(double t, const std::array<double, 4>& a, const std::array<double, 4>& b) {
  const double cosine = std::min(1.0, dot4(a, b));
  double wa = 1 - t, wb = t;
  if (cosine < 0.9999) {
    const double angle = std::acos(cosine), s = std::sin(angle);
    wa = std::sin((1 - t) * angle) / s;
    wb = std::sin(t * angle) / s;
  }
  std::array<double, 4> q{};
  double norm = 0;
  for (size_t i = 0; i < 4; ++i) {
    q[i] = wa * a[i] + wb * b[i];
    norm += q[i] * q[i];
  }
  for (double& x : q) x /= std::sqrt(norm);
  return q;
}

}  // namespace

namespace {

Transform::DoubleMatrix in_double(const Transform::Matrix& m) {
  Transform::DoubleMatrix d{};
  for (size_t i = 0; i < m.size(); ++i) d[i] = double(m[i]);
  return d;
}

}  // namespace

Transform::Transform(const Matrix& matrix) : Transform(in_double(matrix)) {}

Transform::Transform(const DoubleMatrix& matrix) : exact_(matrix) {
  for (size_t k = 0; k < 12; ++k) m_[k] = float(exact_[k]);
  const Matrix3 a = linear_part(exact_);
  const double det = determinant_of(a), largest = column_product(a);
  bool finite = true;
  for (float x : m_) finite = finite && std::isfinite(x);
  // A determinant so much smaller than the product of the column lengths is the rounding error of a singular matrix.
  valid_ = finite && largest > 0 && std::abs(det) > 1e-7 * largest;
  flips_ = det < 0;
  identity_ = exact_ == DoubleMatrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  shifts_only_ = a == Matrix3{1, 0, 0, 0, 1, 0, 0, 0, 1};
  if (!valid_) return;
  const Matrix3 i = inverse_of(a);
  for (size_t r = 0; r < 3; ++r) {
    for (size_t c = 0; c < 3; ++c) exact_inverse_[4 * r + c] = i[3 * r + c];
    exact_inverse_[4 * r + 3] = -(i[3 * r] * exact_[3] + i[3 * r + 1] * exact_[7] + i[3 * r + 2] * exact_[11]);
  }
  // Above this bound, squares and products of several elements overflow floats.
  constexpr float most = 1e15f;
  for (size_t k = 0; k < 12; ++k) {
    inverse_[k] = float(exact_inverse_[k]);
    valid_ = valid_ && std::isfinite(inverse_[k]) && (k % 4 == 3 || (std::abs(inverse_[k]) < most && std::abs(m_[k]) < most));
  }
}

Transform Transform::translate(const DoubleVector3& by) {
  return Transform(DoubleMatrix{1, 0, 0, by.x, 0, 1, 0, by.y, 0, 0, 1, by.z});
}

Transform Transform::rotate(double angle, const DoubleVector3& axis) {
  // Rodrigues' formula.
  const double n = length(axis);
  const double x = axis.x / n, y = axis.y / n, z = axis.z / n, c = std::cos(angle), s = std::sin(angle), d = 1 - c;
  return Transform(DoubleMatrix{c + x * x * d, x * y * d - z * s, x * z * d + y * s, 0,  //
                                y * x * d + z * s, c + y * y * d, y * z * d - x * s, 0,  //
                                z * x * d - y * s, z * y * d + x * s, c + z * z * d, 0});
}

Transform Transform::scale(const DoubleVector3& by) {
  return Transform(DoubleMatrix{by.x, 0, 0, 0, 0, by.y, 0, 0, 0, 0, by.z, 0});
}

Transform Transform::look_at(const DoublePoint3& from, const DoublePoint3& to, const DoubleVector3& up) {
  // If the direction or the left axis vanishes, the columns stay zero and the transform is not valid.
  const auto unit = [](const DoubleVector3& v, double least) {
    const double l = length(v);
    return l > least ? 1 / l * v : DoubleVector3{};
  };
  const DoubleVector3 z = unit(to - from, 0), x = unit(cross(unit(up, 0), z), 1e-6), y = cross(z, x);
  return Transform(DoubleMatrix{x.x, y.x, z.x, from.x, x.y, y.y, z.y, from.y, x.z, y.z, z.z, from.z});
}

Transform Transform::inverse() const {
  Transform t = *this;
  std::swap(t.m_, t.inverse_);
  std::swap(t.exact_, t.exact_inverse_);
  return t;
}

Transform Transform::operator*(const Transform& b) const {
  if (identity_) return b;
  if (b.identity_) return *this;
  DoubleMatrix m{};
  for (size_t r = 0; r < 3; ++r)
    for (size_t c = 0; c < 4; ++c) {
      double sum = c == 3 ? exact_[4 * r + 3] : 0.0;
      for (size_t k = 0; k < 3; ++k) sum += exact_[4 * r + k] * b.exact_[4 * k + c];
      m[4 * r + c] = sum;
    }
  return Transform(m);
}

Bounds3 Transform::operator()(const Bounds3& b) const {
  Bounds3 result;
  if (b.empty()) return result;
  for (int i = 0; i < 8; ++i) result.add((*this)(b.corner(i)));
  return result;
}

AnimatedTransform::AnimatedTransform(std::vector<Key> keys) : keys_(std::move(keys)) {
  if (keys_.empty()) throw Error("an animated transform needs at least one key");
  still_ = keys_.front().transform;
  for (size_t i = 0; i < keys_.size(); ++i) {
    if (!std::isfinite(keys_[i].time)) throw Error("the time of a transform's key must be finite");
    if (i > 0 && !(keys_[i - 1].time < keys_[i].time)) throw Error("the times of a transform's keys must increase");
  }
  if (!animated() || !valid()) return;
  for (const Key& key : keys_) {
    Parts parts = decompose(key.transform);
    // q and -q are the same rotation: the sign nearer to the previous key gives the shorter path.
    if (!parts_.empty() && dot4(parts_.back().rotation, parts.rotation) < 0)
      for (double& x : parts.rotation) x = -x;
    parts_.push_back(parts);
  }
}

void AnimatedTransform::set_origins(const DoublePoint3& outer, const DoublePoint3& inner) {
  outer_ = outer;
  inner_ = inner;
  still_ = shifted(keys_.front().transform);
  if (factors_.empty()) return;
  factors_[0].set_origins(outer, factors_[0].inner_);
  factors_[1].set_origins(factors_[1].outer_, inner);
}

Transform AnimatedTransform::shifted(const Transform& written, const DoublePoint3& inner) const {
  if ((outer_ == DoublePoint3{} && inner == DoublePoint3{}) || !written.valid()) return written;
  Transform::DoubleMatrix m = written.exact();
  const DoubleVector3 translation = written(inner) - outer_;
  m[3] = translation.x;
  m[7] = translation.y;
  m[11] = translation.z;
  return Transform(m);
}

bool AnimatedTransform::valid() const {
  // Between two keys of which only one mirrors, the interpolated transform would become singular.
  for (const Key& key : keys_)
    if (!key.transform.valid() || key.transform.flips() != keys_.front().transform.flips()) return false;
  return true;
}

AnimatedTransform::Parts AnimatedTransform::decompose(const Transform& transform) {
  // Polar decomposition M = R S by averaging with the inverse transpose (Higham 1986), which converges quadratically.
  const Matrix3 m = linear_part(transform.exact());
  Matrix3 r = m;
  for (int iteration = 0; iteration < 100; ++iteration) {
    const Matrix3 i = inverse_of(r);
    double change = 0;
    for (size_t row = 0; row < 3; ++row)
      for (size_t c = 0; c < 3; ++c) {
        const double next = 0.5 * (r[3 * row + c] + i[3 * c + row]);
        change = std::max(change, std::abs(next - r[3 * row + c]));
        r[3 * row + c] = next;
      }
    if (change < 1e-12) break;
  }
  if (determinant_of(r) < 0)
    for (double& x : r) x = -x;  // a reflection becomes part of the stretch
  Parts parts;
  parts.translation = {transform.exact()[3], transform.exact()[7], transform.exact()[11]};
  parts.rotation = quaternion_of(r);
  for (size_t row = 0; row < 3; ++row)
    for (size_t c = 0; c < 3; ++c) {
      double sum = 0;
      for (size_t k = 0; k < 3; ++k) sum += r[3 * k + row] * m[3 * k + c];  // S = R^T M
      parts.stretch[3 * row + c] = sum;
    }
  return parts;
}

AnimatedTransform AnimatedTransform::operator*(const AnimatedTransform& b) const {
  AnimatedTransform product;
  if (!animated() && !b.animated()) {
    product = keys_.front().transform * b.keys_.front().transform;
    product.set_origins(outer_, b.inner_);
    return product;
  }
  std::vector<float> times;
  for (const AnimatedTransform* t : {this, &b})
    if (t->animated())
      for (const Key& key : t->keys_) times.push_back(key.time);
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  product.keys_.clear();
  for (const float time : times) product.keys_.push_back({time, written(time) * b.written(time)});
  product.factors_ = {*this, b};
  product.factors_[1].set_origins(inner_, b.inner_);
  product.set_origins(outer_, b.inner_);
  return product;
}

Transform AnimatedTransform::written(float time) const {
  if (!factors_.empty()) return factors_[0].written(time) * factors_[1].written(time);
  if (!animated() || parts_.empty() || time <= keys_.front().time) return keys_.front().transform;
  if (time >= keys_.back().time) return keys_.back().transform;
  size_t i = 0;
  while (!(time < keys_[i + 1].time)) ++i;
  if (time == keys_[i].time || keys_[i].transform == keys_[i + 1].transform) return keys_[i].transform;
  const Parts &a = parts_[i], &b = parts_[i + 1];
  const double t = (double(time) - keys_[i].time) / (double(keys_[i + 1].time) - keys_[i].time);
  const Matrix3 r = rotation_of(slerp(t, a.rotation, b.rotation));
  Transform::DoubleMatrix m{};
  for (size_t row = 0; row < 3; ++row) {
    for (size_t c = 0; c < 3; ++c) {
      double sum = 0;
      for (size_t k = 0; k < 3; ++k) sum += r[3 * row + k] * ((1 - t) * a.stretch[3 * k + c] + t * b.stretch[3 * k + c]);
      m[4 * row + c] = sum;
    }
    m[4 * row + 3] = (1 - t) * a.translation[row] + t * b.translation[row];
  }
  return Transform(m);
}

// Between keys with the same rotation every point moves in a straight line, so the two ends bound it. Otherwise the box's
// corners are sampled so often that the rotation angle per step is at most 1/20 rad. A point in between is no farther from the
// nearer sample than half the arc; the chord, times 1.02, bounds the arc.
Bounds3 AnimatedTransform::sweep(const Bounds3& box, float begin, float end) const {
  if (!animated()) return still()(box);
  if (!factors_.empty()) return factors_[0].sweep(factors_[1].sweep(box, begin, end), begin, end);
  Bounds3 all;
  if (box.empty()) return all;
  std::vector<float> times{begin};
  for (const Key& key : keys_)
    if (key.time > begin && key.time < end) times.push_back(key.time);
  if (end > begin) times.push_back(end);

  const auto rotation = [this](size_t segment, float time) {
    const float a = keys_[segment].time, b = keys_[segment + 1].time;
    return slerp(clamp((time - a) / (b - a), 0, 1), parts_[segment].rotation, parts_[segment + 1].rotation);
  };
  all.add(at(begin)(box));
  size_t segment = 0;
  for (size_t i = 1; i < times.size(); ++i) {
    const float from = times[i - 1], to = times[i];
    while (segment + 2 < keys_.size() && keys_[segment + 1].time <= from) ++segment;
    int steps = 1;
    if (parts_[segment].rotation != parts_[segment + 1].rotation) {
      const std::array<double, 4> a = rotation(segment, from), b = rotation(segment, to);
      const double cosine = std::min(1.0, std::abs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]));
      steps = std::clamp(int(std::ceil(2 * std::acos(cosine) / 0.05)), 2, 128);
    }
    Point3 before[8];
    for (int c = 0; c < 8; ++c) before[c] = at(from)(box.corner(c));
    float largest = 0;
    Bounds3 part;
    for (int s = 1; s <= steps; ++s) {
      const Transform t = at(s == steps ? to : lerp(float(s) / float(steps), from, to));
      for (int c = 0; c < 8; ++c) {
        const Point3 p = t(box.corner(c));
        largest = std::max(largest, distance(p, before[c]));
        before[c] = p;
        part.add(p);
      }
    }
    const float margin = steps > 1 ? 0.51f * largest : 0;
    part.low = part.low - Vector3{margin, margin, margin};
    part.high = part.high + Vector3{margin, margin, margin};
    all.add(part);
  }
  const Vector3 rounding = rounding_bound(8) * (abs(all.low - Point3{}) + abs(all.high - Point3{}));
  all.low = all.low - rounding;
  all.high = all.high + rounding;
  return all;
}

}  // namespace etendue
