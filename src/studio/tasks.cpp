#include "tasks.h"

#include <fmt/format.h>

#include "check/conform/conformance.h"
#include "etendue/core/error.h"

namespace etendue::studio {

using Json = nlohmann::ordered_json;

Tasks::~Tasks() {
  for (Running& r : running_) r.thread.join();
}

void Tasks::sweep() {
  running_.remove_if([](Running& r) {
    if (r.done) r.thread.join();
    return r.done;
  });
}

int Tasks::conform(const std::string& class_name) {
  const std::lock_guard lock(guard_);
  sweep();
  if (running_.size() >= 2) throw Error("two checks are running already: wait until one is done");
  const int number = next_++;
  Running& entry = running_.emplace_back();
  entry.thread = std::thread([this, number, class_name, &entry] {
    Json event = {{"event", "task"}, {"task", number}};
    try {
      conform::Options options;
      options.classes = {class_name};
      options.effort = conform::Effort::quick;
      options.progress = [&](const std::string&, int done, int of) {
        tell_({{"event", "task"},
               {"task", number},
               {"state", "running"},
               {"text", ""},
               {"fraction", double(done) / std::max(of, 1)}});
      };
      int passed = 0, failed = 0, not_tried = 0;
      std::string text;
      for (const conform::Outcome& o : conform::conform(options)) {
        ++(o.result == conform::Result::passed ? passed : o.result == conform::Result::failed ? failed : not_tried);
        if (o.result == conform::Result::failed) text += fmt::format("{}: {}\n{}\n", o.class_name, o.check, o.detail);
      }
      event["state"] = failed == 0 ? "done" : "failed";
      event["text"] =
          fmt::format("{}: {} checks passed, {} failed, {} not tried\n{}", class_name, passed, failed, not_tried, text);
    } catch (const std::exception& error) {
      event["state"] = "failed";
      event["text"] = error.what();
    }
    event["fraction"] = 1;
    tell_(event);
    const std::lock_guard done(guard_);
    entry.done = true;
  });
  return number;
}

}  // namespace etendue::studio
