// Requests for spatial data of a renderer: photons, and the learned pdf of a guide.

#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "etendue/describe/color.h"
#include "etendue/render/shown_in_space.h"
#include "render/checkpoint.h"
#include "requests_look.h"

namespace etendue::studio {

namespace {

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

}  // namespace

Json photons(const Call& call) {
  constexpr int usual = 5000, most = 20000;
  const auto wanted = size_t(call.integer_or("most", usual, 1, most));
  const auto render = call.render();
  const std::unique_ptr<RenderProcess> process = last_process(*render);
  const std::optional<ShownPhotons> shown = shown_of(*process, *render, "photons").photons(wanted);
  if (!shown) has_none(*render, "photons as it is set");
  const DoublePoint3 centre = render->job().rendering_origin();
  const auto& m = rgb_space("srgb").from_xyz;
  const auto finite = [](double v) { return std::isfinite(v) ? v : 0; };
  Json positions = Json::array(), directions = Json::array(), powers = Json::array(), segments = Json::array(),
       caustic = Json::array();
  for (const ShownPhoton& p : shown->some) {
    for (const double v : {centre.x + double(p.position.x), centre.y + double(p.position.y), centre.z + double(p.position.z)})
      positions.push_back(v);
    for (int axis = 0; axis < 3; ++axis) directions.push_back(p.direction[axis]);
    for (size_t k = 0; k < 3; ++k)
      powers.push_back(finite(m[3 * k] * p.power.x + m[3 * k + 1] * p.power.y + m[3 * k + 2] * p.power.z));
    segments.push_back(p.segments);
    caustic.push_back(p.caustic);
  }
  return {{"all", shown->all},           {"positions", std::move(positions)}, {"directions", std::move(directions)},
          {"powers", std::move(powers)}, {"segments", std::move(segments)},   {"caustic", std::move(caustic)}};
}

Json lobes(const Call& call) {
  make_fine(call.studio);
  const auto render = call.render();
  const Job& job = render->job();
  const Point2 film{float(call.number("x")) + 0.5f, float(call.number("y")) + 0.5f};
  const std::unique_ptr<RenderProcess> process = last_process(*render);
  const ShownInSpace& shown = shown_of(*process, *render, "guide");
  Ray ray = job.camera->ray(film, {0.5f, 0.5f}, job.camera->shutter_open);
  ray.of_camera = true;
  Hit hit;
  if (!job.scene->nearest(ray, hit)) throw Error("nothing is seen in this pixel");
  SurfacePoint point;
  job.scene->locate(ray, hit, point);
  const Normal3 normal = dot(point.normal, ray.direction) > 0 ? -point.normal : point.normal;
  const std::optional<ShownLobes> found = shown.lobes(point.position, normal);
  if (!found) has_none(*render, "guide");
  const DoublePoint3 place = job.rendering_origin() + DoubleVector3(point.position - Point3{});
  return {{"position", {place.x, place.y, place.z}},
          {"normal", {normal.x, normal.y, normal.z}},
          {"share", found->share},
          {"rows", ShownLobes::rows},
          {"columns", ShownLobes::columns},
          {"density", found->pdf}};
}

}  // namespace etendue::studio
