// Requests about the program: what a page learns of it at first, its manual, its end.

#include "requests.h"

namespace etendue::studio {

namespace {

Json hello(const Call& call) {
  Studio& studio = call.studio;
  const auto protocol = call.integer("protocol", 1, 1'000'000);
  if (protocol != 1) throw RequestError("bad_request", "this studio speaks protocol 1; reload the page");
  Json reply = {{"protocol", 1}, {"read_only", studio.settings().read_only}, {"browser", call.browser.number}};
  reply["viewing"] = studio.settings().viewing;
  reply["pictures"] = studio.pictures_json();
  const Json vocabulary = vocabulary_json();
  for (const auto& [key, value] : vocabulary.items()) reply[key] = value;
  reply["folders"] = studio.folders().all();
  reply["document"] = studio.document_json();
  reply["text"] = studio.text_json();
  reply["tree"] = tree_json(studio.document());
  reply["progress"] = studio.progress_json();
  reply["renders"] = studio.sides_json()["renders"];
  reply["queue"] = studio.queue().json();
  return reply;
}

Json manual(const Call& call) { return {{"markdown", Studio::manual_page(class_named(call.text("class")).name)}}; }

/// Ends the program for all pages.
Json shutdown(const Call& call) {
  require_saved(call);
  call.studio.shutdown(call.flag("discard"));
  return {};
}

/// Restarts the program with the current versions of its plugins, since loaded plugins are never unloaded.
Json begin_again(const Call& call) {
  if (call.studio.document().changed())
    throw RequestError("busy", "there are changes that are not saved, and the program begins anew with what is on the disk");
  call.studio.begin_again = true;
  call.studio.shutdown(false);
  return {};
}

const RegisterRequests registered{
    {"hello", true, hello},
    {"manual", true, manual},
    {"shutdown", false, shutdown},
    {"begin_again", false, begin_again},
};

}  // namespace

}  // namespace etendue::studio
