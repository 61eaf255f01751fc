#pragma once
// XML entities: texts that a document declares, and their expansion where the document refers to them.

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace etendue::mitsuba {

/// Maps offsets of the expanded text to the source. From `begin` in the expanded text on, the text was copied from `written` in
/// the source, character by character; if `whole`, all of it up to the next expansion replaces the reference at `written`.
struct Expansion {
  size_t begin, written;
  bool whole;
};

struct ExpandedText {
  std::string text;
  std::vector<Expansion> expansions;  ///< by `begin`
  size_t declared;                    ///< offset of the first declaration in the source
};

class EntityError : public std::runtime_error {
 public:
  EntityError(const std::string& what, size_t at) : std::runtime_error(what), place(at) {}
  size_t place;  ///< offset in the source
};

/// The text with all entities expanded that it declares; nothing: it declares none. Throws EntityError for an entity that
/// refers to a file or to itself, and if the expansions would be too long.
std::optional<ExpandedText> expand_entities(std::string_view text);

/// The offset in the source of an offset in the expanded text.
size_t written_at(const std::vector<Expansion>&, size_t offset);

}  // namespace etendue::mitsuba
