// vector2.h: a vector of two numbers.

#include "headers.h"

namespace etendue::osl {

std::string vector2_header() {
  return std::string(R"osl(
#pragma once
#define VECTOR2_H
struct vector2 { float x; float y; };
#define TUPLE vector2
#define EACH(F) F(x), F(y)
#define ALL(n) n, n
#define BOTH(F) F(x) && F(y)
)osl") + tuple_functions +
         R"osl(
float dot(vector2 a, vector2 b) { return a.x * b.x + a.y * b.y; }
float length(vector2 a) { return hypot(a.x, a.y); }
vector2 normalize(vector2 a) { return a / length(a); }
vector2 mod(vector2 a, vector2 b) { return vector2(mod(a.x, b.x), mod(a.y, b.y)); }
)osl";
}

}  // namespace etendue::osl
