#pragma once
// Cryptomatte: mattes of all objects, materials or assets of a picture in one file, as other programs read them.
//
// Friedman & Jones 2015, "Fully automatic ID mattes with support for motion blur and transparency", and the specification by
// Psyop (github.com/Psyop/Cryptomatte, version 1.2.0). Each pixel has a list of identifiers with their coverages, by decreasing
// coverage ("ranks"). An identifier is the MurmurHash3 of a name, stored as the float with the same bits. The ranks lie in
// channels NAME00.R (identifier), .G (coverage), .B, .A (the next rank), NAME01.R and so on; the names, as JSON, in the file's
// metadata.

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "etendue/core/image.h"

namespace etendue {

/// MurmurHash3_x86_32 of bytes, with the seed 0 (Appleby 2011).
std::uint32_t murmur_hash3(std::string_view);
/// The identifier of a name: its hash, with one bit of the exponent flipped if the float of these bits would be zero,
/// denormal, infinite or not a number.
std::uint32_t cryptomatte_identifier(std::string_view name);

/// Mattes of one kind.
struct Cryptomatte {
  struct Rank {
    std::uint32_t identifier;
    float coverage;
  };
  std::string name;                               ///< "crypto_object", "crypto_material", …
  std::map<std::string, std::uint32_t> manifest;  ///< names and their identifiers
  int width = 0, height = 0;
  std::vector<std::vector<Rank>> pixels;  ///< by row, from the top; ranks by decreasing coverage
};

/// Adds the channels and metadata of a kind to a picture of the same size, with so many ranks: an even number.
void add_cryptomatte(Image&, const Cryptomatte&, size_t ranks);
/// A picture with the channels and metadata of several kinds, all of the same size. `ranks` are kept of each pixel; 0: all.
Image cryptomatte_image(std::span<const Cryptomatte>, int ranks = 0);
/// The kinds in a picture that a file was read as. Throws Error if the metadata are damaged, or channels are missing.
std::vector<Cryptomatte> cryptomattes_of(const Image&);
/// The matte of one identifier: its coverage of each pixel, at most 1.
std::vector<float> coverage_of(const Cryptomatte&, std::uint32_t identifier);

}  // namespace etendue
