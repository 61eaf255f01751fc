// What several kinds of requests have in common.

#include "requests.h"

#include <fmt/format.h>

#include <filesystem>

namespace etendue::studio {

void require_no_draft(const Document& document) {
  if (document.draft())
    throw RequestError("draft", "the text has errors: correct it, or discard what was typed, before other edits");
}

TextEditor editor_for(const Call& call) {
  static_cast<void>(call.studio.valid_render());
  require_no_draft(call.studio.document());
  return TextEditor(call.studio.document());
}

Slot slot_of(const Call& call) { return slot(call.component(), call.text("member"), call.index()); }

Json tell(const Call& call, const Applied& applied) {
  call.studio.tell_edit(applied, &call);
  return {{"revision", call.studio.document().revision()}};
}

Json apply(const Call& call, const TextEditor& editor, const std::string& label) {
  return tell(call, call.studio.document().apply(editor.text(), {label, call.text_or("merge", "")}));
}

std::string allowed_path(const Call& call, const std::string& path) {
  if (path.empty()) throw RequestError("bad_request", "the name of a file is missing");
  const std::string whole = path.front() == '/' ? path : call.studio.document().folder() + "/" + path;
  try {
    return call.studio.folders().inside(whole);
  } catch (const Error& error) {
    throw RequestError("not_allowed", error.what());
  }
}

void require_free(const Call& call, const std::string& path) {
  std::error_code error;
  if (!call.flag("over") && std::filesystem::exists(path, error))
    throw RequestError("changed_on_disk", fmt::format("'{}' exists already", path));
}

void require_saved(const Call& call) {
  if (call.studio.document().changed() && !call.flag("discard"))
    throw RequestError("busy", "there are changes that are not saved");
}

void make_fine(Studio& studio) {
  studio.fine_at.reset();
  if (studio.coarse.exchange(false)) studio.apply_overrides();
}

SeenPoint::SeenPoint(const Call& call, const Job& job)
    : ray(job.camera->ray({float(call.number("x")) + 0.5f, float(call.number("y")) + 0.5f}, {0.5f, 0.5f},
                          job.camera->shutter_open)) {
  ray.of_camera = true;
  found = job.scene->nearest(ray, hit);
  if (found) job.scene->locate(ray, hit, point);
}

}  // namespace etendue::studio
