// The request about the queue: files that are rendered one after the other.

#include <fmt/format.h>

#include "requests.h"

namespace etendue::studio {

namespace {

Json queue(const Call& call) {
  Queue& queue = call.studio.queue();
  if (call.has("add")) {
    if (!call.request["add"].is_array()) throw RequestError("bad_request", "'add' must be a list of files");
    std::vector<std::string> paths;
    for (const Json& file : call.request["add"]) {
      if (!file.is_string()) throw RequestError("bad_request", "'add' must be a list of files");
      paths.push_back(allowed_path(call, file.get<std::string>()));
      // The file is rendered as it is on disk; its output files must be in folders that this studio may use.
      for (const NamedFile& named : files_named_by(*load_job(paths.back())))
        if (!call.studio.folders().contains(named.path))
          throw RequestError("not_allowed", fmt::format("'{}' names '{}', outside of the folders that this studio may use",
                                                        paths.back(), named.path));
    }
    for (const std::string& path : paths) queue.add(path);
  }
  if (call.has("remove")) queue.remove(int(call.integer("remove", 0, 2'000'000'000)));
  if (call.flag("start")) queue.start();
  if (call.flag("stop")) queue.stop();
  Json json = queue.json();
  call.studio.broadcast(json);
  return {{"queue", json}};
}

const RegisterRequests registered{
    {"queue", false, queue},
};

}  // namespace

}  // namespace etendue::studio
