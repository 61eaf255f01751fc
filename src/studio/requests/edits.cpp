// Requests that edit the document by its components: their members, their places in lists and under names; undo and redo.

#include <fmt/format.h>

#include "requests.h"

namespace etendue::studio {

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

// ---- components -------------------------------------------------------------------------------------------------------------

/// A class of which components can be made. Throws Error with suggestions if there is none of this name.
const ClassInfo& concrete_class(const std::string& name) {
  const ClassInfo& info = class_named(name);
  if (info.abstract()) static_cast<void>(Registry::instance().create(name));  // throws Error
  return info;
}

/// The id of the component in a slot; 0 if there is none.
int part_in(const Document& document, const Slot& s, size_t index) {
  const Value value = s.member->get(*s.part, *s.member);
  if (const auto* one = value.as<Ref<Component>>()) return *one ? document.id_of(**one) : 0;
  const auto* list = value.as<Value::List>();
  if (!list || index >= list->size()) return 0;
  const auto* part = (*list)[index].as<Ref<Component>>();
  return part && *part ? document.id_of(**part) : 0;
}

Json with_component(Json reply, int id) {
  reply["component"] = id ? Json(id) : Json();
  return reply;
}

Json replace(const Call& call) {
  TextEditor editor = editor_for(call);
  const Ref<Component> part = call.component();
  const ClassInfo& now = concrete_class(call.text("class"));
  if (call.has("use")) {  // only this use: it becomes a copy first
    const Json& use = call.request["use"];
    if (!use.is_object()) throw RequestError("bad_request", "'use' must be {id, member, index}");
    const Call place{call.studio, call.browser, use, call.id};
    const Slot s = slot(place.component("id"), place.text("member"), place.index());
    if (!editor.name_in(s).empty()) {
      editor.set(s, new_component_text(now));
      const Json reply = apply(call, editor, "replace by " + now.name);
      return with_component(reply, part_in(call.studio.document(), s, s.index.value_or(0)));
    }
  }
  const auto uses = call.studio.document().uses(*part);
  editor.replace_class(part, now);
  const Json reply = apply(call, editor, "replace by " + now.name);
  if (uses.empty()) return reply;
  const Slot s{call.studio.document().component(uses[0].holder), uses[0].member, uses[0].index};
  return with_component(reply, part_in(call.studio.document(), s, uses[0].index.value_or(0)));
}

Json add(const Call& call) {
  TextEditor editor = editor_for(call);
  const Slot s = slot(call.component(), call.text("member"));
  const std::string text = call.has("text") ? call.text("text") : new_component_text(concrete_class(call.text("class")));
  const std::optional<size_t> index = call.index();
  const Value before = s.member->get(*s.part, *s.member);
  const auto* list = before.as<Value::List>();
  const size_t at = index.value_or(list ? list->size() : 0);
  if (s.member->list)
    editor.add(s, index, text);
  else
    editor.set(s, text);
  const Json reply = apply(call, editor, "add to " + s.member->name);
  return with_component(reply, part_in(call.studio.document(), s, at));
}

Json remove(const Call& call) {
  TextEditor editor = editor_for(call);
  const Slot s = slot_of(call);
  if (s.index)
    editor.remove(s);
  else if (s.member->required)
    editor.set(s, "none");
  else if (s.member->default_value.none())
    editor.reset(s);
  else
    editor.set(s, "none");
  return apply(call, editor, "remove from " + s.member->name);
}

Json duplicate(const Call& call) {
  TextEditor editor = editor_for(call);
  const Slot s = slot_of(call);
  if (!s.index) throw RequestError("bad_request", "'index' is missing");
  editor.add(s, *s.index + 1, editor.written(s));
  const Json reply = apply(call, editor, "duplicate in " + s.member->name);
  return with_component(reply, part_in(call.studio.document(), s, *s.index + 1));
}

Json move(const Call& call) {
  TextEditor editor = editor_for(call);
  const Slot from = slot_of(call);
  if (!from.index) throw RequestError("bad_request", "'index' is missing");
  const bool same = !call.has("component_to");
  const Slot to = same ? Slot{from.part, from.member, {}} : slot(call.component("component_to"), call.text("member_to"));
  const auto place = size_t(call.integer("to", 0, 1'000'000'000));
  const std::string text = editor.written(from);
  // Within one list, `to` is the final index of the entry.
  if (same && place == *from.index) return {{"revision", call.studio.document().revision()}};
  editor.remove(from);
  editor.add(to, place, text);
  return apply(call, editor, "move in " + from.member->name);
}

Json share(const Call& call) {
  TextEditor editor = editor_for(call);
  const Slot s = slot_of(call);
  const Ref<Component> with = call.component("with");
  editor.set(s, editor.name_of(with));
  return apply(call, editor, "use an existing " + s.member->name);
}

Json unshare(const Call& call) {
  TextEditor editor = editor_for(call);
  const Slot s = slot_of(call);
  const Value value = s.member->get(*s.part, *s.member);
  const auto* list = value.as<Value::List>();
  const auto* part =
      list && s.index && *s.index < list->size() ? (*list)[*s.index].as<Ref<Component>>() : value.as<Ref<Component>>();
  if (!part || !*part || editor.name_in(s).empty()) throw Error("what stands there is not shared by a name");
  editor.set(s, editor.written_out(**part));
  const Json reply = apply(call, editor, "make " + s.member->name + " independent");
  return with_component(reply, part_in(call.studio.document(), s, s.index.value_or(0)));
}

Json rename(const Call& call) {
  TextEditor editor = editor_for(call);
  const std::string now = call.text_or("name", "");
  std::string old = call.text_or("old", "");
  if (old.empty()) {
    const Ref<Component> part = call.component();
    if (now.empty() && (!part->origin || part->origin->name.empty())) throw Error("it has no name");
    old = editor.name_of(part);
  }
  editor.rename(old, now);
  return apply(call, editor, now.empty() ? "remove the name " + old : "rename to " + now);
}

// ---- history ----------------------------------------------------------------------------------------------------------------

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

const RegisterRequests registered{
    {"edit", false, edit},   {"edits", false, edits},     {"reset", false, reset},         {"replace", false, replace},
    {"add", false, add},     {"remove", false, remove},   {"duplicate", false, duplicate}, {"move", false, move},
    {"share", false, share}, {"unshare", false, unshare}, {"rename", false, rename},       {"undo", false, undo},
    {"redo", false, redo},
};

}  // namespace

}  // namespace etendue::studio
