// SignedDistanceGrid: the zero level set of values on a grid, interpolated trilinearly.

#include "components/objects/meshes/mesh_data.h"
#include "components/volumes/volume_grid.h"
#include "files/regular_file.h"
#include "geometry/bernstein.h"
#include "geometry/inner_origin.h"
#include "images/numpy_array.h"
#include "implicit_grid.h"

namespace etendue {
namespace {

// In a cell of the grid the field is trilinear: T(x, y, z), linear in each coordinate. Along a ray from P to Q in the cell it
// is the cubic f(s) = T(P + s (Q - P)) (Hansson-Soderlund, Evans & Akenine-Moller 2022, "Ray tracing of signed distance
// function grids"). As T is linear in each coordinate, f's polar form is
//   F(r, s, t) = mean over the 6 orders of (r, s, t) of T(x(r), y(s), z(t)),
// and its Bernstein coefficients F(0, 0, 0), F(0, 0, 1), F(0, 1, 1), F(1, 1, 1) are means of T at corners of the box between P
// and Q, computed without cancellation.
class SignedDistanceGrid final : public ImplicitObject {
 public:
  static void describe(Description<SignedDistanceGrid>& d) {
    d.summary(
         "The surface where distances on a regular grid, interpolated trilinearly, are 0; the solid is where they are "
         "negative. "
         "Other fields than distances may be given. Surface coordinates are those of the face of the box the surface faces "
         "most, from 0 to 1 as on a Box.",
         "Hansson-Soderlund, Evans & Akenine-Moller 2022, \"Ray tracing of signed distance function grids\"")
        .group("Shape")
        .member<&SignedDistanceGrid::file>(
            "file", "",
            "a NumPy array (.npy) of shape (nz, ny, nx), or a grid of Mitsuba (.vol) or NanoVDB (.nvdb), whose own box does "
            "not count; if given, 'resolution' and 'distances' are not used",
            Effect::rebuild)
        .member<&SignedDistanceGrid::resolution>("resolution", "1", "how many distances there are along x, y and z",
                                                 Effect::rebuild, unless("file"))
        .member<&SignedDistanceGrid::distances>(
            "distances", "m",
            "at the points of the grid, x running fastest, z slowest. None: a ball that fills four fifths of the box",
            Effect::rebuild)
        .group("Box")
        .member<&SignedDistanceGrid::low>("low", "m", "where the first point is", Effect::rebuild)
        .member<&SignedDistanceGrid::high>("high", "m", "where the last point is", Effect::rebuild)
        .member<&SignedDistanceGrid::capped>(
            "capped", "", "whether the solid has faces where the grid ends, and so is closed; else it is open there",
            Effect::rebuild)
        .member<&SignedDistanceGrid::smooth>("smooth", "", "whether normals for shading are interpolated between the points",
                                             Effect::rebuild);
  }

  void prepare() override {
    file.empty() ? take_list() : read_file();
    for (const float x : values_)
      if (!std::isfinite(x)) fail(file.empty() ? "distances" : "file", "all distances must be finite");
    const DoublePoint3 ends[2] = {low, high};
    transform.set_inner_origin(inner_origin_for(ends));
    const std::vector<Point3> shifted = relative_to(transform.inner_origin(), ends);
    for (int k = 0; k < 3; ++k) {
      count_[k] = points_[k] - 1;
      low_[size_t(k)] = double(shifted[0][k]);
      scale_[size_t(k)] = count_[k] / (double(shifted[1][k]) - double(shifted[0][k]));
    }
    find_empty();
    settle(shifted[0], shifted[1], capped, file.empty() ? "distances" : "file");
  }

  FilePath file;
  std::vector<int> resolution{65, 65, 65};
  std::vector<float> distances;
  DoublePoint3 low{-1, -1, -1}, high{1, 1, 1};
  bool capped = true, smooth = true;

 protected:
  double field(const Place& x) const override {
    Place f;
    const float* corner = find(x, f);
    return trilinear(corners(corner), f[0], f[1], f[2]);
  }

  Place gradient(const Place& x) const override {
    Place f;
    const Corners c = corners(find(x, f));
    const auto mix = [](double t, double a, double b) { return a + t * (b - a); };
    const double gx = mix(f[2], mix(f[1], c[1] - c[0], c[3] - c[2]), mix(f[1], c[5] - c[4], c[7] - c[6]));
    const double gy = mix(f[2], mix(f[0], c[2] - c[0], c[3] - c[1]), mix(f[0], c[6] - c[4], c[7] - c[5]));
    const double gz = mix(f[1], mix(f[0], c[4] - c[0], c[5] - c[1]), mix(f[0], c[6] - c[2], c[7] - c[3]));
    return {gx * scale_[0], gy * scale_[1], gz * scale_[2]};
  }

  bool next_crossing(const DoubleRay& r, double from, double to, bool& inside, double& t) const override {
    GridWalk walk(r, from, to, low_, scale_, count_);
    do {
      const size_t cell = cell_index(walk.cell[0], walk.cell[1], walk.cell[2]);
      const int empty = empty_[cell];
      const float* corner = &values_[point_index(walk.cell[0], walk.cell[1], walk.cell[2])];
      walk.measure(std::max(empty - 1, 0));
      if (empty > 0) {
        if ((*corner < 0) == inside) continue;
        inside = !inside;  // by rounding, the start of the block is on the other side
        t = walk.enter;
        return true;
      }
      double p[3], q[3];
      for (int k = 0; k < 3; ++k) {
        p[k] = std::clamp(walk.at(walk.enter, k) - walk.cell[k], 0.0, 1.0);
        q[k] = std::clamp(walk.at(walk.leave, k) - walk.cell[k], 0.0, 1.0);
      }
      const Corners c = corners(corner);
      const double b[4] = {
          trilinear(c, p[0], p[1], p[2]),
          (trilinear(c, q[0], p[1], p[2]) + trilinear(c, p[0], q[1], p[2]) + trilinear(c, p[0], p[1], q[2])) / 3,
          (trilinear(c, p[0], q[1], q[2]) + trilinear(c, q[0], p[1], q[2]) + trilinear(c, q[0], q[1], p[2])) / 3,
          trilinear(c, q[0], q[1], q[2])};
      if (bernstein::crosses<3>(b, walk.enter, walk.leave, inside, t)) return true;
    } while (walk.next());
    return false;
  }

  /// Interpolated values lie between the values at the surrounding grid points.
  bool may_cross(const Place& from, const Place& to) const override {
    int first[3], last[3];
    for (size_t k = 0; k < 3; ++k) {
      first[k] = std::clamp(int(std::floor((from[k] - low_[k]) * scale_[k] - 1e-6)), 0, count_[k] - 1);
      last[k] = std::clamp(int(std::ceil((to[k] - low_[k]) * scale_[k] + 1e-6)), first[k] + 1, count_[k]);
    }
    bool negative = false, positive = false;
    for (int z = first[2]; z <= last[2]; ++z)
      for (int y = first[1]; y <= last[1]; ++y)
        for (int x = first[0]; x <= last[0]; ++x) {
          (values_[point_index(x, y, z)] < 0 ? negative : positive) = true;
          if (negative && positive) return true;
        }
    return false;
  }

  /// Interpolates gradients at the corners of the cell, found by central differences.
  Normal3 shading_normal(const Place& x, const Normal3& geometric) const override {
    if (!smooth) return {};
    int cell[3];
    Place f, sum{};
    locate(x, cell, f);
    for (int i = 0; i < 8; ++i) {
      int at[3];
      double weight = 1;
      for (int k = 0; k < 3; ++k) {
        const int up = (i >> k) & 1;
        at[k] = cell[k] + up;
        weight *= up ? f[size_t(k)] : 1 - f[size_t(k)];
      }
      for (int k = 0; k < 3; ++k) {
        int before[3] = {at[0], at[1], at[2]}, behind[3] = {at[0], at[1], at[2]};
        before[k] = std::max(at[k] - 1, 0);
        behind[k] = std::min(at[k] + 1, count_[k]);
        const double difference = double(values_[point_index(behind[0], behind[1], behind[2])]) -
                                  double(values_[point_index(before[0], before[1], before[2])]);
        sum[size_t(k)] += weight * difference / (behind[k] - before[k]) * scale_[size_t(k)];
      }
    }
    const double norm = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    if (!(norm > 0)) return {};
    const Normal3 n = normalize(Normal3(float(sum[0] / norm), float(sum[1] / norm), float(sum[2] / norm)));
    return dot(n, geometric) > 0.1f ? n : Normal3{};
  }

 private:
  using Corners = std::array<double, 8>;  // x varies fastest
  static constexpr size_t most_points = NumpyArray::most_numbers;

  void take_list() {
    if (resolution.size() != 3) fail("resolution", "three numbers are needed: how many distances along x, y and z");
    size_t count = 1;
    for (int k = 0; k < 3; ++k) {
      points_[k] = resolution[size_t(k)];
      if (points_[k] < 2) fail("resolution", "at least 2 distances are needed along each axis");
      count *= size_t(points_[k]);
      if (count > most_points) fail("resolution", "too many distances");
    }
    if (distances.empty()) return take_ball();
    if (distances.size() != count)
      fail("distances", std::to_string(distances.size()) + " distances for a grid of " + std::to_string(count) + " points");
    values_ = distances;
  }

  void take_ball() {
    values_.clear();
    const auto coordinate = [&](int k, int i) { return 2 * float(i) / float(points_[k] - 1) - 1; };
    for (int z = 0; z < points_[2]; ++z)
      for (int y = 0; y < points_[1]; ++y)
        for (int x = 0; x < points_[0]; ++x)
          values_.push_back(length(Vector3{coordinate(0, x), coordinate(1, y), coordinate(2, z)}) - 0.8f);
  }

  void read_file() {
    const std::string path = file.resolved();
    try {
      if (!path.ends_with(".npy")) return take_grid(read_volume_grid(path));
      const FileContents contents(path);
      const NumpyArray array = parse_numpy_header(contents.text());
      if (array.shape.size() != 3 || *std::min_element(array.shape.begin(), array.shape.end()) < 2)
        throw Error("an array of shape (nz, ny, nx) with at least 2 numbers along each is needed");
      for (size_t k = 0; k < 3; ++k) points_[k] = int(array.shape[2 - k]);
      values_.resize(array.count());
      for (size_t i = 0; i < values_.size(); ++i) values_[i] = float(array[i]);
    } catch (const Error& error) {
      fail("file", "'" + path + "': " + error.what());
    } catch (const std::bad_alloc&) {
      fail("file", "'" + path + "': " + no_memory_to_read);
    }
  }

  void take_grid(VolumeGrid&& grid) {
    if (grid.channels != 1) throw Error(fmt::format("it has {} numbers at each point, and one is needed", grid.channels));
    for (size_t k = 0; k < 3; ++k) points_[k] = grid.size[k];
    if (*std::ranges::min_element(grid.size) < 2) throw Error("at least 2 numbers are needed along each axis");
    values_ = std::move(grid.values);
  }

  size_t point_index(int x, int y, int z) const {
    return (size_t(z) * size_t(points_[1]) + size_t(y)) * size_t(points_[0]) + size_t(x);
  }
  size_t cell_index(int x, int y, int z) const {
    return (size_t(z) * size_t(count_[1]) + size_t(y)) * size_t(count_[0]) + size_t(x);
  }

  Corners corners(const float* p) const {
    const size_t y = size_t(points_[0]), z = y * size_t(points_[1]);
    return {double(p[0]), double(p[1]),     double(p[y]),     double(p[y + 1]),
            double(p[z]), double(p[z + 1]), double(p[z + y]), double(p[z + y + 1])};
  }
  static double trilinear(const Corners& c, double x, double y, double z) {
    const double a = c[0] + x * (c[1] - c[0]), b = c[2] + x * (c[3] - c[2]);
    const double d = c[4] + x * (c[5] - c[4]), e = c[6] + x * (c[7] - c[6]);
    const double low_z = a + y * (b - a), high_z = d + y * (e - d);
    return low_z + z * (high_z - low_z);
  }

  /// The cell that contains a point, and the point's fractional position in the cell.
  void locate(const Place& x, int (&cell)[3], Place& fraction) const {
    for (size_t k = 0; k < 3; ++k) {
      const double g = (x[k] - low_[k]) * scale_[k];
      cell[k] = int(std::clamp(std::floor(g), 0.0, double(count_[k] - 1)));
      fraction[k] = std::clamp(g - cell[k], 0.0, 1.0);
    }
  }
  const float* find(const Place& x, Place& fraction) const {
    int cell[3];
    locate(x, cell, fraction);
    return &values_[point_index(cell[0], cell[1], cell[2])];
  }

  /// For each cell, its chessboard distance (diagonal steps count as one) to the nearest cell with a sign change; 0 for such a
  /// cell itself. One scan forwards and one backwards.
  void find_empty() {
    constexpr std::uint8_t most = 255;
    empty_.resize(size_t(count_[0]) * size_t(count_[1]) * size_t(count_[2]));
    for (int z = 0; z < count_[2]; ++z)
      for (int y = 0; y < count_[1]; ++y)
        for (int x = 0; x < count_[0]; ++x) {
          const Corners c = corners(&values_[point_index(x, y, z)]);
          const auto negative = std::count_if(c.begin(), c.end(), [](double v) { return v < 0; });
          empty_[cell_index(x, y, z)] = negative == 0 || negative == 8 ? most : 0;
        }
    // The minimum over the other cells of max(|dx|, |dy|, |dz|) is not separable; a two-pass scan over all 26 neighbours is
    // exact (Borgefors 1986, "Distance transformations in digital images": the chessboard distance).
    for (const int turn : {1, -1}) {
      const auto begin = [&](int k) { return turn > 0 ? 0 : count_[k] - 1; };
      const auto in = [&](int k, int i) { return i >= 0 && i < count_[k]; };
      for (int z = begin(2); in(2, z); z += turn)
        for (int y = begin(1); in(1, y); y += turn)
          for (int x = begin(0); in(0, x); x += turn) {
            std::uint8_t& here = empty_[cell_index(x, y, z)];
            for (int n = 0; n < 13 && here > 1; ++n) {  // the neighbours that were already visited: 13 of 26
              const int i = x + turn * (n % 3 - 1), j = y + turn * (n / 3 % 3 - 1), k = z + turn * (n / 9 - 1);
              if (!in(0, i) || !in(1, j) || !in(2, k)) continue;
              here = std::min<std::uint8_t>(here, std::uint8_t(std::min(int(empty_[cell_index(i, j, k)]) + 1, int(most))));
            }
          }
    }
  }

  int points_[3]{}, count_[3]{};  // points and cells along each axis
  Place low_{}, scale_{};         // position of the first point; cells per m
  std::vector<float> values_;
  std::vector<std::uint8_t> empty_;
};

const Register<SignedDistanceGrid> registered;

}  // namespace
}  // namespace etendue
