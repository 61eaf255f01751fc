// Photon mapping against closed forms: see closed_form_rows.h. Radii are small compared with the structures they could blur,
// except where the light is uniform and no blur is visible.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/closed_form_rows.h"

namespace etendue::closed_form {
namespace {

std::vector<Row> photon_rows() {
  const std::string inside = "PerspectiveCamera { from: [0.3, 0.1, 0.2], to: [0, 0, 1], fov: 90 }";
  std::vector<Row> rows;
  // A chord of length r cuts a cap of the area pi r^2 from a sphere: the kernel has no bias. Photons include direct light, too.
  rows.push_back({"R01_Furnace",
                  inside,
                  "Sphere { radius: 1, shader: Lambertian { color: 0.8 }, emission: DiffuseEmission { radiance: 1, sides: "
                  "back } }",
                  5,
                  {{"VertexConnectionMerging", "max_depth: 1000, radius: 0.5", 4},
                   {"VertexConnectionMerging", "max_depth: 1000, radius: 0.5, heuristic: balance", 4},
                   {"VertexConnectionMerging", "max_depth: 1000, radius: 0.5, connecting: false, photon_walks: 2000", 8},
                   {"ProgressivePhotonMapper", "max_depth: 1000, radius: 0.5, photon_walks: 2000", 8},
                   {"ProgressivePhotonMapper", "max_depth: 1000, radius: 0.5, photon_walks: 2000, next_event: false", 8},
                   {"ProgressivePhotonMapper", "max_depth: 1000, radius: 0.5, photon_walks: 2000, most_photons: 3000", 8},
                   {"PhotonMapper", "max_depth: 1000, farthest: 0.5, photon_walks: 5000, samples_per_map: 4", 4},
                   {"PhotonMapper", "max_depth: 40, farthest: 0.5, photon_walks: 20000, importance: 0, irradiance: true", 1},
                   {"PhotonMapper", "max_depth: 1000, farthest: 0.5, photon_walks: 5000, final_gather: false", 4}}});
  // Fog in the furnace: photons in media.
  rows.push_back({"R01_FurnaceWithFog",
                  "PerspectiveCamera { from: [-0.5, 0, 0], to: [1, 0, 0], fov: 90 }",
                  "Sphere { radius: 1, shader: Lambertian { color: 0.5 }, emission: DiffuseEmission { radiance: 1, sides: "
                  "back } }\nSphere { centre: [0.4, 0, 0], radius: 0.5, shader: PassThrough {}, interior: HomogeneousVolume { "
                  "scattering: 2 } }",
                  2,
                  {{"VertexConnectionMerging", "max_depth: 1000, radius: 0.1", 16},
                   {"ProgressivePhotonMapper", "max_depth: 1000, radius: 0.1, photon_walks: 16000", 10},
                   {"ProgressivePhotonMapper", "max_depth: 1000, radius: 0.2, photon_walks: 4000, media: points", 8}}});
  // Light through glass onto a plate of very low reflectance that shows its irradiance; all photons are caustic photons.
  const std::string sun = "Distant { direction: [0, 0, -1], emission: DiffuseEmission { radiance: 314159.265 } }";
  const std::string glass =
      "TriangleMesh { positions: [[-40,-40,-1],[40,-40,-1],[40,40,-1],[-40,40,-1],[-40,-40,0],[40,-40,0],[40,40,0],[-40,40,0]],"
      "triangles: [[0,2,1],[0,3,2],[4,5,6],[4,6,7],[0,5,4],[0,1,5],[1,6,5],[1,2,6],[2,7,6],[2,3,7],[3,4,7],[3,0,4]],"
      "shader: Dielectric { ior: 1.5 } }\n";
  const std::string under = "max_depth: 1000, radius: 1, photon_walks: 5000";
  rows.push_back({"R32_LitThroughGlass",
                  square("[0, 0, -1.5]", "[0, 0, -2]", 60),
                  glass + plate(40, -2, "shader: Lambertian { color: 1e-5 }") + sun,
                  0.923077,
                  {{"VertexConnectionMerging", under, 4},
                   {"ProgressivePhotonMapper", under, 4},
                   {"PhotonMapper",
                    "max_depth: 1000, farthest_caustic: 1, nearest_caustic: 1000, caustic_walks: 5000, samples_per_map: 4", 4},
                   // Few photons: the k-th of ten gives the radius and is not in the sum.
                   {"PhotonMapper",
                    "max_depth: 1000, farthest_caustic: 8, nearest_caustic: 10, caustic_walks: 5000, samples_per_map: 4, "
                    "sampler: IndependentSampler {}",
                    16}}});
  rows.push_back({"R28_PlateInGlass",
                  square("[0, 0, -0.3]", "[0, 0, -1]", 60),
                  glass + plate(39.5, -0.5, "shader: Lambertian { color: 1e-5 }") + sun,
                  0.96,
                  {{"VertexConnectionMerging", under, 4}, {"ProgressivePhotonMapper", under, 4}}});
  return rows;
}

class PhotonRows : public testing::TestWithParam<Case> {};
TEST_P(PhotonRows, HaveTheirClosedForm) { expect_row(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Rows, PhotonRows, testing::ValuesIn(cases(photon_rows())), case_name);

}  // namespace
}  // namespace etendue::closed_form
