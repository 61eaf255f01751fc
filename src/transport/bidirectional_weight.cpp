#include "etendue/transport/bidirectional_weight.h"

namespace etendue {

namespace {

/// The sum over all strategies of (p_j / p_s)^beta, with L_0 in p_1 for merging, and what merging at the connection has of it.
struct Sum {
  double all = 0, merged_here = 0;
};
/// `merges`: the strategy at hand merges at vertex s, so the light walk went on there, and not by a connection.
Sum strategies(const ConnectedPath& path, Heuristic heuristic, bool merges) {
  const int s = path.s, t = path.t, last = s + t - 1;
  // Vertex i of the whole path, its densities, and whether it can stand at a connection: those at this one can.
  const auto vertex = [&](int i) -> const KeptVertex& { return i < s ? path.light[i] : path.camera[last - i]; };
  const auto connectable = [&](int i) { return i == 0 || (i == s - 1 && !merges) || i == s || !vertex(i).specular; };
  const auto from_light = [&](int i) -> double {
    if (i == 0) return path.begun;
    if (i < s) return path.light[i].forward;
    if (i == s) return path.camera_last_from_light;
    return i == s + 1 ? path.camera_before_from_light : path.camera[last - i].reverse;
  };
  const auto from_camera = [&](int i) -> double {
    if (i >= s) return path.camera[last - i].forward;
    if (i == s - 1) return path.light_last_from_camera;
    return i == s - 2 ? path.light_before_from_camera : path.light[i].reverse;
  };
  // p_{j+1} / p_j with L_0 in p_1 as in the others, and what p_1 is to be multiplied by for that.
  const auto step = [&](int j) { return from_light(j) / from_camera(j); };
  const auto first = [&](int j) { return j == 1 ? double(path.direct) / path.begun : 1.0; };
  const auto possible = [&](int j) {
    if (j == 0) return path.luminaire_can_be_met;
    if (j == last && last == 1) return false;  // a luminaire seen by the lens is met, never connected
    return connectable(j - 1) && connectable(j);
  };
  const auto raised = [&](double ratio) { return heuristic == Heuristic::balance ? ratio : ratio * ratio; };

  const auto mergeable = [&](int i) {
    return path.merging > 0 && i > 0 && i < last && vertex(i).on_surface() && connectable(i);
  };
  const auto merged = [&](double ratio, int i) { return mergeable(i) ? raised(ratio * path.merging * from_light(i)) : 0; };

  double sum = possible(s) || !merges ? 1 : 0, ratio = 1 / first(s);
  const double here = merged(ratio, s);
  for (int j = s; j < last; ++j) {
    ratio *= step(j);
    if (!(ratio > 0)) break;
    if (possible(j + 1)) sum += raised(ratio * first(j + 1));
    sum += merged(ratio, j + 1);
  }
  ratio = 1 / first(s);
  for (int j = s - 1; j >= 0; --j) {
    ratio /= step(j);
    if (!(ratio > 0) || !std::isfinite(ratio)) break;
    if (possible(j)) sum += raised(ratio * first(j));
    sum += merged(ratio, j);
  }
  return {sum + here, here};
}

}  // namespace

float bidirectional_weight(const ConnectedPath& path, Heuristic heuristic) {
  return float(1 / strategies(path, heuristic, false).all);
}

float merging_weight(const ConnectedPath& path, Heuristic heuristic) {
  const Sum sum = strategies(path, heuristic, true);
  return float(sum.merged_here / sum.all);
}

}  // namespace etendue
