// color4.h: a color with its alpha.

#include "headers.h"

namespace etendue::osl {

std::string color4_header() {
  return std::string(R"osl(
#pragma once
#define COLOR4_H
struct color4 { color rgb; float a; };
#define TUPLE color4
#define EACH(F) F(rgb), F(a)
#define ALL(x) color(x), x
#define BOTH(F) F(rgb) && F(a)
)osl") + tuple_functions +
         R"osl(
color4 transformc(string from, string to, color4 c) { return color4(transformc(from, to, c.rgb), c.a); }
)osl";
}

}  // namespace etendue::osl
