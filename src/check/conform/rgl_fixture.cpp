#include "rgl_fixture.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

namespace etendue::conform {
namespace {

// The container: "tensor_file", version 1.0, the number of fields, then for each its name, dimensions, type, place and shape;
// little-endian.
struct Field {
  std::string name;
  std::uint8_t type;  ///< 1: uint8, 10: float32
  std::vector<std::uint64_t> shape;
  std::string bytes;
};

template <class T>
void put(std::string& to, T value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

Field floats(const std::string& name, std::vector<std::uint64_t> shape, const std::vector<float>& values) {
  Field f{name, 10, std::move(shape), {}};
  f.bytes.assign(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
  return f;
}

std::string tensor_file(const std::vector<Field>& fields) {
  size_t header = 12 + 2 + 4;
  for (const Field& f : fields) header += 2 + f.name.size() + 2 + 1 + 8 + 8 * f.shape.size();
  std::string file("tensor_file\0", 12);
  put<std::uint8_t>(file, 1);
  put<std::uint8_t>(file, 0);
  put(file, std::uint32_t(fields.size()));
  size_t offset = header;
  for (const Field& f : fields) {
    put(file, std::uint16_t(f.name.size()));
    file += f.name;
    put(file, std::uint16_t(f.shape.size()));
    put(file, f.type);
    put(file, std::uint64_t(offset));
    for (const std::uint64_t n : f.shape) put(file, n);
    offset += f.bytes.size();
  }
  for (const Field& f : fields) file += f.bytes;
  return file;
}

}  // namespace

// Dupuy & Jakob 2018, "An adaptive parameterization for efficient material acquisition and rendering". Directions are laid out
// over the unit square by theta = u^2 pi / 2 and phi = (2 v - 1) pi; densities (`vndf`) are per area of the square, of which
// 1 is 2 pi^2 u sin(theta) steradian. The microfacets have the GGX distribution D (Walter et al. 2007), whose projected area is
// sigma = (cos + sqrt(cos^2 + a^2 sin^2)) / 2; visible normals have density max(i . m, 0) D / sigma. `spectra` is the
// reflectance of the facets.
std::string rgl_material() {
  constexpr std::uint64_t incident = 8, resolution = 32, wavelengths = 4;
  constexpr double roughness2 = 0.16, half_pi = M_PI / 2;
  const auto at = [](std::uint64_t i, std::uint64_t count) { return double(i) / double(count - 1); };
  const auto angle = [&](std::uint64_t column) { return at(column, resolution) * at(column, resolution) * half_pi; };
  const auto distribution = [&](double theta) {
    const double c2 = std::cos(theta) * std::cos(theta), d = c2 * (roughness2 - 1) + 1;
    return roughness2 / (M_PI * d * d);
  };
  const auto area = [&](double theta) {
    const double c = std::cos(theta), s = std::sin(theta);
    return (c + std::sqrt(c * c + roughness2 * s * s)) / 2;
  };
  std::vector<float> theta_i, vndf, luminance, spectra, ndf, sigma;
  for (std::uint64_t i = 0; i < incident; ++i) theta_i.push_back(float(at(i, incident) * half_pi * 0.98));
  // Rows are phi, columns theta.
  for (std::uint64_t row = 0; row < resolution; ++row)
    for (std::uint64_t column = 0; column < resolution; ++column) {
      ndf.push_back(float(distribution(angle(column))));
      sigma.push_back(float(area(angle(column))));
    }
  for (const float incident_angle : theta_i) {
    const double theta = double(incident_angle);
    for (std::uint64_t row = 0; row < resolution; ++row)
      for (std::uint64_t column = 0; column < resolution; ++column) {
        const double m = angle(column), phi = (2 * at(row, resolution) - 1) * M_PI;
        const double cosine = std::sin(theta) * std::sin(m) * std::cos(phi) + std::cos(theta) * std::cos(m);
        const double per_square = 2 * M_PI * M_PI * at(column, resolution) * std::sin(m);
        vndf.push_back(float(std::max(cosine, 0.0) * distribution(m) / area(theta) * per_square));
        luminance.push_back(0.4f);
      }
    for (std::uint64_t w = 0; w < wavelengths; ++w)
      for (std::uint64_t i = 0; i < resolution * resolution; ++i) spectra.push_back(0.3f + 0.1f * float(w));
  }
  const std::string description = "made up for tests";
  return tensor_file({{"description", 1, {description.size()}, description},
                      floats("phi_i", {1}, {0}),
                      floats("theta_i", {incident}, theta_i),
                      floats("ndf", {resolution, resolution}, ndf),
                      floats("sigma", {resolution, resolution}, sigma),
                      floats("vndf", {1, incident, resolution, resolution}, vndf),
                      floats("luminance", {1, incident, resolution, resolution}, luminance),
                      floats("spectra", {1, incident, wavelengths, resolution, resolution}, spectra),
                      floats("wavelengths", {wavelengths}, {400, 500, 600, 700}),
                      {"jacobian", 1, {1}, std::string(1, '\1')}});
}

}  // namespace etendue::conform
