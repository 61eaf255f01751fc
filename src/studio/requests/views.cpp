// Saved views: unused named cameras in the text. So they are stored in the document, and visible to its readers.

#include <fmt/format.h>

#include "language/lexer.h"
#include "requests.h"

namespace etendue::studio {

namespace {

using language::Definition;

/// Whether a definition is a camera component.
bool is_camera(const Definition& d) {
  if (d.function || d.value.type != language::NodeType::component) return false;
  const ClassInfo* info = Registry::instance().find(d.value.text);
  const ClassInfo* camera = Registry::instance().find("Camera");
  return info && camera && info->is_a(*camera);
}

const Definition& view_of(const Call& call) {
  const std::string name = call.text("name");
  const Definition* d = call.studio.document().outline().definition(name);
  if (!d || !is_camera(*d)) throw Error(fmt::format("there is no view '{}'", name));
  return *d;
}

Json views(const Call& call) {
  const Document& document = call.studio.document();
  Json list = Json::array();
  for (const Definition& d : document.outline().syntax().definitions)
    if (is_camera(d))
      list.push_back({{"name", d.name.text},
                      {"class", d.value.text},
                      {"used", !document.outline().uses(d.name.text).empty()},
                      {"begin", document.places().units(d.value.begin)},
                      {"end", document.places().units(d.value.end)}});
  return {{"views", std::move(list)}};
}

/// The complete text of the job's camera.
std::string camera_text(const Call& call) {
  return TextEditor(call.studio.document()).written_out(*call.studio.document().job().camera);
}

Json save_view(const Call& call) {
  static_cast<void>(editor_for(call));  // throws if the text cannot be edited now
  const Document& document = call.studio.document();
  const std::string name = call.text("name");
  if (!language::is_name(name))
    throw Error(fmt::format("'{}' is no name: letters, digits and _, the first of them a letter", name));
  const Definition* there = document.outline().definition(name);
  std::string text;
  if (!there) {
    const language::Node* job = document.written(document.job());
    if (!job) throw Error("the job is not written in this text");
    text = with_definition(document.outline(), name, camera_text(call), job->begin);
  } else if (!is_camera(*there)) {
    throw Error(fmt::format("'{}' is the name of something else", name));
  } else if (!call.flag("over")) {
    throw RequestError("busy", fmt::format("there is a view '{}' already", name));
  } else if (!document.outline().uses(name).empty()) {
    throw Error(fmt::format("'{}' is in use: another view of this name would move it", name));
  } else {
    text = with_span(document.outline(), {there->value.begin, there->value.end}, camera_text(call));
  }
  return tell(call, call.studio.document().apply(text, {"save view " + name, ""}));
}

/// Sets the job's camera to a copy of a view, so that moving the camera does not change the view.
Json use_view(const Call& call) {
  TextEditor editor = editor_for(call);
  const Definition& view = view_of(call);
  const Document& document = call.studio.document();
  const Ref<Component> job(const_cast<Job*>(&document.job()));
  editor.set(slot(job, "camera"), document.outline().text({view.value.begin, view.value.end}));
  return apply(call, editor, "view " + view.name.text);
}

Json remove_view(const Call& call) {
  static_cast<void>(editor_for(call));
  const Definition& view = view_of(call);
  const Document& document = call.studio.document();
  const std::string name = view.name.text;
  if (!document.outline().uses(name).empty()) throw Error(fmt::format("'{}' is in use", name));
  // Also removes the line, if nothing else is in it.
  const std::string& text = document.text();
  Span gone{view.name.begin, view.value.end};
  size_t end = gone.end;
  while (end < text.size() && (text[end] == ' ' || text[end] == '\t' || text[end] == '\r')) ++end;
  const bool begins_line = gone.begin == 0 || text[gone.begin - 1] == '\n';
  if (begins_line && end < text.size() && text[end] == '\n') gone.end = end + 1;
  return tell(call, call.studio.document().apply(with_span(document.outline(), gone, ""), {"remove view " + name, ""}));
}

const RegisterRequests registered{
    {"views", true, views},
    {"save_view", false, save_view},
    {"use_view", false, use_view},
    {"remove_view", false, remove_view},
};

}  // namespace

}  // namespace etendue::studio
