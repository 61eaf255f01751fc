// HomogeneousVolume: a medium that is the same everywhere.

#include "colored_volume.h"

namespace etendue {
namespace {

class HomogeneousVolume final : public ColoredVolume {
 public:
  static void describe(Description<HomogeneousVolume>& d) {
    d.summary("A medium that is the same everywhere.");
    describe_colors(d);
  }

  void prepare() override { prepare_colors(); }
  VolumeCoefficients coefficients(const Point3&, float, const Wavelengths& w) const override { return colors(w); }
  bool homogeneous() const override { return true; }
  float dye_amount(const Point3&, float) const override { return dye_absorption; }
  float most_dye() const override { return dye_absorption; }
  Spectrum majorant(const Wavelengths& w) const override { return colors(w).extinction(); }
};

const Register<HomogeneousVolume> registered;

}  // namespace
}  // namespace etendue
