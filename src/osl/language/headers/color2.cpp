// color2.h: a grey value with its alpha.

#include "headers.h"

namespace etendue::osl {

std::string color2_header() {
  return std::string(R"osl(
#pragma once
#define COLOR2_H
struct color2 { float r; float a; };
#define TUPLE color2
#define EACH(F) F(r), F(a)
#define ALL(x) x, x
#define BOTH(F) F(r) && F(a)
)osl") + tuple_functions;
}

}  // namespace etendue::osl
