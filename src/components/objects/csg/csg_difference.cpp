// Difference: the first operand minus all others.

#include "csg.h"

namespace etendue {
namespace {

class Difference final : public Csg {
 public:
  Difference() : Csg(-1, 1) {}

  static void describe(Description<Difference>& d) {
    d.summary(
        "The solid of what lies in a closed object but not in any of others. Where the shader is an "
        "OperandShader (as by default) each surface has the shader of the operand it comes from; otherwise "
        "the whole solid has this one. Surface coordinates are those of the operand; on what was taken away, where its "
        "sides are exchanged, u runs backwards. Emission, interior, sides and priority are those of the solid.",
        "Roth 1982, \"Ray casting for modeling solids\"");
    describe_operands(d, "closed objects: the first, from which the others are taken away");
  }
};

const Register<Difference> registered;

}  // namespace
}  // namespace etendue
