#pragma once
// GuidedScattering: the one-sample mixture of a guide and scattering, by which a guided path samples directions at a vertex,
//     p(w) = a p_guide(w) + (1 - a) p_scatter(w)                    (one-sample model: Veach 1997, section 9.2.4)
// at surfaces and in media alike. Specular lobes are sampled by scattering alone, with probability 1 - a.

#include "etendue/guiding/guide.h"
#include "etendue/transport/path_vertex.h"

namespace etendue {

class GuidedScattering {
 public:
  /// For a path that came to the vertex from the direction `out`.
  GuidedScattering(const Guide& guide, const PathVertex& vertex, const Vector3& out) : vertex_(vertex) {
    if (!vertex.scatters_smoothly()) return;
    region_ = guide.region_of(vertex.point.position, facing(vertex, out));
    const Guide::Region& region = guide.region(region_);
    share_ = region.share();
    if (share_ > 0) lobes_ = SeenLobes(region.lobes(), vertex.point.position);
  }

  std::uint32_t region() const { return region_; }

  /// f |cos| and p, for the weights of next event estimation.
  ScatterValue operator()(const Vector3& in) const {
    ScatterValue f = scattering(vertex_, vertex_.out, in, Transport::radiance);
    if (share_ > 0 && !f.value.black()) f.pdf = mixed(lobes_.pdf(in), f.pdf);
    return f;
  }

  /// p for a direction in which scattering alone has the pdf `scatter` [1/sr].
  float pdf(const Vector3& in, float scatter) const { return share_ > 0 ? mixed(lobes_.pdf(in), scatter) : scatter; }

  struct Choice {
    std::optional<ScatterSample> next;
    float scatter = 0;  ///< p_scatter [1/sr]; for a specular lobe its probability
    float more = 1;     ///< p / p_scatter
  };

  /// Samples a direction; `scatter(choice)` samples one by scattering alone.
  template <class Scatter>
  Choice sample(float choice, Point2 u, const Scatter& scatter) const {
    Choice chosen;
    if (choice < share_) {
      const Vector3 in = lobes_.sample(choice / share_, u);
      const ScatterValue f = scattering(vertex_, vertex_.out, in, Transport::radiance);
      if (f.value.black()) return chosen;
      chosen.scatter = f.pdf;
      const float p = mixed(lobes_.pdf(in), f.pdf);
      if (!(p > 0)) return chosen;
      ScatterSample& next = chosen.next.emplace();
      next.direction = in;
      next.weight = f.value / p;
      next.pdf = p;
      if (vertex_.on_surface() && (dot(vertex_.point.normal, in) > 0) != (dot(vertex_.point.normal, vertex_.out) > 0))
        next.lobe = diffuse_transmission;
      if (alone(next)) chosen.next.reset();
      if (f.pdf > 0) chosen.more = p / f.pdf;
      return chosen;
    }
    chosen.next = scatter(std::min((choice - share_) / (1 - share_), one_minus_epsilon));
    if (!chosen.next) return chosen;
    ScatterSample& next = *chosen.next;
    chosen.scatter = next.pdf;
    if (alone(next)) {
      next.weight /= 1 - share_;
      chosen.more = 1 - share_;
    } else if (share_ > 0) {
      next.pdf = mixed(lobes_.pdf(next.direction), chosen.scatter);
      next.weight *= chosen.scatter / next.pdf;
      chosen.more = next.pdf / chosen.scatter;
    }
    return chosen;
  }

  /// Whether such directions are sampled by scattering alone: those of specular lobes, and those that enter an object with
  /// subsurface scattering.
  bool alone(const ScatterSample& sample) const {
    return sample.specular() || (vertex_.on_surface() && !vertex_.subsurface_exit && enters_subsurface(vertex_.point, sample));
  }

 private:
  /// The normal on the side of a surface from which a path came; zero in media.
  static Normal3 facing(const PathVertex& vertex, const Vector3& out) {
    if (!vertex.on_surface()) return {};
    return dot(vertex.point.normal, out) < 0 ? -vertex.point.normal : vertex.point.normal;
  }
  float mixed(float guide, float scatter) const { return share_ * guide + (1 - share_) * scatter; }

  const PathVertex& vertex_;
  std::uint32_t region_ = 0;
  float share_ = 0;  // a
  SeenLobes lobes_;  // valid if share_ > 0
};

}  // namespace etendue
