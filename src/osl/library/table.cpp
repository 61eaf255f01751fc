// The whole table.

#include "table.h"

#include <vector>

#include "parts.h"

namespace etendue::osl {

std::span<const Row> library_rows() {
  static const std::vector<Row> rows = [] {
    std::vector<Row> all;
    for (const std::span<const Row> part :
         {constructor_rows(), mathematics_rows(), geometry_rows(), transform_rows(), color_rows(), step_rows(), noise_rows(),
          spline_rows(), derivative_rows(), string_rows(), world_rows(), dictionary_rows(), texture_rows(), closure_rows(),
          spectrum_rows()})
      all.insert(all.end(), part.begin(), part.end());
    return all;
  }();
  return rows;
}

}  // namespace etendue::osl
