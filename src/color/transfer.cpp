// Transfer functions of image files, extended to odd functions for negative values; values above 1 follow the same formula.

#include <cmath>

#include "etendue/describe/color.h"
#include "named.h"
#include "tables.h"

namespace etendue {

namespace {

struct Transfer {
  const char* name;
  const char* aliases;
  double (*encode)(double);
  double (*decode)(double);
};

/// A power with a linear toe: slope * x below `toe`, else (1 + offset) x^power - offset. IEC 61966-2-1's published
/// constants for sRGB; for Rec. 709 those of Rec. 2020 in full precision, which make it continuous.
template <double slope, double toe, double offset, double power>
struct Toe {
  static double encode(double x) { return x <= toe ? slope * x : (1 + offset) * std::pow(x, power) - offset; }
  static double decode(double x) {
    constexpr double encoded_toe = slope * toe;
    return x <= encoded_toe ? x / slope : std::pow((x + offset) / (1 + offset), 1 / power);
  }
};
using Srgb = Toe<12.92, 0.0031308, 0.055, 1 / 2.4>;
using Rec709 = Toe<4.5, 0.018053968510807, 0.09929682680944, 0.45>;

constexpr Transfer transfers[] = {
    {"linear", "", [](double x) { return x; }, [](double x) { return x; }},
    {"srgb", "", Srgb::encode, Srgb::decode},
    {"rec709", "", Rec709::encode, Rec709::decode},
    {"gamma2.2", "", [](double x) { return std::pow(x, 1 / 2.2); }, [](double x) { return std::pow(x, 2.2); }},
};

const Transfer& find(const std::string& name) {
  return find_named(std::span<const Transfer>(transfers), "transfer function", name);
}

}  // namespace

double encode_transfer(const std::string& transfer, double linear) {
  return std::copysign(find(transfer).encode(std::abs(linear)), linear);
}

double decode_transfer(const std::string& transfer, double encoded) {
  return std::copysign(find(transfer).decode(std::abs(encoded)), encoded);
}

std::vector<std::string> transfer_names() { return names_of(std::span<const Transfer>(transfers)); }

}  // namespace etendue
