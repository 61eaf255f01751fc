// Requests for what a page shows in space: a wireframe of the scene, photons, and the learned pdf of a guide.

#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "etendue/mesh_facts.h"
#include "etendue/render/shown_in_space.h"
#include "render/checkpoint.h"
#include "requests.h"
#include "studio/pixels/linear_srgb.h"

namespace etendue::studio {

namespace {

// ---- wireframe --------------------------------------------------------------------------------------------------------------

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

// ---- photons and guides -----------------------------------------------------------------------------------------------------

/// A process in the state of the last finished step. To be used by one thread and at once, before any edit.
std::unique_ptr<RenderProcess> last_process(const Render& render) {
  const std::vector<IndexRange> done = render.samples_done();
  if (!render.job().renderer->steps_depend()) return render.start_at(done.empty() ? 0 : done.back().end - 1);
  // Its learned state is taken from a checkpoint; rendering all steps again would take as long as the render did.
  std::unique_ptr<RenderProcess> process = render.start_at(0);
  std::stringstream state;
  render.save(state);
  const Checkpoint now = read_checkpoint(state);
  if (!now.state.renderer.empty()) process->load_state(now.state.renderer);
  return process;
}

[[noreturn]] void has_none(const Render& render, const char* what) {
  throw Error(fmt::format("{} keeps no {}", render.job().renderer->class_info().name, what));
}

const ShownInSpace& shown_of(const RenderProcess& process, const Render& render, const char* what) {
  const auto* shown = dynamic_cast<const ShownInSpace*>(&process);
  if (!shown) has_none(render, what);
  return *shown;
}

/// A subset of the renderer's photons.
Json photons(const Call& call) {
  constexpr int usual = 5000, most = 20000;
  const auto wanted = size_t(call.integer_or("most", usual, 1, most));
  const auto render = call.render();
  const std::unique_ptr<RenderProcess> process = last_process(*render);
  const std::optional<ShownPhotons> shown = shown_of(*process, *render, "photons").photons(wanted);
  if (!shown) has_none(*render, "photons as it is set");
  const DoublePoint3 centre = render->job().rendering_origin();
  const LinearSrgb linear_srgb;
  const auto finite = [](double v) { return std::isfinite(v) ? v : 0; };
  Json positions = Json::array(), directions = Json::array(), powers = Json::array(), segments = Json::array(),
       caustic = Json::array();
  for (const ShownPhoton& p : shown->some) {
    for (const double v : {centre.x + double(p.position.x), centre.y + double(p.position.y), centre.z + double(p.position.z)})
      positions.push_back(v);
    for (int axis = 0; axis < 3; ++axis) directions.push_back(p.direction[axis]);
    for (const double v : linear_srgb(p.power.x, p.power.y, p.power.z)) powers.push_back(finite(v));
    segments.push_back(p.segments);
    caustic.push_back(p.caustic);
  }
  return {{"all", shown->all},           {"positions", std::move(positions)}, {"directions", std::move(directions)},
          {"powers", std::move(powers)}, {"segments", std::move(segments)},   {"caustic", std::move(caustic)}};
}

/// The pdf learned by the guide at the surface point seen in a pixel.
Json lobes(const Call& call) {
  make_fine(call.studio);
  const auto render = call.render();
  const Job& job = render->job();
  const std::unique_ptr<RenderProcess> process = last_process(*render);
  const ShownInSpace& shown = shown_of(*process, *render, "guide");
  const SeenPoint seen(call, job);
  if (!seen.found) throw Error("nothing is seen in this pixel");
  const SurfacePoint& point = seen.point;
  const Normal3 normal = dot(point.normal, seen.ray.direction) > 0 ? -point.normal : point.normal;
  const std::optional<ShownLobes> found = shown.lobes(point.position, normal);
  if (!found) has_none(*render, "guide");
  const DoublePoint3 place = job.rendering_origin() + DoubleVector3(point.position - Point3{});
  return {{"position", triple(place)}, {"normal", triple(normal)},       {"share", found->share},
          {"rows", ShownLobes::rows},  {"columns", ShownLobes::columns}, {"density", found->pdf}};
}

const RegisterRequests registered{
    {"wireframe", true, wireframe},
    {"photons", true, photons},
    {"lobes", true, lobes},
};

}  // namespace

}  // namespace etendue::studio
