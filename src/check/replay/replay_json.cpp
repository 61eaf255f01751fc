// Writes replayed samples as JSON.

#include <nlohmann/json.hpp>

#include "etendue/describe/bands.h"
#include "replay.h"

namespace etendue {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* names_of_bands[] = {"red", "green", "blue"};

Json array(const Spectrum& s) {
  Json json = Json::array();
  for (int i = 0; i < spectrum_size; ++i) json.push_back(s[i]);
  return json;
}

template <class V>
Json triple(const V& v) {
  return {v.x, v.y, v.z};
}

Json vertices_json(const std::vector<PathRecord::Vertex>& vertices) {
  Json list = Json::array();
  for (const PathRecord::Vertex& v : vertices)
    list.push_back({{"kind", v.kind},
                    {"object", v.object},
                    {"position", triple(v.position)},
                    {"normal", triple(v.normal)},
                    {"lobe", v.lobe},
                    {"density", v.pdf},
                    {"throughput", array(v.throughput)},
                    {"emitted", array(v.emitted)},
                    {"direct", array(v.direct)},
                    {"note", v.note}});
  return list;
}

Json contributions_json(const ReplayedPath& path, double of_splats) {
  const PathRecord& record = path.record;
  Json list = Json::array();
  for (const PathRecord::Contribution& c : record.contributions) {
    const Point2 film = c.splat ? c.film : path.film;
    list.push_back({{"strategy", c.strategy},
                    {"length", c.length},
                    {"weight", c.weight},
                    {"value", array(c.value)},
                    {"luminance", to_xyz(c.value, record.wavelengths).y * (c.splat ? of_splats : 1)},
                    {"film", {film.x, film.y}},
                    {"splat", c.splat}});
  }
  return list;
}

}  // namespace

std::string replay_json(const Job& job, const PixelReplay& replay, const std::string& file,
                        const std::string& picture_command) {
  Json paths = Json::array();
  for (const ReplayedPath& path : replay.paths) {
    const PathRecord& record = path.record;
    Json wavelengths = Json::array(), pdfs = Json::array();
    for (int i = 0; i < spectrum_size; ++i) {
      wavelengths.push_back(in_bands(record.wavelengths) ? Json(names_of_bands[i % 3]) : Json(record.wavelengths[i]));
      pdfs.push_back(record.wavelengths.pdf(i));
    }
    paths.push_back({{"sample", path.sample},
                     {"command", replay_command(picture_command, replay.x, replay.y, path.sample)},
                     {"film", {path.film.x, path.film.y}},
                     {"wavelengths", wavelengths},
                     {"densities", pdfs},
                     {"single", record.wavelengths.single()},
                     {"result", array(record.result)},
                     {"bad", path.bad},
                     {"luminance", path.luminance},
                     {"splatted", path.splatted},
                     {"share", path.share ? Json(*path.share) : Json()},
                     {"vertices", vertices_json(record.vertices)},
                     {"light_vertices", vertices_json(record.light_vertices)},
                     {"contributions", contributions_json(path, splat_weight(*job.image))}});
  }
  const Json json = {{"file", file},
                     {"renderer", job.renderer->class_info().name},
                     {"seed", job.seed},
                     {"pixel", {replay.x, replay.y}},
                     {"samples", replay.samples},
                     {"luminance", replay.luminance ? Json(*replay.luminance) : Json()},
                     {"paths", paths}};
  // A file name may contain bytes that are not UTF-8.
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace etendue
