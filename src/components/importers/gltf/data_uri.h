#pragma once
// URIs in glTF files: embedded data, and file names.

#include <optional>
#include <string>
#include <string_view>

namespace etendue::gltf {

/// The media type of a data URI ("image/png") and its bytes; empty if it is no data URI. Throws Error if it is damaged.
struct UriData {
  std::string type, bytes;
};
bool is_data_uri(std::string_view uri);
UriData decode_data_uri(std::string_view uri);
/// Replaces percent escapes: "my%20file.png" becomes "my file.png".
std::string decode_percents(std::string_view uri);

}  // namespace etendue::gltf
