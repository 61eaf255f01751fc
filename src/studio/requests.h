#pragma once
// Helper functions for several kinds of requests.

#include "studio.h"
#include "studio/document/text_editor.h"

namespace etendue::studio {

/// Throws RequestError while there is a draft with errors: another edit would lose it.
void require_no_draft(const Document&);
/// An editor of the document's text; throws if the text cannot be edited now.
TextEditor editor_for(const Call&);
/// The slot that the arguments `component`, `member` and `index` name.
Slot slot_of(const Call&);
/// Applies the editor's text to the document and broadcasts the changes. Returns the beginning of the reply.
Json apply(const Call&, const TextEditor&, const std::string& label);
Json tell(const Call&, const Applied&);
/// The path, if it may be read or written; throws RequestError otherwise. Relative paths start from the document's folder.
std::string allowed_path(const Call&, const std::string& path);
/// Throws RequestError if the file exists, unless the argument `over` is true.
void require_free(const Call&, const std::string& path);

}  // namespace etendue::studio
