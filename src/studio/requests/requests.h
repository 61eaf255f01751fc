#pragma once
// The requests of docs/studio-protocol.md, a file for each subject. A file ends with the table of its requests; a new request
// is a function and a row there. This header declares what several of them need.
//
//   edits       members and components are changed, undo
//   text        the text is changed as it is typed, completion, explanations
//   files       the document is opened and saved, folders are listed
//   render      renders are controlled: the document's own, and those beside it
//   pictures    whole pictures: which ones a page gets, saving, pinning
//   pixels      single pixels: what they show, their values, the paths and samples behind them
//   space       what is shown in space: a wireframe, photons, the pdf of a guide
//   camera      the camera is moved
//   views       saved views
//   checks      warnings, and tasks that take longer: conformance, verification, the contributions of strategies
//   queue       files that are rendered one after the other
//   program     the first request of a page, the manual, the end of the program

#include "etendue/scene.h"
#include "studio/document/text_editor.h"
#include "studio/request.h"

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
/// Throws RequestError if the document has unsaved changes, unless the argument `discard` is true.
void require_saved(const Call&);
/// Switches from the low-resolution picture of a moving camera to full resolution, so that pixel coordinates refer to the
/// latter.
void make_fine(Studio&);

/// The surface point seen in the pixel that the arguments `x` and `y` name, along the ray through the pixel's centre.
struct SeenPoint {
  SeenPoint(const Call&, const Job&);
  Ray ray;
  Hit hit;
  SurfacePoint point;
  bool found = false;
};

/// The coordinates of a point or vector.
template <class V>
Json triple(const V& v) {
  return {v.x, v.y, v.z};
}

}  // namespace etendue::studio
