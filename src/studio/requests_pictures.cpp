// Requests about pictures that are not rendered: viewed files and pinned pictures.

#include <fmt/format.h>

#include "etendue/describe/color.h"
#include "requests.h"

namespace etendue::studio {

void Studio::show_pictures(std::vector<std::pair<std::string, std::shared_ptr<const Image>>> pictures) {
  begin("");  // an empty description, whose tone map is used
  const std::lock_guard lock(browsers_guard_);
  for (auto& [name, picture] : pictures) pins_[name] = std::move(picture);
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

namespace {

Json pictures(const Call& call) { return {{"pictures", call.studio.pictures_json()}}; }

Json picture_probe(const Call& call) {
  const std::shared_ptr<const Image> picture = call.studio.pinned(call.text("picture"));
  const int x = int(call.integer("x", 0, 1 << 20)), y = int(call.integer("y", 0, 1 << 20));
  if (x >= picture->width || y >= picture->height) throw Error("there is no such pixel in the picture");
  const auto number = [](double v) {
    return std::isfinite(v) ? Json(v) : Json(std::isnan(v) ? "nan" : v > 0 ? "inf" : "-inf");
  };
  const auto& m = rgb_space("srgb").from_xyz;
  Json xyz = Json::array(), rgb = Json::array(), layers = Json::object();
  for (size_t c = 0; c < 3; ++c) {
    xyz.push_back(number(picture->at(x, y, c)));
    rgb.push_back(
        number(m[3 * c] * picture->at(x, y, 0) + m[3 * c + 1] * picture->at(x, y, 1) + m[3 * c + 2] * picture->at(x, y, 2)));
  }
  for (size_t c = 3; c < picture->channels.size(); ++c) layers[picture->channels[c]] = number(picture->at(x, y, c));
  return {{"x", x}, {"y", y}, {"xyz", xyz}, {"rgb", rgb}, {"layers", layers}};
}

}  // namespace

std::span<const Request> picture_requests() {
  static constexpr Request all[] = {{"pictures", true, pictures}, {"picture_probe", true, picture_probe}};
  return all;
}

}  // namespace etendue::studio
