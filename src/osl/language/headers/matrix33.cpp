// matrix33.h: linear maps, as matrices without a translation.

#include "headers.h"

namespace etendue::osl {

// A linear map is kept as a whole matrix whose last row and column are those of the identity. Multiples would change its last
// element, and with it the determinant: they are cut to 3 by 3 again, other than in the reference's header.
std::string matrix33_header() {
  return R"osl(
#pragma once
#define MATRIX33_H
struct matrix33 { matrix m; };
int isValidAs33(matrix m) {
  return m[0][3] == 0 && m[1][3] == 0 && m[2][3] == 0 && m[3][0] == 0 && m[3][1] == 0 && m[3][2] == 0 && m[3][3] == 1;
}
matrix matrix33To44(matrix33 a) { return a.m; }
matrix33 matrix44To33(matrix m) {
  return matrix33(matrix(m[0][0], m[0][1], m[0][2], 0, m[1][0], m[1][1], m[1][2], 0, m[2][0], m[2][1], m[2][2], 0, 0, 0, 0, 1));
}
matrix33 __operator__neg__(matrix33 a) { return matrix44To33(-a.m); }
matrix33 __operator__mul__(matrix33 a, matrix33 b) { return matrix33(a.m * b.m); }
matrix33 __operator__mul__(matrix33 a, float b) { return matrix44To33(a.m * b); }
matrix33 __operator__mul__(float a, matrix33 b) { return matrix44To33(a * b.m); }
matrix33 __operator__div__(matrix33 a, matrix33 b) { return matrix33(a.m / b.m); }
matrix33 __operator__div__(matrix33 a, float b) { return matrix44To33(a.m / b); }
matrix33 __operator__div__(float a, matrix33 b) { return matrix44To33(a / b.m); }
int __operator__eq__(matrix33 a, matrix33 b) { return a.m == b.m; }
int __operator__neq__(matrix33 a, matrix33 b) { return a.m != b.m; }
float determinant(matrix33 a) { return determinant(a.m); }
matrix33 transpose(matrix33 a) { return matrix33(transpose(a.m)); }
point transform(matrix33 a, point b) { return transform(a.m, b); }
vector transform(matrix33 a, vector b) { return transform(a.m, b); }
normal transform(matrix33 a, normal b) { return transform(a.m, b); }
)osl";
}

}  // namespace etendue::osl
