// Requests about single pixels: what they show, their values, the paths and samples behind them.

#include <fmt/format.h>

#include "check/replay/replay.h"
#include "etendue/shader.h"
#include "requests.h"
#include "studio/pixels/linear_srgb.h"

namespace etendue::studio {

namespace {

Json pick(const Call& call) {
  make_fine(call.studio);
  static_cast<void>(call.studio.valid_render());
  const Document& document = call.studio.document();
  const Job& job = document.job();
  const SeenPoint seen(call, job);
  if (!seen.found) return {{"component", nullptr}};
  const Hit& hit = seen.hit;
  const SceneObject& object = hit.object->original();
  Json path = Json::array({document.id_of(job), document.id_of(*job.scene)});
  for (int i = hit.depth - 1; i >= 0; --i) path.push_back(document.id_of(hit.scenes[i]->original()));
  const int id = document.id_of(object);
  path.push_back(id);
  const DoublePoint3 place = job.rendering_origin() + DoubleVector3(seen.point.position - Point3{});
  return {{"component", id ? Json(id) : Json()},
          {"shader", object.shader ? Json(document.id_of(*object.shader)) : Json()},
          {"position", triple(place)},
          {"normal", triple(seen.point.normal)},
          {"distance", job.camera->reach(seen.ray).nearest + hit.distance},
          {"path", path}};
}

/// The colour of a pixel and the values of its layers. `number` also writes values that are not finite.
Json values_json(const Image& picture, int x, int y, Json (*number)(double)) {
  const std::array<double, 3> xyz = {picture.at(x, y, 0), picture.at(x, y, 1), picture.at(x, y, 2)};
  const std::array<double, 3> rgb = LinearSrgb()(xyz[0], xyz[1], xyz[2]);
  Json values = {{"xyz", Json::array()}, {"rgb", Json::array()}, {"layers", Json::object()}};
  for (const double v : xyz) values["xyz"].push_back(number(v));
  for (const double v : rgb) values["rgb"].push_back(number(v));
  for (size_t c = 3; c < picture.channels.size(); ++c) values["layers"][picture.channels[c]] = number(picture.at(x, y, c));
  return values;
}

Json probe(const Call& call) {
  const auto render = call.render();
  const RenderSnapshot now = render->snapshot();
  const Image picture = now.picture();
  const auto corner = [&](const char* key) {
    const auto found = picture.metadata.find(key);
    return found == picture.metadata.end() ? 0 : std::stoi(found->second);
  };
  const int x = int(call.integer("x", 0, 1 << 20)) - corner("crop_x"),
            y = int(call.integer("y", 0, 1 << 20)) - corner("crop_y");
  if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) throw Error("there is no such pixel in the picture");
  Json error;
  for (size_t c = 3; c < picture.channels.size(); ++c)
    if (const double value = picture.at(x, y, c); picture.channels[c].starts_with("variance") && value >= 0)
      error = std::sqrt(value);
  Json reply = {
      {"x", call.request["x"]}, {"y", call.request["y"]}, {"samples", now.progress.samples}, {"error", std::move(error)}};
  reply.update(values_json(picture, x, y, [](double v) { return std::isfinite(v) ? Json(v) : Json(); }));
  return reply;
}

Json picture_probe(const Call& call) {
  const std::shared_ptr<const Image> picture = call.studio.pinned(call.text("picture"));
  const int x = int(call.integer("x", 0, 1 << 20)), y = int(call.integer("y", 0, 1 << 20));
  if (x >= picture->width || y >= picture->height) throw Error("there is no such pixel in the picture");
  const auto number = [](double v) {
    return std::isfinite(v) ? Json(v) : Json(std::isnan(v) ? "nan" : v > 0 ? "inf" : "-inf");
  };
  Json reply = {{"x", x}, {"y", y}};
  reply.update(values_json(*picture, x, y, number));
  return reply;
}

Json replay(const Call& call) {
  make_fine(call.studio);
  const auto render = call.render();
  const int x = int(call.integer("x", 0, 1 << 20)), y = int(call.integer("y", 0, 1 << 20));
  constexpr int most_paths = 1000;
  const Document& document = call.studio.document();
  const auto samples = std::int64_t(render->job().renderer->samples);
  const PixelReplay paths = call.has("sample")
                                ? replay_sample(*render, x, y, std::uint32_t(call.integer("sample", 0, samples - 1)))
                                : replay_pixel(*render, x, y, size_t(call.integer_or("paths", 10, 1, most_paths)));
  return {{"replay", Json::parse(replay_json(render->job(), paths, document.file(), "etendue render " + document.file()))}};
}

/// The reason why no sample of a list can be replayed; null: they can.
Json refusal(const Render& render, const Json& list) {
  if (list.empty()) return {};
  const std::string why = replay_refusal(render);
  return why.empty() ? Json() : Json(why);
}

Json fireflies(const Call& call) {
  const auto render = call.render();
  const auto count = size_t(call.integer_or("count", 20, 1, 10000));
  const bool kept = render->film().largest_kept() > 0;
  if (!kept) {
    call.studio.fireflies_kept = count;
    if (!call.studio.settings().read_only) render->film().keep_largest(count);
  }
  const Image picture = render->picture();
  const PixelArea& area = render->job().image->area();
  Json list = Json::array();
  for (const LargeSample& s : render->film().largest_samples()) {
    const int x = s.splat ? int(std::floor(s.film.x)) : s.x, y = s.splat ? int(std::floor(s.film.y)) : s.y;
    Json ratio;
    if (area.contains(x, y))
      if (const double value = picture.at(x - area.x0, y - area.y0, 1); value > 0) ratio = s.luminance / value;
    list.push_back({{"x", s.x},
                    {"y", s.y},
                    {"sample", s.sample},
                    {"luminance", s.luminance},
                    {"ratio", ratio},
                    {"film", {s.film.x, s.film.y}},
                    {"splat", s.splat}});
  }
  return {{"samples", list}, {"kept", kept}, {"refused", refusal(*render, list)}};
}

Json bad_samples(const Call& call) {
  Json list = Json::array();
  for (const BadSample& bad : call.render()->film().first_bad_samples()) {
    const char* kind = bad.kind == BadSample::Kind::not_a_number ? "not a number"
                       : bad.kind == BadSample::Kind::infinite   ? "infinite"
                                                                 : "negative";
    list.push_back({{"x", bad.x}, {"y", bad.y}, {"sample", bad.sample}, {"kind", kind}});
  }
  return {{"samples", list}};
}

const RegisterRequests registered{
    {"pick", true, pick},     {"probe", true, probe},         {"picture_probe", true, picture_probe},
    {"replay", true, replay}, {"fireflies", true, fireflies}, {"bad_samples", true, bad_samples},
};

}  // namespace

}  // namespace etendue::studio
