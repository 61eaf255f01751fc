// Primary samples, and the wavelengths of paths.

#include "etendue/sampler.h"
#include "etendue/wavelength_sampler.h"
#include "question_arrays.h"
#include "snapshots.h"

namespace etendue::python {

namespace {

SampleKey key_of(const Rows<std::int32_t>& pixels, const Rows<std::uint32_t>& samples, size_t i, std::uint64_t seed) {
  return {seed, pixels[i][0], pixels[i][1], samples.at(i)};
}

nb::object numbers(nb::handle part, size_t count, const Array<std::int32_t>& pixels, const Array<std::uint32_t>& samples,
                   const Array<std::uint32_t>& dimensions, std::uint64_t seed) {
  const auto asked = snapshot_of<Sampler>(part, "a sampler");
  const size_t width = dimensions.size();
  const Rows<std::int32_t> at(pixels);
  const Rows<std::uint32_t> of(samples);
  Answers<float> values({count, width});
  for_all(count, [&](size_t i, Arena&) {
    const SampleKey key = key_of(at, of, i, seed);
    for (size_t d = 0; d < width; ++d) values[i][d] = asked->as<Sampler>().number(key, dimensions.data()[d]);
  });
  return values.take();
}

nb::object pairs(nb::handle part, size_t count, const Array<std::int32_t>& pixels, const Array<std::uint32_t>& samples,
                 std::uint32_t dimension, std::uint64_t seed) {
  const auto asked = snapshot_of<Sampler>(part, "a sampler");
  const Rows<std::int32_t> at(pixels);
  const Rows<std::uint32_t> of(samples);
  Answers<float> values({count, 2});
  for_all(count, [&](size_t i, Arena&) {
    const Point2 p = asked->as<Sampler>().pair(key_of(at, of, i, seed), dimension);
    values[i][0] = p.x;
    values[i][1] = p.y;
  });
  return values.take();
}

/// The wavelengths of paths [nm], and their pdfs [1/nm].
nb::tuple wavelengths(nb::handle part, size_t count, const Array<float>& u, const Array<std::int32_t>& pixels,
                      const Array<std::uint32_t>& samples, std::uint64_t seed) {
  const auto asked = snapshot_of<WavelengthSampler>(part, "a wavelength sampler");
  const Rows<float> us(u);
  const Rows<std::int32_t> at(pixels);
  const Rows<std::uint32_t> of(samples);
  Answers<float> nm({count, size_t(spectrum_size)}), pdf({count, size_t(spectrum_size)});
  for_all(count, [&](size_t i, Arena&) {
    const Wavelengths w = asked->as<WavelengthSampler>().sample(key_of(at, of, i, seed), us.at(i));
    for (int k = 0; k < spectrum_size; ++k) {
      nm[i][k] = w[k];
      pdf[i][k] = w.pdf(k);
    }
  });
  return nb::make_tuple(nm.take(), pdf.take());
}

}  // namespace

void bind_sampler_questions(nb::module_& m) {
  m.def("sampler_numbers", &numbers);
  m.def("sampler_pairs", &pairs);
  m.def("sample_wavelengths", &wavelengths);
}

}  // namespace etendue::python
