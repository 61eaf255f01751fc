// Rows of the table: all noises.
//
// One evaluation function serves them all: a call is taken apart into a position (coordinates, then periods), the kind of noise
// and its options, once for the types, and by the noise's name for each run.

#include <fmt/format.h>

#include <bit>

#include "choose.h"
#include "lattice_hash.h"
#include "noise.h"
#include "parts.h"
#include "services.h"

namespace etendue::osl {

namespace {

enum class Kind { perlin, unsigned_perlin, cell, hash, simplex, unsigned_simplex, gabor, null, unsigned_null, unknown };

Kind kind_of(const String* name) {
  static const std::pair<const String*, Kind> kinds[] = {{intern_string("perlin"), Kind::perlin},
                                                         {intern_string("snoise"), Kind::perlin},
                                                         {intern_string("uperlin"), Kind::unsigned_perlin},
                                                         {intern_string("noise"), Kind::unsigned_perlin},
                                                         {intern_string("cell"), Kind::cell},
                                                         {intern_string("hash"), Kind::hash},
                                                         {intern_string("simplex"), Kind::simplex},
                                                         {intern_string("usimplex"), Kind::unsigned_simplex},
                                                         {intern_string("gabor"), Kind::gabor},
                                                         {intern_string("null"), Kind::null},
                                                         {intern_string("unull"), Kind::unsigned_null}};
  for (const auto& [known, kind] : kinds)
    if (known == name) return kind;
  return Kind::unknown;
}

/// Reads coordinates, or periods, from argument i on: a point has three, and a float may follow. Returns the next argument.
template <class N>
int read_coordinates(const Call& c, int i, int most, std::array<N, most_dimensions>& to, int& dimensions) {
  dimensions = 0;
  while (i < c.count() && dimensions < most) {
    const Type& type = c.type(i);
    if (type.is_triple() && dimensions == 0) {
      for (int k = 0; k < 3; ++k) to[std::size_t(dimensions++)] = component<N>(c, i, k);
    } else if (type.is_float()) {
      to[std::size_t(dimensions++)] = c.get<N>(i);
    } else {
      break;
    }
    ++i;
  }
  return i;
}

/// How many coordinates the call has: the floats and the point behind the name, without the periods, which are as many again.
int dimensions_of(const Call& c, int first, bool periodic) {
  int count = 0;
  for (int i = first; i < c.count() && (c.type(i).is_float() || c.type(i).is_triple()); ++i)
    count += c.type(i).is_triple() ? 3 : 1;
  return std::min(periodic ? count / 2 : count, most_dimensions);
}

GaborOptions read_options(const Call& c, int i) {
  GaborOptions options;
  for (; i + 1 < c.count(); i += 2) {
    if (!c.type(i).is_string()) break;
    const std::string_view name = c.string(i)->view();
    const Type& type = c.type(i + 1);
    const bool number = type.is_float() || type.is_int();
    const float value = !number ? 0 : (type.is_int() ? float(c.at<int>(i + 1)) : c.at<float>(i + 1));
    if (name == "anisotropic" && type.is_int())
      options.anisotropic = c.at<int>(i + 1);
    else if (name == "do_filter" && type.is_int())
      options.filter = c.at<int>(i + 1) != 0;
    else if (name == "direction" && type.is_triple())
      options.direction = c.at<Triple>(i + 1);
    else if (name == "bandwidth" && number)
      options.bandwidth = value;
    else if (name == "impulses" && number)
      options.impulses = value;
    else
      c.services.warn(fmt::format("Unknown noise optional argument: \"{}\", <{}>", name, type.name()), c.types.place);
  }
  return options;
}

/// (1 + n) / 2, from [-1, 1] to [0, 1].
template <class N>
void make_unsigned(int count, N* values) {
  for (int c = 0; c < count; ++c) values[c] = N(0.5f) * (values[c] + N(1));
}

template <class N>
Position<float> plain(const Position<N>& p) {
  if constexpr (is_dual<N>) {
    Position<float> r{p.dimensions, {}, p.periodic, p.period};
    for (int d = 0; d < p.dimensions; ++d) r.at[std::size_t(d)] = p.at[std::size_t(d)].value;
    return r;
  } else {
    return p;
  }
}

/// A noise that is constant in pieces, as numbers with or without derivatives.
template <class N>
void constant_noise(void (*noise)(const Position<float>&, int, float*), const Position<N>& p, int count, N* out) {
  float values[3];
  noise(plain(p), count, values);
  for (int c = 0; c < count; ++c) out[c] = N(values[c]);
}

template <class N>
void give(const Call& c, int count, const N* values) {
  float* to = static_cast<float*>(c.result);
  for (int k = 0; k < count; ++k) detail::set<N>(to + k, count, values[k]);
}

/// Gabor noise needs the derivatives of the coordinates to filter, also where its own are not wanted.
template <class N>
void gabor(const Call& c, int first, int dimensions, const Position<N>& p, int options_at, int count, N* out) {
  Position<Dual<float>> q{dimensions, {}, p.periodic, p.period};
  int read = 0;
  read_coordinates(c, first, dimensions, q.at, read);
  Dual<float> values[3];
  gabor_noise(q, read_options(c, options_at), count, values);
  for (int k = 0; k < count; ++k)
    if constexpr (is_dual<N>)
      out[k] = values[k];
    else
      out[k] = values[k].value;
}

template <class N>
void noise(const Call& c, Kind kind, int first, bool periodic) {
  const int count = c.types.result.type.is_triple() ? 3 : 1;
  Position<N> p;
  const int dimensions = dimensions_of(c, first, periodic);
  int next = read_coordinates(c, first, dimensions, p.at, p.dimensions);
  p.periodic = periodic;
  int periods = 0;
  if (periodic) next = read_coordinates(c, next, dimensions, p.period, periods);
  N values[3] = {};
  switch (kind) {
    case Kind::perlin:
    case Kind::unsigned_perlin: perlin_noise(p, count, values); break;
    case Kind::simplex:
    case Kind::unsigned_simplex: simplex_noise(p, count, values); break;
    case Kind::cell: constant_noise(cell_noise, p, count, values); break;
    case Kind::hash: constant_noise(hash_noise, p, count, values); break;
    case Kind::gabor: gabor(c, first, dimensions, p, next, count, values); break;
    default: break;
  }
  if (kind == Kind::unsigned_perlin || kind == Kind::unsigned_simplex || kind == Kind::unsigned_null)
    make_unsigned(count, values);
  give(c, count, values);
}

/// noise and its relatives whose kind is in their name.
template <Kind kind, bool periodic>
struct OfKind {
  template <bool D>
  static void evaluate(const Call& c) {
    noise<Number<float, D>>(c, kind, 0, periodic);
  }
};

template <bool periodic>
struct Named {
  template <bool D>
  static void evaluate(const Call& c) {
    const Kind kind = kind_of(c.string(0));
    if (kind == Kind::unknown) c.services.error(fmt::format("Unknown noise type \"{}\"", c.string(0)->text()), c.types.place);
    noise<Number<float, D>>(c, kind, 1, periodic);
  }
};

/// int hash(float u), hash(float u, float v), hash(point p), hash(point p, float t)
void hash_of_numbers(const Call& c) {
  std::array<float, most_dimensions> x;
  int n = 0;
  read_coordinates(c, 0, most_dimensions, x, n);
  std::uint32_t k[most_dimensions] = {};
  for (int d = 0; d < n; ++d) k[d] = std::bit_cast<std::uint32_t>(x[std::size_t(d)]);
  const std::uint32_t hash = n == 1   ? hash_words(k[0])
                             : n == 2 ? hash_words(k[0], k[1])
                             : n == 3 ? hash_words(k[0], k[1], k[2])
                                      : hash_words(k[0], k[1], k[2], k[3]);
  c.give(int(hash));
}

void hash_of_int(const Call& c) { c.give(int(hash_words(std::uint32_t(c.at<int>(0))))); }

constexpr Derivatives passed = Derivatives::passed, none = Derivatives::none, taken = Derivatives::taken;

#define ETENDUE_OSL_NOISE(NAME, KIND, HOW)                                             \
  {"TYPE " NAME "(float x)", with_derivatives<OfKind<KIND, false>>, HOW},              \
      {"TYPE " NAME "(float x, float y)", with_derivatives<OfKind<KIND, false>>, HOW}, \
      {"TYPE " NAME "(point p)", with_derivatives<OfKind<KIND, false>>, HOW}, {        \
    "TYPE " NAME "(point p, float t)", with_derivatives<OfKind<KIND, false>>, HOW      \
  }

#define ETENDUE_OSL_PERIODIC_NOISE(NAME, KIND, HOW)                                                                   \
  {"TYPE " NAME "(float x, float x_period)", with_derivatives<OfKind<KIND, true>>, HOW},                              \
      {"TYPE " NAME "(float x, float y, float x_period, float y_period)", with_derivatives<OfKind<KIND, true>>, HOW}, \
      {"TYPE " NAME "(point p, point period)", with_derivatives<OfKind<KIND, true>>, HOW}, {                          \
    "TYPE " NAME "(point p, float t, point period, float t_period)", with_derivatives<OfKind<KIND, true>>, HOW        \
  }

constexpr Row rows[] = {
    ETENDUE_OSL_NOISE("noise", Kind::unsigned_perlin, passed),
    ETENDUE_OSL_NOISE("snoise", Kind::perlin, passed),
    ETENDUE_OSL_NOISE("cellnoise", Kind::cell, none),
    ETENDUE_OSL_NOISE("hashnoise", Kind::hash, none),
    ETENDUE_OSL_PERIODIC_NOISE("pnoise", Kind::unsigned_perlin, passed),
    ETENDUE_OSL_PERIODIC_NOISE("psnoise", Kind::perlin, passed),
    // Of the named ones only "gabor" takes derivatives, which the compiler sees if the name is a constant.
    // The rows with more coordinates come first, as further floats are coordinates.
    {"TYPE noise(string name, float x, float y, ...)", with_derivatives<Named<false>>, taken, 0, nullptr, false},
    {"TYPE noise(string name, float x, ...)", with_derivatives<Named<false>>, taken, 0, nullptr, false},
    {"TYPE noise(string name, point p, float t, ...)", with_derivatives<Named<false>>, taken, 0, nullptr, false},
    {"TYPE noise(string name, point p, ...)", with_derivatives<Named<false>>, taken, 0, nullptr, false},
    {"TYPE pnoise(string name, float x, float y, float x_period, float y_period, ...)", with_derivatives<Named<true>>, taken, 0,
     nullptr, false},
    {"TYPE pnoise(string name, float x, float x_period, ...)", with_derivatives<Named<true>>, taken, 0, nullptr, false},
    {"TYPE pnoise(string name, point p, float t, point period, float t_period, ...)", with_derivatives<Named<true>>, taken, 0,
     nullptr, false},
    {"TYPE pnoise(string name, point p, point period, ...)", with_derivatives<Named<true>>, taken, 0, nullptr, false},
    {"int hash(int i)", always<hash_of_int>, none},
    {"int hash(float u)", always<hash_of_numbers>, none},
    {"int hash(float u, float v)", always<hash_of_numbers>, none},
    {"int hash(point p)", always<hash_of_numbers>, none},
    {"int hash(point p, float t)", always<hash_of_numbers>, none},
};

#undef ETENDUE_OSL_NOISE
#undef ETENDUE_OSL_PERIODIC_NOISE

}  // namespace

std::span<const Row> noise_rows() { return rows; }

}  // namespace etendue::osl
