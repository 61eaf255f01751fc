#include "etendue/transport/bidirectional_weight.h"

namespace etendue {

namespace {

/// The pdfs of a path by all strategies. `merges`: the strategy that made the path merges at vertex s, which the light subpath
/// sampled as well; otherwise it connects vertices s - 1 and s.
class Strategies {
 public:
  Strategies(const ConnectedPath& p, Heuristic h, bool merges) : path_(p), heuristic_(h), merges_(merges) {}

  double raised(double ratio) const { return heuristic_ == Heuristic::balance ? ratio : ratio * ratio; }
  /// The factor of p_j that replaces L_0 by D_0, for j = 1.
  double first(int j) const { return j == 1 ? double(path_.next_event_point_pdf) / path_.pdf_emission_origin : 1.0; }

  /// The sum of (p_j / p_s)^beta over the strategies with more vertices from the luminaire than s, connecting and merging.
  /// `ratio` is prod_{i<s} L_i prod_{i>=s} E_i over p_s: 1, or L_0 / D_0 if s = 1.
  double after(double ratio) const {
    double sum = 0;
    const int last = path_.s + path_.t - 1;
    for (int j = path_.s; j < last; ++j) {
      ratio *= from_light(j) / from_camera(j);
      if (!(ratio > 0)) break;
      if (possible(j + 1)) sum += raised(ratio * first(j + 1));
      sum += merged(ratio, j + 1);
    }
    return sum;
  }
  /// The same for the strategies with fewer vertices from the luminaire.
  double before(double ratio) const {
    double sum = 0;
    for (int j = path_.s - 1; j >= 0; --j) {
      ratio *= from_camera(j) / from_light(j);
      if (!(ratio > 0) || !std::isfinite(ratio)) break;
      if (possible(j)) sum += raised(ratio * first(j));
      sum += merged(ratio, j);
    }
    return sum;
  }
  /// The term of merging at vertex i. `ratio` is prod_{j<i} L_j prod_{j>=i} E_j over p_s.
  double merged(double ratio, int i) const {
    const int last = path_.s + path_.t - 1;
    if (!(path_.merging.surface > 0) || i <= 0 || i >= last || !connectable(i)) return 0;
    const SubpathVertex& v = vertex(i);
    const double merging = v.in_medium() ? path_.merging.medium : v.on_surface() ? path_.merging.surface : 0;
    return raised(ratio * merging * from_light(i));
  }
  /// p_j / p_s; 0 if strategy j cannot make the path. Strategy s has connected it.
  double relative_pdf(int j) const {
    if (j != path_.s && !possible(j)) return 0;
    double ratio = 1 / first(path_.s);
    for (int i = path_.s; i < j; ++i) ratio *= from_light(i) / from_camera(i);
    for (int i = path_.s - 1; i >= j; --i) ratio *= from_camera(i) / from_light(i);
    return ratio > 0 && std::isfinite(ratio) ? ratio * first(j) : 0;
  }
  bool possible(int j) const {
    const int last = path_.s + path_.t - 1;
    if (j == 0) return path_.emitter_can_be_hit;
    if (j == last && last == 1) return false;  // an emitter that the camera sees directly is hit, never connected to the lens
    return connectable(j - 1) && connectable(j);
  }

 private:
  // Vertex i of the whole path, whether it can be connected (the two vertices of the connection that was made can), and its
  // pdfs.
  const SubpathVertex& vertex(int i) const { return i < path_.s ? path_.light[i] : path_.camera[path_.s + path_.t - 1 - i]; }
  bool connectable(int i) const {
    return i == 0 || (i == path_.s - 1 && !merges_) || i == path_.s || !vertex(i).leaves_specularly;
  }
  double from_light(int i) const {
    if (i == 0) return path_.pdf_emission_origin;
    if (i < path_.s) return path_.light[i].pdf_forward;
    if (i == path_.s) return path_.camera_last_from_light;
    return i == path_.s + 1 ? path_.camera_before_from_light : vertex(i).pdf_reverse;
  }
  double from_camera(int i) const {
    if (i >= path_.s) return vertex(i).pdf_forward;
    if (i == path_.s - 1) return path_.light_last_from_camera;
    return i == path_.s - 2 && !merges_ ? path_.light_before_from_camera : path_.light[i].pdf_reverse;
  }

  const ConnectedPath& path_;
  const Heuristic heuristic_;
  const bool merges_;
};

}  // namespace

float bidirectional_weight(const ConnectedPath& path, Heuristic heuristic) {
  const Strategies strategies(path, heuristic, false);
  const double ratio = 1 / strategies.first(path.s);
  return float(1 / (1 + strategies.merged(ratio, path.s) + strategies.after(ratio) + strategies.before(ratio)));
}

double path_tracing_moment(const ConnectedPath& path, Heuristic heuristic) {
  const Strategies strategies(path, heuristic, false);
  const double hit = strategies.relative_pdf(0), next_event = strategies.relative_pdf(1);
  if (!(hit + next_event > 0)) return 0;
  if (heuristic == Heuristic::balance) return 1 / (hit + next_event);
  // In units of the larger pdf, whose cube can be more than a number holds.
  const double most = std::max(hit, next_event), a = hit / most, b = next_event / most;
  return (a * a * a + b * b * b) / ((a * a + b * b) * (a * a + b * b)) / most;
}

PhotonWeight photon_weight(const ConnectedPath& path, float pdf_forward, Heuristic heuristic) {
  const Strategies strategies(path, heuristic, true);
  PhotonWeight w;
  w.pdf_forward = pdf_forward;
  w.connecting =
      path.s == 1 || !path.light[path.s - 1].leaves_specularly ? float(strategies.raised(strategies.first(path.s))) : 0;
  w.others = strategies.before(1);
  return w;
}

float merging_weight(const ConnectedPath& path, const PhotonWeight& photon, float back, Heuristic heuristic) {
  const Strategies strategies(path, heuristic, true);
  const double here = strategies.merged(1, path.s);
  if (!(here > 0)) return 0;
  return float(here / (photon.connecting + here + strategies.after(1) + photon.others * strategies.raised(back)));
}

}  // namespace etendue
