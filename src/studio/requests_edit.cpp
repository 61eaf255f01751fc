// Requests that change members, and events that report changes.

#include <fmt/format.h>

#include "requests.h"

namespace etendue::studio {

void require_no_draft(const Document& document) {
  if (document.draft())
    throw RequestError("draft", "the text has errors: correct it, or discard what was typed, before other edits");
}

Json tell(const Call& call, const Applied& applied) {
  call.studio.tell_edit(applied, &call);
  return {{"revision", call.studio.document().revision()}};
}

/// Applies the editor's text to the document.
Json apply(const Call& call, const TextEditor& editor, const std::string& label) {
  return tell(call, call.studio.document().apply(editor.text(), {label, call.text_or("merge", "")}));
}

TextEditor editor_for(const Call& call) {
  static_cast<void>(call.studio.valid_render());
  require_no_draft(call.studio.document());
  return TextEditor(call.studio.document());
}

Slot slot_of(const Call& call) { return slot(call.component(), call.text("member"), call.index()); }

// ---- events ----------------------------------------------------------------------------------------------------------------

void Studio::tell_edit(const Applied& applied, const Call* call) {
  const std::shared_ptr<Render> render = document_.render();
  const Document& d = document_;
  // The previous text is not kept: the length of the replaced part follows from the lengths of the text before and after the
  // change.
  const TextChange& change = applied.change;
  const bool textual = change.begin != change.end || !change.insert.empty();
  runner_.follow(render);
  runner_.hurry();
  ++generation;
  if (textual) {
    const size_t begin = d.places().units(change.begin);
    const size_t inserted = d.places().units(change.begin + change.insert.size()) - begin;
    const size_t behind = d.places().size() - begin - inserted;
    Json event = {{"event", "text"},
                  {"revision", d.revision()},
                  {"changes", Json::array({{{"begin", begin}, {"end", text_units_ - behind}, {"insert", change.insert}}})}};
    if (call) {
      event["by"] = call->browser.number;
      event["request"] = call->id;
    }
    broadcast(event);
  }
  text_units_ = d.places().size();
  if (applied.structure) {
    broadcast(tree_json(d));
  } else if (textual || !applied.components.empty()) {
    Json update = Json::object();
    for (const int id : applied.components) update[std::to_string(id)] = component_json(d, *d.component(id));
    broadcast({{"event", "tree"}, {"revision", d.revision()}, {"update", update}, {"names", names_json(d)}});
  }
  tell_document();
  follow_sides();
  wake_viewer();
}

void Studio::tell_all() {
  runner_.follow(document_.render());
  for (const auto& side : sides_.all()) side->reload();
  ++generation;
  text_units_ = document_.places().size();
  broadcast(document_json());
  broadcast(text_json());
  broadcast(tree_json(document_));
  wake_viewer();
}

void Studio::tell_document() { broadcast(document_json()); }

Json Studio::text_json() const {
  Json json = {{"event", "text"}, {"revision", document_.revision()}, {"text", document_.text()}};
  if (document_.draft())
    json["draft"] = {{"text", document_.draft()->text}, {"errors", errors_json(document_.draft()->errors, &document_)}};
  return json;
}

Json Studio::document_json() const {
  const Document& d = document_;
  const auto text = [](const std::optional<std::string>& t) { return t ? Json(*t) : Json(); };
  const std::string& file = d.file();
  return {{"event", "document"},
          {"file", file.empty() ? Json() : Json(file)},
          {"title", file.empty() ? "new.etd" : file.substr(file.rfind('/') + 1)},
          {"revision", d.revision()},
          {"saved_revision", d.saved_revision()},
          {"changed", d.changed()},
          {"undo", text(d.undo_label())},
          {"redo", text(d.redo_label())},
          {"undo_count", d.undo_count()},
          {"redo_count", d.redo_count()},
          {"valid", d.valid()},
          {"draft", d.draft().has_value()},
          {"errors", d.draft() ? errors_json(d.draft()->errors, &d) : Json::array()},
          {"warnings", Json::array()},
          {"changed_on_disk", d.changed_on_disk()}};
}

namespace {

// ---- members ----------------------------------------------------------------------------------------------------------------

Json edit(const Call& call) {
  TextEditor editor = editor_for(call);
  editor.set(slot_of(call), call.text("text"));
  return apply(call, editor, "edit " + call.text("member"));
}

Json edits(const Call& call) {
  TextEditor editor = editor_for(call);
  if (!call.has("edits") || !call.request["edits"].is_array() || call.request["edits"].empty())
    throw RequestError("bad_request", "'edits' must be a list of edits");
  std::string label;
  for (const Json& one : call.request["edits"]) {
    if (!one.is_object()) throw RequestError("bad_request", "an edit is an object");
    const Call part{call.studio, call.browser, one, call.id};
    editor.set(slot_of(part), part.text("text"));
    label += (label.empty() ? "edit " : ", ") + part.text("member");
  }
  return apply(call, editor, label);
}

Json reset(const Call& call) {
  TextEditor editor = editor_for(call);
  editor.reset(slot_of(call));
  return apply(call, editor, "reset " + call.text("member"));
}

Json undo_or_redo(const Call& call, bool back) {
  require_no_draft(call.studio.document());
  Json reply;
  for (std::int64_t count = call.integer_or("count", 1, 1, 1'000'000); count > 0; --count) {
    Document& document = call.studio.document();
    if ((back ? document.undo_count() : document.redo_count()) == 0 && !reply.is_null()) break;
    reply = tell(call, back ? document.undo() : document.redo());
  }
  return reply;
}

Json undo(const Call& call) { return undo_or_redo(call, true); }
Json redo(const Call& call) { return undo_or_redo(call, false); }

}  // namespace

std::span<const Request> edit_requests() {
  static constexpr Request all[] = {
      {"edit", false, edit}, {"edits", false, edits}, {"reset", false, reset}, {"undo", false, undo}, {"redo", false, redo},
  };
  return all;
}

}  // namespace etendue::studio
