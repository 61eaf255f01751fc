#pragma once
// Decodes the buffer views of EXT_meshopt_compression and KHR_meshopt_compression. Source: the appendices A (Bitstream) and B
// (Filters) of the latter, The Khronos Group 2026.

#include <cstdint>
#include <string>
#include <string_view>

namespace etendue::gltf {

enum class MeshoptMode : std::uint8_t { attributes, triangles, indices };
enum class MeshoptFilter : std::uint8_t { none, octahedral, quaternion, exponential, color };

/// The decoded content of a view: `count` elements of `stride` bytes.
struct MeshoptLayout {
  MeshoptMode mode = MeshoptMode::attributes;
  MeshoptFilter filter = MeshoptFilter::none;
  std::uint64_t count = 0, stride = 0;
};

/// The view's decoded bytes. Throws Error with the reason, without a location. Nothing is allocated before it is checked that
/// the compressed bytes can encode the result, at most 1024 bytes for each.
std::string decode_meshopt(std::string_view compressed, const MeshoptLayout&);

/// Undoes a filter, in place.
void undo_meshopt_filter(MeshoptFilter, std::uint64_t count, std::uint64_t stride, char* bytes);

}  // namespace etendue::gltf
