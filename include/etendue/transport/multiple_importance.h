#pragma once
// Heuristics of multiple importance sampling (Veach & Guibas 1995, "Optimally combining sampling techniques"; Veach 1997,
// section 9.2): weights for a sample that two strategies can make.

#include "etendue/core/math.h"

namespace etendue {

/// balance: w = p/(p+q); power: w = p^2/(p^2+q^2).
enum class Heuristic : std::uint8_t { balance, power };

/// The weight of a sample that a strategy with the pdf p made and a strategy with the pdf q could have made; both in the same
/// measure.
inline float heuristic_weight(Heuristic heuristic, float p, float q) {
  if (heuristic == Heuristic::balance) return p > 0 ? p / (p + q) : 0;
  // As a ratio, so that large pdfs do not overflow.
  if (!(p > 0)) return 0;
  const float r = q / p;
  return 1 / (1 + r * r);
}

/// heuristic_weight(p, q) / p: the factor of a sample from the strategy with the pdf p. One division, in double so that squares
/// of large pdfs stay finite.
inline float weight_over_pdf(Heuristic heuristic, float p, float q) {
  const double a = p, b = q;
  return float(heuristic == Heuristic::balance ? 1 / (a + b) : a / (a * a + b * b));
}

}  // namespace etendue
