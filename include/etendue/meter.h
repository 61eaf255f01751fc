#pragma once
// Meter: a camera that measures one quantity by the mean over its whole picture, such as IrradianceMeter. `etendue measure`
// prints the numbers (check/measure/measure.h).

#include <string>

namespace etendue {

/// The quantity that the mean radiance over the whole picture stands for.
struct MeterQuantity {
  std::string name = "mean radiance";      ///< the radiometric quantity
  std::string photometric = "luminance";   ///< the photometric one
  double factor = 1;                       ///< of the mean radiance, in sr for an irradiance
  std::string unit = "W/(m2 sr)";          ///< of the quantity; per nm in a band
  std::string photometric_unit = "cd/m2";  ///< the unit times lumen per watt
};

/// Implemented by cameras in addition to Camera. Cameras that do not implement it measure the default, the mean radiance of the
/// picture.
class Meter {
 public:
  virtual MeterQuantity measures() const = 0;

 protected:
  ~Meter() = default;
};

}  // namespace etendue
