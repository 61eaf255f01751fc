// Intersection: the space that lies in all operands.

#include "csg.h"

namespace etendue {
namespace {

class Intersection final : public Csg {
 public:
  Intersection() : Csg(1, 0) {}

  static void describe(Description<Intersection>& d) {
    d.summary(
        "The solid of what lies in all of several closed objects. Where the shader is an OperandShader (as by "
        "default) each surface has the shader of the operand it comes from; otherwise the whole solid has "
        "this one. Surface coordinates are those of the operand. Emission, interior, sides and priority are those of the "
        "solid.",
        "Roth 1982, \"Ray casting for modeling solids\"");
    describe_operands(d, "closed objects; what is common to all of them is left");
  }
};

const Register<Intersection> registered;

}  // namespace
}  // namespace etendue
