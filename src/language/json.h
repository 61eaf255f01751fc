#pragma once
// Render descriptions as JSON: the same components, names and expressions in the form that programs write. docs/language.md
// describes it, and `etendue schema` prints what may stand where.

#include <string>
#include <string_view>

#include "etendue/describe/component.h"
#include "syntax.h"

namespace etendue {

/// A description in JSON that reads back as an equal component; options as those of write_description.
std::string write_json(const Component&, bool all = false, const std::string& folder = {});

namespace language {

/// Whether a file or text of this name is JSON: by its ending.
bool is_json(std::string_view name);
/// Reads statements of a JSON text, reporting what is wrong.
Document parse_json(const Source&, Diagnostics&);
/// The expression that a JSON string holds; null when it is wrong (and reported). Places are those in the JSON text.
std::unique_ptr<Node> parse_json_string(const Node&, Diagnostics&);
/// Where a place is within the objects and lists of a JSON text: "scene.objects[2].radius"; "" at its root or when it is not
/// JSON.
std::string json_path(const std::string& text, const Location&);

}  // namespace language
}  // namespace etendue
