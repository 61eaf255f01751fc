#pragma once
// Bytes of buffer views as EXT_meshopt_compression and KHR_meshopt_compression keep them. Source: the appendices A (Bitstream)
// and B (Filters) of the latter, The Khronos Group 2026.

#include <cstdint>
#include <string>
#include <string_view>

namespace etendue::gltf {

enum class MeshoptMode : std::uint8_t { attributes, triangles, indices };
enum class MeshoptFilter : std::uint8_t { none, octahedral, quaternion, exponential, color };

/// What a view holds: `count` elements of `stride` bytes.
struct MeshoptLayout {
  MeshoptMode mode = MeshoptMode::attributes;
  MeshoptFilter filter = MeshoptFilter::none;
  std::uint64_t count = 0, stride = 0;
};

/// The view's bytes. Throws Error with the reason alone; nothing is allocated that the compressed bytes cannot stand for, which
/// is at most 1024 for each.
std::string decode_meshopt(std::string_view compressed, const MeshoptLayout&);

/// Undoes a filter, in place.
void undo_meshopt_filter(MeshoptFilter, std::uint64_t count, std::uint64_t stride, char* bytes);

}  // namespace etendue::gltf
