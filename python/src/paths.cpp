#include "paths.h"

#include <nanobind/stl/string.h>

#include "arrays.h"
#include "check/replay/replay.h"

namespace etendue::python {

namespace {

template <class V>
void add_three(std::vector<double>& to, const V& v) {
  to.insert(to.end(), {double(v.x), double(v.y), double(v.z)});
}

void add_spectrum(std::vector<float>& to, const Spectrum& s) {
  for (int i = 0; i < spectrum_size; ++i) to.push_back(s[i]);
}

constexpr size_t lanes = spectrum_size;

nb::dict vertices_dict(const std::vector<PathRecord::Vertex>& vertices) {
  nb::list kinds, objects, lobes, notes;
  std::vector<double> positions, normals;
  std::vector<float> pdfs, throughput, emitted, direct;
  for (const PathRecord::Vertex& v : vertices) {
    kinds.append(v.kind);
    objects.append(v.object);
    lobes.append(v.lobe);
    notes.append(v.note);
    add_three(positions, v.position);
    add_three(normals, v.normal);
    pdfs.push_back(v.pdf);
    add_spectrum(throughput, v.throughput);
    add_spectrum(emitted, v.emitted);
    add_spectrum(direct, v.direct);
  }
  const size_t n = vertices.size();
  nb::dict d;
  d["kind"] = nb::tuple(kinds);
  d["object"] = nb::tuple(objects);
  d["position"] = array_from(std::move(positions), {n, 3});
  d["normal"] = array_from(std::move(normals), {n, 3});
  d["lobe"] = nb::tuple(lobes);
  d["pdf"] = array_from(std::move(pdfs), {n});
  d["throughput"] = array_from(std::move(throughput), {n, lanes});
  d["emitted"] = array_from(std::move(emitted), {n, lanes});
  d["direct"] = array_from(std::move(direct), {n, lanes});
  d["note"] = nb::tuple(notes);
  return d;
}

nb::dict contributions_dict(const std::vector<PathRecord::Contribution>& contributions) {
  nb::list strategies;
  std::vector<std::int32_t> lengths;
  std::vector<float> weights, values;
  std::vector<double> film;
  std::vector<bool> splats;
  for (const PathRecord::Contribution& c : contributions) {
    strategies.append(c.strategy);
    lengths.push_back(c.length);
    weights.push_back(c.weight);
    add_spectrum(values, c.value);
    film.insert(film.end(), {double(c.film.x), double(c.film.y)});
    splats.push_back(c.splat);
  }
  nb::list is_splat;
  for (const bool b : splats) is_splat.append(b);
  const size_t n = contributions.size();
  nb::dict d;
  d["strategy"] = nb::tuple(strategies);
  d["length"] = array_from(std::move(lengths), {n});
  d["weight"] = array_from(std::move(weights), {n});
  d["value"] = array_from(std::move(values), {n, lanes});
  d["film"] = array_from(std::move(film), {n, 2});
  d["splat"] = nb::tuple(is_splat);
  return d;
}

}  // namespace

nb::dict path_dict(const PathRecord& record, Point2 film) {
  std::vector<float> wavelengths, result;
  for (int i = 0; i < spectrum_size; ++i) wavelengths.push_back(record.wavelengths[i]);
  add_spectrum(result, record.result);
  nb::dict d;
  d["film"] = nb::make_tuple(double(film.x), double(film.y));
  d["vertices"] = vertices_dict(record.vertices);
  d["light_vertices"] = vertices_dict(record.light_vertices);
  d["contributions"] = contributions_dict(record.contributions);
  d["wavelengths"] = array_from(std::move(wavelengths), {lanes});
  d["result"] = array_from(std::move(result), {lanes});
  d["text"] = path_text(record, film);
  return d;
}

}  // namespace etendue::python
