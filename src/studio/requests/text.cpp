// Requests about the document's text as it is typed: changes, completion, explanations.

#include <fmt/format.h>

#include "describe/guard.h"
#include "etendue/describe/reflection.h"
#include "requests.h"
#include "studio/text/assistance.h"

namespace etendue::studio {

namespace {

/// The text being typed: the draft, or the text in the request.
std::string typed_text(const Call& call) {
  if (call.has("text")) return call.text("text");
  const Document& document = call.studio.document();
  return document.draft() ? document.draft()->text : document.text();
}

/// The document's text with the changes of a request applied.
std::string changed_text(const Call& call) {
  const Document& document = call.studio.document();
  if (call.has("text")) return call.text("text");
  if (!call.has("changes") || !call.request["changes"].is_array())
    throw RequestError("bad_request", "'text' or 'changes' is missing");
  struct Change {
    size_t begin, end;
    std::string insert;
  };
  std::vector<Change> changes;
  for (const Json& one : call.request["changes"]) {
    if (!one.is_object()) throw RequestError("bad_request", "a change is {begin, end, insert}");
    const Call part{call.studio, call.browser, one, call.id};
    const auto units = std::int64_t(document.places().size());
    const auto begin = size_t(part.integer("begin", 0, units));
    const auto end = size_t(part.integer("end", std::int64_t(begin), units));
    changes.push_back({document.places().byte(begin), document.places().byte(end), part.text("insert")});
    if (changes.back().begin == std::string::npos || changes.back().end == std::string::npos)
      throw RequestError("bad_request", "a change begins or ends within a character");
  }
  std::stable_sort(changes.begin(), changes.end(), [](const Change& a, const Change& b) { return a.begin < b.begin; });
  std::string text;
  size_t done = 0;
  for (const Change& change : changes) {
    if (change.begin < done) throw RequestError("bad_request", "changes overlap");
    text.append(document.text(), done, change.begin - done).append(change.insert);
    done = change.end;
  }
  return text.append(document.text(), done);
}

Json text(const Call& call) {
  Document& document = call.studio.document();
  if (call.integer("revision", 0, 2'000'000'000) != document.revision())
    throw RequestError("busy", fmt::format("the text has changed meanwhile: it is at revision {}", document.revision()));
  std::string now = changed_text(call);
  Applied applied;
  try {
    applied = document.apply(now, {"type", call.text_or("merge", "")});
  } catch (...) {
    std::vector<Error> errors = thrown_errors();
    document.set_draft(std::move(now), errors);
    call.studio.tell_document();
    return {{"valid", false}, {"revision", document.revision()}, {"errors", errors_json(errors, &document)}};
  }
  Json reply = tell(call, applied);
  reply["valid"] = true;
  return reply;
}

Json drop_draft(const Call& call) {
  call.studio.document().drop_draft();
  call.studio.tell_document();
  return {{"revision", call.studio.document().revision()}};
}

/// The position that a request refers to in the text being typed.
struct Pointed {
  std::string text;
  Places places;
  size_t byte = 0;
  explicit Pointed(const Call& call) : text(typed_text(call)), places(text) {
    byte = places.byte(size_t(call.integer("at", 0, std::int64_t(places.size()))));
    if (byte == std::string::npos) throw RequestError("bad_request", "'at' is within a character");
  }
};

Json complete(const Call& call) {
  const Pointed at(call);
  Json items = Json::array();
  for (const Completion& c : completions(at.text, at.byte))
    items.push_back({{"label", c.label},
                     {"kind", c.kind},
                     {"detail", c.detail},
                     {"insert", c.insert},
                     {"begin", at.places.units(c.begin)},
                     {"end", at.places.units(at.byte)}});
  return {{"items", items}};
}

Json hover(const Call& call) {
  const Pointed at(call);
  const std::optional<Explanation> found = explanation(at.text, at.byte);
  if (!found) return {{"markdown", nullptr}};
  return {
      {"markdown", found->markdown}, {"begin", at.places.units(found->word.begin)}, {"end", at.places.units(found->word.end)}};
}

Json definition(const Call& call) {
  const Pointed at(call);
  const Outline outline(at.text, intern("typed text"));
  const Span word = word_at(at.text, at.byte);
  const language::Definition* d = outline.definition(outline.text(word));
  if (!d) return {{"begin", nullptr}};
  return {{"begin", at.places.units(d->name.begin)}, {"end", at.places.units(d->name.begin + d->name.text.size())}};
}

const RegisterRequests registered{
    {"text", false, text},  {"drop_draft", false, drop_draft}, {"complete", true, complete},
    {"hover", true, hover}, {"definition", true, definition},
};

}  // namespace

}  // namespace etendue::studio
