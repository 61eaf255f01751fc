// Scattering at points of surfaces: by one shader at all points, or by the shader of each point's own object.

#include <nanobind/stl/string.h>

#include "etendue/transport/path_sink.h"
#include "etendue/transport/scattering.h"
#include "points.h"

namespace etendue::python {

namespace {

/// The BSDFs of a question: those of a shader, or with the shader None those of the points' own objects in a scene.
class Scattering {
 public:
  Scattering(nb::handle shader, nb::handle scene, const Points& points) : points_(points) {
    if (!shader.is_none()) {
      asked_ = snapshot_of<Shader>(shader, "a shader");
      shader_ = &asked_->as<Shader>();
      return;
    }
    asked_ = snapshot_of<Scene>(scene, "a scene");
    require_present(points, asked_);
    if (!points.scene)
      throw Error("points that were made by hand have no shader: ask one for them, as in shader.evaluate(points, …)");
  }
  /// The point of an item.
  const SurfacePoint& point(size_t i) const { return points_.row(i).point; }
  /// The BSDF at the point of an item, seen from `out`. Null: black, or no point.
  const Scatter* at(size_t i, const Vector3& out, const Wavelengths& wavelengths, Arena& arena) const {
    const FoundPoint& found = points_.row(i);
    if (!found.exists()) return nullptr;
    if (shader_) return bound(*shader_, found.point, wavelengths, arena);
    return found.point.object ? scattering_at(found.point, out, wavelengths, arena) : nullptr;
  }

 private:
  const Points& points_;
  std::shared_ptr<const Snapshot> asked_;
  const Shader* shader_ = nullptr;
};

ScatterContext context_of(bool importance, Lobes lobes) {
  return {importance ? Transport::importance : Transport::radiance, lobes};
}

/// The values and pdfs for given pairs of directions; the pdfs are those of the first group of wavelengths.
nb::tuple evaluate(nb::handle shader, nb::handle scene, const Points& points, size_t count, const Array<float>& outgoing,
                   const Array<float>& incoming, const nb::tuple& wavelengths, bool importance, Lobes lobes, bool values_too) {
  const Scattering scattering(shader, scene, points);
  const Rows<float> outs(outgoing), ins(incoming);
  const WavelengthRows rows = wavelength_rows(wavelengths);
  const ScatterContext context = context_of(importance, lobes);
  Answers<float> values({values_too ? count : 0, rows.count()}), pdfs({count});
  for_all(count, [&](size_t i, Arena& arena) {
    Vector3 out = vector_at(outs, i), in = vector_at(ins, i);
    const bool usable = make_unit(out) && make_unit(in);
    pdfs.set(i, 0);
    for (size_t g = 0; g < rows.groups(); ++g) {
      const Scatter* const scatter = usable ? scattering.at(i, out, rows.at(i, g), arena) : nullptr;
      if (g == 0 && scatter) pdfs.set(i, scatter->pdf(out, in, context));
      if (!values_too) return;
      rows.store(scatter ? scatter->evaluate(out, in, context) : Spectrum(), g, values[i]);
    }
  });
  return nb::make_tuple(values_too ? values.take() : nb::none(), pdfs.take());
}

/// Direction, weight, pdf, lobe, eta, whether it disperses, and whether it enters an object with subsurface scattering.
nb::tuple sample(nb::handle shader, nb::handle scene, const Points& points, size_t count, const Array<float>& outgoing,
                 const nb::tuple& wavelengths, const Array<float>& u, bool importance, Lobes lobes) {
  const Scattering scattering(shader, scene, points);
  const Rows<float> outs(outgoing), us(u);
  const WavelengthRows rows = wavelength_rows(wavelengths);
  const ScatterContext context = context_of(importance, lobes);
  Answers<float> directions({count, 3}), weights({count, rows.count()}), pdfs({count}), etas({count});
  Answers<std::uint8_t> lobe({count});
  Answers<bool> dispersive({count}), subsurface({count});
  for_all(count, [&](size_t i, Arena& arena) {
    Vector3 out = vector_at(outs, i);
    const Wavelengths w = rows.at(i);
    const Scatter* const scatter = make_unit(out) ? scattering.at(i, out, w, arena) : nullptr;
    const float* const n = us[i];
    const std::optional<ScatterSample> s = scatter ? scatter->sample(out, n[0], {n[1], n[2]}, context) : std::nullopt;
    directions.set(i, s ? s->direction : Vector3{});
    rows.store(s ? s->weight : Spectrum(), 0, weights[i]);
    pdfs.set(i, s ? s->pdf : 0);
    lobe.set(i, s ? std::uint8_t(s->lobe) : std::uint8_t(0));
    etas.set(i, s ? s->eta : 1);
    dispersive.set(i, s && s->dispersive);
    subsurface.set(i, s && scattering.point(i).object && enters_subsurface(scattering.point(i), *s));
  });
  return nb::make_tuple(directions.take(), weights.take(), pdfs.take(), lobe.take(), etas.take(), dispersive.take(),
                        subsurface.take());
}

nb::object albedo(nb::handle shader, nb::handle scene, const Points& points, size_t count, const Array<float>& outgoing,
                  const nb::tuple& wavelengths, Lobes lobes) {
  const Scattering scattering(shader, scene, points);
  const Rows<float> outs(outgoing);
  const WavelengthRows rows = wavelength_rows(wavelengths);
  Answers<float> values({count, rows.count()});
  for_all(count, [&](size_t i, Arena& arena) {
    Vector3 out = vector_at(outs, i);
    const bool usable = make_unit(out);
    rows.fill(i, values[i], [&](const Wavelengths& w) {
      const Scatter* const scatter = usable ? scattering.at(i, out, w, arena) : nullptr;
      return scatter ? scatter->albedo(out, lobes) : Spectrum();
    });
  });
  return values.take();
}

nb::object lobes_at(nb::handle shader, nb::handle scene, const Points& points, size_t count, const Array<float>& outgoing,
                    const nb::tuple& wavelengths) {
  const Scattering scattering(shader, scene, points);
  const Rows<float> outs(outgoing);
  const WavelengthRows rows = wavelength_rows(wavelengths);
  Answers<std::uint8_t> lobes({count});
  for_all(count, [&](size_t i, Arena& arena) {
    Vector3 out = vector_at(outs, i);
    const Scatter* const scatter = make_unit(out) ? scattering.at(i, out, rows.at(i), arena) : nullptr;
    lobes.set(i, scatter ? scatter->lobes() : no_lobes);
  });
  return lobes.take();
}

nb::object interior_index(nb::handle shader, const nb::tuple& wavelengths, size_t count) {
  const auto asked = snapshot_of<Shader>(shader, "a shader");
  return answer_spectra(count, wavelengths,
                        [&](size_t, const Wavelengths& w) { return asked->as<Shader>().interior_index(w); });
}

/// The kinds of scattering and their bits: "diffuse reflection": 1, …
nb::dict lobe_bits() {
  nb::dict bits;
  for (int bit = 1; bit < all_lobes; bit *= 2) bits[nb::str(lobe_name(Lobe(bit)).c_str())] = bit;
  return bits;
}

}  // namespace

void bind_scatter_questions(nb::module_& m) {
  using namespace nb::literals;
  const auto none = [](const char* name) { return nb::arg(name).none(); };
  m.def("scatter_evaluate", &evaluate, none("shader"), none("scene"), "points"_a, "count"_a, "outgoing"_a, "incoming"_a,
        "wavelengths"_a, "importance"_a, "lobes"_a, "values"_a);
  m.def("scatter_sample", &sample, none("shader"), none("scene"), "points"_a, "count"_a, "outgoing"_a, "wavelengths"_a, "u"_a,
        "importance"_a, "lobes"_a);
  m.def("scatter_albedo", &albedo, none("shader"), none("scene"), "points"_a, "count"_a, "outgoing"_a, "wavelengths"_a,
        "lobes"_a);
  m.def("scatter_lobes", &lobes_at, none("shader"), none("scene"), "points"_a, "count"_a, "outgoing"_a, "wavelengths"_a);
  m.def("interior_index", &interior_index);
  m.def("lobe_bits", &lobe_bits);
}

}  // namespace etendue::python
