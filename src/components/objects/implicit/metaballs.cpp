// Metaballs: the isosurface of a sum of soft balls, which blend into each other.

#include "geometry/bernstein.h"
#include "geometry/inner_origin.h"
#include "implicit_grid.h"

namespace etendue {
namespace {

// Ball i adds s_i u^3 to the density at a distance r < R_i of its centre, u = 1 - r^2 / R_i^2 (Wyvill, McPheeters & Wyvill
// 1986, "Data structure for soft objects", in the form with even powers only); the surface is where the density equals the
// threshold. Along a ray u is quadratic in t, so between the points where the ray enters or leaves a ball the density is a
// polynomial of degree 6, whose first crossing is found from its Bernstein coefficients: no feature is too thin to be found.
class Metaballs final : public ImplicitObject {
 public:
  static void describe(Description<Metaballs>& d) {
    d.summary(
         "Soft balls that flow together: the solid where the sum of strength * (1 - (distance / radius)^2)^3, over all balls "
         "within whose radius a point is, exceeds the threshold. Surface coordinates are those of the face of the surrounding "
         "box "
         "the surface faces most, from 0 to 1 as on a Box.",
         "Wyvill, McPheeters & Wyvill 1986, \"Data structure for soft objects\"")
        .group("Shape")
        .member<&Metaballs::centres>("centres", "m", "the middles of the balls", Effect::rebuild)
        .member<&Metaballs::radii>("radii", "m", "how far each ball reaches; one number: all reach as far", Effect::rebuild)
        .member<&Metaballs::strengths>("strengths", "1",
                                       "the density at the middle of each, negative to take away; one number: all "
                                       "are as strong",
                                       Effect::rebuild)
        .member<&Metaballs::threshold>("threshold", "1", "the density at the surface", more_than(0), Effect::rebuild,
                                       soft(0.01, 10), logarithmic);
  }

  void prepare() override {
    if (centres.empty()) fail("centres", "at least one ball is needed");
    if (radii.size() != 1 && radii.size() != centres.size())
      fail("radii",
           std::to_string(radii.size()) + " radii for " + std::to_string(centres.size()) + " balls: give one, or as many");
    if (strengths.size() != 1 && strengths.size() != centres.size())
      fail("strengths", std::to_string(strengths.size()) + " strengths for " + std::to_string(centres.size()) +
                            " balls: give one, or as many");
    if (!std::isfinite(threshold)) fail("threshold", "must be finite");
    balls_.clear();
    Bounds3 box;
    transform.set_inner_origin(inner_origin_for(centres));
    const std::vector<Point3> middles = relative_to(transform.inner_origin(), centres);
    for (size_t i = 0; i < centres.size(); ++i) {
      const float radius = radii[radii.size() == 1 ? 0 : i], strength = strengths[strengths.size() == 1 ? 0 : i];
      if (!is_finite(centres[i])) fail("centres", "must be finite");
      if (!(radius > 0 && radius < infinity)) fail("radii", "must be positive and finite");
      if (!std::isfinite(strength)) fail("strengths", "must be finite");
      const Point3& c = middles[i];
      balls_.push_back({{double(c.x), double(c.y), double(c.z)}, 1 / (double(radius) * double(radius)), double(strength)});
      if (!(strength > 0)) continue;
      box.add(c - Vector3{radius, radius, radius});
      box.add(c + Vector3{radius, radius, radius});
    }
    if (box.empty()) fail("strengths", "at least one ball must have a positive strength");
    make_grid(box);
    settle(box.low, box.high, false, "threshold");
  }

  bool closed() const override { return true; }  // at the border of the box the density is 0

  std::vector<DoublePoint3> centres{{-0.45, 0, 0}, {0.45, 0, 0}};
  std::vector<float> radii{1}, strengths{1};
  float threshold = 0.2f;

 protected:
  double field(const Place& x) const override {
    double density = 0;
    for_balls_at(x, [&](const Ball& ball, double u) { density += ball.strength * u * u * u; });
    return double(threshold) - density;
  }
  Place gradient(const Place& x) const override {
    Place g{};
    for_balls_at(x, [&](const Ball& ball, double u) {
      const double slope = 6 * ball.strength * u * u * ball.inverse_square;
      for (size_t k = 0; k < 3; ++k) g[k] += slope * (x[k] - ball.centre[k]);
    });
    return g;
  }

  bool next_crossing(const DoubleRay& r, double from, double to, bool& inside, double& t) const override {
    GridWalk walk(r, from, to, low_, scale_, count_);
    do {
      walk.measure();
      const Cell& cell = cells_[cell_index(walk.cell[0], walk.cell[1], walk.cell[2])];
      if (cell.sign == Sign::mixed) {
        if (crosses_cell(cell, r, walk.enter, walk.leave, inside, t)) return true;
      } else if ((cell.sign == Sign::inside) != inside) {  // by rounding, the start of the cell is on the other side
        inside = !inside;
        t = walk.enter;
        return true;
      }
    } while (walk.next());
    return false;
  }

  bool may_cross(const Place& from, const Place& to) const override {
    const Block block = block_between(from, to);
    bool inside = false, outside = false;
    for (int z = block[2][0]; z <= block[2][1]; ++z)
      for (int y = block[1][0]; y <= block[1][1]; ++y)
        for (int x = block[0][0]; x <= block[0][1]; ++x) {
          const Cell& cell = cells_[cell_index(x, y, z)];
          Sign sign = cell.sign;
          if (sign == Sign::mixed) {
            auto [low, high] = cell_box({x, y, z});
            for (size_t k = 0; k < 3; ++k) {
              low[k] = std::max(low[k], from[k]);
              high[k] = std::min(high[k], to[k]);
            }
            const auto [least, most] = range(cell, low, high);
            if (least <= double(threshold) && most >= double(threshold)) return true;
            sign = least > double(threshold) ? Sign::inside : Sign::outside;
          }
          (sign == Sign::inside ? inside : outside) = true;
          if (inside && outside) return true;
        }
    return false;
  }

 private:
  struct Ball {
    Place centre;
    double inverse_square, strength;  // 1 / radius^2 [1/m^2], strength
  };
  enum class Sign : std::uint8_t { mixed, inside, outside };
  struct Cell {
    std::uint32_t begin = 0, end = 0;  // range in listed_
    Sign sign = Sign::mixed;
  };
  /// The part of a ray within a ball.
  struct Piece {
    double begin, end;
    const Ball* ball;
  };

  /// Bounds of the density in a box within a cell.
  std::pair<double, double> range(const Cell& cell, const Place& from, const Place& to) const {
    double least = 0, most = 0;
    for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
      const Ball& ball = balls_[listed_[i]];
      double near = 0, far = 0;
      for (size_t k = 0; k < 3; ++k) {
        const double a = from[k] - ball.centre[k], b = to[k] - ball.centre[k], nearest = std::max({a, -b, 0.0});
        near += nearest * nearest;
        far += std::max(a * a, b * b);
      }
      const double high = std::max(0.0, 1 - near * ball.inverse_square), low = std::max(0.0, 1 - far * ball.inverse_square);
      const double large = ball.strength * high * high * high, small = ball.strength * low * low * low;
      least += std::min(small, large);
      most += std::max(small, large);
    }
    const double rounding = 1e-12 * (std::abs(least) + std::abs(most));
    return {least - rounding, most + rounding};
  }

  using Block = std::array<std::array<int, 2>, 3>;  // the first and the last cell along each axis

  /// Chooses the cell size so that uniformly distributed balls would give about one ball per cell; larger cells if the balls
  /// overlap so much that the lists would become long.
  void make_grid(const Bounds3& box) {
    constexpr double most_cells = 64;
    const double most_entries = double(size_t(1) << 22) + 256 * double(balls_.size());
    Place edge;
    for (size_t k = 0; k < 3; ++k) {
      edge[k] = double(box.high[int(k)]) - double(box.low[int(k)]);
      low_[k] = double(box.low[int(k)]);
      if (!(edge[k] < 1e30)) fail("", "the balls reach beyond what can be counted with");
    }
    double wanted = std::cbrt(edge[0] * edge[1] * edge[2] / (64 + 8 * double(balls_.size())));  // edge of a cell
    for (double entries = infinity; entries > most_entries; wanted *= 1.5) {
      for (size_t k = 0; k < 3; ++k) {
        const double number = std::ceil(edge[k] / wanted);
        count_[k] = number > 1 ? int(std::min(number, most_cells)) : 1;  // 1 where it is NaN
        scale_[k] = edge[k] > 0 ? count_[k] / edge[k] : 0;
      }
      entries = 0;
      for (const Ball& ball : balls_) {
        double covered = 1;
        for (const auto& [first, last] : block_of(ball)) covered *= last - first + 1;
        entries += covered;
      }
      if (count_[0] == 1 && count_[1] == 1 && count_[2] == 1) break;
    }
    list_balls();
    for (int z = 0; z < count_[2]; ++z)
      for (int y = 0; y < count_[1]; ++y)
        for (int x = 0; x < count_[0]; ++x) {
          Cell& cell = cells_[cell_index(x, y, z)];
          most_listed_ = std::max(most_listed_, size_t(cell.end - cell.begin));
          const auto [from, to] = cell_box({x, y, z});
          const auto [least, most] = range(cell, from, to);
          cell.sign = most < double(threshold) ? Sign::outside : (least > double(threshold) ? Sign::inside : Sign::mixed);
        }
  }

  /// Lists, for each cell, the balls that overlap it, in their order; a first pass counts them.
  void list_balls() {
    cells_.assign(size_t(count_[0]) * size_t(count_[1]) * size_t(count_[2]), {});
    most_listed_ = 0;
    const auto for_cells_of = [&](const Ball& ball, const auto& visit) {
      const Block block = block_of(ball);
      for (int z = block[2][0]; z <= block[2][1]; ++z)
        for (int y = block[1][0]; y <= block[1][1]; ++y)
          for (int x = block[0][0]; x <= block[0][1]; ++x) {
            const auto [from, to] = cell_box({x, y, z});
            if (overlaps(ball, from, to)) visit(cells_[cell_index(x, y, z)]);
          }
    };
    for (const Ball& ball : balls_) for_cells_of(ball, [](Cell& cell) { ++cell.end; });
    std::uint32_t sum = 0;
    for (Cell& cell : cells_) {
      const std::uint32_t count = cell.end;
      cell.begin = cell.end = sum;
      sum += count;
    }
    listed_.resize(sum);
    for (size_t i = 0; i < balls_.size(); ++i)
      for_cells_of(balls_[i], [&](Cell& cell) { listed_[cell.end++] = std::uint32_t(i); });
  }

  /// The index of the cell at a coordinate along an axis, clamped to the grid.
  int cell_at(double x, size_t k) const {
    const double cell = std::floor((x - low_[k]) * scale_[k]);
    return cell > 0 ? int(std::min(cell, double(count_[k] - 1))) : 0;  // 0 where it is NaN, because the box has no extent
  }

  /// The cells that a box overlaps or, within rounding, touches.
  Block block_between(const Place& from, const Place& to) const {
    Block block;
    for (size_t k = 0; k < 3; ++k) {
      const double margin = 2 * cell_margin / scale_[k];
      block[k] = {cell_at(from[k] - margin, k), cell_at(to[k] + margin, k)};
    }
    return block;
  }

  Block block_of(const Ball& ball) const {
    const double reach = std::sqrt(1 / ball.inverse_square);
    const Place& c = ball.centre;
    return block_between({c[0] - reach, c[1] - reach, c[2] - reach}, {c[0] + reach, c[1] + reach, c[2] + reach});
  }

  /// A cell's box, widened by a margin, because points are assigned to cells by rounded coordinates.
  std::pair<Place, Place> cell_box(const std::array<int, 3>& at) const {
    Place from, to;
    for (size_t k = 0; k < 3; ++k) {
      from[k] = low_[k] + (at[k] - cell_margin) / scale_[k];
      to[k] = low_[k] + (at[k] + 1 + cell_margin) / scale_[k];
    }
    return {from, to};
  }

  static bool overlaps(const Ball& ball, const Place& from, const Place& to) {
    double near = 0;
    for (size_t k = 0; k < 3; ++k) {
      const double d = std::max({from[k] - ball.centre[k], ball.centre[k] - to[k], 0.0});
      near += d * d;
    }
    return near * ball.inverse_square <= 1;
  }

  size_t cell_index(int x, int y, int z) const {
    return (size_t(z) * size_t(count_[1]) + size_t(y)) * size_t(count_[0]) + size_t(x);
  }

  /// Calls visit(ball, u) for each ball that contains a point.
  template <class F>
  void for_balls_at(const Place& x, const F& visit) const {
    const Cell& cell = cells_[cell_index(cell_at(x[0], 0), cell_at(x[1], 1), cell_at(x[2], 2))];
    for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
      const Ball& ball = balls_[listed_[i]];
      double r2 = 0;
      for (size_t k = 0; k < 3; ++k) r2 += (x[k] - ball.centre[k]) * (x[k] - ball.centre[k]);
      const double u = 1 - r2 * ball.inverse_square;
      if (u > 0) visit(ball, u);
    }
  }

  /// Between consecutive ends of pieces, sums the polynomials of the balls that contain that part of the ray.
  bool crosses_cell(const Cell& cell, const DoubleRay& r, double enter, double leave, bool& inside, double& t) const {
    thread_local std::vector<Piece> pieces;
    if (pieces.size() < most_listed_) pieces.resize(most_listed_);
    size_t count = 0;
    for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
      const Ball& ball = balls_[listed_[i]];
      double a = 0, h = 0, c = -1 / ball.inverse_square;
      for (int k = 0; k < 3; ++k) {
        const double x = r.at(enter, k) - ball.centre[size_t(k)];
        a += r.direction[k] * r.direction[k];
        h += r.direction[k] * x;
        c += x * x;
      }
      const double discriminant = h * h - a * c;
      if (!(discriminant > 0)) continue;
      const double root = std::sqrt(discriminant);
      const double begin = std::max(enter, enter - (h + root) / a), end = std::min(leave, enter + (root - h) / a);
      if (begin < end) pieces[count++] = {begin, end, &ball};
    }
    for (double from = enter; from < leave;) {
      double to = leave;
      for (size_t i = 0; i < count; ++i) {
        if (pieces[i].begin > from) to = std::min(to, pieces[i].begin);
        if (pieces[i].end > from) to = std::min(to, pieces[i].end);
      }
      double b[7];
      std::fill(b, b + 7, double(threshold));
      for (size_t i = 0; i < count; ++i)
        if (pieces[i].begin <= from && pieces[i].end >= to) subtract(*pieces[i].ball, r, from, to, b);
      if (bernstein::crosses<6>(b, from, to, inside, t)) return true;
      from = to;
    }
    return false;
  }

  /// Subtracts from b the Bernstein coefficients of a ball's density along a part of the ray: those of u (degree 2), u^2 (4)
  /// and u^3 (6), by (f g)_k = sum over i + j = k of C(m, i) C(n, j) / C(m + n, k) f_i g_j.
  static void subtract(const Ball& ball, const DoubleRay& r, double from, double to, double (&b)[7]) {
    double start = 0, end = 0, slope = 0;  // values at the ends, and half the slope at the start, of r^2
    for (int k = 0; k < 3; ++k) {
      const double x = r.at(from, k) - ball.centre[size_t(k)], y = r.at(to, k) - ball.centre[size_t(k)];
      start += x * x;
      end += y * y;
      slope += x * r.direction[k] * (to - from);
    }
    const double u0 = 1 - start * ball.inverse_square, u1 = u0 - slope * ball.inverse_square,
                 u2 = 1 - end * ball.inverse_square;
    const double v0 = u0 * u0, v1 = u0 * u1, v2 = (u0 * u2 + 2 * u1 * u1) / 3, v3 = u1 * u2, v4 = u2 * u2, s = ball.strength;
    b[0] -= s * v0 * u0;
    b[1] -= s * (v0 * u1 + 2 * v1 * u0) / 3;
    b[2] -= s * (v0 * u2 + 8 * v1 * u1 + 6 * v2 * u0) / 15;
    b[3] -= s * (v1 * u2 + 3 * v2 * u1 + v3 * u0) / 5;
    b[4] -= s * (6 * v2 * u2 + 8 * v3 * u1 + v4 * u0) / 15;
    b[5] -= s * (2 * v3 * u2 + v4 * u1) / 3;
    b[6] -= s * v4 * u2;
  }

  static constexpr double cell_margin = 1e-9;  // in units of cells
  std::vector<Ball> balls_;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> listed_;
  size_t most_listed_ = 0;
  int count_[3]{1, 1, 1};  // number of cells along each axis
  Place low_{}, scale_{};  // low corner of the grid; cells per m
};

const Register<Metaballs> registered;

}  // namespace
}  // namespace etendue
