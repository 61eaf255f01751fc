// The events that report changes of the document to browsers.

#include "request.h"

namespace etendue::studio {

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

}  // namespace etendue::studio
