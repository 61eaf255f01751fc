#include "pose.h"

#include <algorithm>

#include "accessor.h"

namespace etendue::gltf {
namespace {

/// An animation sampler: values that change with time (glTF 2.0, 3.11 and appendix C).
class Sampler {
 public:
  Sampler(const Document& document, const Json& sampler) : interpolation_(text(sampler, "interpolation", "LINEAR")) {
    times_ = Accessor(document, needed_whole(sampler, "input")).floats();
    values_ = Accessor(document, needed_whole(sampler, "output")).floats();
    if (interpolation_ != "LINEAR" && interpolation_ != "STEP" && interpolation_ != "CUBICSPLINE")
      throw Error("'interpolation' '" + interpolation_.substr(0, 20) + "' is unknown");
    const size_t keys = times_.size() * (cubic() ? 3 : 1);
    if (keys == 0 || values_.size() % keys != 0) throw Error("the numbers of its keys do not fit");
    width_ = values_.size() / keys;
    if (!std::ranges::is_sorted(times_)) throw Error("the times of its keys do not increase");
  }

  /// The interpolated values at a time; `turns`: they are a rotation.
  std::vector<double> at(double time, bool turns) const {
    const size_t next = size_t(std::ranges::upper_bound(times_, float(time)) - times_.begin());
    if (next == 0) return key(0);
    if (next == times_.size() || interpolation_ == "STEP") return key(next - 1);
    const double t0 = double(times_[next - 1]), t1 = double(times_[next]), step = t1 - t0, t = (time - t0) / step;
    std::vector<double> a = key(next - 1), b = key(next);
    if (cubic()) {
      const double t2 = t * t, t3 = t2 * t;
      for (size_t i = 0; i < width_; ++i)
        a[i] = (2 * t3 - 3 * t2 + 1) * a[i] + step * (t3 - 2 * t2 + t) * value(next - 1, 2, i) + (-2 * t3 + 3 * t2) * b[i] +
               step * (t3 - t2) * value(next, 0, i);
    } else if (turns && width_ == 4) {
      slerp(a, b, t);
    } else {
      for (size_t i = 0; i < width_; ++i) a[i] += t * (b[i] - a[i]);
    }
    return a;
  }

 private:
  bool cubic() const { return interpolation_ == "CUBICSPLINE"; }
  /// A cubic key consists of in-tangent, value and out-tangent; `which` 1 is the value.
  double value(size_t key, size_t which, size_t i) const {
    return double(values_[(cubic() ? 3 * key + which : key) * width_ + i]);
  }
  std::vector<double> key(size_t k) const {
    std::vector<double> all(width_);
    for (size_t i = 0; i < width_; ++i) all[i] = value(k, 1, i);
    return all;
  }
  /// Spherical linear interpolation along the shorter arc (Shoemake 1985).
  static void slerp(std::vector<double>& a, const std::vector<double>& b, double t) {
    double cosine = 0;
    for (size_t i = 0; i < 4; ++i) cosine += a[i] * b[i];
    const double sign = cosine < 0 ? -1 : 1;
    cosine = std::min(std::abs(cosine), 1.0);
    const double angle = std::acos(cosine), sine = std::sin(angle);
    const double from = sine > 1e-6 ? std::sin((1 - t) * angle) / sine : 1 - t;
    const double to = sign * (sine > 1e-6 ? std::sin(t * angle) / sine : t);
    for (size_t i = 0; i < 4; ++i) a[i] = from * a[i] + to * b[i];
  }

  std::string interpolation_;
  std::vector<float> times_, values_;
  size_t width_ = 0;
};

template <size_t n>
std::array<double, n> first(const std::vector<double>& values) {
  if (values.size() != n) throw Error("the numbers of its keys do not fit");
  std::array<double, n> all{};
  std::copy_n(values.begin(), n, all.begin());
  return all;
}

}  // namespace

Transform composed(const std::array<double, 3>& t, std::array<double, 4> q, const std::array<double, 3>& s) {
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (length > 0 && std::isfinite(length))
    for (double& x : q) x /= length;
  else
    q = {0, 0, 0, 1};
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  return Transform(
      Transform::DoubleMatrix{(1 - 2 * (y * y + z * z)) * s[0], 2 * (x * y - z * w) * s[1], 2 * (x * z + y * w) * s[2], t[0],
                              2 * (x * y + z * w) * s[0], (1 - 2 * (x * x + z * z)) * s[1], 2 * (y * z - x * w) * s[2], t[1],
                              2 * (x * z - y * w) * s[0], 2 * (y * z + x * w) * s[1], (1 - 2 * (x * x + y * y)) * s[2], t[2]});
}

bool has_animation(const Document& document) { return document.count("animations") > 0; }

Pose::Pose(const Document& document, const Moment& moment) : document_(document) {
  const size_t n = document.count("nodes");
  animated_.resize(n);
  for (size_t i = 0; moment.animation && i < document.count("animations"); ++i)
    if (*moment.animation == i || *moment.animation == every_animation)
      within(fmt::format("animations[{}]", i), [&] { animate(document.element("animations", i), moment.time); });
  if (moment.animation && *moment.animation != every_animation) document.element("animations", *moment.animation);
  constexpr size_t nobody = SIZE_MAX;
  std::vector<size_t> parents(n, nobody), order;
  std::vector<std::vector<size_t>> children(n);
  for (size_t i = 0; i < n; ++i)
    within(fmt::format("nodes[{}]", i), [&] {
      children[i] = places(document.element("nodes", i), "children", n);
      for (const size_t child : children[i]) {
        if (parents[child] != nobody) throw Error(fmt::format("nodes[{}] has two parents", child));
        parents[child] = i;
      }
    });
  globals_.resize(n);
  for (size_t i = 0; i < n; ++i)
    if (parents[i] == nobody) order.push_back(i);
  for (size_t k = 0; k < order.size(); ++k) {
    const size_t i = order[k];
    const Transform own = within(fmt::format("nodes[{}]", i), [&] { return local(i); });
    globals_[i] = parents[i] == nobody ? own : globals_[parents[i]] * own;
    order.insert(order.end(), children[i].begin(), children[i].end());
  }
  if (order.size() == n) return;
  std::ranges::sort(order);
  size_t lost = 0;
  while (lost < order.size() && order[lost] == lost) ++lost;
  throw Error(fmt::format("nodes[{}] is a child of its own descendants", lost));
}

void Pose::animate(const Json& animation, double time) {
  const Json &samplers = list_in(animation, "samplers"), &channels = list_in(animation, "channels");
  for (size_t i = 0; i < channels.size(); ++i)
    within(fmt::format("channels[{}]", i), [&] {
      const Json& target = object_in(channels[i], "target");
      const auto node = whole(target, "node");
      const std::string path = text(target, "path");
      if (!node) return;
      if (*node >= animated_.size()) throw Error(fmt::format("there is no nodes[{}]", *node));
      const size_t sampler = needed_whole(channels[i], "sampler");
      if (sampler >= samplers.size()) throw Error(fmt::format("there is no samplers[{}]", sampler));
      const std::vector<double> values = Sampler(document_, samplers[sampler]).at(time, path == "rotation");
      Animated& a = animated_[*node];
      if (path == "translation") a.translation = first<3>(values);
      if (path == "scale") a.scale = first<3>(values);
      if (path == "rotation") a.rotation = first<4>(values);
      if (path == "weights") a.weights = values;
    });
}

Transform Pose::local(size_t node) const {
  const Json& n = document_.element("nodes", node);
  const Animated& a = animated_[node];
  const bool moves = a.translation || a.rotation || a.scale;
  if (const auto m = numbers<16>(n, "matrix"); m && !moves)
    return Transform(Transform::DoubleMatrix{(*m)[0], (*m)[4], (*m)[8], (*m)[12], (*m)[1], (*m)[5], (*m)[9], (*m)[13], (*m)[2],
                                             (*m)[6], (*m)[10], (*m)[14]});
  const auto or_else = [](const auto& animated, const auto& still, const auto& otherwise) {
    return animated ? *animated : still.value_or(otherwise);
  };
  return composed(or_else(a.translation, numbers<3>(n, "translation"), std::array<double, 3>{0, 0, 0}),
                  or_else(a.rotation, numbers<4>(n, "rotation"), std::array<double, 4>{0, 0, 0, 1}),
                  or_else(a.scale, numbers<3>(n, "scale"), std::array<double, 3>{1, 1, 1}));
}

std::vector<double> Pose::weights(size_t node) const {
  if (animated_.at(node).weights) return *animated_[node].weights;
  const Json& n = document_.element("nodes", node);
  const Json* list = find(n, "weights");
  if (const auto mesh = whole(n, "mesh"); !list && mesh) list = find(document_.element("meshes", *mesh), "weights");
  std::vector<double> all;
  if (list)
    for (const Json& weight : *list) {
      if (!weight.is_number()) throw Error("'weights' is not a list of numbers");
      all.push_back(weight.get<double>());
    }
  return all;
}

}  // namespace etendue::gltf
