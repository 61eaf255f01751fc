#pragma once
// String: the texts of shaders, interned. Equal texts have equal addresses, so a shader's comparison of strings is a comparison
// of addresses, and a string variable is one address that may be copied bit by bit.

#include <cstdint>
#include <string>
#include <string_view>

namespace etendue::osl {

/// A text that lives as long as the process. A string variable in memory is a `const String*`, never null.
class String {
 public:
  const std::string& text() const { return text_; }
  std::string_view view() const { return text_; }
  /// What the library's hash() returns: the lower half of farm_hash.
  std::uint32_t hash() const { return hash_; }

  String(std::string_view text, std::uint32_t hash) : text_(text), hash_(hash) {}  ///< for the table only: use intern_string
  String(const String&) = delete;
  String& operator=(const String&) = delete;

 private:
  const std::string text_;
  const std::uint32_t hash_;
};

/// The one String of a text. Safe to be called from several threads. Texts are never freed: the library limits what one shader
/// may make, see string_limit.
const String* intern_string(std::string_view);
/// The String of "".
const String* empty_string();

/// The longest text [bytes] that a function of the library makes; a longer one is an error of the shader.
inline constexpr std::size_t string_limit = std::size_t(1) << 20;

/// The size of all interned texts [bytes], and where the library stops to make new ones: shaders that make endless texts end
/// there.
std::size_t interned_bytes();
inline constexpr std::size_t interned_limit = std::size_t(1) << 30;

/// The 64-bit FarmHash (Pike and Alakuijala 2014) in the form of OpenImageIO, which the reference implementation uses: 0 for
/// "".
std::uint64_t farm_hash(std::string_view);

}  // namespace etendue::osl
