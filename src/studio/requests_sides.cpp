// Requests about renders beside the document's own render.

#include "requests.h"

namespace etendue::studio {

std::shared_ptr<Render> Studio::render_of(int number) {
  if (number == 0) return valid_render();
  return sides_.find(number)->render();
}

Runner& Studio::runner_of(int number) { return number == 0 ? runner_ : sides_.find(number)->runner(); }

void Studio::follow_sides() {
  if (coarse || !document_.valid() || sides_.all().empty()) return;
  sides_.follow(document_, overrides);
}

void Studio::tell_sides() { broadcast(sides_json()); }

namespace {

Json renders(const Call& call) {
  Studio& studio = call.studio;
  Json reply = Json::object();
  if (call.has("remove")) studio.sides().remove(int(call.integer("remove", 0, 2'000'000'000)));
  if (call.has("add")) {
    static_cast<void>(studio.valid_render());
    const Json& wanted = call.request["add"];
    if (!wanted.is_object()) throw RequestError("bad_request", "'add' must be an object");
    const Call part{studio, call.browser, wanted, call.id};
    Difference difference;
    difference.renderer = part.text_or("renderer", "");
    if (part.has("set")) {
      constexpr size_t most = 100;
      const Json& set = wanted["set"];
      if (!set.is_object() || set.size() > most) throw RequestError("bad_request", "'set' must be an object of texts");
      for (const auto& [path, expression] : set.items()) {
        if (!expression.is_string()) throw RequestError("bad_request", "'set' must be an object of texts");
        difference.set[path] = expression.get<std::string>();
      }
    }
    reply["render"] = studio.sides().add(std::move(difference), studio.document(), studio.overrides)->number;
  }
  if (call.has("remove") || call.has("add")) {
    studio.tell_sides();
    studio.wake_viewer();
  }
  const Json now = studio.sides_json();
  reply["renders"] = now["renders"];
  return reply;
}

Json course(const Call& call) {
  const int number = call.render_number();
  static_cast<void>(call.studio.runner_of(number));  // throws Error if there is none
  return {{"points", call.studio.course_json(number)}};
}

}  // namespace

std::span<const Request> side_requests() {
  static constexpr Request all[] = {{"renders", false, renders}, {"course", true, course}};
  return all;
}

}  // namespace etendue::studio
