// Participating media and phase functions.

#include "etendue/numbers.h"
#include "etendue/phase_function.h"
#include "etendue/volume_shader.h"
#include "points.h"

namespace etendue::python {

namespace {

using Asked = std::shared_ptr<const Snapshot>;

Point3 point_at(const Rows<float>& rows, size_t i) { return Point3{} + vector_at(rows, i); }

/// Absorption, scattering and emission at points of object space.
nb::tuple coefficients(nb::handle part, size_t count, const Array<float>& points, const Array<float>& time,
                       const nb::tuple& wavelengths) {
  const Asked asked = snapshot_of<VolumeShader>(part, "a volume shader");
  const Rows<float> at(points), times(time);
  const WavelengthRows rows = wavelength_rows(wavelengths);
  Answers<float> absorption({count, rows.count()}), scattering({count, rows.count()}), emission({count, rows.count()});
  for_all(count, [&](size_t i, Arena&) {
    const Point3 p = point_at(at, i);
    for (size_t g = 0; g < rows.groups(); ++g) {
      const VolumeCoefficients c =
          is_finite(p) ? asked->as<VolumeShader>().coefficients(p, times.at(i), rows.at(i, g)) : VolumeCoefficients{};
      rows.store(c.absorption, g, absorption[i]);
      rows.store(c.scattering, g, scattering[i]);
      rows.store(c.emission, g, emission[i]);
    }
  });
  return nb::make_tuple(absorption.take(), scattering.take(), emission.take());
}

nb::object majorant(nb::handle part, const nb::tuple& wavelengths, size_t count) {
  const Asked asked = snapshot_of<VolumeShader>(part, "a volume shader");
  return answer_spectra(count, wavelengths,
                        [&](size_t, const Wavelengths& w) { return asked->as<VolumeShader>().majorant(w); });
}

/// T(d) in a medium that fills all of object space: in closed form if the medium is homogeneous, else by ratio tracking with
/// the numbers of a hash.
Spectrum transmittance_along(const VolumeShader& volume, const Point3& from, const Vector3& direction, float distance,
                             float time, const Wavelengths& w, std::uint64_t key) {
  if (volume.homogeneous()) return exp(-volume.coefficients(from, time, w).extinction() * distance);
  const float m = volume.majorant(w).maximum();
  Spectrum product(1.0f);
  if (!(m > 0)) return product;
  for (double t = 0;;) {
    key = mix_bits(key + 0x9e3779b97f4a7c15ull);
    t -= std::log1p(-double(to_unit_float(std::uint32_t(key >> 32)))) / double(m);
    if (!(t < double(distance))) return product;
    const Point3 at = from + float(t) * direction;
    product *= max(Spectrum(1.0f) - volume.coefficients(at, time, w).extinction() / m, 0);
    if (product.black()) return product;
  }
}

nb::object transmittance(nb::handle part, size_t count, const Array<float>& origins, const Array<float>& directions,
                         const Array<float>& distances, const Array<float>& time, const nb::tuple& wavelengths,
                         std::uint64_t seed) {
  const Asked asked = snapshot_of<VolumeShader>(part, "a volume shader");
  const auto& volume = asked->as<VolumeShader>();
  const Rows<float> froms(origins), along(directions), far(distances), times(time);
  const WavelengthRows rows = wavelength_rows(wavelengths);
  Answers<float> values({count, rows.count()});
  for_all(count, [&](size_t i, Arena&) {
    const Point3 from = point_at(froms, i);
    Vector3 d = vector_at(along, i);
    const float distance = far.at(i);
    const bool usable = make_unit(d) && is_finite(from) && distance >= 0 && (std::isfinite(distance) || volume.homogeneous());
    rows.fill(i, values[i], [&](const Wavelengths& w) {
      if (!usable) return Spectrum(std::numeric_limits<float>::quiet_NaN());
      return distance == 0 ? Spectrum(1.0f)
                           : transmittance_along(volume, from, d, distance, times.at(i), w, mix_bits(seed) ^ i);
    });
  });
  return values.take();
}

nb::object phase(nb::handle part, size_t count, const Array<float>& points, const Array<float>& outgoing,
                 const Array<float>& incoming) {
  const Asked asked = snapshot_of<VolumeShader>(part, "a volume shader");
  const Rows<float> at(points), outs(outgoing), ins(incoming);
  return answer_numbers(count, [&](size_t i) {
    Vector3 out = vector_at(outs, i), in = vector_at(ins, i);
    const bool usable = make_unit(out) && make_unit(in) && is_finite(point_at(at, i));
    return usable ? asked->as<VolumeShader>().phase(point_at(at, i), out, in) : 0;
  });
}

nb::tuple sample_phase(nb::handle part, size_t count, const Array<float>& points, const Array<float>& outgoing,
                       const Array<float>& u) {
  const Asked asked = snapshot_of<VolumeShader>(part, "a volume shader");
  const Rows<float> at(points), outs(outgoing), us(u);
  Answers<float> direction({count, 3}), pdfs({count});
  for_all(count, [&](size_t i, Arena&) {
    Vector3 out = vector_at(outs, i), in;
    float pdf = 0;
    if (make_unit(out) && is_finite(point_at(at, i)))
      in = asked->as<VolumeShader>().sample_phase(point_at(at, i), out, point2_at(us, i), pdf);
    direction.set(i, in);
    pdfs.set(i, pdf);
  });
  return nb::make_tuple(direction.take(), pdfs.take());
}

nb::object phase_value(nb::handle part, size_t count, const Array<double>& cosines) {
  const Asked asked = snapshot_of<PhaseFunction>(part, "a phase function");
  const Rows<double> given(cosines);
  return answer_numbers(count, [&](size_t i) {
    constexpr double rounding = 1e-6;
    const double h = 1 - given.at(i);
    return h >= -rounding && h <= 2 + rounding ? asked->as<PhaseFunction>().value(clamp(float(h), 0, 2))
                                               : std::numeric_limits<float>::quiet_NaN();
  });
}

nb::tuple phase_sample(nb::handle part, size_t count, const Array<float>& u) {
  const Asked asked = snapshot_of<PhaseFunction>(part, "a phase function");
  const auto& function = asked->as<PhaseFunction>();
  const Rows<float> us(u);
  Answers<double> cosine({count});
  Answers<float> pdf({count});
  for_all(count, [&](size_t i, Arena&) {
    const float h = function.sample(us.at(i));
    cosine.set(i, 1 - double(h));
    pdf.set(i, function.value(h));
  });
  return nb::make_tuple(cosine.take(), pdf.take());
}

}  // namespace

void bind_volume_questions(nb::module_& m) {
  m.def("volume_coefficients", &coefficients);
  m.def("volume_majorant", &majorant);
  m.def("volume_transmittance", &transmittance);
  m.def("volume_phase", &phase);
  m.def("volume_sample_phase", &sample_phase);
  m.def("phase_value", &phase_value);
  m.def("phase_sample", &phase_sample);
}

}  // namespace etendue::python
