// Union: the space that lies in any of the operands.

#include "csg.h"

namespace etendue {
namespace {

class Union final : public Csg {
 public:
  Union() : Csg(1, 1) {}

  static void describe(Description<Union>& d) {
    d.summary(
        "The solid of all that lies in any of several closed objects, without the surfaces within. Where the "
        "shader is an OperandShader (as by default) each surface has the shader of the operand it comes from; "
        "otherwise the whole solid has this one. Surface coordinates are those of the operand. Emission, interior, sides and "
        "priority are those of the "
        "solid.",
        "Roth 1982, \"Ray casting for modeling solids\"");
    describe_operands(d, "closed objects, which are joined");
  }
};

const Register<Union> registered;

}  // namespace
}  // namespace etendue
