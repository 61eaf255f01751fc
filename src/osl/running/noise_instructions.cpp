// Noise of numbers without derivatives: called as a function of its coordinates alone, which stay in registers, instead of by
// the addresses of a Call that it first has to take apart.

#include <string_view>
#include <utility>

#include "coded_numbers.h"
#include "library_code.h"
#include "osl/library/noise.h"

namespace etendue::osl {
namespace {

using Noise = void (*)(const Position<float>&, int count, float* out);
template <std::size_t>
using Coordinate = float;

template <Noise noise, bool is_unsigned, class Indices>
struct OfCoordinates;
template <Noise noise, bool is_unsigned, std::size_t... i>
struct OfCoordinates<noise, is_unsigned, std::index_sequence<i...>> {
  static float value(Coordinate<i>... x) {
    float out = 0;
    if constexpr (noise == static_cast<Noise>(perlin_noise))
      out = perlin_noise(x...);
    else
      noise({int(sizeof...(i)), {x...}, false, {}}, 1, &out);
    return is_unsigned ? 0.5f * (out + 1) : out;
  }
};

template <Noise noise, bool is_unsigned = false>
const void* of_dimensions(int n) {
  switch (n) {
    case 1: return reinterpret_cast<const void*>(&OfCoordinates<noise, is_unsigned, std::make_index_sequence<1>>::value);
    case 2: return reinterpret_cast<const void*>(&OfCoordinates<noise, is_unsigned, std::make_index_sequence<2>>::value);
    case 3: return reinterpret_cast<const void*>(&OfCoordinates<noise, is_unsigned, std::make_index_sequence<3>>::value);
    case 4: return reinterpret_cast<const void*>(&OfCoordinates<noise, is_unsigned, std::make_index_sequence<4>>::value);
    default: return nullptr;
  }
}

constexpr Noise perlin = perlin_noise, simplex = simplex_noise;

/// The function of `n` coordinates; null: this kind is not called so.
const void* function_of(std::string_view kind, int n) {
  if (kind == "perlin" || kind == "snoise") return of_dimensions<perlin>(n);
  if (kind == "uperlin" || kind == "noise") return of_dimensions<perlin, true>(n);
  if (kind == "simplex") return of_dimensions<simplex>(n);
  if (kind == "usimplex") return of_dimensions<simplex, true>(n);
  if (kind == "cell" || kind == "cellnoise") return of_dimensions<cell_noise>(n);
  if (kind == "hash" || kind == "hashnoise") return of_dimensions<hash_noise>(n);
  return nullptr;
}

}  // namespace

bool emit_noise(const Row& row, const CodedCall& c) {
  std::string_view kind = row.signature;  // "TYPE noise(point p)", or with a name: "TYPE noise(string name, point p, ...)"
  kind = kind.substr(kind.find(' ') + 1);
  kind = kind.substr(0, kind.find('('));
  if (!function_of(kind, 1) || !c.result.type.is_float()) return false;
  std::size_t first = 0;
  if (c.arguments.front().memory.type.is_string()) {
    const std::byte* name = c.code.constant(c.arguments.front().memory.offset);
    if (!name) return false;
    kind = (*reinterpret_cast<const String* const*>(name))->view();
    first = 1;
  }
  const bool steps = kind == "cell" || kind == "hash" || kind == "cellnoise" || kind == "hashnoise";
  if (c.result.stride && !steps) return false;
  std::vector<Word> coordinates;
  for (std::size_t i = first; i < c.arguments.size(); ++i) {
    const Memory& m = c.arguments[i].memory;
    if (!m.type.is_float() && !(m.type.is_triple() && i == first)) return false;
    for (int k = 0; k < m.type.floats(); ++k) coordinates.push_back(load_number<Real>(c.code, m, k).word);
  }
  const void* const function = function_of(kind, int(coordinates.size()));
  if (!function) return false;
  store_number(c.code, c.result, 0, coded<Real>(c.code, c.code.call_pure(function, WordKind::float_, coordinates)));
  return true;
}

}  // namespace etendue::osl
