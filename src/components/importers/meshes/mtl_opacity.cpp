// The opacity of MTL materials, in the dialects of 'd' and 'Tr'.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mtl_lines.h"

namespace etendue {
namespace {

/// Whether the illumination model is one of glass, so that a material of opacity 0 is still visible.
bool refracts(const MtlLines& m) {
  const double illum = m.number("illum", 2);
  return illum == 4 || illum == 6 || illum == 7 || illum == 9;
}

}  // namespace

// The meaning of 'Tr' is decided by materials that also state 'd'; else by the program that wrote the file; else by whether a
// reading as transparency would leave something invisible and nothing opaque, which nobody would save.
bool tr_is_opacity(Importing& importing, const std::vector<MtlLines>& materials, bool by_meshlab) {
  constexpr double near = 0.01;
  int as_opacity = 0, as_transparency = 0;
  bool alone = !materials.empty(), opaque = false, invisible = false;
  const MtlLines* first = nullptr;
  for (const MtlLines& m : materials) {
    const double tr = m.number("tr", 0), d = m.number("d", 1);
    if (m.has("tr") && !first) first = &m;
    alone = alone && m.has("tr") && !m.has("d");
    opaque = opaque || tr <= 0;
    invisible = invisible || (tr >= 1 && !refracts(m));
    if (!m.has("tr") || !m.has("d") || (tr <= 0 && d <= 0)) continue;
    const bool same = std::abs(d - tr) < near, rest = std::abs(d + tr - 1) < near;
    as_opacity += same && !rest;
    as_transparency += rest && !same;
  }
  if (!first || as_transparency > as_opacity) return false;
  const char* why = nullptr;
  if (as_opacity > as_transparency)
    why = "it is that of 'd'";
  else if (by_meshlab)
    why = "the file is MeshLab's";
  else if (alone && invisible && !opaque)
    why = "as 1 - d it would leave nothing opaque";
  if (why) importing.inexact(fmt::format("'Tr' is taken for the opacity, as MeshLab writes it: {}", why), first->at);
  return why != nullptr;
}

double mtl_opacity(Importing& importing, const MtlLines& said, bool tr_is_opacity) {
  const double tr = std::clamp(said.number("tr", 0), 0.0, 1.0), by_tr = tr_is_opacity ? tr : 1 - tr;
  if (!said.has("d")) return said.has("tr") ? by_tr : 1;
  const double d = std::clamp(said.number("d", 1), 0.0, 1.0);
  if (!said.has("tr") || std::abs(d - by_tr) < 0.01) return d;
  const bool hidden = d <= 0 && by_tr >= 1;
  importing.inexact(
      hidden ? "'d' says invisible and 'Tr' opaque: it is opaque" : "'d' and 'Tr' contradict each other: 'd' counts", said.at);
  return hidden ? 1 : d;
}

}  // namespace etendue
