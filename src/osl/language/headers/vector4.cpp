// vector4.h: a vector of four numbers; homogeneous coordinates.

#include "headers.h"

namespace etendue::osl {

std::string vector4_header() {
  return std::string(R"osl(
#pragma once
#define VECTOR4_H
struct vector4 { float x; float y; float z; float w; };
#define TUPLE vector4
#define EACH(F) F(x), F(y), F(z), F(w)
#define ALL(n) n, n, n, n
#define BOTH(F) F(x) && F(y) && F(z) && F(w)
)osl") + tuple_functions +
         R"osl(
float dot(vector4 a, vector4 b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }
float length(vector4 a) { return sqrt(dot(a, a)); }
vector4 normalize(vector4 a) { return a / length(a); }
vector vec4ToVec3(vector4 a) { return vector(a.x, a.y, a.z) / a.w; }
// Points are rows: the matrix multiplies from the right.
float _column(matrix m, int i, vector4 p) { return m[0][i] * p.x + m[1][i] * p.y + m[2][i] * p.z + m[3][i] * p.w; }
vector4 transform(matrix m, vector4 p) { return vector4(_column(m, 0, p), _column(m, 1, p), _column(m, 2, p), _column(m, 3, p)); }
vector4 transform(string from, string to, vector4 p) { return transform(matrix(from, to), p); }
)osl";
}

}  // namespace etendue::osl
