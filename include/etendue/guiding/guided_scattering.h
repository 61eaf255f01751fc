#pragma once
// How a path goes on from a vertex where a guide is asked:
//     p(w) = a p_guide(w) + (1 - a) p_scatter(w)                    (one-sample mixture: Veach 1997, section 9.2.4)
// at surfaces and in media alike; specular lobes are chosen by scattering alone, with probability 1 - a.

#include "etendue/guiding/guide.h"
#include "etendue/transport/path_vertex.h"

namespace etendue {

class GuidedScattering {
 public:
  /// Of a walk that came from `out`.
  GuidedScattering(const Guide& guide, const PathVertex& v, const Vector3& out) : vertex_(v) {
    if (!v.scatters_smoothly()) return;
    region_ = guide.region_of(v.point.position, facing(v, out));
    const Guide::Region& region = guide.region(region_);
    share_ = region.share();
    if (share_ > 0) lobes_ = SeenLobes(region.lobes(), v.point.position);
  }

  std::uint32_t region() const { return region_; }

  /// f |cos| and p, as direct light is weighted.
  ScatterValue operator()(const Vector3& in) const {
    ScatterValue f = scattering(vertex_, vertex_.out, in, Transport::radiance);
    if (share_ > 0 && !f.value.black()) f.pdf = mixed(lobes_.pdf(in), f.pdf);
    return f;
  }

  /// p, where scattering alone has the density `scatter` [1/sr].
  float pdf(const Vector3& in, float scatter) const { return share_ > 0 ? mixed(lobes_.pdf(in), scatter) : scatter; }

  struct Choice {
    std::optional<ScatterSample> next;
    float scatter = 0;  ///< p_scatter [1/sr]; of a specular lobe the probability of having chosen it
    float more = 1;     ///< p / p_scatter
  };

  /// Chooses a direction; `scatter(choice)` does by scattering alone.
  template <class Scatter>
  Choice sample(float choice, Point2 u, const Scatter& scatter) const {
    Choice c;
    if (choice < share_) {
      const Vector3 in = lobes_.sample(choice / share_, u);
      const ScatterValue f = scattering(vertex_, vertex_.out, in, Transport::radiance);
      if (f.value.black()) return c;
      c.scatter = f.pdf;
      const float p = mixed(lobes_.pdf(in), f.pdf);
      if (!(p > 0)) return c;
      ScatterSample& s = c.next.emplace();
      s.direction = in;
      s.weight = f.value / p;
      s.pdf = p;
      if (vertex_.on_surface() && (dot(vertex_.point.normal, in) > 0) != (dot(vertex_.point.normal, vertex_.out) > 0))
        s.lobe = diffuse_transmission;
      if (alone(s)) c.next.reset();
      if (f.pdf > 0) c.more = p / f.pdf;
      return c;
    }
    c.next = scatter(std::min((choice - share_) / (1 - share_), one_minus_epsilon));
    if (!c.next) return c;
    ScatterSample& s = *c.next;
    c.scatter = s.pdf;
    if (alone(s)) {
      s.weight /= 1 - share_;
      c.more = 1 - share_;
    } else if (share_ > 0) {
      s.pdf = mixed(lobes_.pdf(s.direction), c.scatter);
      s.weight *= c.scatter / s.pdf;
      c.more = s.pdf / c.scatter;
    }
    return c;
  }

  /// Whether only scattering chooses such directions: those of mirrors, and into bodies that light leaves elsewhere.
  bool alone(const ScatterSample& s) const {
    return s.specular() || (vertex_.on_surface() && !vertex_.subsurface_exit && enters_subsurface(vertex_.point, s));
  }

 private:
  /// The side of a surface where a path came from; zero in media.
  static Normal3 facing(const PathVertex& v, const Vector3& out) {
    if (!v.on_surface()) return {};
    return dot(v.point.normal, out) < 0 ? -v.point.normal : v.point.normal;
  }
  float mixed(float guide, float scatter) const { return share_ * guide + (1 - share_) * scatter; }

  const PathVertex& vertex_;
  std::uint32_t region_ = 0;
  float share_ = 0;  // a
  SeenLobes lobes_;  // of share_ > 0
};

}  // namespace etendue
