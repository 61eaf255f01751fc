#include "headers.h"

namespace etendue::osl {

// A number as an operand stands for a tuple of it; whole numbers are converted to float.
const char* const tuple_functions = R"osl(
#define _TUPLE_ADD(p) a.p + b.p
#define _TUPLE_SUBTRACT(p) a.p - b.p
#define _TUPLE_MULTIPLY(p) a.p * b.p
#define _TUPLE_DIVIDE(p) a.p / b.p
#define _TUPLE_EQUAL(p) a.p == b.p
#define _TUPLE_NEGATE(p) -a.p
#define _TUPLE_OPERATOR(name, part)                                          \
  TUPLE __operator__##name##__(TUPLE a, TUPLE b) { return TUPLE(EACH(part)); } \
  TUPLE __operator__##name##__(TUPLE x, float y) { TUPLE a = x, b = TUPLE(ALL(y)); return TUPLE(EACH(part)); } \
  TUPLE __operator__##name##__(float x, TUPLE y) { TUPLE a = TUPLE(ALL(x)), b = y; return TUPLE(EACH(part)); }
_TUPLE_OPERATOR(add, _TUPLE_ADD)
_TUPLE_OPERATOR(sub, _TUPLE_SUBTRACT)
_TUPLE_OPERATOR(mul, _TUPLE_MULTIPLY)
_TUPLE_OPERATOR(div, _TUPLE_DIVIDE)
TUPLE __operator__neg__(TUPLE a) { return TUPLE(EACH(_TUPLE_NEGATE)); }
int __operator__eq__(TUPLE a, TUPLE b) { return BOTH(_TUPLE_EQUAL); }
int __operator__neq__(TUPLE a, TUPLE b) { return !(a == b); }

#define _TUPLE_ABS(p) abs(a.p)
#define _TUPLE_CEIL(p) ceil(a.p)
#define _TUPLE_FLOOR(p) floor(a.p)
#define _TUPLE_SQRT(p) sqrt(a.p)
#define _TUPLE_EXP(p) exp(a.p)
#define _TUPLE_LOG(p) log(a.p)
#define _TUPLE_LOG2(p) log2(a.p)
#define _TUPLE_SIGN(p) sign(a.p)
#define _TUPLE_SIN(p) sin(a.p)
#define _TUPLE_COS(p) cos(a.p)
#define _TUPLE_TAN(p) tan(a.p)
#define _TUPLE_ASIN(p) asin(a.p)
#define _TUPLE_ACOS(p) acos(a.p)
TUPLE abs(TUPLE a) { return TUPLE(EACH(_TUPLE_ABS)); }
TUPLE ceil(TUPLE a) { return TUPLE(EACH(_TUPLE_CEIL)); }
TUPLE floor(TUPLE a) { return TUPLE(EACH(_TUPLE_FLOOR)); }
TUPLE sqrt(TUPLE a) { return TUPLE(EACH(_TUPLE_SQRT)); }
TUPLE exp(TUPLE a) { return TUPLE(EACH(_TUPLE_EXP)); }
TUPLE log(TUPLE a) { return TUPLE(EACH(_TUPLE_LOG)); }
TUPLE log2(TUPLE a) { return TUPLE(EACH(_TUPLE_LOG2)); }
TUPLE sign(TUPLE a) { return TUPLE(EACH(_TUPLE_SIGN)); }
TUPLE sin(TUPLE a) { return TUPLE(EACH(_TUPLE_SIN)); }
TUPLE cos(TUPLE a) { return TUPLE(EACH(_TUPLE_COS)); }
TUPLE tan(TUPLE a) { return TUPLE(EACH(_TUPLE_TAN)); }
TUPLE asin(TUPLE a) { return TUPLE(EACH(_TUPLE_ASIN)); }
TUPLE acos(TUPLE a) { return TUPLE(EACH(_TUPLE_ACOS)); }

#define _TUPLE_MIN(p) min(a.p, b.p)
#define _TUPLE_MAX(p) max(a.p, b.p)
#define _TUPLE_FMOD(p) fmod(a.p, b.p)
#define _TUPLE_POW(p) pow(a.p, b.p)
#define _TUPLE_ATAN2(p) atan2(a.p, b.p)
#define _TUPLE_FUNCTION(name, part)                          \
  TUPLE name(TUPLE a, TUPLE b) { return TUPLE(EACH(part)); } \
  TUPLE name(TUPLE a, float x) { TUPLE b = TUPLE(ALL(x)); return TUPLE(EACH(part)); }
_TUPLE_FUNCTION(min, _TUPLE_MIN)
_TUPLE_FUNCTION(max, _TUPLE_MAX)
_TUPLE_FUNCTION(fmod, _TUPLE_FMOD)
_TUPLE_FUNCTION(pow, _TUPLE_POW)
_TUPLE_FUNCTION(atan2, _TUPLE_ATAN2)

#define _TUPLE_MIX(p) mix(a.p, b.p, x)
#define _TUPLE_CLAMP(p) clamp(a.p, low.p, high.p)
#define _TUPLE_STEP(p) smoothstep(low.p, high.p, a.p)
TUPLE mix(TUPLE a, TUPLE b, float x) { return TUPLE(EACH(_TUPLE_MIX)); }
TUPLE clamp(TUPLE a, TUPLE low, TUPLE high) { return TUPLE(EACH(_TUPLE_CLAMP)); }
TUPLE clamp(TUPLE a, float low, float high) { return clamp(a, TUPLE(ALL(low)), TUPLE(ALL(high))); }
TUPLE smoothstep(TUPLE low, TUPLE high, TUPLE a) { return TUPLE(EACH(_TUPLE_STEP)); }
TUPLE smoothstep(float low, float high, TUPLE a) { return smoothstep(TUPLE(ALL(low)), TUPLE(ALL(high)), a); }

#undef TUPLE
#undef EACH
#undef ALL
#undef BOTH
)osl";

}  // namespace etendue::osl
