// Requests that inspect the render: what a pixel shows, and by which paths.

#include <fmt/format.h>

#include "check/replay/replay.h"
#include "etendue/describe/color.h"
#include "etendue/mesh_facts.h"
#include "etendue/shader.h"
#include "requests_look.h"

namespace etendue::studio {

void make_fine(Studio& studio) {
  studio.fine_at.reset();
  if (studio.coarse.exchange(false)) studio.apply_overrides();
}

namespace {

template <class V>
Json triple(const V& v) {
  return {v.x, v.y, v.z};
}

Json pick(const Call& call) {
  make_fine(call.studio);
  static_cast<void>(call.studio.valid_render());
  const Document& document = call.studio.document();
  const Job& job = document.job();
  const Point2 film{float(call.number("x")) + 0.5f, float(call.number("y")) + 0.5f};
  Ray ray = job.camera->ray(film, {0.5f, 0.5f}, job.camera->shutter_open);
  ray.of_camera = true;
  Hit hit;
  if (!job.scene->nearest(ray, hit)) return {{"component", nullptr}};
  SurfacePoint point;
  job.scene->locate(ray, hit, point);
  const SceneObject& object = hit.object->original();
  Json path = Json::array({document.id_of(job), document.id_of(*job.scene)});
  for (int i = hit.depth - 1; i >= 0; --i) path.push_back(document.id_of(hit.scenes[i]->original()));
  const int id = document.id_of(object);
  path.push_back(id);
  const Vector3 from_centre = point.position - Point3{};
  const DoublePoint3 place =
      job.rendering_origin() + DoubleVector3{double(from_centre.x), double(from_centre.y), double(from_centre.z)};
  return {{"component", id ? Json(id) : Json()},
          {"shader", object.shader ? Json(document.id_of(*object.shader)) : Json()},
          {"position", triple(place)},
          {"normal", triple(point.normal)},
          {"distance", job.camera->reach(ray).nearest + hit.distance},
          {"path", path}};
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
  Json xyz = Json::array(), rgb = Json::array();
  const auto& m = rgb_space("srgb").from_xyz;
  for (size_t c = 0; c < 3; ++c) {
    xyz.push_back(picture.at(x, y, c));
    rgb.push_back(m[3 * c] * picture.at(x, y, 0) + m[3 * c + 1] * picture.at(x, y, 1) + m[3 * c + 2] * picture.at(x, y, 2));
  }
  Json layers = Json::object();
  Json error;
  for (size_t c = 3; c < picture.channels.size(); ++c) {
    const double value = picture.at(x, y, c);
    layers[picture.channels[c]] = std::isfinite(value) ? Json(value) : Json();
    if (picture.channels[c].starts_with("variance") && value >= 0) error = std::sqrt(value);
  }
  return {{"x", call.request["x"]},          {"y", call.request["y"]}, {"xyz", xyz},      {"rgb", rgb},
          {"samples", now.progress.samples}, {"error", error},         {"layers", layers}};
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

// ---- a wireframe ------------------------------------------------------------------------------------------------------------

class Wires {
 public:
  Wires(const DoublePoint3& centre, size_t most) : centre_(centre), most_(most) {}
  bool full() const { return count >= most_; }
  void line(const Point3& a, const Point3& b) {
    if (full()) return;
    ++count;
    for (const Point3& p : {a, b}) {
      lines.push_back(centre_.x + double(p.x));
      lines.push_back(centre_.y + double(p.y));
      lines.push_back(centre_.z + double(p.z));
    }
  }
  void box(const Bounds3& b) {
    if (b.empty()) return;
    const auto corner = [&](int i) {
      return Point3{i & 1 ? b.high.x : b.low.x, i & 2 ? b.high.y : b.low.y, i & 4 ? b.high.z : b.low.z};
    };
    for (int i = 0; i < 8; ++i)
      for (const int bit : {1, 2, 4})
        if (!(i & bit)) line(corner(i), corner(i | bit));
  }
  /// Draws all edges of small meshes, and some of those of large ones.
  void mesh(const TriangleView& view, size_t share) {
    const size_t step = std::max<size_t>(1, view.triangles.size() * 3 / std::max<size_t>(share, 3));
    for (size_t t = 0; t < view.triangles.size(); t += step)
      for (int k = 0; k < 3; ++k) {
        const auto a = view.triangles[t][size_t(k)], b = view.triangles[t][size_t((k + 1) % 3)];
        if (step > 1 || a < b) line(view.positions[a], view.positions[b]);
      }
  }
  Json lines = Json::array();
  size_t count = 0;

 private:
  DoublePoint3 centre_;
  size_t most_;
};

/// The wireframe of one object of the main scene; objects in nested scenes have no world space bounds.
Json wires_of(const Job& job, const Component& wanted, size_t most) {
  Wires wires(job.rendering_origin(), most);
  Json reply = {{"lines", Json::array()}, {"whole", true}, {"low", nullptr}, {"high", nullptr}};
  for (const Ref<SceneObject>& object : job.scene->objects) {
    if (object.get() != &wanted || object->unbounded() || object->infinite()) continue;
    const Bounds3 bounds = object->bounds();
    if (bounds.empty()) continue;
    if (const auto triangles = still_triangles(*object))
      wires.mesh(*triangles, most);
    else
      wires.box(bounds);
    const auto world = [&](const Point3& p) { return triple(job.rendering_origin() + DoubleVector3(p - Point3{})); };
    reply = {
        {"lines", std::move(wires.lines)}, {"whole", !wires.full()}, {"low", world(bounds.low)}, {"high", world(bounds.high)}};
    break;
  }
  return reply;
}

Json wireframe(const Call& call) {
  static_cast<void>(call.studio.valid_render());
  const Job& job = call.studio.document().job();
  if (call.has("component")) return wires_of(job, *call.component(), size_t(call.integer_or("most", 5000, 100, 1'000'000)));
  const auto most = size_t(call.integer_or("most", 50000, 100, 1'000'000));
  Wires wires(job.rendering_origin(), most);
  const auto& objects = job.scene->objects;
  for (const Ref<SceneObject>& object : objects) {
    if (!object || object->unbounded() || wires.full()) continue;
    const auto triangles = still_triangles(*object);
    if (triangles)
      wires.mesh(*triangles, most / std::max<size_t>(objects.size(), 1));
    else
      wires.box(object->bounds());
  }
  return {{"lines", std::move(wires.lines)}, {"whole", !wires.full()}};
}

}  // namespace

std::span<const Request> look_requests() {
  static constexpr Request all[] = {
      {"pick", true, pick},
      {"probe", true, probe},
      {"replay", true, replay},
      {"fireflies", true, fireflies},
      {"bad_samples", true, bad_samples},
      {"wireframe", true, wireframe},
      {"photons", true, photons},
      {"lobes", true, lobes},
  };
  return all;
}

}  // namespace etendue::studio
