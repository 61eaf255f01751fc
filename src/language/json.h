#pragma once
// Render descriptions as JSON: the same components, names and expressions in a form that programs write. docs/language.md
// describes it, and `etendue schema` prints its JSON schema.

#include <string>
#include <string_view>

#include "etendue/describe/component.h"
#include "syntax.h"

namespace etendue {

/// A description in JSON that reads back as an equal component; the options are those of write_description.
std::string write_json(const Component&, bool all = false, const std::string& folder = {});

namespace language {

/// Whether a file or text with this name is JSON, by its extension.
bool is_json(std::string_view name);
/// Parses the statements of a JSON text and reports errors.
Document parse_json(const Source&, Diagnostics&);
/// Parses the expression in a JSON string; null if it has errors (which are reported). Locations are those in the JSON text.
std::unique_ptr<Node> parse_json_string(const Node&, Diagnostics&);
/// The path of a location through the objects and lists of a JSON text: "scene.objects[2].radius"; "" at its root or if the
/// text is not JSON.
std::string json_path(const std::string& text, const Location&);

}  // namespace language
}  // namespace etendue
