#pragma once
// Entities of XML: texts that a document declares, and names where they are to stand.

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace etendue::mitsuba {

/// From `begin` in an expanded text on, what was written at `written` stands, all of it one after the other; `whole`: up to the
/// next expansion it stands for what was written there.
struct Expansion {
  size_t begin, written;
  bool whole;
};

struct ExpandedText {
  std::string text;
  std::vector<Expansion> expansions;  ///< by `begin`
  size_t declared;                    ///< where the first declaration was written
};

class EntityError : public std::runtime_error {
 public:
  EntityError(const std::string& what, size_t at) : std::runtime_error(what), place(at) {}
  size_t place;  ///< in the text as it was written
};

/// The text with all entities that it declares in their places; nothing: it declares none. Throws EntityError for one that
/// stands for another file or for itself, and where all of them would be too long.
std::optional<ExpandedText> expand_entities(std::string_view text);

/// Where something of an expanded text was written.
size_t written_at(const std::vector<Expansion>&, size_t offset);

}  // namespace etendue::mitsuba
