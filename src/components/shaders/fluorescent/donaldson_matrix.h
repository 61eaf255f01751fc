#pragma once
// A measured Donaldson matrix: how much of the light at each wavelength leaves a surface at each wavelength.

#include <string>
#include <vector>

#include "etendue/reradiation.h"

namespace etendue {

// D_ij is the power that leaves in the band j of the width h, over the power that arrives in the band i, with the bands at the
// wavelengths l_i = l_0 + i h. On the diagonal is the light that is scattered elastically. Between the bands, linear in both
// wavelengths,
//     Phi(l' -> l) = sum_ij D_ij b(l' - l_i) b(l - l_j) / h,    b(x) = max(0, 1 - |x| / h),    D_ii = 0 here,
// so that exactly sum_{j != i} D_ij of the power at l_i is reradiated.
class DonaldsonMatrix {
 public:
  DonaldsonMatrix() = default;
  /// Row by row; throws Error for values that no surface has. `wavelengths`: of rows and columns, equally spaced [nm].
  DonaldsonMatrix(const std::vector<float>& wavelengths, std::vector<float> values);

  float value(float absorbed, float emitted) const;              ///< Phi [1/nm]
  float elastic(float wavelength) const;                         ///< the reflectance; 0 outside of the matrix
  const SampledFunction& absorbed() const { return absorbed_; }  ///< int Phi(l' -> l) dl, of l'
  const SampledFunction& emitted() const { return emitted_; }    ///< int Phi(l' -> l) dl', of l
  float first() const { return first_; }                         ///< the shortest wavelength [nm]

 private:
  std::vector<float> values_;  // without the diagonal
  int count_ = 0;
  float first_ = 0, step_ = 1;
  std::vector<float> elastic_;  // the diagonal
  SampledFunction absorbed_, emitted_;
};

/// From a CSV file: the first line has, after any label, the emitted wavelengths [nm]; each further one an absorbed wavelength
/// and the row of its values. Throws Error with the line.
DonaldsonMatrix read_donaldson_matrix(const std::string& path);

}  // namespace etendue
