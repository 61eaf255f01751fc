#pragma once
// URIs in glTF files: data within them, and names of files.

#include <optional>
#include <string>
#include <string_view>

namespace etendue::gltf {

/// What follows "data:": its type ("image/png") and its bytes; none: it is no data URI. Throws Error when it is damaged.
struct UriData {
  std::string type, bytes;
};
bool is_data_uri(std::string_view uri);
UriData decode_data_uri(std::string_view uri);
/// "my%20file.png" as "my file.png".
std::string decode_percents(std::string_view uri);

}  // namespace etendue::gltf
