// The pictures of a studio that are not rendered: pinned ones, and viewed files.

#include <fmt/format.h>

#include "studio.h"

namespace etendue::studio {

void Studio::show_pictures(std::vector<std::pair<std::string, std::shared_ptr<const Image>>> pictures) {
  begin("");  // an empty description, whose tone map is used
  const std::lock_guard lock(browsers_guard_);
  for (auto& [name, picture] : pictures) pins_[name] = std::move(picture);
}

void Studio::pin(const std::string& name, std::shared_ptr<const Image> picture) {
  constexpr size_t most = 8;
  const std::lock_guard lock(browsers_guard_);
  if (!picture) {
    pins_.erase(name);
  } else if (pins_.size() >= most && !pins_.contains(name)) {
    throw Error("eight pictures are pinned already: take one off first");
  } else {
    pins_[name] = std::move(picture);
  }
}

std::shared_ptr<const Image> Studio::pinned(const std::string& name) const {
  const std::lock_guard lock(browsers_guard_);
  const auto found = pins_.find(name);
  if (found == pins_.end()) throw Error(fmt::format("there is no picture '{}'", name));
  return found->second;
}

Json Studio::pictures_json() const {
  Json list = Json::array();
  const std::lock_guard lock(browsers_guard_);
  for (const auto& [name, picture] : pins_)
    list.push_back({{"name", name}, {"width", picture->width}, {"height", picture->height}, {"channels", picture->channels}});
  return list;
}

}  // namespace etendue::studio
