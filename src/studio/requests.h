#pragma once
// What requests have in common.

#include "studio.h"
#include "studio/document/text_editor.h"

namespace etendue::studio {

/// Throws RequestError while there is a text that was typed and is not valid: another edit would lose it.
void require_no_draft(const Document&);
/// An editor of the document's text, if that may be edited now.
TextEditor editor_for(const Call&);
/// The slot that `component`, `member` and `index` name.
Slot slot_of(const Call&);
/// Applies what an editor made of the text, and tells of it. The beginning of the reply.
Json apply(const Call&, const TextEditor&, const std::string& label);
Json tell(const Call&, const Applied&);
/// The path as one that may be read or written; relative ones start from the document's folder.
std::string allowed_path(const Call&, const std::string& path);
/// Refuses to write over a file that is there, unless `over` is true.
void require_free(const Call&, const std::string& path);

}  // namespace etendue::studio
